// What may be sent to a client when, and what is known of its link: by a fake clock and a simulated link.
#include "net/flow_control.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

using namespace vrut::server::net;
using namespace std::chrono_literals;
using Clock = vrut::server::base::Clock;
using Seconds = std::chrono::duration<double>;

namespace {

constexpr Clock::duration kTick = 1ms;

/// A client behind a link, each way with a delay, towards it with a rate; and a server that sends it frames
/// of one size whenever it may, and an update after each while something moves.
struct Simulation {
    double bytes_per_second = 1e6;
    Clock::duration delay = 5ms;   ///< one way
    Clock::duration thinks = 0ms;  ///< between having a frame and granting the next
    std::size_t frame_bytes = 20'000, update_bytes = 0;
    bool acknowledges = true, pongs = true;
    int most_frames = 1'000'000;  ///< for which the client asks

    FlowControl flow;
    Clock::time_point now{1h};
    Clock::time_point stalled_until{};
    int sent = 0, arrived = 0, most_in_flight = 0;
    std::size_t most_bytes_in_flight = 0;
    Clock::duration oldest_update{}, oldest_frame{};  ///< when it arrived, since it was handed over

    Simulation() {
        at(now, [this] {
            ping();
            at(now + 4 * delay, [this] {
                grant();
                grant();
            });
        });
    }

    void run(Clock::duration lasts) {
        for (const Clock::time_point end = now + lasts; now < end; now += kTick) {
            while (!events_.empty() && events_.begin()->first <= now) {
                const auto event = events_.begin()->second;
                events_.erase(events_.begin());
                event();
            }
            serve();
        }
    }
    double rate() const { return flow.link(now) ? flow.link(now)->bytes_per_second : 0; }

    void at(Clock::time_point when, std::function<void()> event) { events_.emplace(when, std::move(event)); }

private:
    void grant(int shown = 0) {
        if (granted_++ >= most_frames) return;
        at(now + delay, [this, shown] {
            if (shown == 0 || !acknowledges)
                flow.grant();
            else
                CHECK(flow.grant(shown, now));
        });
    }
    /// When what is handed over now has passed the link.
    Clock::time_point passes(std::size_t bytes) {
        const Seconds takes(static_cast<double>(bytes) / bytes_per_second);
        free_at_ =
            std::max({free_at_, now, stalled_until}) + std::chrono::duration_cast<Clock::duration>(takes);
        return free_at_ + delay;
    }
    void serve() {
        ping();
        if (update_bytes > 0 && flow.may_send_update(now) && now >= next_update_) {
            next_update_ = now + 30ms;
            flow.sent_update(update_bytes, now);
            at(passes(update_bytes),
               [this, since = now] { oldest_update = std::max(oldest_update, now - since); });
            ping();
        }
        if (!flow.may_send_frame(now)) return;
        ++sent;
        flow.sent_frame(sent, frame_bytes, now);
        most_in_flight = std::max(most_in_flight, sent - arrived);
        most_bytes_in_flight = std::max(most_bytes_in_flight, flow.in_flight());
        at(passes(frame_bytes), [this, number = sent, since = now] {
            arrived = number;
            oldest_frame = std::max(oldest_frame, now - since);
            client_free_at_ = std::max(client_free_at_, now) + thinks;
            at(client_free_at_, [this, number] { grant(number); });
        });
        ping();
    }
    void ping() {
        if (!flow.wants_ping()) return;
        const std::uint64_t number = flow.sent_ping(now);
        if (pongs) at(passes(2) + delay, [this, number] { flow.pong(number, now); });
    }

    int granted_ = 0;
    std::multimap<Clock::time_point, std::function<void()>> events_;
    Clock::time_point free_at_{}, client_free_at_{}, next_update_{};
};

bool within(double value, double expected, double factor) {
    return value >= expected / factor && value <= expected * factor;
}

const Clock::time_point kStart{1h};

}  // namespace

TEST_CASE("nothing is granted, nothing may be sent") {
    FlowControl flow;
    CHECK(flow.credits() == 0);
    CHECK(!flow.may_send_frame(kStart));
    CHECK(!flow.ask_again(kStart));
    CHECK(flow.may_send_update(kStart));
    CHECK(!flow.link(kStart));
}

