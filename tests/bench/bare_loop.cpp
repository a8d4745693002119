#include "bare_loop.hpp"

#include <algorithm>
#include <array>
#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <stdexcept>
#include <tuple>

#include "gl/shader_program.hpp"
#include "math/frustum.hpp"
#include "mesh/simplification.hpp"
#include "plan/frame_plan.hpp"

namespace vrut::bench {

struct BareMesh {
    gl::GlBuffer vertices, indices;
    gl::GlVertexArray vertex_array;
    GLsizei index_count = 0;
};

namespace {

constexpr GLsizei kSamples = 4;

enum Uniform : GLint {
    clip_from_local_at = 0,
    view_from_local_at = 1,
    base_at = 2,
    diffuse_at = 3,
    specular_at = 4,
    shininess_at = 5,
    two_sided_at = 6,
    light_color_at = 7,
    attenuation_at = 8,
};

constexpr std::string_view kVertexShader = R"(#version 450 core
layout(location = 0) uniform mat4 clip_from_local;
layout(location = 1) uniform mat4 view_from_local;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
out vec3 view_position;
out vec3 view_normal;
invariant gl_Position;

void main() {
    view_position = (view_from_local * vec4(position, 1)).xyz;
    vec3 n = mat3(view_from_local) * normal;
    float size = length(n);
    view_normal = size > 0 ? n / size : vec3(0);
    gl_Position = clip_from_local * vec4(position, 1);
}
)";

// The program's (gl/passes/surface_programs.cpp) for a headlight, at each pixel.
constexpr std::string_view kFragmentShader = R"(#version 450 core
layout(location = 2) uniform vec3 base;
layout(location = 3) uniform vec3 diffuse;
layout(location = 4) uniform vec3 specular;
layout(location = 5) uniform float shininess;
layout(location = 6) uniform bool two_sided;
layout(location = 7) uniform vec3 light_color;
layout(location = 8) uniform vec3 attenuation;
in vec3 view_position;
in vec3 view_normal;
out vec4 color;

void main() {
    float d = length(view_position);
    vec3 to_eye = -view_position / d;
    vec3 n = view_normal;
    vec3 across = dFdx(view_position), upwards = dFdy(view_position);
    if (dot(n, n) < 1e-12) n = cross(normalize(across), normalize(upwards));
    n = normalize(n);
    if (two_sided && dot(n, to_eye) < 0) n = -n;
    float lambert = max(dot(to_eye, n), 0);
    float highlight = max(dot(reflect(-to_eye, n), to_eye), 1e-30);
    float intensity = 1 / max(dot(attenuation, vec3(1, d, d * d)), 1e-6);
    vec2 light = lambert * intensity * vec2(1, pow(highlight, shininess));
    color = vec4(clamp(base + (diffuse * light.x + specular * light.y) * light_color, 0, 1), 1);
}
)";

constexpr std::string_view kDepthVertexShader = R"(#version 450 core
layout(location = 0) uniform mat4 clip_from_local;
layout(location = 0) in vec3 position;
invariant gl_Position;

void main() { gl_Position = clip_from_local * vec4(position, 1); }
)";

constexpr std::string_view kDepthFragmentShader = "#version 450 core\nvoid main() {}\n";

struct Vertex {
    glm::vec3 position, normal;
};

/// Triangles in world space, relative to a centre.
struct Triangles {
    std::vector<Vertex> vertices;
    std::vector<GLuint> indices;
    math::Bounds bounds;
};

/// Flat where the geometry has no normals; counter-clockwise from the front, also of a mirrored part.
void add(Triangles& triangles, const scene::Geometry& geometry, const glm::dmat4& local_from_node,
         bool mirrored) {
    const glm::dmat3 linear(local_from_node);
    const glm::dmat3 normals = glm::transpose(glm::inverse(linear));
    const auto add_vertex = [&](unsigned corner, const glm::dvec3& normal) {
        const glm::dvec3 position(local_from_node * glm::dvec4(geometry.positions[corner], 1));
        triangles.bounds.add(position);
        triangles.vertices.push_back({position, glm::normalize(normals * normal)});
    };
    const bool flat = geometry.normals.empty();
    const auto first = static_cast<GLuint>(triangles.vertices.size());
    if (!flat)
        for (unsigned i = 0; i < geometry.positions.size(); ++i) add_vertex(i, geometry.normals[i]);
    for (const glm::uvec3& corners : geometry.triangles) {
        glm::uvec3 triangle = first + corners;
        if (flat) {
            const auto& at = geometry.positions;
            const auto next = static_cast<GLuint>(triangles.vertices.size());
            for (int k = 0; k < 3; ++k)
                add_vertex(corners[k],
                           glm::cross(at[corners[1]] - at[corners[0]], at[corners[2]] - at[corners[0]]));
            triangle = {next, next + 1, next + 2};
        }
        if (mirrored) std::swap(triangle.y, triangle.z);
        triangles.indices.insert(triangles.indices.end(), {triangle.x, triangle.y, triangle.z});
    }
}

