// Whether a connection's peer is alive, and takes what it is sent.
#include <charconv>

#include "net/connection.hpp"

namespace vrut::server::net {

namespace beast = boost::beast;
using namespace std::chrono_literals;

namespace {

constexpr auto kPollInterval = 1s;  // between two looks at how the peer is doing
// Of answers and snapshots somebody who asks for more than these must take so much: they are kept for him
// alone, while frames and updates replace each other.
constexpr std::size_t kMayWait = std::size_t{64} * 1024;  // bytes
constexpr int kLeastRateOfQueued = 4000;                  // bytes per second

}  // namespace

void Connection::poll_deadlines() {
    const auto next = base::Clock::now() + kPollInterval;
    deadline_timer_.expires_at(unfinished_since() && !closing_
                                   ? std::min(next, *unfinished_since() + registry_.deadlines.message)
                                   : next);
    deadline_timer_.async_wait([weak = weak_from_this()](beast::error_code stopped) {
        const auto self = weak.lock();
        if (stopped || !self || self->dropped_) return;
        self->check_deadlines(base::Clock::now());
        if (!self->dropped_) self->poll_deadlines();
    });
}

/// Cuts who does not take a message in its time, who does not come to the end of one, and who is silent: one
/// whose ping waits behind a frame may be slow.
void Connection::check_deadlines(base::Clock::time_point now) {
    const Deadlines& deadlines = registry_.deadlines;
    if (!writing_ || std::exchange(taken_seen_, traffic().taken) != traffic().taken) progress_at_ = now;
    if (now >= write_by_ ? writing_ : now - progress_at_ >= deadlines.stuck) return drop("stuck");
    if (takes_too_little(now)) return drop("stuck");
    if (unfinished_since() && !closing_ && now - *unfinished_since() >= deadlines.message) {
        reject_and_close(
            {{}, protocol::error_code::bad_message, "a message took too long to come to its end"},
            beast::websocket::close_code::policy_error);
        close_reason_ = "slow";
        return;
    }
    const auto waits = std::chrono::seconds(flow_.in_flight() / kLeastRate);
    if (!writing_ && reading_ && now - heard_at_ >= deadlines.idle + waits) return drop("silent");
    if (!closing_ && !client_.empty() && !writing_ && now - std::max(heard_at_, pinged_at_) >= deadlines.ping)
        send_ping(now);
}

/// Bytes that are kept for this client alone: answers and snapshots.
std::size_t Connection::queued() const {
    std::size_t bytes = answer_bytes_;
    for (const auto& picture : snapshots_) bytes += picture->file.size();
    return bytes + (sends_queued_ ? sending() : 0);
}

/// Of what is being sent, this client's part.
std::size_t Connection::sending() const {
    const auto part = [](std::size_t size, long sharers) { return size / static_cast<std::size_t>(sharers); };
    return (text_ ? part(text_->size(), text_.use_count()) : 0) +
           (picture_ ? part(picture_->file.size(), picture_.use_count()) : 0);
}

std::size_t Connection::backlog() const { return queued() + (sends_queued_ ? 0 : sending()); }

bool Connection::takes_too_little(base::Clock::time_point now) {
    const bool rated = queued() > kMayWait;
    const std::chrono::duration<double> passed = now - rated_since_;
    if (rated && passed < registry_.deadlines.least_rate) return false;
    const std::uint64_t taken = traffic().taken - std::exchange(taken_before_, traffic().taken);
    rated_since_ = now;
    return rated && static_cast<double>(taken) < kLeastRateOfQueued * passed.count();
}

void Connection::on_pong(std::string_view text, base::Clock::time_point now) {
    heard_at_ = now;
    std::uint64_t number = 0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    flow_.pong(number, now);
    ask_for_frames(now);
    pump();
}

}  // namespace vrut::server::net
