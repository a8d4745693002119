#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "base/clock.hpp"
#include "engine/link.hpp"

namespace vrut::server::net {

/// Decides when a client may be sent a frame or an update of the state, and measures its link. Its inputs are
/// what was sent, acknowledged and ponged, and when; it holds all credits. Proxies and kernels take bytes
/// long before the client has them. So a message has arrived only if the client acknowledges it, or answers a
/// ping that was sent behind it. Messages before an arrived one have arrived, too.
class FlowControl {
public:
    using Clock = base::Clock;

    /// The client grants one more frame and acknowledges none. Where it was sent one before, and this is none
    /// of its first grants (protocol::kMaxGrants), its grants are counted from then on and its link is taken
    /// as unlimited, until it acknowledges one.
    void grant();
    /// The client grants one more frame and has shown `frame`. False: it was never sent, and nothing changes.
    bool grant(std::int64_t frame, Clock::time_point now);

    /// A frame was handed to the socket, for one credit.
    void sent_frame(std::int64_t frame, std::size_t bytes, Clock::time_point now);
    /// An update was.
    void sent_update(std::size_t bytes, Clock::time_point now);
    /// Anything else was.
    void sent(std::size_t bytes, Clock::time_point now);

    /// Returns true if a ping is to follow what was sent: the first before anything else, then one behind
    /// every frame, and behind other messages where none is under way.
    bool wants_ping() const;
    /// A ping was handed to the socket; its number, which the pong brings back.
    std::uint64_t sent_ping(Clock::time_point now);
    /// A number that is not under way is ignored.
    void pong(std::uint64_t number, Clock::time_point now);

    /// Frames that were granted and not sent.
    int credits() const { return credits_; }
    /// Credits that may be used now; 0 while a frame must wait.
    int frames_allowed(Clock::time_point now) const;
    bool may_send_frame(Clock::time_point now) const { return frames_allowed(now) > 0; }
    /// True if an update may be sent now. Updates wait here, where a newer one replaces them, rather than in
    /// the link's queue.
    bool may_send_update(Clock::time_point now) const;
    /// The earliest time at which may_send_frame() or may_send_update() may become true without an arrival;
    /// none if there is no such time.
    std::optional<Clock::time_point> ask_again(Clock::time_point now) const;

    /// None before the first measurement; unlimited for a client that does not acknowledge.
    std::optional<engine::Link> link(Clock::time_point now) const;
    /// When a frame of `bytes` may be sent: now if it passes the link within kLongDelivery, else once the
    /// view has been idle, which it is since `idle_since`, for as long as the frame takes.
    Clock::time_point may_send_from(std::size_t bytes, Clock::time_point idle_since,
                                    Clock::time_point now) const;
    /// Bytes that were sent and are not known to have arrived.
    std::size_t in_flight() const { return sent_ - arrived_; }

private:
    struct Frame {
        std::int64_t number = 0;
        std::size_t bytes = 0, end = 0;  ///< `end`: of all bytes sent
        Clock::time_point sent_at;
        std::optional<Clock::time_point> arrived_at = {};
        bool shown = false;
    };
    struct Ping {
        std::uint64_t number = 0;
        std::size_t end = 0;  ///< of all bytes sent before it
        Clock::time_point sent_at;
        bool idle = false;  ///< nothing was in flight
    };
    void credit();
    void arrive(std::size_t end, Clock::time_point now);
    void measure(const Frame& frame, Clock::time_point shown_at);
    Clock::duration round_trip() const { return round_trip_.value_or(Clock::duration{}); }
    bool is_slow(Clock::time_point now) const;
    Clock::duration passing(std::size_t bytes, Clock::time_point now) const;
    Clock::duration queueing(Clock::time_point now) const;
    Clock::time_point frame_passed_at(Clock::time_point now) const;

    int credits_ = 0;
    std::uint64_t plain_grants_ = 0;  ///< that acknowledged none
    bool acknowledges_ = false, counts_grants_ = false;
    std::size_t sent_ = 0, arrived_ = 0;  ///< bytes
    std::int64_t newest_ = 0;             ///< frame that was sent
    std::int64_t forgotten_ = 0;          ///< the newest frame that is not in frames_ any more
    Clock::time_point sent_at_{};         ///< the newest message
    Clock::time_point passed_at_{};       ///< when what was sent has passed the link, by its rate
    Clock::time_point update_from_{};     ///< the earliest next update
    Clock::time_point heard_at_{};        ///< the newest arrival
    std::size_t pinged_ = 0;              ///< bytes sent before the newest ping
    std::deque<Frame> frames_;            ///< the last that were sent
    std::deque<Ping> pings_;              ///< under way
    std::uint64_t next_ping_ = 1;
    std::optional<Clock::duration> round_trip_;
    std::optional<double> rate_;    ///< bytes per second
    Clock::time_point free_at_{};   ///< when the frame measured last was shown
    std::size_t measured_end_ = 0;  ///< of that frame
};

}  // namespace vrut::server::net
