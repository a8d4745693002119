#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "camera.hpp"

namespace vrut {

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
};

struct WheelInput {
    enum class Unit { pixel, line, page };
    double delta_y = 0;  ///< towards the user is positive
    Unit unit = Unit::pixel;
};

struct KeyInput {
    std::string key;  ///< `KeyboardEvent.key`
    bool shift = false;
};

/// What turns an input into a move, besides the input.
struct NavigationContext {
    double width = 1280, height = 720;  ///< of the view, CSS pixels
    Bounds bounds;                      ///< of the scene
    bool keep_upright = true;
    double rotate_speed = 1, pan_speed = 1, zoom_speed = 1;
};

/// Drags by mouse, pen and touch. Pure: no clock, no input but its arguments. A drag is computed from the
/// camera at its start and the pointers' places since, so that dropped or merged moves give the same camera
/// to the last bit.
class Gestures {
public:
    /// The camera after `input`, from `camera` before it.
    Camera pointer(const PointerInput& input, const Camera& camera, const NavigationContext& context);
    /// To be called after the camera changed by anything but pointer(): drags begin anew there.
    void restart(const Camera& camera);
    /// Lifts the pointers of `client`; the camera stays where it is.
    void lift(const std::string& client, const Camera& camera);
    bool any_pressed() const { return !pressed_.empty(); }
    bool is_pressed(const std::string& client, std::int64_t pointer) const;

private:
    struct Pressed {
        std::string client;
        std::int64_t pointer = 0;
        PointerInput::Device device = PointerInput::Device::mouse;
        glm::dvec2 start{0}, now{0};
        unsigned buttons = 0;
        int button = 0;  ///< the held one that was pressed last: it says what the drag does
    };

    std::vector<const Pressed*> fingers() const;  ///< two at most: a third is ignored until it is lifted
    Camera dragged(const NavigationContext& context) const;

    std::vector<Pressed> pressed_;  // in the order of pressing
    Camera start_;
};

/// The camera after a wheel event: a step (100 pixels, 3 lines, ⅓ page) away from the user divides the
/// distance by 1.1.
Camera wheel(const WheelInput& input, const Camera& camera, const NavigationContext& context);

/// The camera after a key is pressed; the same camera for keys that do not move it. `home` is where Home
/// goes.
Camera key_down(const KeyInput& input, const Camera& camera, const Camera& home,
                const NavigationContext& context);

}  // namespace vrut
