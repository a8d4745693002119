// How a session's peer is doing.
#include <linux/sockios.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <cstring>

#include "net/connection.hpp"

namespace vrut::server::net {

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
        self->look_after(base::Clock::now());
        if (!self->dropped_) self->watch();
    });
}

/// Whether news would wait in the socket, where frames arrive late even a few.
bool Session::is_behind() {
    constexpr int kFewNews = 1024, kManyNews = 8192;  // bytes
    const int frame = has_frame() ? 0 : static_cast<int>(frame_bytes_);
    const int waiting = traffic_of(beast::get_lowest_layer(socket_).socket().native_handle()).waiting;
    return waiting > (frames_are_late_ ? kFewNews : kManyNews + frame);
}

/// Cuts who takes nothing of what waits for him, who does not come to the end of a message, and who is silent
/// though he got everything, a ping as well: one whose ping waits behind a frame may be slow.
void Session::look_after(base::Clock::time_point now) {
    const Deadlines& deadlines = hub_.deadlines;
    const Traffic traffic = traffic_of(beast::get_lowest_layer(socket_).socket().native_handle());
    const bool has_all = !writing_ && traffic.waiting == 0;
    if (std::exchange(acknowledged_, traffic.acknowledged) != traffic.acknowledged || has_all)
        progress_at_ = now;
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
    // Who is heard of, too, once there was a pong: while nothing is on its way, it tells how long that is.
    const auto since = round_trip_ && traffic.waiting == 0 ? pinged_at_ : std::max(heard_at_, pinged_at_);
    if (!closing_ && !pinging_ && now - since >= deadlines.ping) ping(now);
}

void Session::frame_written() {
    constexpr auto kDelayedBy = 50ms;  // TCP may acknowledge 40 ms later
    const Traffic traffic = traffic_of(beast::get_lowest_layer(socket_).socket().native_handle());
    frame_end_ = traffic.acknowledged + static_cast<std::uint64_t>(traffic.waiting);
    frame_timer_.expires_after(kDelayedBy + round_trip_.value_or(base::Clock::duration{}));
    frame_timer_.async_wait([weak = weak_from_this()](beast::error_code stopped) {
        const auto self = weak.lock();
        if (!stopped && self && !self->dropped_) self->frames_are_late_ = !self->has_frame();
    });
}

/// Whether the peer has acknowledged all of the newest frame that was written.
bool Session::has_frame() {
    return traffic_of(beast::get_lowest_layer(socket_).socket().native_handle()).acknowledged >= frame_end_;
}

void Session::ping(base::Clock::time_point now) {
    pinging_ = true;
    pinged_at_ = now;
    socket_.async_ping({}, [self = shared_from_this()](beast::error_code) { self->pinging_ = false; });
}

void Session::on_pong(base::Clock::time_point now) {
    if (pinged_at_ == base::Clock::time_point{}) return;  // nobody asked
    const base::Clock::duration took = now - pinged_at_;
    round_trip_ = std::min(took, round_trip_.value_or(took));
}

}  // namespace vrut::server::net
