#include "gl/passes/surface_programs.hpp"

#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <string>

#include "gl/passes/texture_filter.hpp"

namespace vrut::gl {

namespace {

enum SurfaceUniform : GLint {
    clip_from_view_at = 0,  // of SolidColorProgram; others find it in the sight's block
    view_from_local_at = 1,
    normal_matrix_at = 2,
    solid_color_at = 3,
    node_at = 4,
    base_at = 5,
    diffuse_at = 6,
    specular_at = 7,
    shininess_at = 8,
    two_sided_at = 9,
    reflectivity_at = 10,
    alpha_at = 11,
    first_triangle_at = 12,
    clip_plane_at = 13,
};

constexpr GLuint kViewUniformsBinding = 0;
constexpr GLuint kTextureUnit = 0, kEnvironmentUnit = 1;

/// What holds for all surfaces of a sight, in view space; laid out as std140 has it.
struct ViewUniforms {
    glm::mat4 clip_from_view;
    glm::mat3x4 world_from_view;  // of directions
    glm::vec4 light_color, attenuation, light_position, light_direction;
    glm::vec4 cone;  // x, y: 1 - cos where the light is full, and where it ends
};

constexpr std::string_view kViewUniformsBlock = R"(
layout(std140, binding = 0) uniform ViewUniforms {
    mat4 clip_from_view;
    mat3 world_from_view;
    vec4 light_color, attenuation, light_position, light_direction;
    vec4 cone;
};
)";

// For the stage that evaluates it. The eye is the origin. After the sight's block, and what the light's kind
// defines.
constexpr std::string_view kPhong = R"(
layout(location = 8) uniform float shininess;

float attenuated(float d) { return 1 / max(dot(attenuation.xyz, vec3(1, d, d * d)), 1e-6); }

// smoothstep of the cosine. What it is short of 1 is half the square of a difference, which keeps its digits in
// the narrowest cone.
float in_cone(vec3 from_light) {
    vec3 off = from_light - light_direction.xyz;
    float t = clamp((cone.y - dot(off, off) / 2) / max(cone.y - cone.x, 1e-12), 0, 1);
    return t * t * (3 - 2 * t);
}

// How much light the matte and the shiny part of a surface send to the eye, which is at a distance d.
vec2 phong(vec3 at, vec3 n, vec3 to_eye, float d) {
#if defined(HEADLIGHT)
    vec3 to_light = to_eye;
    float intensity = attenuated(d);
#elif defined(DIRECTIONAL)
    vec3 to_light = -light_direction.xyz;
    float intensity = 1;
#else
    vec3 light_offset = light_position.xyz - at;
    float light_distance = length(light_offset);
    vec3 to_light = light_offset / max(light_distance, 1e-30);
    float intensity = attenuated(light_distance);
#ifdef SPOT
    intensity *= in_cone(-to_light);
#endif
#endif
    float lambert = max(dot(to_light, n), 0);
    float highlight = max(dot(reflect(-to_light, n), to_eye), 1e-30);  // pow(0, 0) is undefined
    return lambert * intensity * vec2(1, pow(highlight, shininess));
}
)";

// After the sight's block.
constexpr std::string_view kVertexShader = R"(
layout(location = 1) uniform mat4 view_from_local;
layout(location = 2) uniform mat3 normal_matrix;
#ifdef CLIPPED
layout(location = 13) uniform vec4 clip_plane;
out float gl_ClipDistance[1];
#endif
layout(location = 0) in vec3 position;
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
#ifdef CLIPPED
    gl_ClipDistance[0] = dot(clip_plane, vec4(position, 1));
#endif
#ifdef TEXTURED
    uv = texcoord;
#endif
    vec4 p = view_from_local * vec4(position, 1);
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
)";

