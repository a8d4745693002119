// How a session's peer is doing.
#include <charconv>

#include "net/connection.hpp"

namespace vrut::server::net {

namespace beast = boost::beast;
using namespace std::chrono_literals;

namespace {

constexpr auto kLook = 1s;        // between two looks at how the peer is doing
constexpr int kLeastRate = 1000;  // bytes per second

}  // namespace

void Session::watch() {
    watch_.expires_after(kLook);
    watch_.async_wait([weak = weak_from_this()](beast::error_code stopped) {
        const auto self = weak.lock();
        if (stopped || !self || self->dropped_) return;
        self->look_after(base::Clock::now());
        if (!self->dropped_) self->watch();
    });
}

/// Cuts who does not take a message in its time, who does not come to the end of one, and who is silent: one
/// whose ping waits behind a frame may be slow.
void Session::look_after(base::Clock::time_point now) {
    const Deadlines& deadlines = hub_.deadlines;
    if (writing_ && now >= write_by_) return drop("stuck");
    if (begun_ && !closing_ && now - *begun_ >= deadlines.message) {
        refuse_and_close(
            {{}, protocol::error_code::bad_message, "a message took too long to come to its end"},
            beast::websocket::close_code::policy_error);
        close_reason_ = "slow";
        return;
    }
    const auto waits = std::chrono::seconds(flow_.in_flight() / kLeastRate);
    if (!writing_ && reading_ && now - heard_at_ >= deadlines.silence + waits) return drop("silent");
    if (!closing_ && !client_.empty() && !writing_ && now - std::max(heard_at_, pinged_at_) >= deadlines.ping)
        send_ping(now);
}

void Session::on_pong(std::string_view text, base::Clock::time_point now) {
    heard_at_ = now;
    std::uint64_t number = 0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    flow_.pong(number, now);
    ask_for_frames(now);
    pump();
}

}  // namespace vrut::server::net
