#include "net/flow_control.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "messages.hpp"

namespace vrut::server::net {

using namespace std::chrono_literals;
using Seconds = std::chrono::duration<double>;

namespace {

/// So much may wait in queues of the link, beyond what fills its round trip.
constexpr Seconds kQueue = 100ms;
/// The same for updates, which are small: a host is to get every change while its link takes them.
constexpr auto kUpdateQueue = 250ms;
/// Updates leave so many times the time that they take to other messages, in the mean over kUpdateQueue.
constexpr int kUpdatePause = 4;
/// Bytes that may be under way behind which an update is sent, on a link that is not measured.
constexpr std::size_t kFewBytes = 8192, kFewestBytes = 1024;
/// Who has a frame and does not acknowledge it for longer does something else: the frame's arrival counts.
constexpr auto kThinking = 250ms;
/// A link of which nothing is heard any more is tried again.
constexpr auto kFrameTimeout = 5s, kUpdateTimeout = 10s;
/// Weights of a new measurement in the mean, by the logarithm of the rate: bad news count more.
constexpr double kSlowerWeight = 0.5, kFasterWeight = 0.25;
constexpr Seconds kShortest = 1ms;  // of a measurement: clocks and threads are not more exact
constexpr std::size_t kMostTracked = 64;
/// A frame that takes longer may be in somebody's way.
constexpr Seconds kLongestWait = 60s;

}  // namespace

void FlowControl::credit() { credits_ = std::min(credits_ + 1, protocol::kMaxGrants); }

void FlowControl::grant() {
    credit();
    // The first grants have nothing to acknowledge, even where a frame was sent between them.
    ++plain_grants_;
    if (newest_ > 0 && (acknowledges_ || plain_grants_ > protocol::kMaxGrants)) {
        counts_grants_ = true;
        acknowledges_ = false;
    }
}

bool FlowControl::grant(std::int64_t frame, Clock::time_point now) {
    const auto known =
        std::find_if(frames_.begin(), frames_.end(), [&](const Frame& sent) { return sent.number == frame; });
    const bool forgotten = frame > 0 && frame <= forgotten_;
    if (known == frames_.end() && !forgotten) return false;
    credit();
    acknowledges_ = true;
    counts_grants_ = false;
    if (known == frames_.end() || known->shown) return true;  // out of order
    arrive(known->end, now);
    for (auto earlier = frames_.begin(); earlier <= known; ++earlier) earlier->shown = true;
    measure(*known, now - *known->arrived_at <= kThinking ? now : *known->arrived_at);
    return true;
}

void FlowControl::sent(std::size_t bytes, Clock::time_point now) {
    sent_ += bytes;
    sent_at_ = now;
    passed_at_ = std::max(passed_at_, now) + passing(bytes, now);
}

void FlowControl::sent_frame(std::int64_t frame, std::size_t bytes, Clock::time_point now) {
    sent(bytes, now);
    newest_ = frame;
    --credits_;
    frames_.push_back({frame, bytes, sent_, now});
    if (frames_.size() <= kMostTracked) return;
    forgotten_ = frames_.front().number;
    frames_.pop_front();
}

void FlowControl::sent_update(std::size_t bytes, Clock::time_point now) {
    sent(bytes, now);
    // Updates that must go before answers and frames are not asked for here, and count all the same.
    update_from_ =
        std::min(std::max(update_from_, now - kUpdateQueue) + (1 + kUpdatePause) * passing(bytes, now),
                 now + kUpdateTimeout);
}

bool FlowControl::wants_ping() const {
    if (next_ping_ == 1) return true;
    if (sent_ == pinged_ || pings_.size() >= kMostTracked) return false;
    const bool behind_frame = !frames_.empty() && frames_.back().end > pinged_;
    return behind_frame || pings_.empty();
}

std::uint64_t FlowControl::sent_ping(Clock::time_point now) {
    pings_.push_back({next_ping_, sent_, now, in_flight() == 0});
    if (pings_.size() > kMostTracked) pings_.pop_front();
    pinged_ = sent_;
    return next_ping_++;
}

void FlowControl::pong(std::uint64_t number, Clock::time_point now) {
    const auto ping =
        std::find_if(pings_.begin(), pings_.end(), [&](const Ping& sent) { return sent.number == number; });
    if (ping == pings_.end()) return;
    const Clock::duration took = now - ping->sent_at;
    // Behind other messages a ping takes longer than the link's round trip.
    round_trip_ = ping->idle ? took : std::min(took, round_trip_.value_or(took));
    const std::size_t end = ping->end;
    pings_.erase(pings_.begin(), ping + 1);
    arrive(end, now);
}

/// Everything up to `end` has arrived.
void FlowControl::arrive(std::size_t end, Clock::time_point now) {
    if (end <= arrived_) return;
    arrived_ = end;
    if (in_flight() == 0) passed_at_ = now;
    heard_at_ = now;
    for (Frame& frame : frames_)
        if (frame.end <= end && !frame.arrived_at) frame.arrived_at = now;
}

/// A frame begins to pass through the link when it was sent, or when the one before it has passed; updates
/// that were sent between the two pass with it.
void FlowControl::measure(const Frame& frame, Clock::time_point shown_at) {
    if (shown_at < free_at_) return;  // it arrived behind one that was shown later: nothing is known
    const Clock::time_point alone = frame.sent_at + round_trip();
    const std::size_t bytes = alone < free_at_ ? frame.end - measured_end_ : frame.bytes;
    const Seconds took = shown_at - std::max(alone, free_at_);
    free_at_ = shown_at;
    measured_end_ = frame.end;
    const double rate = static_cast<double>(bytes) / std::max(took, kShortest).count();
    if (!rate_) {
        rate_ = rate;
        return;
    }
    const double weight = rate < *rate_ ? kSlowerWeight : kFasterWeight;
    rate_ = *rate_ * std::pow(rate / *rate_, weight);
}

/// How long so many bytes take to pass the link, by its measured rate; 0 where it is not measured.
FlowControl::Clock::duration FlowControl::passing(std::size_t bytes, Clock::time_point now) const {
    const auto measured = link(now);
    const Seconds takes(measured ? static_cast<double>(bytes) / measured->bytes_per_second : 0);
    return std::chrono::duration_cast<Clock::duration>(std::min<Seconds>(takes, kLongestWait));
}

/// How long what is in flight will wait in queues of the link.
FlowControl::Clock::duration FlowControl::queueing(Clock::time_point now) const {
    return passing(in_flight(), now) - round_trip();
}

/// When the newest frame has passed the link, by its rate: on a long link it is not heard for long.
FlowControl::Clock::time_point FlowControl::frame_passed_at(Clock::time_point now) const {
    if (frames_.empty() || frames_.back().arrived_at) return {};
    return frames_.back().sent_at + passing(frames_.back().bytes, now);
}

/// Returns true if a second frame would wait behind one like the newest.
bool FlowControl::is_slow(Clock::time_point now) const {
    if (!link(now) || frames_.empty()) return !counts_grants_;
    return passing(frames_.back().bytes, now) > kQueue;
}

int FlowControl::frames_allowed(Clock::time_point now) const {
    if (credits_ == 0 || counts_grants_) return credits_;
    const int at_once = is_slow(now) ? 1 : credits_;
    if (in_flight() == 0) return at_once;
    if (link(now)) return std::max(queueing(now), frame_passed_at(now) - now) <= kQueue ? at_once : 0;
    // Nothing was heard of a frame yet: the next one waits for that.
    const bool frame_in_flight = !frames_.empty() && !frames_.back().arrived_at;
    return !frame_in_flight || now - sent_at_ >= kFrameTimeout ? at_once : 0;
}

bool FlowControl::may_send_update(Clock::time_point now) const {
    if (now < update_from_) return false;
    if (in_flight() == 0 || now - std::max(heard_at_, sent_at_) >= kUpdateTimeout) return true;
    // On a long link it is not heard for long what of it has passed.
    return link(now) && !counts_grants_ ? std::max(queueing(now), passed_at_ - now) <= kUpdateQueue
                                        : in_flight() <= (counts_grants_ ? kFewBytes : kFewestBytes);
}

std::optional<FlowControl::Clock::time_point> FlowControl::ask_again(Clock::time_point now) const {
    constexpr auto queue = std::chrono::duration_cast<Clock::duration>(kQueue);
    std::optional<Clock::time_point> first;
    const auto may_at = [&](Clock::time_point at) {
        if (at > now) first = std::min(first.value_or(at), at);
    };
    if (credits_ > 0 && !may_send_frame(now))
        may_at(link(now) ? frame_passed_at(now) - queue : sent_at_ + kFrameTimeout);
    if (!may_send_update(now)) {
        may_at(link(now) ? std::max(passed_at_ - kUpdateQueue, update_from_) : update_from_);
        may_at(std::max(heard_at_, sent_at_) + kUpdateTimeout);
    }
    return first;
}

std::optional<engine::Link> FlowControl::link(Clock::time_point now) const {
    if (counts_grants_) return engine::Link{std::numeric_limits<double>::infinity(), round_trip()};
    if (!acknowledges_ || !rate_) return std::nullopt;
    engine::Link measured{*rate_, round_trip()};
    // A frame that has not arrived for long tells of a slower link than those before it.
    const auto under_way =
        std::find_if(frames_.begin(), frames_.end(), [](const Frame& frame) { return !frame.arrived_at; });
    if (under_way == frames_.end()) return measured;
    const Clock::time_point begin = std::max(under_way->sent_at + round_trip(), free_at_);
    const double bound =
        static_cast<double>(under_way->bytes) / std::max<Seconds>(now - begin, kShortest).count();
    measured.bytes_per_second = std::min(measured.bytes_per_second, bound);
    return measured;
}

FlowControl::Clock::time_point FlowControl::may_send_from(std::size_t bytes, Clock::time_point idle_since,
                                                          Clock::time_point now) const {
    const Clock::duration takes = passing(bytes, now);
    return takes <= engine::kLongDelivery ? now : idle_since + takes;
}

}  // namespace vrut::server::net
