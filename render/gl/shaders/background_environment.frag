#version 450 core
#include "texture_filter.glsl"
#include "sample_position.glsl"
// A pixel's ray in view space is (x, y, -1).
layout(location = 2) uniform vec2 ray_scale;
layout(location = 3) uniform mat3 world_from_view;
layout(binding = 0) uniform samplerCube environment_map;

void main() {
    vec2 step = pixel * ray_scale;
    vec3 direction = world_from_view * vec3(sample_position() * ray_scale, -1);
    color = vec4(sample_environment(environment_map, direction, world_from_view[0] * step.x, world_from_view[1] * step.y), 1);
}
