#include "passes/programs.hpp"

#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <string>

namespace vrut {

namespace {

enum Uniform : GLint {
    clip_from_view_at = 0,
    view_from_local_at = 1,
    normal_matrix_at = 2,
    light_color_at = 3,
    attenuation_at = 4,
    base_at = 5,
    diffuse_at = 6,
    specular_at = 7,
    shininess_at = 8,
    both_sides_at = 9,
    light_position_at = 10,
    light_direction_at = 11,
    cone_at = 12,
    plain_color_at = 3,
};

constexpr std::string_view kVertexShader = R"(#version 450 core
layout(location = 0) uniform mat4 clip_from_view;
layout(location = 1) uniform mat4 view_from_local;
layout(location = 2) uniform mat3 normal_matrix;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
out vec3 view_position;
out vec3 view_normal;

void main() {
    vec4 p = view_from_local * vec4(position, 1);
    vec3 n = normal_matrix * normal;
    float size = length(n);
    view_position = p.xyz;
    view_normal = size > 0 ? n / size : vec3(0);
    gl_Position = clip_from_view * p;
}
)";

// The eye is the origin. After what the light's kind and the shape define.
constexpr std::string_view kFragmentShader = R"(
layout(location = 3) uniform vec3 light_color;
layout(location = 4) uniform vec3 attenuation;
layout(location = 5) uniform vec3 base;
layout(location = 6) uniform vec3 diffuse;
layout(location = 7) uniform vec3 specular;
layout(location = 8) uniform float shininess;
layout(location = 9) uniform bool both_sides;
layout(location = 10) uniform vec3 light_position;
layout(location = 11) uniform vec3 light_direction;
layout(location = 12) uniform vec2 cone;  // 1 - cos where its light is full, and where it ends
in vec3 view_position;
in vec3 view_normal;
out vec4 color;

float attenuated(float d) { return 1 / max(dot(attenuation, vec3(1, d, d * d)), 1e-6); }

// smoothstep of the cosine. What it is short of 1 is half the square of a difference, which keeps its digits in
// the narrowest cone.
float in_cone(vec3 from_light) {
    vec3 off = from_light - light_direction;
    float t = clamp((cone.y - dot(off, off) / 2) / max(cone.y - cone.x, 1e-12), 0, 1);
    return t * t * (3 - 2 * t);
}

void main() {
    float d = length(view_position);
    vec3 to_eye = -view_position / d;
    vec3 n = view_normal;
#ifdef EDGES
    if (dot(n, n) < 1e-12) n = to_eye;
    n = normalize(n);
    if (dot(n, to_eye) < 0) n = -n;
#else
    // A normal that vanishes (flattened parts, opposite neighbours) takes the face's, which faces the viewer.
    if (dot(n, n) < 1e-12) n = cross(normalize(dFdx(view_position)), normalize(dFdy(view_position)));
    n = normalize(n);
    if (both_sides && dot(n, to_eye) < 0) n = -n;
#endif

#if defined(HEADLIGHT)
    vec3 to_light = to_eye;
    float intensity = attenuated(d);
#elif defined(DIRECTIONAL)
    vec3 to_light = -light_direction;
    float intensity = 1;
#else
    vec3 light_offset = light_position - view_position;
    float light_distance = length(light_offset);
    vec3 to_light = light_offset / max(light_distance, 1e-30);
    float intensity = attenuated(light_distance);
#ifdef SPOT
    intensity *= in_cone(-to_light);
#endif
#endif
    float lambert = max(dot(to_light, n), 0);
    float highlight = max(dot(reflect(-to_light, n), to_eye), 1e-30);  // pow(0, 0) is undefined
    vec3 lit = diffuse + specular * pow(highlight, shininess);
    color = vec4(clamp(base + lit * light_color * (lambert * intensity), 0, 1), 1);
}
)";

constexpr std::string_view kPlainVertexShader = R"(#version 450 core
layout(location = 0) uniform mat4 clip_from_view;
layout(location = 1) uniform mat4 view_from_local;
layout(location = 0) in vec3 position;

void main() { gl_Position = clip_from_view * (view_from_local * vec4(position, 1)); }
)";

constexpr std::string_view kPlainFragmentShader = R"(#version 450 core
layout(location = 3) uniform vec3 plain_color;
out vec4 color;

