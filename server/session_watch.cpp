// How a session's peer is doing.
#include <linux/sockios.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <cstring>

#include "session.hpp"

namespace vrut {

namespace beast = boost::beast;
using namespace std::chrono_literals;

namespace {

constexpr auto kLook = 1s;  // between two looks at how the peer is doing

/// What the kernel knows of a connection, in bytes since it began.
struct Traffic {
    std::uint64_t acknowledged = 0;  ///< by the peer
    std::uint64_t received = 0;      ///< from the peer
    int waiting = 0;                 ///< handed over here, and not acknowledged yet
};

Traffic traffic_of(int socket) {
    // tcpi_bytes_acked and tcpi_bytes_received: the C library's struct tcp_info ends before, the kernel's
    // goes on.
    constexpr std::size_t kAckedAt = 120, kReceivedAt = 128;
    std::array<std::uint8_t, 256> raw{};
    socklen_t size = raw.size();
    Traffic traffic;
    if (::getsockopt(socket, IPPROTO_TCP, TCP_INFO, raw.data(), &size) == 0 && size >= kReceivedAt + 8) {
        std::memcpy(&traffic.acknowledged, raw.data() + kAckedAt, sizeof traffic.acknowledged);
        std::memcpy(&traffic.received, raw.data() + kReceivedAt, sizeof traffic.received);
    }
    // Afterwards: what is acknowledged meanwhile makes the sum of both too small, never too large.
    if (::ioctl(socket, SIOCOUTQ, &traffic.waiting) != 0) traffic.waiting = 0;
    return traffic;
}

}  // namespace

void Session::watch() {
    watch_.expires_after(kLook);
    watch_.async_wait([weak = weak_from_this()](beast::error_code stopped) {
        const auto self = weak.lock();
        if (stopped || !self || self->dropped_) return;
        self->look_after(Clock::now());
        if (!self->dropped_) self->watch();
    });
}

/// Whether news would wait in the socket, where frames arrive late even a few. They do not wait here for
/// ever, though.
bool Session::is_behind(Clock::time_point now) {
    constexpr int kFewNews = 1024, kManyNews = 8192;  // bytes
    constexpr auto kLongestSilence = 10s;
    const Traffic traffic = traffic_of(beast::get_lowest_layer(socket_).socket().native_handle());
    has_frame(traffic.acknowledged, now);
    return now - told_at_ < kLongestSilence && traffic.waiting > (frames_are_late_ ? kFewNews : kManyNews);
}

/// Cuts who takes nothing of what waits for him, who does not come to the end of a message, and who is silent
/// though he got everything, a ping as well: one whose ping waits behind a frame may be slow.
void Session::look_after(Clock::time_point now) {
    const Deadlines& deadlines = hub_.deadlines;
    const Traffic traffic = traffic_of(beast::get_lowest_layer(socket_).socket().native_handle());
    const bool has_all = !writing_ && traffic.waiting == 0;
    if (std::exchange(acknowledged_, traffic.acknowledged) != traffic.acknowledged || has_all)
        progress_at_ = now;
    has_frame(acknowledged_, now);
    if (std::exchange(received_, traffic.received) != traffic.received || !reading_) heard_at_ = now;
    if (now - progress_at_ >= deadlines.stuck) return drop("stuck");
    if (begun_ && !closing_ && now - *begun_ >= deadlines.message) {
        refuse_and_close(
            {{}, protocol::error_code::bad_message, "a message took too long to come to its end"},
            beast::websocket::close_code::policy_error);
        close_reason_ = "slow";
        return;
    }
    if (has_all && now - heard_at_ >= deadlines.silence) return drop("silent");
    if (!closing_ && !pinging_ && now - std::max(heard_at_, pinged_at_) >= deadlines.ping) ping(now);
}

void Session::frame_written() {
    const Traffic traffic = traffic_of(beast::get_lowest_layer(socket_).socket().native_handle());
    frame_end_ = traffic.acknowledged + static_cast<std::uint64_t>(traffic.waiting);
    frame_written_at_ = Clock::now();
}

/// Whether the peer, who has acknowledged so many bytes, has all of the newest frame.
bool Session::has_frame(std::uint64_t acknowledged, Clock::time_point now) {
    constexpr auto kInTime = 50ms;  // TCP may delay what it acknowledges by 40
    const bool has_it = acknowledged >= frame_end_;
    if (has_it == (now - frame_written_at_ < kInTime)) frames_are_late_ = !has_it;
    return has_it;
}

/// The same; true while that frame is being written.
bool Session::may_have_frame() {
    const auto socket = beast::get_lowest_layer(socket_).socket().native_handle();
    return writes_frame_ || has_frame(traffic_of(socket).acknowledged, Clock::now());
}

void Session::ping(Clock::time_point now) {
    pinging_ = true;
    pinged_at_ = now;
    socket_.async_ping({}, [self = shared_from_this()](beast::error_code) { self->pinging_ = false; });
}

void Session::on_pong(Clock::time_point now) {
    if (pinged_at_ == Clock::time_point{}) return;  // nobody asked
    const Clock::duration took = now - pinged_at_;
    round_trip_ = std::min(took, round_trip_.value_or(took));
}

}  // namespace vrut