TEST_CASE("at most two grants are kept") {
    FlowControl flow;
    for (int i = 0; i < 5; ++i) flow.grant();
    CHECK(flow.credits() == 2);
    CHECK(flow.frames_allowed(kStart) == 1);  // a second one would grow old behind the first
}

TEST_CASE("a frame that leaves between the first two grants does not make the link unlimited") {
    FlowControl flow;
    flow.grant();
    flow.sent_frame(1, 8400, kStart);
    flow.grant();
    CHECK(!flow.link(kStart + 50ms));
    CHECK(flow.frames_allowed(kStart + 50ms) == 0);
    CHECK(flow.grant(1, kStart + 4s));
    CHECK(flow.link(kStart + 4s)->bytes_per_second == doctest::Approx(2100));
}

TEST_CASE("a frame uses one credit") {
    FlowControl flow;
    flow.grant();
    flow.sent_frame(1, 1000, kStart);
    CHECK(flow.credits() == 0);
    CHECK(!flow.may_send_frame(kStart + 1h));
}

TEST_CASE("a frame that was never sent cannot have been shown") {
    FlowControl flow;
    flow.grant();
    CHECK(!flow.grant(1, kStart));
    CHECK(flow.credits() == 1);
    flow.sent_frame(7, 1000, kStart);
    CHECK(!flow.grant(6, kStart));
    CHECK(!flow.grant(8, kStart));
    CHECK(!flow.grant(0, kStart));
    CHECK(!flow.grant(-7, kStart));
    CHECK(flow.credits() == 0);
    CHECK(flow.grant(7, kStart + 1ms));
    CHECK(flow.credits() == 1);
}

TEST_CASE("the first frame goes alone until something is heard of it") {
    FlowControl flow;
    flow.grant();
    flow.grant();
    flow.sent_frame(1, 1000, kStart);
    CHECK(!flow.may_send_frame(kStart));
    CHECK(flow.ask_again(kStart) == kStart + 5s);
    SUBCASE("a pong") {
        flow.pong(flow.sent_ping(kStart), kStart + 10ms);
        CHECK(flow.may_send_frame(kStart + 10ms));
    }
    SUBCASE("an acknowledgement") {
        CHECK(flow.grant(1, kStart + 10ms));
        CHECK(flow.frames_allowed(kStart + 10ms) == 2);
    }
    SUBCASE("a grant without one") {
        flow.grant();
        CHECK(flow.frames_allowed(kStart + 10ms) == 2);
    }
    SUBCASE("nothing for five seconds") { CHECK(flow.may_send_frame(kStart + 5s)); }
}

TEST_CASE("a quick link is measured, and both grants are used") {
    Simulation simulation;
    simulation.run(2s);
    CHECK(within(simulation.rate(), 1e6, 1.2));
    CHECK(simulation.most_in_flight == 2);
    CHECK(simulation.arrived > 60);  // of 100 that the link could take
    CHECK(simulation.flow.link(simulation.now)->round_trip >= 10ms);
    CHECK(simulation.flow.link(simulation.now)->round_trip <= 31ms);
}

TEST_CASE("a very quick link is never taken for a slow one") {
    Simulation simulation;
    simulation.bytes_per_second = 1e9;
    simulation.delay = 1ms;
    simulation.run(1s);
    CHECK(simulation.rate() > 5e6);
    CHECK(simulation.arrived > 200);
}

TEST_CASE("on a slow link one frame is under way at a time") {
    Simulation simulation;
    simulation.bytes_per_second = 2500;
    simulation.frame_bytes = 5500;
    simulation.run(30s);
    CHECK(simulation.most_in_flight == 1);
    CHECK(simulation.oldest_frame <= 2300ms);
    CHECK(within(simulation.rate(), 2500, 1.1));
    CHECK(simulation.arrived >= 12);  // it never idles for long
}

TEST_CASE("on a slow link updates wait here rather than behind frames") {
    Simulation simulation;
    simulation.bytes_per_second = 2500;
    simulation.frame_bytes = 5500;
    simulation.update_bytes = 300;
    simulation.run(30s);
    CHECK(simulation.oldest_update <= 3s);
    CHECK(simulation.oldest_frame <= 3s);
    CHECK(simulation.arrived >= 9);
}