// After the sight's block, and what the shape and its light define.
constexpr std::string_view kFragmentShader = R"(
layout(location = 5) uniform vec3 base;
layout(location = 6) uniform vec3 diffuse;
layout(location = 7) uniform vec3 specular;
#ifdef MIRROR
layout(location = 10) uniform float reflectivity;
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
layout(location = 9) uniform bool two_sided;
in vec3 view_position;
in vec3 view_normal;
#endif
#ifdef TEXTURED
layout(binding = 0) uniform sampler2D image;
in vec2 uv;
#endif
#ifdef ENVIRONMENT
layout(location = 10) uniform float reflectivity;
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
    return two_sided && dot(n, to_eye) < 0 ? -n : n;
}
#endif

void main() {
#ifdef NEEDS_NORMAL
    float d = length(view_position);
    vec3 to_eye = -view_position / d;
    vec3 n = normal_to(to_eye);
#endif
#ifndef LIT_AT_VERTEX
    vec2 light = phong(view_position, n, to_eye, d);
#endif
#ifdef TEXTURED
    vec4 texel = sample_filtered(image, uv);
    vec3 matte = texel.rgb;
#else
    vec3 matte = diffuse;
#endif
    vec3 own = clamp(base + (matte * light.x + specular * light.y) * light_color.rgb, 0, 1);
#ifdef ENVIRONMENT
    vec3 seen = world_from_view * reflect(-to_eye, n);
    own = mix(own, sample_environment(environment_map, seen, dFdx(seen), dFdy(seen)), reflectivity);
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
)";

// After kPerPixelLists. A layer without room is counted all the same.
constexpr std::string_view kAppendFragment = R"(
void append_fragment(vec4 own, uint order) {
    uint number = atomicAdd(count, 1) + 1;
    if (number > most) return;
    uint next = atomicExchange(heads[head_index(ivec2(gl_FragCoord.xy))], number);
    fragments[number - 1] =
        Fragment(next, order, gl_FragCoord.z, packUnorm2x16(own.rg), packUnorm2x16(own.ba));
}
)";

constexpr std::string_view kSolidColorVertexShader = R"(#version 450 core
layout(location = 0) uniform mat4 clip_from_view;
layout(location = 1) uniform mat4 view_from_local;
layout(location = 0) in vec3 position;
invariant gl_Position;

void main() { gl_Position = clip_from_view * (view_from_local * vec4(position, 1)); }
)";

constexpr std::string_view kSolidColorFragmentShader = R"(#version 450 core
layout(location = 3) uniform vec3 solid_color;
out vec4 color;

void main() { color = vec4(solid_color, 1); }
)";

constexpr std::string_view kNodeIdShader = R"(#version 450 core
layout(location = 4) uniform int number;
out int node;

void main() { node = number; }
)";

void set(GLint location, const glm::vec3& value) { glUniform3fv(location, 1, glm::value_ptr(value)); }

/// 1 - cos, exact near 0.
double short_of_one(double degrees) {
    const double sine = std::sin(degrees * scene::kRadiansPerDegree / 2);
    return 2 * sine * sine;
}

ViewUniforms view_uniforms_of(const CameraMatrices& camera, const plan::View& view) {
    const scene::Light& light = view.light;
    ViewUniforms uniforms{};
    uniforms.clip_from_view = glm::mat4(camera.clip_from_view);
    uniforms.world_from_view = glm::mat3x4(glm::mat3(glm::transpose(glm::dmat3(camera.view_from_world))));
    uniforms.light_color = glm::vec4(light.color);
    uniforms.attenuation = light.attenuation == glm::dvec3(0) ? glm::vec4(1, 0, 0, 0)
                                                              : glm::vec4(glm::vec3(light.attenuation), 0);
    glm::dvec3 position(camera.view_from_world *
                        glm::dvec4(light.headlight ? view.camera.eye : light.position, 1));
    // The shader squares it; from so far its light is parallel.
    const double distance = glm::length(position);
    if (distance > scene::kMaxDrawDistance) position *= scene::kMaxDrawDistance / distance;
    uniforms.light_position = glm::vec4(glm::vec3(position), 1);
    uniforms.light_direction = glm::vec4(glm::vec3(glm::dmat3(camera.view_from_world) * light.direction), 0);
    uniforms.cone = {static_cast<float>(short_of_one(0.45 * light.angle)),
                     static_cast<float>(short_of_one(0.5 * light.angle)), 0, 0};
    return uniforms;
}

