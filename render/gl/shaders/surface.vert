#version 450 core
#include "view_uniforms.glsl"
#include "local_position.glsl"
#include "clip_planes.glsl"
#ifdef LIT_AT_VERTEX
#include "phong.glsl"
#endif
layout(location = 1) in vec3 normal;
#ifdef INSTANCED
layout(location = 3) in mat4 view_from_local;
layout(location = 7) in mat3 normal_matrix;
layout(location = 10) in vec4 base_sides;  // w: 1 if two-sided
layout(location = 11) in vec4 diffuse_reflectivity;
layout(location = 12) in vec4 specular_shininess;
flat out vec3 base, diffuse, specular;
flat out float two_sided, reflectivity, shininess;
#else
layout(location = 1) uniform mat4 view_from_local;
layout(location = 2) uniform mat3 normal_matrix;
#ifdef LIT_AT_VERTEX
layout(location = 8) uniform float shininess;
layout(location = 9) uniform float two_sided;
#endif
#endif
#ifdef LIT_AT_VERTEX
out vec2 light;
#endif
#ifdef NEEDS_NORMAL
out vec3 view_position;
out vec3 view_normal;
#endif
invariant gl_Position;  // one depth in all programs
#if defined(TEXTURED) || defined(EMISSIVE) || defined(MAPPED)
layout(location = 2) in vec2 texcoord;
out vec2 uv;
#endif
#ifdef COLORED
layout(location = 4) in vec3 color;
out vec3 vertex_color;
#endif

void main() {
    vec3 local = local_position();
#ifdef INSTANCED
    base = base_sides.xyz;
    diffuse = diffuse_reflectivity.xyz;
    specular = specular_shininess.xyz;
    two_sided = base_sides.w;
    reflectivity = diffuse_reflectivity.w;
    shininess = specular_shininess.w;
#endif
    clip_by_planes(local);
#if defined(TEXTURED) || defined(EMISSIVE) || defined(MAPPED)
    uv = texcoord;
#endif
#ifdef COLORED
    vertex_color = color;
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
    light = phong(p.xyz, two_sided != 0 && dot(n, to_eye) < 0 ? -n : n, to_eye, d, shininess);
#endif
    gl_Position = clip_from_view * p;
}
