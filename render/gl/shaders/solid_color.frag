#version 450 core
layout(location = 3) uniform vec3 solid_color;
out vec4 color;

void main() { color = vec4(solid_color, 1); }
