#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "navigation/navigation_style.hpp"
#include "scene/camera.hpp"

namespace vrut::navigation {

/// W3C Pointer Events, in CSS pixels of the view from its top left.
struct PointerInput {
    enum class Action { down, move, up, cancel };
    enum class Device { mouse, touch, pen };
    Action action = Action::move;
    std::string client;
    std::int64_t pointer = 0;  ///< `pointerId`; unique within its client
    Device device = Device::mouse;
    double x = 0, y = 0;
    int button = -1;       ///< the one that changed; -1 none
    unsigned buttons = 0;  ///< those held: 1 left, 2 right, 4 middle
    ModifierKeys modifiers{};
};

struct WheelInput {
    enum class Unit { pixel, line, page };
    double delta_y = 0;  ///< towards the user is positive
    Unit unit = Unit::pixel;
    double x = 0, y = 0;  ///< of the pointer, as in PointerInput
};

struct KeyInput {
    std::string key;  ///< `KeyboardEvent.key`
    bool shift = false;
    std::string code{};  ///< `KeyboardEvent.code`: where the key lies
};

/// What a move depends on besides the input.
struct NavigationContext {
    double width = 1280, height = 720;  ///< of the view, CSS pixels
    math::Bounds bounds;                ///< of the scene
    bool keep_upright = true;
    double rotate_speed = 1, pan_speed = 1, zoom_speed = 1;
    NavigationStyle style = NavigationStyle::vrut;
    /// Turns about what is touched, where something is, instead of `Camera::center`, which stays.
    bool turn_about_touched = false;
    /// Returns the point of a surface that a camera sees at a place of the view; none if nothing is there.
    /// Empty: nothing is anywhere.
    std::function<std::optional<glm::dvec3>(const scene::Camera& camera, const glm::dvec2& place)>
        surface_at = {};
    /// Returns whether drags look around from an eye, instead of turning the scene. Empty: from none.
    std::function<bool(const glm::dvec3& eye)> looks_around_from = {};
};

bool looks_around(const scene::Camera& camera, const NavigationContext& context);

/// A wheel's step away from the user divides the distance by it, and so does a zooming drag of the view's
/// height upwards.
inline constexpr double kWheelZoom = 1.1, kDragZoom = 4;
/// What is one step of a wheel, by WheelInput::Unit.
inline constexpr double kWheelSteps[] = {100, 3, 1.0 / 3};

/// Drags by mouse, pen and touch as a pure function of the input. The camera is computed from the camera at
/// the start of the drag and the pointers' positions since, so that dropped or coalesced moves give a
/// bit-identical camera. What was touched at the start stays under the pointer, or between two fingers, while
/// they pan and zoom; where nothing is, that is the point at the focus' depth. Where drags look around, what
/// is in the middle of the view follows the pointer. A move (`button` is -1) may be replaced by a later one
/// of the same pointer with the same buttons if nothing else came between, and if both have the same context.
class Gestures {
public:
    struct HeldKey {
        std::string client;
        int number = 0;  ///< 1 to 9

        KeyInput input() const;
        bool operator==(const HeldKey&) const = default;
    };

    /// Returns the camera after `input`, given the `camera` before it.
    scene::Camera pointer(const PointerInput& input, const scene::Camera& camera,
                          const NavigationContext& context);
    /// Number keys, which some navigation styles use for drags that begin while they are held; other keys are
    /// ignored.
    void key_down(const std::string& client, const KeyInput& input);
    void key_up(const std::string& client, const KeyInput& input);
    /// Call this after the camera changed by anything but pointer(): drags restart there.
    void restart(const scene::Camera& camera);
    /// Lifts the pointers and keys of `client`; the camera stays where it is.
    void lift(const std::string& client, const scene::Camera& camera);
    bool any_pressed() const { return !pressed_.empty(); }
    bool is_pressed(const std::string& client, std::int64_t pointer) const;

    /// Returns the keys held and the pointers as if pressed at their present positions. Feeding these, in
    /// this order and with the present camera, into a new Gestures continues identically. (Drags restart, so
    /// that keys and buttons released since they began no longer count.)
    std::vector<HeldKey> held_keys() const { return keys_; }
    std::vector<PointerInput> pressed() const;

private:
    struct Pressed {
        std::string client;
        std::int64_t pointer = 0;
        PointerInput::Device device = PointerInput::Device::mouse;
        glm::dvec2 start{0}, now{0};
        Grip grip;
    };

    int number_held(const std::string& client) const;
    void press(const PointerInput& input);
    static void change_buttons(Pressed& pressed, const PointerInput& input);
    std::vector<const Pressed*> fingers() const;  ///< two at most: a third is ignored until it is lifted
    scene::Camera dragged(const NavigationContext& context);
    scene::Camera turned(const Pressed& pressed, const NavigationContext& context);
    const std::optional<glm::dvec3>& surface_at_start(const glm::dvec2& place,
                                                      const NavigationContext& context);
    glm::dvec3 point_at_start(const glm::dvec2& place, const NavigationContext& context);

    std::vector<Pressed> pressed_;  // in the order of pressing
    std::vector<HeldKey> keys_;     // in the order of pressing
    scene::Camera start_;
    std::optional<std::optional<glm::dvec3>> surface_;  // at the start; none: not looked for yet
};

/// Returns the camera after a wheel event. What lies under the pointer stays there, as in a drag.
scene::Camera wheel(const WheelInput& input, const scene::Camera& camera, const NavigationContext& context);

}  // namespace vrut::navigation
