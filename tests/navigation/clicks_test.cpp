#include "navigation/clicks.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

using namespace vrut;
using Action = navigation::PointerInput::Action;
using Device = navigation::PointerInput::Device;
using Operation = navigation::Click::Operation;

namespace {

std::chrono::microseconds ms(double milliseconds) {
    return std::chrono::microseconds(std::llround(milliseconds * 1000));
}

/// Events as they come, each at its time; tells what the last one completed.
class Hand {
public:
    explicit Hand(Device device = Device::mouse, int button = 0) : device_(device), button_(button) {}

    std::optional<navigation::Click> down(double time, double x, double y, int pointer = 1) {
        return send(Action::down, time, x, y, pointer, button_, 1);
    }
    std::optional<navigation::Click> move(double time, double x, double y, int pointer = 1, int button = -1) {
        return send(Action::move, time, x, y, pointer, button, 1);
    }
    std::optional<navigation::Click> up(double time, double x, double y, int pointer = 1) {
        return send(Action::up, time, x, y, pointer, button_, 0);
    }
    std::optional<navigation::Click> cancel(double time, int pointer = 1) {
        return send(Action::cancel, time, 0, 0, pointer, -1, 0);
    }
    /// A release that nobody saw.
    std::optional<navigation::Click> hover(double time, double x, double y) {
        return send(Action::move, time, x, y, 1, -1, 0);
    }
    navigation::Clicks& clicks() { return clicks_; }