void add(Triangles& triangles, const plan::DrawItem& item, const plan::View& view, const glm::dvec3& center) {
    const scene::Geometry& geometry =
        view.scene->scene->geometries()[static_cast<std::size_t>(item.geometry)];
    glm::dmat4 local_from_node = view.scene->world[static_cast<std::size_t>(item.node)];
    local_from_node[3] -= glm::dvec4(center, 0);
    add(triangles, item.level ? mesh::geometry_of(geometry, *item.level) : geometry, local_from_node,
        item.mirrored);
}

BareDraw draw_of(const plan::DrawItem& item, const Triangles& triangles, const scene::Scene& scene) {
    auto mesh = std::make_shared<BareMesh>();
    mesh->vertices =
        gl::make_buffer("vertices", triangles.vertices.data(), triangles.vertices.size() * sizeof(Vertex));
    mesh->indices =
        gl::make_buffer("triangles", triangles.indices.data(), triangles.indices.size() * sizeof(GLuint));
    mesh->index_count = static_cast<GLsizei>(triangles.indices.size());
    mesh->vertex_array = gl::make_vertex_array();
    const GLuint array = mesh->vertex_array.get();
    glVertexArrayVertexBuffer(array, 0, mesh->vertices.get(), 0, sizeof(Vertex));
    glVertexArrayElementBuffer(array, mesh->indices.get());
    for (const GLuint location : {0U, 1U}) {
        glEnableVertexArrayAttrib(array, location);
        glVertexArrayAttribFormat(array, location, 3, GL_FLOAT, GL_FALSE, location * sizeof(glm::vec3));
        glVertexArrayAttribBinding(array, location, 0);
    }
    return {std::move(mesh), scene.material(item.material), item.cull_mode != plan::CullMode::none,
            item.cull_mode != plan::CullMode::back, triangles.bounds};
}

void set(GLint location, const glm::dvec4& color) {
    const glm::vec3 value(color);
    glUniform3fv(location, 1, glm::value_ptr(value));
}

void set(GLint location, const glm::dmat4& matrix) {
    const glm::mat4 value(matrix);
    glUniformMatrix4fv(location, 1, GL_FALSE, glm::value_ptr(value));
}

void set_cull_mode(const BareDraw& draw) {
    if (draw.cull_backfaces)
        glEnable(GL_CULL_FACE);
    else
        glDisable(GL_CULL_FACE);
}

void draw_triangles(const BareDraw& draw) {
    glBindVertexArray(draw.mesh->vertex_array.get());
    glDrawElements(GL_TRIANGLES, draw.mesh->index_count, GL_UNSIGNED_INT, nullptr);
}

}  // namespace

SecondContext::SecondContext() {
    const std::array<EGLint, 7> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                           4,
                                           EGL_CONTEXT_MINOR_VERSION,
                                           5,
                                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                           EGL_NONE};
    second_ = eglCreateContext(display_, EGLConfig{}, EGL_NO_CONTEXT, attributes.data());
    if (second_ == EGL_NO_CONTEXT) throw std::runtime_error("EGL makes no second context");
    use_second();
}

SecondContext::~SecondContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, first_);
    eglDestroyContext(display_, second_);
}

void SecondContext::use(EGLContext context) const {
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
        throw std::runtime_error("EGL does not make a context current");
}

BareLoop::BareLoop(int width, int height, const glm::dvec3& center)
    : width_(width),
      height_(height),
      center_(center),
      target_(width, height),
      surface_(gl::make_program(kVertexShader, kFragmentShader)),
      depth_(gl::make_program(kDepthVertexShader, kDepthFragmentShader)) {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glClearDepth(0);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glDisable(GL_DITHER);
}

void BareLoop::draw(const std::vector<BareDraw>& draws, const plan::View& view, BareMethod method,
                    scene::Image& image) {
    std::vector<const BareDraw*> order;
    for (const BareDraw& draw : draws) order.push_back(&draw);
    if (method == BareMethod::front_to_back) {
        const auto distance = [&](const BareDraw* draw) {
            return glm::distance(draw->bounds.center(), view.camera.eye - center_);
        };
        std::ranges::sort(order, {}, distance);
    }
    if (method == BareMethod::multisampled)
        bind_multisampled();
    else
        target_.bind();
    clear(view);
    if (method == BareMethod::depth_pre_pass) draw_depth(order);
    if (method == BareMethod::strips)
        draw_strips(order, view);
    else
        draw_all(order, method == BareMethod::flushes);
    if (method == BareMethod::multisampled) resolve();
    glDepthMask(GL_TRUE);
    gl::wait_for_gl();
    image.width = width_;
    image.height = height_;
    image.rgba.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * 4);
    target_.read(image.rgba);
}