void main() { color = vec4(plain_color, 1); }
)";

enum class LightKind { headlight, point, directional, spot };

LightKind kind_of(const Light& light) {
    if (light.headlight) return LightKind::headlight;
    switch (light.type) {
        case LightData::Type::directional:
            return LightKind::directional;
        case LightData::Type::spot:
            return LightKind::spot;
        case LightData::Type::point:
            break;
    }
    return LightKind::point;
}

GlProgram make_surface_program(LightKind light, SurfacePrograms::Shape shape) {
    constexpr std::array<const char*, 4> kDefines{"HEADLIGHT", "POINT", "DIRECTIONAL", "SPOT"};
    std::string fragment = "#version 450 core\n";
    fragment += std::string("#define ") + kDefines[static_cast<std::size_t>(light)] + "\n";
    if (shape == SurfacePrograms::Shape::edges) fragment += "#define EDGES\n";
    fragment += kFragmentShader;
    return make_program(kVertexShader, fragment);
}

void set(GLint location, const glm::vec3& value) { glUniform3fv(location, 1, glm::value_ptr(value)); }

void set_clip(const glm::dmat4& clip_from_view) {
    const glm::mat4 clip(clip_from_view);
    glUniformMatrix4fv(clip_from_view_at, 1, GL_FALSE, glm::value_ptr(clip));
}

/// 1 - cos, exact near 0.
double short_of_one(double degrees) {
    const double sine = std::sin(degrees * kRadiansPerDegree / 2);
    return 2 * sine * sine;
}

void set_light(const Light& light, const Camera& camera) {
    const bool none = light.attenuation == glm::dvec3(0);
    set(light_color_at, glm::vec3(light.color));
    set(attenuation_at, none ? glm::vec3(1, 0, 0) : glm::vec3(light.attenuation));
    if (light.headlight) return;
    const glm::dmat4 view = view_from_world(camera);
    glm::dvec3 position(view * glm::dvec4(light.position, 1));
    // The shader squares it; from so far its light is parallel.
    const double distance = glm::length(position);
    if (distance > kFarthestDrawn) position *= kFarthestDrawn / distance;
    set(light_position_at, glm::vec3(position));
    set(light_direction_at, glm::vec3(glm::dmat3(view) * light.direction));
    glUniform2f(cone_at, static_cast<float>(short_of_one(0.45 * light.angle)),
                static_cast<float>(short_of_one(0.5 * light.angle)));
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

}  // namespace

void SurfacePrograms::use(const View& view, const glm::dmat4& clip_from_view) {
    const LightKind kind = kind_of(view.light);
    GlProgram& program = programs_[static_cast<std::size_t>(kind)];
    if (!program) program = make_surface_program(kind, shape_);
    glUseProgram(program.get());
    set_clip(clip_from_view);
    set_light(view.light, view.camera);
}

void PlainProgram::use(const glm::dvec3& color, const glm::dmat4& clip_from_view) {
    if (!program_) program_ = make_program(kPlainVertexShader, kPlainFragmentShader);
    glUseProgram(program_.get());
    set_clip(clip_from_view);
    set(plain_color_at, glm::vec3(color));
}

void set_place(const DrawItem& item, const GpuGeometry& geometry) {
    glm::dmat4 view_from_local = item.view_from_node;
    view_from_local[3] = item.view_from_node * glm::dvec4(geometry.origin, 1);
    const glm::mat4 view(view_from_local);
    glUniformMatrix4fv(view_from_local_at, 1, GL_FALSE, glm::value_ptr(view));
}

void set_surface(const DrawItem& item, const GpuGeometry& geometry, const Material& material) {
    set_place(item, geometry);
    const glm::mat3 normals = normal_matrix(glm::dmat3(item.view_from_node), item.mirrored);
    glUniformMatrix3fv(normal_matrix_at, 1, GL_FALSE, glm::value_ptr(normals));
    set(base_at, glm::vec3(material.emission) + glm::vec3(material.ambient));
    set(diffuse_at, glm::vec3(material.diffuse));
    set(specular_at, glm::vec3(material.specular));
    glUniform1f(shininess_at, static_cast<float>(material.shininess));
    glUniform1i(both_sides_at, item.sides == Sides::both);
}

}  // namespace vrut