TEST_CASE("on a quick link updates are not held back") {
    Simulation simulation;
    simulation.update_bytes = 300;
    simulation.run(2s);
    CHECK(simulation.oldest_update <= 100ms);
}

TEST_CASE("on a link of which frames take a fifth of a second, every one of many updates leaves at once") {
    FlowControl flow;
    Clock::time_point now = kStart;
    const auto take_frame = [&](std::int64_t number) {
        flow.sent_frame(number, 20'000, now);
        flow.pong(flow.sent_ping(now), now + 200ms);
        CHECK(flow.grant(number, now + 200ms));
    };
    flow.grant();
    take_frame(1);
    now += 1s;
    flow.sent_frame(2, 20'000, now);
    for (int i = 0; i < 60; ++i, now += 3ms) {
        CAPTURE(i);
        CHECK(flow.may_send_update(now));
        flow.sent_update(300, now);
    }
}

TEST_CASE("updates that must go before answers put off the next one by ten seconds at most") {
    FlowControl flow;
    Clock::time_point now = kStart;
    flow.grant();
    flow.sent_frame(1, 5000, now);
    CHECK(flow.grant(1, now += 2s));
    for (int i = 0; i < 100; ++i) {
        flow.sent_update(400, now);
        flow.pong(flow.sent_ping(now), now + 200ms);
        now += 200ms;
    }
    CHECK(!flow.may_send_update(now));
    CHECK(flow.may_send_update(now + 10s));
}

TEST_CASE("a frame that had arrived before one that was shown later tells nothing of the link") {
    FlowControl flow;
    flow.grant();
    flow.sent_frame(1, 5000, kStart);
    flow.pong(flow.sent_ping(kStart), kStart + 100ms);
    CHECK(flow.grant(1, kStart + 100ms));
    flow.grant(1, kStart + 100ms);
    const Clock::time_point now = kStart + 1s;
    flow.sent_frame(2, 5000, now);
    const auto second = flow.sent_ping(now);
    flow.sent_frame(3, 5000, now);
    const auto third = flow.sent_ping(now);
    flow.pong(second, now + 110ms);
    flow.pong(third, now + 120ms);
    CHECK(flow.grant(2, now + 340ms));
    const double rate = flow.link(now + 340ms)->bytes_per_second;
    CHECK(flow.grant(3, now + 400ms));  // it is taken as shown when it arrived, before the second was
    CHECK(flow.link(now + 400ms)->bytes_per_second == rate);
}

TEST_CASE("a long link is not a slow one: its pipe is filled") {
    Simulation simulation;
    simulation.delay = 2s;
    simulation.bytes_per_second = 125'000;
    simulation.frame_bytes = 6000;
    simulation.run(60s);
    CHECK(simulation.most_in_flight == 2);
    CHECK(within(simulation.rate(), 125'000, 3));
    CHECK(simulation.oldest_frame <= 2200ms);
    CHECK(simulation.arrived >= 22);  // two for each round trip
}

TEST_CASE("a link that is slow and long") {
    Simulation simulation;
    simulation.delay = 2s;
    simulation.bytes_per_second = 2500;
    simulation.frame_bytes = 5500;
    simulation.update_bytes = 300;
    simulation.run(60s);
    CHECK(simulation.oldest_frame <= 4700ms);  // it waits here rather than behind another
    CHECK(simulation.oldest_update <= 3200ms);
    CHECK(within(simulation.rate(), 2500, 2));
    CHECK(simulation.arrived >= 8);
}

TEST_CASE("while a link stands still no more is sent than before, and then all is as it was") {
    Simulation simulation;
    simulation.run(1s);
    const int before = simulation.sent;
    simulation.stalled_until = simulation.now + 10s;
    simulation.run(9s);
    CHECK(simulation.sent <= before + 2);
    CHECK(simulation.rate() < 10'000);  // what stands still is not quick
    simulation.run(3s);
    CHECK(within(simulation.rate(), 1e6, 3));
    CHECK(simulation.oldest_frame <= 10'100ms);
}

TEST_CASE("a client that roams to a slower network is known to be slow after a few frames") {
    Simulation simulation;
    simulation.run(1s);
    simulation.bytes_per_second = 10'000;
    const int before = simulation.arrived;
    simulation.run(2s);
    CHECK(simulation.rate() < 40'000);  // before the frame under way has arrived
    simulation.run(10s);
    CHECK(simulation.arrived - before <= 8);
    CHECK(within(simulation.rate(), 10'000, 1.5));
}

TEST_CASE("a client that roams to a quicker network is found out in a second") {
    Simulation simulation;
    simulation.bytes_per_second = 10'000;
    simulation.run(10s);
    simulation.bytes_per_second = 1e6;
    simulation.run(2s);
    CHECK(within(simulation.rate(), 1e6, 2));
}

TEST_CASE("a frame lost and sent again by TCP costs half of the rate at most twice") {
    Simulation simulation;
    simulation.run(1s);
    simulation.stalled_until = simulation.now + 200ms;  // a retransmission timeout
    simulation.run(400ms);
    CHECK(simulation.rate() > 1e5);
    simulation.run(1s);
    CHECK(within(simulation.rate(), 1e6, 1.5));
}

TEST_CASE("jitter does not make a link slow") {
    Simulation simulation;
    for (int i = 0; i < 200; ++i) {
        simulation.delay = 5ms + (i * 7919 % 11) * 1ms;
        simulation.run(50ms);
        if (i > 10) CHECK(simulation.rate() > 3e5);
    }
}

TEST_CASE("who thinks between frames has no slow link") {
    Simulation simulation;
    simulation.thinks = 1s;
    simulation.run(20s);
    CHECK(within(simulation.rate(), 1e6, 1.3));
    CHECK(simulation.arrived >= 18);
}

TEST_CASE("what a tablet takes to show a frame counts") {
    Simulation simulation;
    simulation.thinks = 60ms;
    simulation.run(5s);
    CHECK(simulation.rate() < 20'000 / 0.060);
}

TEST_CASE("who takes one picture gets one") {
    Simulation simulation;
    simulation.most_frames = 1;
    simulation.run(10s);
    CHECK(simulation.sent == 1);
}

TEST_CASE("who never acknowledges is served by its grants, and its link is unlimited") {
    Simulation simulation;
    simulation.acknowledges = false;
    simulation.run(5s);
    CHECK(std::isinf(simulation.rate()));
    CHECK(simulation.most_in_flight == 2);
    CHECK(simulation.arrived > 150);
}

TEST_CASE("who neither acknowledges nor pongs is served by its grants") {
    Simulation simulation;
    simulation.acknowledges = simulation.pongs = false;
    simulation.update_bytes = 300;
    simulation.run(5s);
    CHECK(simulation.arrived > 150);
}

TEST_CASE("who acknowledges and does not pong is measured by that") {
    Simulation simulation;
    simulation.pongs = false;
    simulation.run(5s);
    CHECK(within(simulation.rate(), 1e6, 2.5));
    CHECK(simulation.arrived > 100);
}

TEST_CASE("who stops acknowledging is counted from then on, and measured again when he goes on") {
    FlowControl flow;
    flow.grant();
    flow.sent_frame(1, 10'000, kStart);
    CHECK(flow.grant(1, kStart + 1s));
    CHECK(flow.link(kStart + 1s)->bytes_per_second < 11'000);
    flow.sent_frame(2, 10'000, kStart + 1s);
    flow.grant();
    CHECK(std::isinf(flow.link(kStart + 2s)->bytes_per_second));
    flow.sent_frame(3, 10'000, kStart + 2s);
    CHECK(flow.grant(3, kStart + 3s));
    CHECK(within(flow.link(kStart + 3s)->bytes_per_second, 10'000, 1.5));
}

TEST_CASE("acknowledgements out of order and twice are grants, and no measurements") {
    FlowControl flow;
    flow.grant();
    flow.grant();
    flow.sent_frame(1, 10'000, kStart);
    flow.pong(flow.sent_ping(kStart), kStart + 1ms);
    flow.sent_frame(2, 10'000, kStart + 10ms);
    CHECK(flow.grant(2, kStart + 110ms));
    const auto link = flow.link(kStart + 110ms);
    CHECK(flow.grant(1, kStart + 5s));
    CHECK(flow.grant(2, kStart + 5s));
    CHECK(flow.link(kStart + 5s) == link);
    CHECK(flow.credits() == 2);
    CHECK(flow.in_flight() == 0);
}

TEST_CASE("an acknowledgement speaks for the frames before it") {
    FlowControl flow;
    flow.grant();
    flow.grant();
    flow.sent_frame(1, 10'000, kStart);
    flow.sent_frame(2, 10'000, kStart);
    CHECK(flow.grant(2, kStart + 20ms));
    CHECK(flow.in_flight() == 0);
}

TEST_CASE("a frame long forgotten may still be acknowledged") {
    FlowControl flow;
    for (int number = 1; number <= 200; ++number) {
        flow.grant();
        flow.sent_frame(number * 2, 100, kStart);
    }
    CHECK(flow.grant(2, kStart));
    CHECK(!flow.grant(399, kStart));
}

TEST_CASE("pongs that nobody asked for, late ones and a second one of a ping are ignored") {
    FlowControl flow;
    flow.pong(1, kStart);
    flow.sent(1000, kStart);
    const std::uint64_t first = flow.sent_ping(kStart);
    flow.pong(first + 1, kStart + 1ms);
    CHECK(flow.in_flight() == 1000);
    flow.pong(first, kStart + 2ms);
    CHECK(flow.in_flight() == 0);
    flow.sent(500, kStart + 3ms);
    flow.pong(first, kStart + 4ms);
    CHECK(flow.in_flight() == 500);
}

TEST_CASE("a later pong speaks for the pings before it") {
    FlowControl flow;
    flow.sent(1000, kStart);
    const std::uint64_t first = flow.sent_ping(kStart);
    flow.sent(1000, kStart);
    const std::uint64_t second = flow.sent_ping(kStart);
    flow.pong(second, kStart + 5ms);
    CHECK(flow.in_flight() == 0);
    flow.pong(first, kStart + 1h);
    CHECK(flow.in_flight() == 0);
}

TEST_CASE("a ping goes behind every frame, behind updates while none is under way") {
    FlowControl flow;
    CHECK(flow.wants_ping());  // the first, on an idle link
    flow.pong(flow.sent_ping(kStart), kStart);
    CHECK(!flow.wants_ping());
    flow.sent(100, kStart);
    CHECK(flow.wants_ping());
    flow.sent_ping(kStart);
    CHECK(!flow.wants_ping());
    flow.sent(100, kStart);
    CHECK(!flow.wants_ping());
    flow.grant();
    flow.sent_frame(1, 100, kStart);
    CHECK(flow.wants_ping());
}

TEST_CASE("the round trip is that of an idle link, however long pings wait behind frames") {
    Simulation simulation;
    simulation.bytes_per_second = 2500;
    simulation.frame_bytes = 5500;
    simulation.pongs = true;
    simulation.flow.pong(simulation.flow.sent_ping(simulation.now), simulation.now + 10ms);
    simulation.run(20s);
    CHECK(simulation.flow.link(simulation.now)->round_trip == 10ms);
}

TEST_CASE("updates to who is not heard of go on after ten seconds") {
    FlowControl flow;
    flow.sent(100'000, kStart);
    CHECK(!flow.may_send_update(kStart + 9s));
    CHECK(flow.ask_again(kStart + 9s) == kStart + 10s);
    CHECK(flow.may_send_update(kStart + 10s));
}

TEST_CASE("a frame that takes long goes once the view has rested for as long") {
    FlowControl flow;
    CHECK(flow.may_send_from(1'000'000, kStart, kStart) == kStart);  // nothing is known
    flow.grant();
    flow.sent_frame(1, 10'000, kStart);
    CHECK(flow.grant(1, kStart + 1s));
    const Clock::time_point now = kStart + 2s;
    CHECK(flow.may_send_from(15'000, now, now) == now);
    CHECK(flow.may_send_from(50'000, now, now) == now + 5s);
    CHECK(flow.may_send_from(100'000'000, now, now) == now + 60s);  // and not never
    CHECK(flow.may_send_from(50'000, {}, now) < now);               // of a view that moves: at once
}

TEST_CASE("on a slow link frames are asked for one at a time: a second one would be old when it leaves") {
    FlowControl flow;
    flow.grant();
    flow.sent_frame(1, 10'000, kStart);
    CHECK(flow.grant(1, kStart + 1s));
    flow.grant(1, kStart + 1s);
    CHECK(flow.credits() == 2);
    CHECK(flow.in_flight() == 0);
    CHECK(flow.frames_allowed(kStart + 1s) == 1);
}
