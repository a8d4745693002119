#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "navigation/gestures.hpp"

namespace vrut::navigation {

/// What a key asks for when it goes down.
struct KeyOperation {
    enum class Kind { rotate, pan, zoom, fit, home, toggle_wireframe, toggle_stylized, escape };
    Kind kind = Kind::fit;
    /// rotate: degrees to the right and down; pan: parts of the view's height; zoom: `x` divides the
    /// distance.
    glm::dvec2 by{0};
};

/// None for keys that mean nothing. Here stand all their names, but for the number keys of the navigation
/// styles.
std::optional<KeyOperation> key_operation(const KeyInput& input);

/// The camera after an operation; the same camera for those that do not move it. Speeds do not apply. `home`
/// is where Home goes; `context.bounds` is what fit fits, and what limits the zoom.
scene::Camera apply_key_operation(const KeyOperation& operation, const scene::Camera& camera,
                                  const scene::Camera& home, const NavigationContext& context);

}  // namespace vrut::navigation
