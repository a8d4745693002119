#include "navigation/gestures.hpp"

#include <algorithm>
#include <cmath>

#include "navigation/camera_moves.hpp"

namespace vrut::navigation {

namespace {

using Device = PointerInput::Device;
using Action = PointerInput::Action;

// More than any hand has; without a bound each press would make the next one slower.
constexpr std::size_t kMostPressed = 16;

int first_held(unsigned buttons) {
    for (int button : {left_button, right_button, middle_button})
        if (buttons & button_mask(button)) return button;
    return -1;
}

/// The digit that a key types, else the one that is printed on it: with Shift, or on a French keyboard, it
/// types another sign. 0 for other keys.
int number_of(const KeyInput& input) {
    const auto digit = [](const std::string& text, std::size_t at) {
        return text.size() == at + 1 && text[at] >= '1' && text[at] <= '9' ? text[at] - '0' : 0;
    };
    const int typed = digit(input.key, 0);
    return typed == 0 && input.code.starts_with("Digit") ? digit(input.code, 5) : typed;
}

scene::Camera rotate_by(const scene::Camera& camera, const glm::dvec2& moved,
                        const NavigationContext& context) {
    const double degrees = 180 * context.rotate_speed / std::min(context.width, context.height);
    return rotated(camera, moved.x * degrees, moved.y * degrees, context.keep_upright);
}

/// `point` moves with the image.
scene::Camera pan_by(const scene::Camera& camera, const glm::dvec2& moved, const glm::dvec3& point,
                     const NavigationContext& context) {
    const glm::dvec2 part = moved * (context.pan_speed / context.height);
    const double depth = glm::dot(point - camera.eye, scene::view_direction(camera));
    return panned(camera, part.x, part.y, depth);
}

/// `point` stays where it is seen.
scene::Camera zoom_by(const scene::Camera& camera, double factor, const glm::dvec3& point,
                      const NavigationContext& context) {
    return zoomed(camera, std::pow(factor, context.zoom_speed), context.bounds.radius(), point);
}

std::optional<glm::dvec3> surface_at(const scene::Camera& camera, const glm::dvec2& place,
                                     const NavigationContext& context) {
    return context.surface_at ? context.surface_at(camera, place) : std::nullopt;
}

/// At the focus' depth.
glm::dvec3 point_at(const scene::Camera& camera, const glm::dvec2& place, const NavigationContext& context) {
    const glm::dvec2 size(context.width, context.height);
    const glm::dvec3 ray = scene::direction_through(camera, size.x / size.y, 2.0 * place / size - 1.0);
    return camera.eye + ray * (scene::focus_distance(camera) / glm::dot(ray, scene::view_direction(camera)));
}

/// Fingers that touch the same pixel would divide by zero.
double span(const glm::dvec2& a, const glm::dvec2& b) { return std::max(glm::distance(a, b), 1.0); }

}  // namespace

bool looks_around(const scene::Camera& camera, const NavigationContext& context) {
    return context.looks_around_from && context.looks_around_from(camera.eye);
}

bool Gestures::is_pressed(const std::string& client, std::int64_t pointer) const {
    return std::any_of(pressed_.begin(), pressed_.end(),
                       [&](const Pressed& p) { return p.pointer == pointer && p.client == client; });
}

scene::Camera Gestures::pointer(const PointerInput& input, const scene::Camera& camera,
                                const NavigationContext& context) {
    const auto pressed = std::find_if(pressed_.begin(), pressed_.end(), [&](const Pressed& p) {
        return p.pointer == input.pointer && p.client == input.client;
    });
    if (input.action == Action::down) {
        if (pressed != pressed_.end()) pressed_.erase(pressed);
        if (pressed_.size() == kMostPressed) return camera;
        if (input.device == Device::touch && fingers().size() == 2) return camera;  // a third one
        press(input);
        restart(camera);
        return camera;
    }
    if (pressed == pressed_.end()) return camera;  // hovering

    // A move without buttons is hovering: the release was not seen, and where it was is not known.
    const bool lost = input.action == Action::cancel || (input.action == Action::move && input.buttons == 0);
    if (!lost && input.action == Action::move && input.button < 0 && input.buttons != pressed->grip.buttons) {
        change_buttons(*pressed, input);  // unseen, too: the whole way since is the new drag's
        restart(camera);
    }
    scene::Camera result = camera;
    if (!lost) {
        pressed->now = {input.x, input.y};
        result = dragged(context);
    }
    if (lost || input.action == Action::up) {
        pressed_.erase(pressed);
        restart(result);
    } else if (input.buttons != pressed->grip.buttons) {  // a chord
        change_buttons(*pressed, input);
        pressed->grip.modifiers = input.modifiers;
        pressed->grip.number = number_held(input.client);
        restart(result);
    }
    return result;
}

void Gestures::press(const PointerInput& input) {
    Grip grip;
    grip.buttons = input.buttons != 0 ? input.buttons : button_mask(input.button);
    grip.button = input.button >= 0 ? input.button : first_held(grip.buttons);
    grip.modifiers = input.modifiers;
    grip.number = number_held(input.client);
    const glm::dvec2 at{input.x, input.y};
    pressed_.push_back({input.client, input.pointer, input.device, at, at, grip});
}

/// Another button went down or up.
void Gestures::change_buttons(Pressed& pressed, const PointerInput& input) {
    Grip& grip = pressed.grip;
    const unsigned middle = button_mask(middle_button),
                   others = button_mask(left_button) | button_mask(right_button);
    grip.after_chord = (grip.buttons & input.buttons & middle) && (grip.after_chord || grip.buttons & others);
    grip.buttons = input.buttons;
    const bool went_down = (input.buttons & button_mask(input.button)) != 0;
    if (went_down) grip.button = input.button;
    if (!(input.buttons & button_mask(grip.button))) grip.button = first_held(input.buttons);
}

int Gestures::number_held(const std::string& client) const {
    const auto newest =
        std::find_if(keys_.rbegin(), keys_.rend(), [&](const HeldKey& key) { return key.client == client; });
    return newest == keys_.rend() ? 0 : newest->number;
}

void Gestures::key_down(const std::string& client, const KeyInput& input) {
    const HeldKey key{client, number_of(input)};
    // A held key repeats itself.
    if (key.number != 0 && std::find(keys_.begin(), keys_.end(), key) == keys_.end()) keys_.push_back(key);
}

void Gestures::key_up(const std::string& client, const KeyInput& input) {
    std::erase(keys_, HeldKey{client, number_of(input)});
}

KeyInput Gestures::HeldKey::input() const {
    const std::string digit = std::to_string(number);
    return {digit, false, "Digit" + digit};
}

std::vector<PointerInput> Gestures::pressed() const {
    std::vector<PointerInput> inputs;
    inputs.reserve(pressed_.size());
    for (const Pressed& p : pressed_)
        inputs.push_back({Action::down, p.client, p.pointer, p.device, p.now.x, p.now.y, p.grip.button,
                          p.grip.buttons, p.grip.modifiers});
    return inputs;
}

void Gestures::restart(const scene::Camera& camera) {
    start_ = camera;
    surface_.reset();
    for (Pressed& pressed : pressed_) pressed.start = pressed.now;
}

void Gestures::lift(const std::string& client, const scene::Camera& camera) {
    std::erase_if(pressed_, [&](const Pressed& pressed) { return pressed.client == client; });
    std::erase_if(keys_, [&](const HeldKey& key) { return key.client == client; });
    restart(camera);
}

std::vector<const Gestures::Pressed*> Gestures::fingers() const {
    std::vector<const Pressed*> touching;
    for (const Pressed& pressed : pressed_)
        if (pressed.device == Device::touch) touching.push_back(&pressed);
    return touching;
}

const std::optional<glm::dvec3>& Gestures::surface_at_start(const glm::dvec2& place,
                                                            const NavigationContext& context) {
    if (!surface_) surface_ = surface_at(start_, place, context);
    return *surface_;
}

glm::dvec3 Gestures::point_at_start(const glm::dvec2& place, const NavigationContext& context) {
    const std::optional<glm::dvec3>& surface = surface_at_start(place, context);
    return surface ? *surface : point_at(start_, place, context);
}

scene::Camera Gestures::turned(const Pressed& pressed, const NavigationContext& context) {
    const glm::dvec2 moved = pressed.now - pressed.start;
    scene::Camera start = start_;
    if (looks_around(start, context)) {
        const double height = scene::projection_of(start, 1).height();
        const glm::dvec2 degrees =
            moved * (height * context.rotate_speed / (context.height * scene::kRadiansPerDegree));
        return looked_around(start, -degrees.x, -degrees.y, context.keep_upright);
    }
    if (context.turn_about_touched)
        start.center = surface_at_start(pressed.start, context).value_or(start_.center);
    scene::Camera result = rotate_by(start, moved, context);
    result.center = start_.center;
    return result;
}

scene::Camera Gestures::dragged(const NavigationContext& context) {
    const std::vector<const Pressed*> touching = fingers();
    if (touching.size() == 1) return turned(*touching[0], context);
    if (touching.size() == 2) {
        const Pressed &a = *touching[0], &b = *touching[1];
        // The pan comes second, so that it is measured in the image as the fingers leave it.
        const glm::dvec3 point = point_at_start((a.start + b.start) * 0.5, context);
        const scene::Camera pinched =
            zoom_by(start_, span(a.now, b.now) / span(a.start, b.start), point, context);
        return pan_by(pinched, (a.now + b.now - a.start - b.start) * 0.5, point, context);
    }
    const Pressed& pressed = pressed_.back();
    const glm::dvec2 moved = pressed.now - pressed.start;
    switch (drag_operation(context.style, pressed.grip)) {
        case DragOperation::rotate:
            return turned(pressed, context);
        case DragOperation::pan:
            return pan_by(start_, moved, point_at_start(pressed.start, context), context);
        case DragOperation::zoom:
            return zoom_by(start_, std::pow(kDragZoom, -moved.y / context.height), start_.focus, context);
        case DragOperation::none:
            break;
    }
    return start_;
}

scene::Camera wheel(const WheelInput& input, const scene::Camera& camera, const NavigationContext& context) {
    const double step = kWheelSteps[static_cast<std::size_t>(input.unit)];
    const glm::dvec2 place(input.x, input.y);
    const glm::dvec3 point = surface_at(camera, place, context).value_or(point_at(camera, place, context));
    return zoom_by(camera, std::pow(kWheelZoom, -input.delta_y / step), point, context);
}

}  // namespace vrut::navigation
