#version 450 core
// The distance along the row to the nearest covered pixel. What lies outside the box is of an earlier image, or of none.
layout(location = 0) uniform int width;
layout(location = 2) uniform ivec4 box;
layout(binding = 0) uniform sampler2D covered;
out float across;

bool is_covered(ivec2 at) {
    return at.x >= box.x && at.x < box.z && texelFetch(covered, at, 0).r > 0.5;
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    int found = 255;
    for (int step = width; step >= 0; --step)
        if (is_covered(here - ivec2(step, 0)) || is_covered(here + ivec2(step, 0))) found = step;
    across = found / 255.0;
}
