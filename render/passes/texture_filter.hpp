#pragma once

#include <string_view>

namespace vrut {

/// For fragment shaders: `vec4 filtered(sampler2D image, vec2 place)`, for textures of upload_texture().
/// Bilinear where a pixel is smaller than a texel, else trilinear at the level log2 of the pixel's longer
/// side in texels. Drivers approximate that level, and the mixing of two; so both are computed here.
inline constexpr std::string_view kTextureFilter = R"(
float level_of(vec2 across, vec2 up) { return 0.5 * log2(max(max(dot(across, across), dot(up, up)), 1)); }

vec4 filtered(sampler2D image, vec2 place) {
    vec2 size = vec2(textureSize(image, 0));
    float level = level_of(dFdx(place) * size, dFdy(place) * size);
    float finer = floor(level);
    return mix(textureLod(image, place, finer), textureLod(image, place, finer + 1), level - finer);
}
)";

}  // namespace vrut
