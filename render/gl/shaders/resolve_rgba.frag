#version 450 core
#include "sample_bytes.glsl"
out vec4 color;

void main() { color = vec4(bytes_at(ivec2(gl_FragCoord.xy))) / 255; }
