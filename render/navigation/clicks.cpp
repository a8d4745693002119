#include "navigation/clicks.hpp"

#include <algorithm>
#include <cmath>

namespace vrut::navigation {

namespace {

using Action = PointerInput::Action;
using Device = PointerInput::Device;

constexpr std::size_t kMaxPresses = 16;
constexpr std::chrono::milliseconds kTrusted{1000};

std::chrono::microseconds whole(double milliseconds) {
    return std::chrono::microseconds(std::llround(milliseconds * 1000));
}

std::optional<Click::Operation> operation_of(int button) {
    switch (button) {
        case 0:
            return Click::Operation::select;
        case 1:
            return Click::Operation::look_at;
        case 2:
            return Click::Operation::set_center;
        default:
            return std::nullopt;
    }
}

}  // namespace

std::chrono::microseconds EventClock::time(const EventTime& event) {
    if (last_) {
        std::chrono::microseconds step = event.arrival - last_->arrival;
        if (event.stamp && last_->stamp) {
            const std::chrono::microseconds stamped = whole(*event.stamp) - whole(*last_->stamp);
            if (stamped.count() >= 0 && std::chrono::abs(stamped - step) <= kTrusted) step = stamped;
        }
        time_ += step;
    }
    last_ = event;
    return time_;
}

std::optional<Click> Clicks::pointer(const PointerInput& input, const EventTime& when,
                                     NavigationStyle style) {
    const auto pressed = std::find_if(pressed_.begin(), pressed_.end(), [&](const Press& press) {
        return press.pointer == input.pointer && press.client == input.client;
    });
    if (input.action == Action::down) {
        if (pressed != pressed_.end()) pressed_.erase(pressed);
        if (pressed_.size() < kMaxPresses) press(input, when, style);
        return std::nullopt;
    }
    if (pressed == pressed_.end()) return std::nullopt;
    pressed->now = {input.x, input.y};
    // A second button of the same mouse makes a drag of two buttons, and no click.
    if (input.action == Action::move && input.button >= 0) pressed->clicks = false;
    if (input.action == Action::move && input.buttons != 0) return std::nullopt;

    const Press press = *pressed;
    pressed_.erase(pressed);
    if (input.action == Action::up) return released(press, clocks_[input.client].time(when));
    last_.reset();  // cancelled, or a release that was not seen
    return std::nullopt;
}

void Clicks::press(const PointerInput& input, const EventTime& when, NavigationStyle style) {
    const glm::dvec2 at{input.x, input.y};
    const bool drags = input.device != Device::touch && suppresses_clicks(style, input.modifiers);
    pressed_.push_back({input.client, input.pointer, input.device, std::max(input.button, 0), at, at,
                        clocks_[input.client].time(when), !drags});
}

std::optional<Click> Clicks::released(const Press& press, std::chrono::microseconds time) {
    const std::optional<Press> before = std::exchange(last_, std::nullopt);
    if (!press.stays() || time - press.time > kLongest) return std::nullopt;

    const bool touch = press.device == Device::touch;
    if (touch && !pressed_.empty()) {
        // The first finger rests: it lies longer than a tap would, alone, and is where it was put.
        const Press& first = pressed_.front();
        const bool rests = pressed_.size() == 1 && first.device == Device::touch &&
                           first.client == press.client && first.stays() &&
                           press.time - first.time > kLongest;
        if (!rests) return std::nullopt;
        return Click{Click::Operation::look_at, press.place.x, press.place.y};
    }
    const bool second = before && before->client == press.client && before->device == press.device &&
                        before->button == press.button && press.time - before->time <= kNextWithin &&
                        glm::distance(press.place, before->place) <= kNextNear;
    if (!second) {
        last_ = press;
        return std::nullopt;
    }
    const std::optional<Click::Operation> operation =
        touch ? Click::Operation::select : operation_of(press.button);
    return operation ? std::optional(Click{*operation, press.place.x, press.place.y}) : std::nullopt;
}

std::optional<glm::dvec2> Clicks::tap() const {
    if (!last_ || (last_->device != Device::touch && last_->button != left_button)) return std::nullopt;
    return last_->place;
}

bool Clicks::is_pressed(const std::string& client, std::int64_t pointer) const {
    return std::any_of(pressed_.begin(), pressed_.end(), [&](const Press& press) {
        return press.pointer == pointer && press.client == client;
    });
}

void Clicks::lift(const std::string& client) {
    std::erase_if(pressed_, [&](const Press& press) { return press.client == client; });
    clocks_.erase(client);
    last_.reset();
}

}  // namespace vrut::navigation
