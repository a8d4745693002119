#version 450 core
// Depth is near / distance, so over a plane it is linear in the image, and over all that is convex it is concave:
// interpolated between texels it is nowhere more than at the point itself, and going away from the point it grows by no
// more than it falls on the other side. In a hollow it goes on growing as it began. What grows by more lies before the
// point. Where the point itself is hidden, everything before it hides it.
layout(location = 0) uniform mat4 clip_from_view;
layout(location = 1) uniform float radius;
layout(location = 2) uniform bool judged;
layout(std140, binding = 1) uniform Points { vec4 points[256]; };
layout(binding = 0) uniform sampler2D depth;
flat out vec2 center;
flat out float opacity;

const int kPlaces = 16;
const float kRounding = 1e-5, kHidden = 0.3;

float depth_at(vec2 pixel) {
    ivec2 low = ivec2(floor(pixel - 0.5)), last = textureSize(depth, 0) - 1;
    vec2 part = pixel - 0.5 - low;
    float d[4];
    for (int i = 0; i < 4; ++i)
        d[i] = texelFetch(depth, clamp(low + ivec2(i & 1, i >> 1), ivec2(0), last), 0).r;
    return mix(mix(d[0], d[1], part.x), mix(d[2], d[3], part.x), part.y);
}

// The part of a point's surroundings, as wide as half its sign, that does not lie before it.
float seen(vec2 at, float own, float pixel) {
    float hides = own * (1 + kRounding + 1.5 * pixel);
    bool is_seen = depth_at(at) <= hides;
    int count = is_seen ? 1 : 0;
    for (int i = 0; i < kPlaces; ++i) {
        float angle = i * 2.39996323, away = radius / 2 * sqrt((i + 0.5) / kPlaces);  // evenly over the disc
        vec2 offset = away * vec2(cos(angle), sin(angle));
        float here = depth_at(at + offset), opposite = max(depth_at(at - offset), own / 2);
        float next = max(depth_at(at + offset / away), own);
        bool own_surface = is_seen && (here + opposite <= 2 * hides || here <= mix(own, next, away) + hides - own);
        if (here <= hides || own_surface) ++count;
    }
    return count / float(kPlaces + 1);
}

void main() {
    vec4 clip = clip_from_view * points[gl_InstanceID];
    vec2 size = textureSize(depth, 0);
    center = (clip.xy / clip.w * 0.5 + 0.5) * size;
    float pixel = 2 / (clip_from_view[1][1] * size.y);  // at distance 1
    opacity = judged ? mix(kHidden, 1, seen(center, clip.z / clip.w, pixel)) : 1;
    vec2 corner = center + (radius + 1) * (vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2 - 1);
    gl_Position = vec4(corner / size * 2 - 1, 0, 1);
}
