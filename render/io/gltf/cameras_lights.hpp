#pragma once

#include <optional>

#include "io/conversion_warnings.hpp"
#include "io/gltf/json.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// The camera of a glTF node, or none where it has none or one of a kind that we have not. Throws
/// ImportError.
std::optional<scene::Node> read_gltf_camera(const GltfJson& document, const GltfJson& node,
                                            ConversionWarnings& warnings);
/// The same of its light (KHR_lights_punctual).
std::optional<scene::Node> read_gltf_light(const GltfJson& document, const GltfJson& node,
                                           ConversionWarnings& warnings);

}  // namespace vrut::io
