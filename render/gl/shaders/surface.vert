#version 450 core
#include "view_uniforms.glsl"
#include "local_position.glsl"
#ifdef LIT_AT_VERTEX
#include "phong.glsl"
#endif
layout(location = 1) uniform mat4 view_from_local;
layout(location = 2) uniform mat3 normal_matrix;
#ifdef CLIPPED
layout(location = 13) uniform vec4 clip_plane;
out float gl_ClipDistance[1];
#endif
layout(location = 1) in vec3 normal;
#ifdef LIT_AT_VERTEX
layout(location = 9) uniform bool two_sided;
out vec2 light;
#endif
#ifdef NEEDS_NORMAL
out vec3 view_position;
out vec3 view_normal;
#endif
invariant gl_Position;  // one depth in all programs
#ifdef TEXTURED
layout(location = 2) in vec2 texcoord;
out vec2 uv;
#endif

void main() {
    vec3 local = local_position();
#ifdef CLIPPED
    gl_ClipDistance[0] = dot(clip_plane, vec4(local, 1));
#endif
#ifdef TEXTURED
    uv = texcoord;
#endif
    vec4 p = view_from_local * vec4(local, 1);
    vec3 n = normal_matrix * normal;
    float size = length(n);
    n = size > 0 ? n / size : vec3(0);
#ifdef NEEDS_NORMAL
    view_position = p.xyz;
    view_normal = n;
#endif
#ifdef LIT_AT_VERTEX
    float d = max(length(p.xyz), 1e-30);
    vec3 to_eye = -p.xyz / d;
    if (size == 0) n = to_eye;  // a vertex knows no face
    light = phong(p.xyz, two_sided && dot(n, to_eye) < 0 ? -n : n, to_eye, d);
#endif
    gl_Position = clip_from_view * p;
}
