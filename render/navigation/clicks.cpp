#include "clicks.hpp"

#include <algorithm>
#include <cmath>

namespace vrut {

namespace {

using Action = PointerInput::Action;
using Device = PointerInput::Device;
using Operation = Click::Operation;

constexpr std::size_t kMostPressed = 16;
constexpr double kTrusted = 1000;

std::optional<Operation> operation_of(int button) {
    switch (button) {
        case 0:
            return Operation::select;
        case 1:
            return Operation::look_at;
        case 2:
            return Operation::set_center;
        default:
            return std::nullopt;
    }
}

}  // namespace

double EventClock::time(std::optional<double> time_stamp, double arrival) {
    double step = arrival - last_arrival_;
    if (time_stamp && last_stamp_) {
        const double stamped = *time_stamp - *last_stamp_;
        if (stamped >= 0 && std::abs(stamped - step) <= kTrusted) step = stamped;
    }
    if (started_) time_ += step;
    started_ = true;
    last_stamp_ = time_stamp;
    last_arrival_ = arrival;
    return time_;
}

std::optional<Click> Clicks::pointer(const PointerInput& input, double time) {
    const auto pressed = std::find_if(pressed_.begin(), pressed_.end(), [&](const Press& press) {
        return press.pointer == input.pointer && press.client == input.client;
    });
    const glm::dvec2 place{input.x, input.y};
    if (input.action == Action::down) {
        if (pressed != pressed_.end()) pressed_.erase(pressed);
        if (pressed_.size() < kMostPressed)
            pressed_.push_back(
                {input.client, input.pointer, input.device, std::max(input.button, 0), place, time, false});
        return std::nullopt;
    }
    if (pressed == pressed_.end()) return std::nullopt;
    if (glm::distance(place, pressed->place) > kFarthest) pressed->moved = true;
    // A second button of the same mouse makes a drag of two buttons, and no click.
    if (input.action == Action::move && input.button >= 0) pressed->moved = true;
    if (input.action == Action::move && input.buttons != 0) return std::nullopt;

    const Press press = *pressed;
    pressed_.erase(pressed);
    if (input.action == Action::up) return released(press, time);
    last_.reset();  // cancelled, or a release that was not seen
    return std::nullopt;
}

std::optional<Click> Clicks::released(const Press& press, double time) {
    const std::optional<Press> before = std::exchange(last_, std::nullopt);
    if (press.moved || time - press.time > kLongest) return std::nullopt;

    const bool touch = press.device == Device::touch;
    if (touch && !pressed_.empty()) {
        // The first finger rests: it lies there longer than a tap would, alone, and has not moved.
        const Press& first = pressed_.front();
        const bool rests = pressed_.size() == 1 && first.device == Device::touch &&
                           first.client == press.client && !first.moved && press.time - first.time > kLongest;
        if (!rests) return std::nullopt;
        return Click{Operation::look_at, press.place.x, press.place.y};
    }
    const bool second = before && before->client == press.client && before->device == press.device &&
                        before->button == press.button && press.time - before->time <= kNextWithin &&
                        glm::distance(press.place, before->place) <= kNextNear;
    if (!second) {
        last_ = press;
        return std::nullopt;
    }
    const std::optional<Operation> operation = touch ? Operation::select : operation_of(press.button);
    return operation ? std::optional(Click{*operation, press.place.x, press.place.y}) : std::nullopt;
}

bool Clicks::is_pressed(const std::string& client, std::int64_t pointer) const {
    return std::any_of(pressed_.begin(), pressed_.end(), [&](const Press& press) {
        return press.pointer == pointer && press.client == client;
    });
}

void Clicks::lift(const std::string& client) {
    std::erase_if(pressed_, [&](const Press& press) { return press.client == client; });
    last_.reset();
}

}  // namespace vrut
