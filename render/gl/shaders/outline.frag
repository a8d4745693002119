#version 450 core
layout(location = 0) uniform int width;
layout(location = 1) uniform vec3 outline_color;
layout(location = 2) uniform ivec4 box;
layout(binding = 0) uniform sampler2D measured;
out vec4 color;

int across(ivec2 at) {
    return at.y >= box.y && at.y < box.w ? int(round(texelFetch(measured, at, 0).r * 255)) : 255;
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    if (across(here) == 0) discard;  // covered
    int nearest = width * width + 1;
    for (int step = -width; step <= width; ++step) {
        int along = across(here + ivec2(0, step));
        nearest = min(nearest, along * along + step * step);
    }
    if (nearest > width * width) discard;
    color = vec4(outline_color, 1);
}
