#version 450 core
#include "sample_bytes.glsl"
out vec4 sum;

void main() { sum = vec4(bytes_at(ivec2(gl_FragCoord.xy))); }
