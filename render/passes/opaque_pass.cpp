#include "passes/opaque_pass.hpp"

#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "program.hpp"

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

// The eye is the origin, and the headlight is there too: L and C are the same.
constexpr std::string_view kFragmentShader = R"(#version 450 core
layout(location = 3) uniform vec3 light_color;
layout(location = 4) uniform vec3 attenuation;
layout(location = 5) uniform vec3 base;
layout(location = 6) uniform vec3 diffuse;
layout(location = 7) uniform vec3 specular;
layout(location = 8) uniform float shininess;
layout(location = 9) uniform bool both_sides;
in vec3 view_position;
in vec3 view_normal;
out vec4 color;

void main() {
    float d = length(view_position);
    vec3 to_eye = -view_position / d;
    // A normal that vanishes (flattened parts, opposite neighbours) takes the face's, which faces the viewer.
    vec3 n = view_normal;
    if (dot(n, n) < 1e-12) n = cross(normalize(dFdx(view_position)), normalize(dFdy(view_position)));
    n = normalize(n);
    if (both_sides && dot(n, to_eye) < 0) n = -n;

    float intensity = 1 / max(dot(attenuation, vec3(1, d, d * d)), 1e-6);
    float lambert = max(dot(to_eye, n), 0);
    float highlight = max(dot(reflect(-to_eye, n), to_eye), 1e-30);  // pow(0, 0) is undefined
    vec3 lit = diffuse + specular * pow(highlight, shininess);
    color = vec4(clamp(base + lit * light_color * (lambert * intensity), 0, 1), 1);
}
)";

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

void set(GLint location, const glm::vec3& value) { glUniform3fv(location, 1, glm::value_ptr(value)); }

void set_material(const Material& material) {
    set(base_at, glm::vec3(material.emission) + glm::vec3(material.ambient));
    set(diffuse_at, glm::vec3(material.diffuse));
    set(specular_at, glm::vec3(material.specular));
    glUniform1f(shininess_at, static_cast<float>(material.shininess));
}

void set_sides(const DrawItem& item) {
    glUniform1i(both_sides_at, item.sides == Sides::both);
    if (item.sides == Sides::both)
        glDisable(GL_CULL_FACE);
    else
        glEnable(GL_CULL_FACE);
    glFrontFace(item.mirrored ? GL_CW : GL_CCW);
}

}  // namespace

void OpaquePass::draw(std::span<const DrawItem> items, GpuScene& scene, const glm::dmat4& clip_from_view,
                      const Headlight& headlight, FrameStats& stats) {
    if (!program_) program_ = make_program(kVertexShader, kFragmentShader);
    glUseProgram(program_.get());
    const glm::mat4 clip(clip_from_view);
    glUniformMatrix4fv(clip_from_view_at, 1, GL_FALSE, glm::value_ptr(clip));
    set(light_color_at, glm::vec3(headlight.color));
    set(attenuation_at,
        headlight.attenuation == glm::dvec3(0) ? glm::vec3(1, 0, 0) : glm::vec3(headlight.attenuation));

    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glDisable(GL_BLEND);
    glCullFace(GL_BACK);
    for (const DrawItem& item : items) {
        const GpuGeometry& geometry = scene.geometry(item.geometry);
        glm::dmat4 view_from_local = item.view_from_node;
        view_from_local[3] = item.view_from_node * glm::dvec4(geometry.origin, 1);
        const glm::mat4 view(view_from_local);
        const glm::mat3 normals = normal_matrix(glm::dmat3(item.view_from_node), item.mirrored);
        glUniformMatrix4fv(view_from_local_at, 1, GL_FALSE, glm::value_ptr(view));
        glUniformMatrix3fv(normal_matrix_at, 1, GL_FALSE, glm::value_ptr(normals));
        set_material(scene.scene()->material(item.material));
        set_sides(item);
        glBindVertexArray(geometry.vertex_array.get());
        glDrawElements(GL_TRIANGLES, geometry.index_count, GL_UNSIGNED_INT, nullptr);
        ++stats.draws;
        stats.triangles += static_cast<std::uint64_t>(geometry.index_count) / 3;
    }
    ++stats.passes;
}

}  // namespace vrut