/// Normals go by the cofactor matrix · sign(det) (eq. 6.3 without its inverse); its scale is taken out, so
/// that it fits into float for parts of any size.
glm::mat3 normal_matrix(const glm::dmat3& m, bool mirrored) {
    glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    double largest = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(cofactors[i][k]));
    if (largest > 0) cofactors *= (mirrored ? -1 : 1) / largest;
    return glm::mat3(cofactors);
}

void set_clip(const glm::dmat4& clip_from_view) {
    const glm::mat4 clip(clip_from_view);
    glUniformMatrix4fv(clip_from_view_at, 1, GL_FALSE, glm::value_ptr(clip));
}

void set_clip_plane(const plan::DrawItem& item, const GpuGeometry& geometry) {
    if (!item.clip_plane) {
        glDisable(GL_CLIP_DISTANCE0);
        return;
    }
    glEnable(GL_CLIP_DISTANCE0);
    const glm::vec4 clip_plane(glm::dvec3(*item.clip_plane),
                               glm::dot(*item.clip_plane, glm::dvec4(geometry.origin, 1)));
    glUniform4fv(clip_plane_at, 1, glm::value_ptr(clip_plane));
}

}  // namespace

const std::string_view kPerPixelLists = R"(
struct Fragment {
    uint next;  // in the same pixel; 0 for none
    uint order;  // of triangles; at equal depth the higher one is in front
    float depth;  // reversed
    uint red_green, blue_alpha;  // multiplied by alpha
};
layout(std430, binding = 0) buffer Fragments {
    uint count, most, unused_0, unused_1;
    Fragment fragments[];
};
layout(std430, binding = 1) buffer Lists {
    ivec4 box;  // low corner and size
    uint heads[];
};
int head_index(ivec2 pixel) { return (pixel.y - box.y) * box.z + pixel.x - box.x; }
)";

SurfacePrograms::LightKind SurfacePrograms::kind_of(const scene::Light& light, const CameraMatrices& camera) {
    // It stays at the true eye, which in a mirror is not the one that sees.
    const bool reflected = glm::determinant(glm::dmat3(camera.view_from_world)) < 0;
    if (light.headlight) return reflected ? LightKind::point : LightKind::headlight;
    switch (light.type) {
        case scene::LightData::Type::directional:
            return LightKind::directional;
        case scene::LightData::Type::spot:
            return LightKind::spot;
        case scene::LightData::Type::point:
            break;
    }
    return LightKind::point;
}

GlProgram SurfacePrograms::make(const ProgramKey& key) {
    constexpr std::array<const char*, 4> kLights{"HEADLIGHT", "POINT", "DIRECTIONAL", "SPOT"};
    std::string head = "#version 450 core\n";
    const auto define = [&](bool wanted, const char* name) {
        if (wanted) head += std::string("#define ") + name + "\n";
    };
    define(true, kLights[static_cast<std::size_t>(key.light)]);
    define(key.kind == SurfaceKind::edges, "EDGES");
    define(key.textured, "TEXTURED");
    define(key.environment, "ENVIRONMENT");
    const bool layered = key.kind == SurfaceKind::per_pixel_glass;
    define(layered || key.kind == SurfaceKind::glass, "GLASS");
    define(layered, "LAYERED");
    define(key.kind == SurfaceKind::mirror, "MIRROR");
    define(key.clipped, "CLIPPED");
    const bool at_vertex = key.lit_at == plan::Methods::Lighting::vertex;
    define(at_vertex, "LIT_AT_VERTEX");
    define(!at_vertex || key.environment, "NEEDS_NORMAL");
    head += kViewUniformsBlock;
    std::string needed(key.textured || key.environment ? kTextureFilter : std::string_view());
    if (layered) needed += std::string(kPerPixelLists) + std::string(kAppendFragment);
    const std::string phong(kPhong), none;
    return make_program(head + (at_vertex ? phong : none) + std::string(kVertexShader),
                        head + (at_vertex ? none : phong) + needed + std::string(kFragmentShader));
}

