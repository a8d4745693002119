#version 450 core
#include "texture_filter.glsl"
#include "sample_position.glsl"
layout(binding = 0) uniform sampler2D image;

void main() {
    vec2 size = vec2(textureSize(image, 0)) / 2;
    float level = mip_level(vec2(pixel.x * size.x, 0), vec2(0, pixel.y * size.y));
    color = vec4(sample_level(image, sample_position() / 2 + 0.5, level).rgb, 1);
}
