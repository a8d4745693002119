#version 450 core
#include "view_uniforms.glsl"
#include "discard_clipped.glsl"
#include "cap_depth.glsl"
#ifndef LIT_AT_VERTEX
#include "phong.glsl"
#endif
#if defined(TEXTURED) || defined(EMISSIVE) || defined(ENVIRONMENT) || defined(MAPPED)
#include "texture_filter.glsl"
#endif
#if defined(EMISSIVE) || defined(METALLIC_ROUGHNESS)
#include "srgb.glsl"
#endif
#ifdef METALLIC_ROUGHNESS
#include "metallic_roughness.glsl"
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
#endif
#ifdef MAPPED
layout(binding = 5) uniform sampler2D occlusion_roughness_metallic_image;
layout(binding = 6) uniform sampler2D normal_image;
layout(location = 17) uniform float normal_scale;  // 0 without an image
#endif
#if defined(TEXTURED) || defined(EMISSIVE) || defined(MAPPED)
in vec2 uv;
#endif
#ifdef COLORED
layout(location = 15) uniform vec3 ambient;  // else part of base
in vec3 vertex_color;
#endif
#ifdef ENVIRONMENT
layout(binding = 1) uniform samplerCube environment_map;
#ifdef METALLIC_ROUGHNESS
layout(binding = 4) uniform samplerCube prefiltered_map;
#endif
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

#ifdef MAPPED
// `n` with what the normal map tells. The tangents are those of the pixel's triangle, across the normal.
vec3 mapped_normal(vec3 n) {
    vec3 across = dFdx(view_position), upwards = dFdy(view_position);
    vec2 duv_across = dFdx(uv), duv_upwards = dFdy(uv);
    float turn = duv_across.x * duv_upwards.y - duv_across.y * duv_upwards.x < 0 ? -1 : 1;
    vec3 u = turn * (across * duv_upwards.y - upwards * duv_across.y);
    vec3 v = turn * (upwards * duv_across.x - across * duv_upwards.x);
    float side = dot(n, view_normal) < 0 ? -1 : 1;  // the map lies on the front
    vec3 front = n * side, tangent = u - front * dot(front, u);
    float size = length(tangent);
    if (!(size > 0)) return n;
    tangent /= size;
    vec3 bitangent = cross(front, tangent);
    if (dot(bitangent, v) < 0) bitangent = -bitangent;
    vec3 components = 2 * sample_filtered(normal_image, uv).rgb - 1;
    components = normal_scale == 0 ? vec3(0, 0, 1) : components * vec3(normal_scale, normal_scale, 1);
    return side * normalize(tangent * components.x + bitangent * components.y + front * components.z);
}
#endif

#if defined(COATED) || (defined(ENVIRONMENT) && !defined(METALLIC_ROUGHNESS))
#define MIRRORS_ENVIRONMENT
// What the ray that is reflected at `n` meets.
vec3 reflected_environment(vec3 to_eye, vec3 n, vec3 smooth_normal) {
    // The interpolated normal is linear over a triangle, a unit normal is not: the derivatives of the reflected
    // direction follow by the chain rule, but for the part along it, which does not turn it.
    vec3 ray = world_from_view * -to_eye;
    vec3 normal = world_from_view * (dot(view_normal, view_normal) < 1e-12 ? smooth_normal : view_normal);
    vec3 scaled = 2 / dot(normal, normal) * normal;
    float along = dot(ray, scaled);
    vec3 reflected = ray - along * normal;
    vec3 dray = dFdx(ray), dnormal = dFdx(normal);
    vec3 ddx = dray - along * dnormal - (dot(dnormal, reflected) + dot(dray, normal)) * scaled;
    dray = dFdy(ray), dnormal = dFdy(normal);
    vec3 ddy = dray - along * dnormal - (dot(dnormal, reflected) + dot(dray, normal)) * scaled;
#ifdef MAPPED
    reflected = reflect(ray, world_from_view * n);
#endif
    return sample_environment(environment_map, reflected, ddx, ddy);
}
#endif

#ifdef METALLIC_ROUGHNESS
// As displayed; `displayed_base` is the base colour as displayed.
vec3 metallic_color(vec3 displayed_base, vec3 to_eye, float d, vec3 n, vec3 smooth_normal) {
    MetallicSurface surface =
        MetallicSurface(linear_from_srgb(displayed_base), specular.x, specular.y, specular.z, 1);
#ifdef MAPPED
    vec3 texel = sample_filtered(occlusion_roughness_metallic_image, uv).rgb;
    surface.occlusion = texel.r;
    surface.roughness *= texel.g;
    surface.metallic *= texel.b;
#endif
    vec3 direction = world_from_view * reflect(-to_eye, n);
    vec3 glossy = sample_prefiltered(prefiltered_map, direction, surface.roughness);
#ifdef COATED
    vec3 sharp = linear_from_srgb(reflected_environment(to_eye, smooth_normal, smooth_normal));
#else
    vec3 sharp = vec3(0);
#endif
    vec4 light = incident_light(view_position, to_eye, d);
    return srgb_from_linear(metallic_roughness(surface, light, n, smooth_normal, to_eye, glossy, sharp));
}
#endif

void main() {
    discard_clipped();
    write_cap_depth();
#ifdef NEEDS_NORMAL
    float d = length(view_position);
    vec3 to_eye = -view_position / d;
    vec3 smooth_normal = normal_to(to_eye), n = smooth_normal;
#ifdef MAPPED
    n = mapped_normal(smooth_normal);
#endif
#endif
#if !defined(LIT_AT_VERTEX) && !defined(METALLIC_ROUGHNESS)
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
#endif
#ifdef METALLIC_ROUGHNESS
    vec3 own = metallic_color(clamp(matte, 0, 1), to_eye, d, n, smooth_normal);
#else
#ifdef COLORED
    vec3 unlit = base + ambient * vertex_color;
#else
    vec3 unlit = base;
#endif
    vec3 own = clamp(unlit + (matte * light.x + specular * light.y) * light_color.rgb, 0, 1);
#endif
#ifdef EMISSIVE
    own = srgb_from_linear(linear_from_srgb(own) +
                           emissive * linear_from_srgb(sample_filtered(emissive_image, uv).rgb));
#endif
#if defined(MIRRORS_ENVIRONMENT) && !defined(MIRROR)
    own = mix(own, reflected_environment(to_eye, n, smooth_normal), reflectivity);
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
