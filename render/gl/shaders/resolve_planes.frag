#version 450 core
// Writes the bytes of scene::PlanarImage. libjpeg's integers (jccolor.c, jcsample.c) give the same file.
#include "sample_bytes.glsl"
layout(location = 2) uniform ivec2 size;
layout(location = 3) uniform ivec2 luma;  // stride, rows
layout(location = 4) uniform bool subsampled;
out float value;

// `at` counts rows from the top down; beyond the image lies its last row or column.
ivec3 color_at(ivec2 at) {
    at = min(at, size - 1);
    return ivec3(bytes_at(ivec2(at.x, size.y - 1 - at.y)).rgb);
}

int dot3(ivec3 a, ivec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

int luma_of(ivec3 color) { return (dot3(color, ivec3(19595, 38470, 7471)) + 32768) >> 16; }

int chroma_of(ivec3 color, bool is_red) {
    ivec3 factors = is_red ? ivec3(32768, -27439, -5329) : ivec3(-11059, -21709, 32768);
    return (dot3(color, factors) + (128 << 16) + 32767) >> 16;
}

int chroma_at(ivec2 at) {
    if (!subsampled) return chroma_of(color_at(ivec2(at.x, at.y % luma.y)), at.y >= luma.y);
    bool is_red = at.x >= luma.x / 2;
    int column = is_red ? at.x - luma.x / 2 : at.x;
    int sum = 1 + column % 2;  // rounds up and down in turns
    for (int i = 0; i < 4; ++i) sum += chroma_of(color_at(ivec2(column, at.y) * 2 + ivec2(i & 1, i >> 1)), is_red);
    return sum >> 2;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    int byte = at.y < luma.y ? luma_of(color_at(at)) : chroma_at(at - ivec2(0, luma.y));
    value = float(byte) / 255;
}