void SurfacePrograms::begin(const CameraMatrices& camera, const plan::View& view, GpuScene* scene) {
    scene_ = scene;
    cube_map_ = view.background.cube_map;
    light_ = kind_of(view.light, camera);
    lit_at_ = view.methods.light;
    if (!view_uniforms_) view_uniforms_ = make_dynamic_buffer("uniforms", sizeof(ViewUniforms));
    const ViewUniforms uniforms = view_uniforms_of(camera, view);
    glNamedBufferSubData(view_uniforms_.get(), 0, sizeof uniforms, &uniforms);
    glBindBufferBase(GL_UNIFORM_BUFFER, kViewUniformsBinding, view_uniforms_.get());
}

void SurfacePrograms::use(SurfaceKind kind, const plan::DrawItem& item, const GpuGeometry& geometry,
                          const scene::Material& material) {
    const ProgramKey key{
        kind, light_, item.texture != scene::kNone, item.environment, item.clip_plane.has_value(), lit_at_};
    GlProgram& program = programs_[key];
    if (!program) program = make(key);
    glUseProgram(program.get());
    set_transform(item, geometry);
    const glm::mat3 normals = normal_matrix(glm::dmat3(item.view_from_node), item.mirrored);
    glUniformMatrix3fv(normal_matrix_at, 1, GL_FALSE, glm::value_ptr(normals));
    if (key.textured) glBindTextureUnit(kTextureUnit, scene_->texture(item.texture).get());
    if (key.environment) {
        glBindTextureUnit(kEnvironmentUnit, scene_->cube_map(*cube_map_).get());
        glUniform1f(reflectivity_at, static_cast<float>(material.reflectivity));
    }
    set(base_at, glm::vec3(material.emission) + glm::vec3(material.ambient));
    set(diffuse_at, glm::vec3(material.diffuse));
    set(specular_at, glm::vec3(material.specular));
    glUniform1f(shininess_at, static_cast<float>(material.shininess));
    glUniform1i(two_sided_at, item.cull_mode != plan::CullMode::back || kind == SurfaceKind::edges);
    if (kind == SurfaceKind::glass || kind == SurfaceKind::per_pixel_glass)
        glUniform1f(alpha_at, static_cast<float>(material.diffuse.a));
    if (kind == SurfaceKind::mirror) glUniform1f(reflectivity_at, static_cast<float>(material.reflectivity));
    set_clip_plane(item, geometry);
}

void SolidColorProgram::use(const glm::dvec3& color, const glm::dmat4& clip_from_view) {
    if (!program_) program_ = make_program(kSolidColorVertexShader, kSolidColorFragmentShader);
    glUseProgram(program_.get());
    set_clip(clip_from_view);
    set(solid_color_at, glm::vec3(color));
}

void NodeIdProgram::use(const glm::dmat4& clip_from_view) {
    if (!program_) program_ = make_program(kSolidColorVertexShader, kNodeIdShader);
    glUseProgram(program_.get());
    set_clip(clip_from_view);
}

void NodeIdProgram::set_node(scene::Index number) { glUniform1i(node_at, number); }

void set_first_triangle(GLuint number) { glUniform1ui(first_triangle_at, number); }

void set_transform(const plan::DrawItem& item, const GpuGeometry& geometry) {
    glm::dmat4 view_from_local = item.view_from_node;
    view_from_local[3] = item.view_from_node * glm::dvec4(geometry.origin, 1);
    const glm::mat4 view(view_from_local);
    glUniformMatrix4fv(view_from_local_at, 1, GL_FALSE, glm::value_ptr(view));
}

}  // namespace vrut::gl
