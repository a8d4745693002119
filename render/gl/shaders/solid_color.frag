#version 450 core
#include "discard_clipped.glsl"
#include "cap_depth.glsl"
layout(location = 3) uniform vec3 solid_color;
out vec4 color;

void main() {
    discard_clipped();
    write_cap_depth();
    color = vec4(solid_color, 1);
}