void BareLoop::bind_multisampled() {
    if (!sampled_) {
        const auto attach = [&](GLenum format, GLenum attachment) {
            GLuint name = 0;
            glCreateRenderbuffers(1, &name);
            gl::GlRenderbuffer buffer(name);
            glNamedRenderbufferStorageMultisample(name, kSamples, format, width_, height_);
            glNamedFramebufferRenderbuffer(sampled_.get(), attachment, GL_RENDERBUFFER, name);
            return buffer;
        };
        sampled_ = gl::make_framebuffer();
        sampled_color_ = attach(GL_RGBA8, GL_COLOR_ATTACHMENT0);
        sampled_depth_ = attach(GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, sampled_.get());
    glViewport(0, 0, width_, height_);
}

void BareLoop::resolve() {
    target_.bind();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, sampled_.get());
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void BareLoop::clear(const plan::View& view) {
    const glm::vec3 color(view.background.color);
    glClearColor(color.r, color.g, color.b, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    view_from_local_ = scene::view_from_world(view.camera);
    view_from_local_[3] = view_from_local_ * glm::dvec4(center_, 1);
    const double near = scene::fit_clip_range(view.camera, view.scene->bounds).near;
    const glm::dmat4 clip_from_local =
        math::reversed_clip_from_view(plan::projection_of(view), near) * view_from_local_;
    glUseProgram(depth_.get());
    set(clip_from_local_at, clip_from_local);
    glUseProgram(surface_.get());
    set(clip_from_local_at, clip_from_local);
    set(view_from_local_at, view_from_local_);
    set(light_color_at, view.light.color);
    set(attenuation_at, glm::dvec4(view.light.attenuation, 0));
}

void BareLoop::draw_all(const std::vector<const BareDraw*>& draws, bool flush) {
    GLsizei unflushed = 0;
    for (const BareDraw* draw : draws) {
        const scene::Material& material = draw->material;
        set(base_at, material.emission + material.ambient);
        set(diffuse_at, material.diffuse);
        set(specular_at, material.specular);
        glUniform1f(shininess_at, static_cast<float>(material.shininess));
        glUniform1i(two_sided_at, draw->two_sided);
        set_cull_mode(*draw);
        draw_triangles(*draw);
        unflushed += draw->mesh->index_count / 3;
        if (!flush || unflushed < kFlushedTriangles) continue;
        glFlush();
        unflushed = 0;
    }
}

void BareLoop::draw_depth(const std::vector<const BareDraw*>& draws) {
    glUseProgram(depth_.get());
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    for (const BareDraw* draw : draws) {
        set_cull_mode(*draw);
        draw_triangles(*draw);
    }
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_FALSE);
    glUseProgram(surface_.get());
}

void BareLoop::draw_strips(const std::vector<const BareDraw*>& draws, const plan::View& view) {
    glEnable(GL_SCISSOR_TEST);
    for (const bool upper : {false, true}) {
        const math::NdcRect strip{{-1, upper ? 0 : -1}, {1, upper ? 1 : 0}};
        const math::Frustum frustum = math::frustum_of(math::cropped(plan::projection_of(view), strip));
        std::vector<const BareDraw*> seen;
        std::ranges::copy_if(draws, std::back_inserter(seen), [&](const BareDraw* draw) {
            return !math::is_outside(frustum, view_from_local_, draw->bounds);
        });
        glScissor(0, upper ? height_ / 2 : 0, width_, height_ / 2);
        draw_all(seen, false);
        glFlush();
    }
    glDisable(GL_SCISSOR_TEST);
}

std::vector<BareDraw> draws_of_parts(const plan::View& view, const glm::dvec3& center) {
    std::vector<BareDraw> draws;
    const plan::FramePlan plan = plan::plan_frame(view);
    for (const plan::DrawItem& item : plan.scene.opaque) {
        Triangles triangles;
        add(triangles, item, view, center);
        draws.push_back(draw_of(item, triangles, *view.scene->scene));
    }
    return draws;
}

std::vector<BareDraw> draws_of_materials(const plan::View& view, const glm::dvec3& center) {
    struct Merged {
        const plan::DrawItem* first = nullptr;
        Triangles triangles;
    };
    std::map<std::tuple<scene::Index, plan::CullMode>, Merged> by_material;
    const plan::FramePlan plan = plan::plan_frame(view);
    for (const plan::DrawItem& item : plan.scene.opaque) {
        Merged& merged = by_material[{item.material, item.cull_mode}];
        if (!merged.first) merged.first = &item;
        add(merged.triangles, item, view, center);
    }
    std::vector<BareDraw> draws;
    for (const auto& [key, merged] : by_material)
        draws.push_back(draw_of(*merged.first, merged.triangles, *view.scene->scene));
    return draws;
}

}  // namespace vrut::bench
