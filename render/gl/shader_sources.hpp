#pragma once

#include <span>
#include <string>
#include <string_view>

namespace vrut::gl {

/// A stage of shaders/, embedded by embed_shaders.cmake.
struct ShaderSource {
    std::string_view file;  ///< "surface.vert"
    std::string_view text;  ///< begins with its version line; what it includes stands in its place
};

/// All of them.
std::span<const ShaderSource> shader_sources();

/// Returns the text of one, with these names defined. Throws std::logic_error where there is none: our own
/// fault.
std::string shader_source(std::string_view file, std::span<const std::string_view> defines = {});

}  // namespace vrut::gl
