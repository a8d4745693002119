#version 450 core
#include "discard_clipped.glsl"
#include "cap_depth.glsl"
layout(location = 4) uniform int number;
out int node;

void main() {
    discard_clipped();
    write_cap_depth();
    node = number;
}
