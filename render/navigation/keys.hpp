#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "navigation/gestures.hpp"

namespace vrut::navigation {

/// The operation of a key press.
struct KeyOperation {
    enum class Kind { rotate, pan, zoom, fit, home, toggle_wireframe, toggle_stylized, escape };
    Kind kind = Kind::fit;
    /// rotate: degrees to the right and down; pan: parts of the view's height; zoom: `x` divides the
    /// distance.
    glm::dvec2 by{0};
};

struct KeyName {
    std::string_view key;  ///< `KeyboardEvent.key`
    bool repeats = false;  ///< goes on while it is held
};
/// All keys with a meaning; the number keys of the navigation styles come last.
std::vector<KeyName> key_names();

/// Returns none for keys without a binding. All key names are here, except the number keys of the navigation
/// styles.
std::optional<KeyOperation> key_operation(const KeyInput& input);

/// Returns the camera after an operation; unchanged for those that do not move it. Speeds do not apply.
/// `home` is the target of Home; `context.bounds` limits the zoom. `fit` is left to the caller, who knows
/// what is shown.
scene::Camera apply_key_operation(const KeyOperation& operation, const scene::Camera& camera,
                                  const scene::Camera& home, const NavigationContext& context);

}  // namespace vrut::navigation
