#version 450 core
#include "view_uniforms.glsl"
#ifndef LIT_AT_VERTEX
#include "phong.glsl"
#endif
#if defined(TEXTURED) || defined(EMISSIVE) || defined(ENVIRONMENT)
#include "texture_filter.glsl"
#endif
#ifdef LAYERED
#include "per_pixel_lists.glsl"

// A layer without room is counted all the same.
void append_fragment(vec4 own, uint order) {
    uint number = atomicAdd(count, 1) + 1;
    if (number > most) return;
    uint next = atomicExchange(heads[head_index(ivec2(gl_FragCoord.xy))], number);
    fragments[number - 1] =
        Fragment(next, order, gl_FragCoord.z, packUnorm2x16(own.rg), packUnorm2x16(own.ba));
}
#endif
#ifdef INSTANCED
flat in vec3 base, diffuse, specular;
flat in float two_sided, reflectivity, shininess;
#else
layout(location = 5) uniform vec3 base;
layout(location = 6) uniform vec3 diffuse;
layout(location = 7) uniform vec3 specular;
layout(location = 8) uniform float shininess;
layout(location = 9) uniform float two_sided;
layout(location = 10) uniform float reflectivity;
#endif
#ifdef MIRROR
layout(binding = 2) uniform sampler2D reflection;
#endif
#ifdef GLASS
layout(location = 11) uniform float alpha;
#endif
#ifdef LAYERED
layout(location = 12) uniform uint first_triangle;
layout(early_fragment_tests) in;
#else
out vec4 color;
#endif
#ifdef LIT_AT_VERTEX
in vec2 light;
#endif
#ifdef NEEDS_NORMAL
in vec3 view_position;
in vec3 view_normal;
#endif
#ifdef TEXTURED
layout(binding = 0) uniform sampler2D image;
#endif
#ifdef EMISSIVE
layout(binding = 3) uniform sampler2D emissive_image;
layout(location = 16) uniform vec3 emissive;
#include "srgb.glsl"
#endif
#if defined(TEXTURED) || defined(EMISSIVE)
in vec2 uv;
#endif
#ifdef COLORED
layout(location = 15) uniform vec3 ambient;  // else part of base
in vec3 vertex_color;
#endif
#ifdef ENVIRONMENT
layout(binding = 1) uniform samplerCube environment_map;
#endif

#ifdef NEEDS_NORMAL
vec3 normal_to(vec3 to_eye) {
    vec3 n = view_normal;
#ifdef EDGES
    if (dot(n, n) < 1e-12) n = to_eye;
#else
    // A normal that vanishes (flattened parts, opposite neighbours) takes the face's, which faces the viewer.
    vec3 across = dFdx(view_position), upwards = dFdy(view_position);
    if (dot(n, n) < 1e-12) n = cross(normalize(across), normalize(upwards));
#endif
    n = normalize(n);
    return two_sided != 0 && dot(n, to_eye) < 0 ? -n : n;
}
#endif

void main() {
#ifdef NEEDS_NORMAL
    float d = length(view_position);
    vec3 to_eye = -view_position / d;
    vec3 n = normal_to(to_eye);
#endif
#ifndef LIT_AT_VERTEX
    vec2 light = phong(view_position, n, to_eye, d, shininess);
#endif
#ifdef TEXTURED
    vec4 texel = sample_filtered(image, uv);
    vec3 matte = texel.rgb;
#else
    vec3 matte = diffuse;
#endif
#ifdef COLORED
    matte *= vertex_color;
    vec3 unlit = base + ambient * vertex_color;
#else
    vec3 unlit = base;
#endif
    vec3 own = clamp(unlit + (matte * light.x + specular * light.y) * light_color.rgb, 0, 1);
#ifdef EMISSIVE
    own = srgb_from_linear(linear_from_srgb(own) +
                           emissive * linear_from_srgb(sample_filtered(emissive_image, uv).rgb));
#endif
#ifdef ENVIRONMENT
    // The interpolated normal is linear over a triangle, a unit normal is not: the derivatives of the reflected
    // direction follow by the chain rule, but for the part along it, which does not turn it.
    vec3 ray = world_from_view * -to_eye;
    vec3 normal = world_from_view * (dot(view_normal, view_normal) < 1e-12 ? n : view_normal);
    vec3 scaled = 2 / dot(normal, normal) * normal;
    float along = dot(ray, scaled);
    vec3 reflected = ray - along * normal;
    vec3 dray = dFdx(ray), dnormal = dFdx(normal);
    vec3 ddx = dray - along * dnormal - (dot(dnormal, reflected) + dot(dray, normal)) * scaled;
    dray = dFdy(ray), dnormal = dFdy(normal);
    vec3 ddy = dray - along * dnormal - (dot(dnormal, reflected) + dot(dray, normal)) * scaled;
    own = mix(own, sample_environment(environment_map, reflected, ddx, ddy), reflectivity);
#endif
#ifdef MIRROR
    own = mix(own, texelFetch(reflection, ivec2(gl_FragCoord.xy), 0).rgb, reflectivity);
#endif
#if defined(GLASS) && defined(TEXTURED)
    vec4 layer = vec4(own, 1) * (alpha * texel.a);
#elif defined(GLASS)
    vec4 layer = vec4(own, 1) * alpha;
#endif
#if defined(LAYERED)
    append_fragment(layer, first_triangle + uint(gl_PrimitiveID));
#elif defined(GLASS)
    color = layer;
#else
    color = vec4(own, 1);
#endif
}
