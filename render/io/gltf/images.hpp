#pragma once

#include <filesystem>
#include <string>
#include <tl/expected.hpp>

#include "io/gltf/buffers.hpp"
#include "scene/image.hpp"

namespace vrut::io {

/// Returns the name of an image for scene::Material: a file in the folder or below, or `*` and the image's
/// number where it lies inside the scene's file or its buffers. Throws ImportError.
std::string image_name(const GltfJson& document, std::uint32_t image, const std::filesystem::path& folder);

/// Decodes an image of the latter kind, by its name.
tl::expected<scene::Image, std::string> decode_gltf_image(const GltfJson& document, GltfBuffers& buffers,
                                                          const std::string& name, std::uint64_t max_pixels);

}  // namespace vrut::io