    navigation::NavigationStyle style = navigation::NavigationStyle::vrut;
    navigation::ModifierKeys modifiers;

private:
    std::optional<navigation::Click> send(Action action, double time, double x, double y, int pointer,
                                          int button, unsigned buttons) {
        return clicks_.pointer({action, "c1", pointer, device_, x, y, button, buttons, modifiers},
                               {std::nullopt, ms(time)}, style);
    }
    navigation::Clicks clicks_;
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

TEST_CASE("a first click by touch or the left button is a tap, until anything follows it") {
    for (const auto& [device, button] : {std::pair(Device::touch, 0), {Device::mouse, 0}, {Device::pen, 0}}) {
        Hand hand(device, button);
        hand.down(0, 100, 100);
        CHECK_FALSE(hand.clicks().tap());
        hand.up(100, 103, 100);
        CHECK(hand.clicks().tap() == glm::dvec2(100, 100));
        hand.down(200, 100, 100);
        hand.up(300, 100, 100);  // a double one
        CHECK_FALSE(hand.clicks().tap());
        hand.down(1000, 100, 100);
        hand.up(1300, 100, 100);  // too long
        CHECK_FALSE(hand.clicks().tap());
    }
    Hand right(Device::mouse, 2);
    right.down(0, 100, 100);
    right.up(100, 100, 100);
    CHECK_FALSE(right.clicks().tap());
}

TEST_CASE("what is almost a double click is none") {
    struct Row {
        std::string name;
        bool clicks;
        std::function<void(Hand&)> before_last_release;  // which is at 500 ms, (100, 100)
    };
    for (const Row& row : {
             Row{"as it should be", true, [](Hand& h) { h.up(100, 100, 100), h.down(300, 100, 100); }},
             Row{"250 ms", true, [](Hand& h) { h.up(250, 100, 100), h.down(300, 100, 100); }},
             Row{"held too long", false, [](Hand& h) { h.up(251, 100, 100), h.down(300, 100, 100); }},
             Row{"10 pixels", true, [](Hand& h) { h.up(100, 108, 94), h.down(300, 100, 100); }},
             Row{"dragged", false, [](Hand& h) { h.up(100, 110.01, 100), h.down(300, 100, 100); }},
             Row{"400 ms", true, [](Hand& h) { h.up(100, 100, 100), h.down(400, 100, 100); }},
             Row{"too late", false, [](Hand& h) { h.up(100, 100, 100), h.down(401, 100, 100); }},
             Row{"second held too long", false, [](Hand& h) { h.up(100, 100, 100), h.down(249, 100, 100); }},
             Row{"second dragged", false, [](Hand& h) { h.up(100, 100, 100), h.down(300, 110.01, 100); }},
             Row{"cancelled", false, [](Hand& h) { h.cancel(100), h.down(300, 100, 100); }},
             Row{"released unseen", false, [](Hand& h) { h.hover(100, 100, 100), h.down(300, 100, 100); }},
             Row{"pressed anew in mid-press", false,
                 [](Hand& h) { h.down(90, 100, 100), h.down(300, 100, 100); }},
             Row{"a second button as a chord", false,
                 [](Hand& h) { h.move(50, 100, 100, 1, 2), h.up(100, 100, 100), h.down(300, 100, 100); }},
             Row{"a chord in the second press", false,
                 [](Hand& h) { h.up(100, 100, 100), h.down(300, 100, 100), h.move(350, 100, 100, 1, 2); }},
             Row{"another click elsewhere between", false,
                 [](Hand& h) {
                     h.up(50, 100, 100), h.down(100, 500, 100), h.up(150, 500, 100), h.down(300, 100, 100);
                 }},
             Row{"a drag between", false,
                 [](Hand& h) {
                     h.up(50, 100, 100), h.down(100, 100, 100), h.up(150, 150, 100), h.down(300, 100, 100);
                 }},
             Row{"lifted between", false,
                 [](Hand& h) { h.up(100, 100, 100), h.clicks().lift("c1"), h.down(300, 100, 100); }},
         }) {
        CAPTURE(row.name);
        for (const Device device : {Device::mouse, Device::touch, Device::pen}) {
            Hand hand(device);
            hand.down(0, 100, 100);
            row.before_last_release(hand);
            CHECK(hand.up(500, 100, 100).has_value() == row.clicks);
        }
    }
}

TEST_CASE("the second press may be 24 pixels from the first, and no farther") {
    for (const auto& [x, clicks] : {std::pair{124.0, true}, {124.01, false}}) {
        Hand hand;
        hand.down(0, 100, 100);
        hand.up(100, 91, 100);
        hand.down(200, x, 100);
        CHECK(hand.up(300, x, 100).has_value() == clicks);
    }
}

TEST_CASE("between press and release a pointer may wander: where it is then counts") {
    Hand hand;
    hand.down(0, 100, 100);
    hand.move(50, 400, 300);
    hand.up(100, 100, 100);
    hand.down(200, 100, 100);
    hand.move(250, 111, 100);
    CHECK(hand.up(300, 109, 100).has_value());
}

TEST_CASE("two different buttons, devices or clients are no double click") {
    const navigation::PointerInput first{Action::down, "c1", 1, Device::mouse, 5, 5, 0, 1};
    const auto second = [&](const navigation::PointerInput& press) {
        navigation::Clicks clicks;
        const auto send = [&](navigation::PointerInput input, Action action, double time) {
            input.action = action;
            return clicks.pointer(input, {std::nullopt, ms(time)});
        };
        send(first, Action::down, 0);
        send(first, Action::up, 50);
        send(press, Action::down, 100);
        return send(press, Action::up, 150).has_value();
    };
    CHECK(second(first));
    CHECK(second({Action::down, "c1", 7, Device::mouse, 5, 5, 0, 1}));  // touches: each has its own number
    CHECK_FALSE(second({Action::down, "c1", 1, Device::mouse, 5, 5, 2, 2}));
    CHECK_FALSE(second({Action::down, "c1", 1, Device::pen, 5, 5, 0, 1}));
    CHECK_FALSE(second({Action::down, "c2", 1, Device::mouse, 5, 5, 0, 1}));
}

TEST_CASE("with the key held that makes a style's buttons the camera's, presses are no clicks") {
    const auto clicks = [](navigation::NavigationStyle style, navigation::ModifierKeys modifiers,
                           Device device = Device::mouse) {
        Hand hand(device);
        hand.style = style;
        hand.modifiers = modifiers;
        hand.down(0, 100, 100);
        hand.up(50, 100, 100);
        hand.down(100, 100, 100);
        return hand.up(150, 100, 100).has_value();
    };
    using Style = navigation::NavigationStyle;
    const navigation::ModifierKeys alt{true, false, false, false}, others{false, true, true, true};
    for (const Style style : {Style::vrut, Style::maya, Style::catia, Style::cinema4d}) {
        CHECK(clicks(style, {}));
        CHECK(clicks(style, others));
        CHECK(clicks(style, alt, Device::touch));
        CHECK(clicks(style, alt) == (style == Style::vrut || style == Style::catia));
    }
}

TEST_CASE("one finger rests, a second taps: look at its point") {
    Hand hand(Device::touch);
    hand.down(0, 100, 100, 1);
    hand.down(300, 400, 300, 2);
    const auto click = hand.up(400, 402, 300, 2);
    REQUIRE(click.has_value());
    CHECK(click->operation == Operation::look_at);
    CHECK(click->x == 400);
    // Again, with the first still there, and both a little off.
    hand.down(600, 200, 300, 2);
    hand.move(650, 106, 108, 1);
    CHECK(hand.up(700, 210, 300, 2).has_value());
    // The first one's release is no tap.
    CHECK_FALSE(hand.up(720, 100, 100, 1).has_value());
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
    CHECK(taps(251, 501, nothing));
    CHECK_FALSE(taps(250, 300, nothing));  // the first does not rest yet
    CHECK_FALSE(taps(0, 50, nothing));     // two fingers at once
    CHECK_FALSE(taps(300, 551, nothing));  // the second stays
    CHECK(taps(300, 400, [](Hand& h) { h.move(100, 110, 100, 1); }));
    CHECK_FALSE(taps(300, 400, [](Hand& h) { h.move(100, 110.01, 100, 1); }));  // the first has gone
    CHECK(taps(300, 400, [](Hand& h) { h.move(100, 500, 100, 1), h.move(200, 100, 100, 1); }));
    CHECK_FALSE(taps(300, 400, [](Hand& h) { h.down(100, 50, 50, 3); }));  // three fingers
    CHECK(taps(300, 400, [](Hand& h) { h.down(100, 50, 50, 3), h.up(200, 50, 50, 3); }));
    CHECK_FALSE(taps(300, 400, [](Hand& h) { h.cancel(200, 1); }));
    CHECK_FALSE(taps(300, 400, [](Hand& h) { h.up(200, 100, 100, 1); }));

    Hand hand(Device::touch);
    hand.down(0, 100, 100, 1);
    hand.down(300, 400, 300, 2);
    CHECK_FALSE(hand.up(400, 410.01, 300, 2).has_value());  // the second is no tap

    Hand mouse;  // and a mouse is no finger
    mouse.down(0, 100, 100, 1);
    mouse.down(300, 400, 300, 2);
    CHECK_FALSE(mouse.up(400, 400, 300, 2).has_value());

    navigation::Clicks clicks;  // nor is another client's hand
    clicks.pointer({Action::down, "c1", 1, Device::touch, 100, 100, 0, 1}, {std::nullopt, ms(0)});
    clicks.pointer({Action::down, "c2", 1, Device::touch, 400, 300, 0, 1}, {std::nullopt, ms(300)});
    CHECK_FALSE(clicks.pointer({Action::up, "c2", 1, Device::touch, 400, 300, 0, 0}, {std::nullopt, ms(400)})
                    .has_value());
}

TEST_CASE("a client's own time counts, so that the link's delays do not") {
    navigation::EventClock clock;
    const auto time = [&](std::optional<double> stamp, double arrival) {
        return clock.time({stamp, ms(arrival)});
    };
    CHECK(time(5000, 100) == ms(0));
    CHECK(time(5100, 900) == ms(100));   // 700 ms late
    CHECK(time(5200, 901) == ms(200));   // together with the next
    CHECK(time(9000, 1001) == ms(300));  // a clock that jumps: by arrival
    CHECK(time(8000, 1101) == ms(400));  // or falls
    CHECK(time(std::nullopt, 1201) == ms(500));
    CHECK(time(8300, 1301) == ms(600));  // after none there is nothing to compare with
    CHECK(time(8350, 1401) == ms(650));
    CHECK(time(8450, 2501) == ms(750));   // a second apart
    CHECK(time(8550, 3602) == ms(1851));  // and more
    CHECK(time(8540, 3702) == ms(1951));  // falls a little
}

TEST_CASE("time does not depend on where the clocks start, nor on how often they are asked") {
    for (const double start : {0.0, 0.123, 1e9, -4e12})
        for (const double zero : {0.0, 77777.7, 1.7e12})
            for (const int every : {1, 10, 1000}) {
                navigation::EventClock clock;
                std::chrono::microseconds time{0};
                for (int i = 0; i <= 3000; i += every)
                    time = clock.time({zero + i * 0.1, ms(start) + std::chrono::microseconds(i * 133)});
                CAPTURE(start);
                CAPTURE(zero);
                CHECK(time == ms(300));
            }
}

TEST_CASE("jitter of the arrivals has no influence where time stamps can be trusted") {
    // Two double clicks and what is almost one, each event late by up to half a second.
    struct Event {
        Action action;
        double stamp;
    };
    const std::vector<Event> events = {
        {Action::down, 0},    {Action::up, 249},  {Action::down, 400},  {Action::up, 650},   // double
        {Action::down, 2000}, {Action::up, 2100}, {Action::down, 2401}, {Action::up, 2450},  // too late
        {Action::down, 4000}, {Action::up, 4251}, {Action::down, 4300}, {Action::up, 4350},  // held too long
        {Action::down, 6000}, {Action::up, 6250}, {Action::down, 6300}, {Action::up, 6550},  // double
    };
    for (const int seed : {0, 1, 2, 3, 4}) {
        navigation::Clicks clicks;
        std::string completed;
        double last = 0;
        for (std::size_t i = 0; i < events.size(); ++i) {
            const Event& event = events[i];
            const double late =
                seed == 0
                    ? 0
                    : static_cast<double>((i * 7919 + i * i * 31) * static_cast<std::size_t>(seed) % 500);
            last = std::max(last, event.stamp + late);
            const bool up = event.action == Action::up;
            const navigation::PointerInput input{event.action, "c1", 1, Device::mouse,
                                                 100,          100,  0, up ? 0u : 1u};
            if (clicks.pointer(input, {1e6 + event.stamp, ms(last)})) completed += std::to_string(i) + " ";
        }
        CAPTURE(seed);
        CHECK(completed == "3 15 ");
    }
}
