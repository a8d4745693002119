#version 450 core
#include "discard_clipped.glsl"
layout(location = 4) uniform int number;
out int node;

void main() {
    discard_clipped();
    node = number;
}
