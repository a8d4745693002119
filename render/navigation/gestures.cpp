#include "gestures.hpp"

#include <algorithm>
#include <cmath>

namespace vrut {

namespace {

using Device = PointerInput::Device;
using Action = PointerInput::Action;

// More than any hand has; without a bound each press would make the next one slower.
constexpr std::size_t kMostPressed = 16;

enum Button { left = 0, middle = 1, right = 2 };

/// W3C numbers a button one way and its bit among the held ones another.
unsigned bit_of(int button) {
    return button == right ? 2u : button == middle ? 4u : button == left ? 1u : 0u;
}

int first_held(unsigned buttons) {
    for (int button : {left, right, middle})
        if (buttons & bit_of(button)) return button;
    return -1;
}

Camera rotate_by(const Camera& camera, const glm::dvec2& moved, const NavigationContext& context) {
    const double degrees = 180 * context.rotate_speed / std::min(context.width, context.height);
    return rotated(camera, moved.x * degrees, moved.y * degrees, context.keep_upright);
}

Camera pan_by(const Camera& camera, const glm::dvec2& moved, const NavigationContext& context) {
    const glm::dvec2 part = moved * (context.pan_speed / context.height);
    return panned(camera, part.x, part.y);
}

Camera zoom_by(const Camera& camera, double factor, const NavigationContext& context) {
    return zoomed(camera, std::pow(factor, context.zoom_speed), context.bounds.radius());
}

/// Fingers that touch the same pixel would divide by zero.
double span(const glm::dvec2& a, const glm::dvec2& b) { return std::max(glm::distance(a, b), 1.0); }

}  // namespace

bool Gestures::is_pressed(const std::string& client, std::int64_t pointer) const {
    return std::any_of(pressed_.begin(), pressed_.end(),
                       [&](const Pressed& p) { return p.pointer == pointer && p.client == client; });
}

Camera Gestures::pointer(const PointerInput& input, const Camera& camera, const NavigationContext& context) {
    const auto pressed = std::find_if(pressed_.begin(), pressed_.end(), [&](const Pressed& p) {
        return p.pointer == input.pointer && p.client == input.client;
    });
    if (input.action == Action::down) {
        if (pressed != pressed_.end()) pressed_.erase(pressed);
        if (pressed_.size() == kMostPressed) return camera;
        if (input.device == Device::touch && fingers().size() == 2) return camera;  // a third one
        const glm::dvec2 at{input.x, input.y};
        const unsigned buttons = input.buttons != 0 ? input.buttons : bit_of(input.button);
        pressed_.push_back(
            {input.client, input.pointer, input.device, at, at, buttons, std::max(input.button, 0)});
        restart(camera);
        return camera;
    }
    if (pressed == pressed_.end()) return camera;  // hovering

    // A move without buttons is hovering: the release was not seen, and where it was is not known.
    const bool lost = input.action == Action::cancel || (input.action == Action::move && input.buttons == 0);
    Camera result = camera;
    if (!lost) {
        pressed->now = {input.x, input.y};
        result = dragged(context);
    }
    if (lost || input.action == Action::up) {
        pressed_.erase(pressed);
        restart(result);
    } else if (input.buttons != pressed->buttons) {  // a chord: another button went down or up
        pressed->buttons = input.buttons;
        const bool went_down = (input.buttons & bit_of(input.button)) != 0;
        if (went_down) pressed->button = input.button;
        if (!(input.buttons & bit_of(pressed->button))) pressed->button = first_held(input.buttons);
        restart(result);
    }
    return result;
}

void Gestures::restart(const Camera& camera) {
    start_ = camera;
    for (Pressed& pressed : pressed_) pressed.start = pressed.now;
}

void Gestures::lift(const std::string& client, const Camera& camera) {
    std::erase_if(pressed_, [&](const Pressed& pressed) { return pressed.client == client; });
    restart(camera);
}

std::vector<const Gestures::Pressed*> Gestures::fingers() const {
    std::vector<const Pressed*> touching;
    for (const Pressed& pressed : pressed_)
        if (pressed.device == Device::touch) touching.push_back(&pressed);
    return touching;
}

Camera Gestures::dragged(const NavigationContext& context) const {
    const std::vector<const Pressed*> touching = fingers();
    if (touching.size() == 1) return rotate_by(start_, touching[0]->now - touching[0]->start, context);
    if (touching.size() == 2) {
        const Pressed &a = *touching[0], &b = *touching[1];
        // The pan comes second, so that it is measured in the picture as the fingers leave it.
        const Camera pinched = zoom_by(start_, span(a.now, b.now) / span(a.start, b.start), context);
        return pan_by(pinched, (a.now + b.now - a.start - b.start) * 0.5, context);
    }
    const Pressed& pressed = pressed_.back();
    const glm::dvec2 moved = pressed.now - pressed.start;
    switch (pressed.button) {
        case left:
            return rotate_by(start_, moved, context);
        case right:
            return pan_by(start_, moved, context);
        case middle:
            return zoom_by(start_, std::pow(4, -moved.y / context.height), context);
        default:
            return start_;
    }
}

Camera wheel(const WheelInput& input, const Camera& camera, const NavigationContext& context) {
    const double step = input.unit == WheelInput::Unit::pixel  ? 100.0
                        : input.unit == WheelInput::Unit::line ? 3.0
                                                               : 1.0 / 3;
    return zoom_by(camera, std::pow(1.1, -input.delta_y / step), context);
}

Camera key_down(const KeyInput& input, const Camera& camera, const Camera& home,
                const NavigationContext& context) {
    const auto arrow = [&](double x, double y) {
        return input.shift ? panned(camera, x * 0.05, y * 0.05)
                           : rotated(camera, x * 5, y * 5, context.keep_upright);
    };
    if (input.key == "ArrowLeft") return arrow(-1, 0);
    if (input.key == "ArrowRight") return arrow(1, 0);
    if (input.key == "ArrowUp") return arrow(0, -1);
    if (input.key == "ArrowDown") return arrow(0, 1);
    if (input.key == "+") return zoomed(camera, 1.1, context.bounds.radius());
    if (input.key == "-") return zoomed(camera, 1 / 1.1, context.bounds.radius());
    if (input.key == "f") return fitted(camera, context.bounds, context.width / context.height);
    if (input.key == "Home") return home;
    return camera;
}

}  // namespace vrut
