#include "clicks.hpp"

#include <doctest/doctest.h>

using namespace vrut;
using Action = PointerInput::Action;
using Device = PointerInput::Device;
using Operation = Click::Operation;

namespace {

/// Events as they come, each at its time; tells what the last one completed.
class Hand {
public:
    explicit Hand(Device device = Device::mouse, int button = 0) : device_(device), button_(button) {}

    std::optional<Click> down(double time, double x, double y, int pointer = 1) {
        return clicks_.pointer(input(Action::down, x, y, pointer, button_, 1), time);
    }
    std::optional<Click> move(double time, double x, double y, int pointer = 1, int button = -1) {
        return clicks_.pointer(input(Action::move, x, y, pointer, button, 1), time);
    }
    std::optional<Click> up(double time, double x, double y, int pointer = 1) {
        return clicks_.pointer(input(Action::up, x, y, pointer, button_, 0), time);
    }
    std::optional<Click> cancel(double time, int pointer = 1) {
        return clicks_.pointer(input(Action::cancel, 0, 0, pointer, -1, 0), time);
    }
    Clicks& clicks() { return clicks_; }

private:
    PointerInput input(Action action, double x, double y, int pointer, int button, unsigned buttons) const {
        return {action, "c1", pointer, device_, x, y, button, buttons};
    }
    Clicks clicks_;
    Device device_;
    int button_;
};

}  // namespace

TEST_CASE("double clicks and taps do what the table says, at the second press's point") {
    struct Row {
        Device device;
        int button;
        Operation operation;
    };
    for (const Row& row : {Row{Device::mouse, 0, Operation::select},
                           {Device::mouse, 2, Operation::set_center},
                           {Device::mouse, 1, Operation::look_at},
                           {Device::touch, 0, Operation::select},
                           {Device::pen, 0, Operation::select}}) {
        Hand hand(row.device, row.button);
        hand.down(0, 100, 100);
        CHECK_FALSE(hand.up(250, 106, 108).has_value());  // 10 pixels, 250 ms
        hand.down(400, 100, 124);                         // 24 pixels, 400 ms
        const auto click = hand.up(650, 100, 124);
        REQUIRE(click.has_value());
        CHECK(click->operation == row.operation);
        CHECK(click->x == 100);
        CHECK(click->y == 124);
        // A third one begins anew.
        hand.down(700, 100, 124);
        CHECK_FALSE(hand.up(750, 100, 124).has_value());
        hand.down(800, 100, 124);
        CHECK(hand.up(850, 100, 124).has_value());
    }
}

TEST_CASE("what is almost a double click is none") {
    const auto second = [](auto between) {
        Hand hand;
        hand.down(0, 100, 100);
        between(hand);
        return hand.up(500, 100, 100).has_value();
    };
    CHECK(second([](Hand& h) { h.up(100, 100, 100), h.down(300, 100, 100); }));
    CHECK_FALSE(second([](Hand& h) { h.up(251, 100, 100), h.down(300, 100, 100); }));  // held too long
    CHECK_FALSE(second([](Hand& h) { h.up(100, 111, 100), h.down(300, 111, 100); }));  // moved too far
    CHECK_FALSE(second(
        [](Hand& h) { h.move(50, 111, 100), h.up(100, 100, 100), h.down(300, 100, 100); }));  // and back
    CHECK_FALSE(second([](Hand& h) { h.up(100, 100, 100), h.down(401, 100, 100); }));         // too late
    CHECK_FALSE(second([](Hand& h) { h.up(100, 100, 100), h.down(300, 125, 100); }));         // elsewhere
    CHECK_FALSE(second([](Hand& h) { h.up(100, 100, 100), h.down(200, 100, 100); }));  // second held too long
    CHECK_FALSE(second([](Hand& h) { h.cancel(100), h.down(300, 100, 100); }));
    CHECK_FALSE(second(
        [](Hand& h) { h.move(50, 100, 100, 1, 2), h.up(100, 100, 100), h.down(300, 100, 100); }));  // chord
    CHECK_FALSE(second([](Hand& h) { h.up(100, 100, 100), h.clicks().lift("c1"), h.down(300, 100, 100); }));
}

TEST_CASE("two different buttons are no double click") {
    Clicks clicks;
    clicks.pointer({Action::down, "c1", 1, Device::mouse, 5, 5, 0, 1}, 0);
    clicks.pointer({Action::up, "c1", 1, Device::mouse, 5, 5, 0, 0}, 50);
    clicks.pointer({Action::down, "c1", 1, Device::mouse, 5, 5, 2, 2}, 100);
    CHECK_FALSE(clicks.pointer({Action::up, "c1", 1, Device::mouse, 5, 5, 2, 0}, 150).has_value());
}

TEST_CASE("one finger rests, a second taps: look at its point") {
    Hand hand(Device::touch);
    hand.down(0, 100, 100, 1);
    hand.down(300, 400, 300, 2);
    const auto click = hand.up(400, 402, 300, 2);
    REQUIRE(click.has_value());
    CHECK(click->operation == Operation::look_at);
    CHECK(click->x == 400);
    // Again, with the first still there.
    hand.down(600, 200, 300, 2);
    CHECK(hand.up(700, 200, 300, 2).has_value());
}

TEST_CASE("what is almost press and tap is none") {
    const auto taps = [](double second_press, double second_release, auto between) {
        Hand hand(Device::touch);
        hand.down(0, 100, 100, 1);
        between(hand);
        hand.down(second_press, 400, 300, 2);
        return hand.up(second_release, 400, 300, 2).has_value();
    };
    const auto nothing = [](Hand&) {};
    CHECK(taps(300, 500, nothing));
    CHECK_FALSE(taps(200, 300, nothing));                                    // two fingers at once
    CHECK_FALSE(taps(300, 600, nothing));                                    // the second stays
    CHECK_FALSE(taps(300, 400, [](Hand& h) { h.move(100, 120, 100, 1); }));  // the first moves
    CHECK_FALSE(taps(300, 400, [](Hand& h) { h.down(100, 50, 50, 3); }));    // three fingers
}

TEST_CASE("a client's own time counts, so that the link's delays do not") {
    EventClock clock;
    CHECK(clock.time(5000, 100) == 0);
    CHECK(clock.time(5100, 900) == 100);   // 700 ms late
    CHECK(clock.time(5200, 901) == 200);   // together with the next
    CHECK(clock.time(9000, 1001) == 300);  // a clock that jumps: by arrival
    CHECK(clock.time(8000, 1101) == 400);  // or falls
    CHECK(clock.time(std::nullopt, 1201) == 500);
    CHECK(clock.time(8300, 1301) == 600);  // after none there is nothing to compare with
    CHECK(clock.time(8350, 1401) == 650);
}
