#include "gl/passes/surface_programs.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "plan/draw_groups.hpp"

namespace vrut::gl {

namespace {

/// A CPU that draws rasterizes what is flushed while it processes the next vertices; a graphics card takes
/// some time for each flush. Measured by bench_bare_gl.
constexpr std::uint64_t kFlushedTriangles = 30'000, kMostFlushes = 64;

enum SurfaceUniform : GLint {
    clip_from_view_at = 0,  // of programs of one colour; surfaces find it in the view's block
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
    origin_at = 14,
    ambient_at = 15,
    emissive_at = 16,
    normal_scale_at = 17,
    clip_planes_at = 20,
    cap_depth_at = 33,
};

constexpr GLuint kViewUniformsBinding = 0;
constexpr GLuint kTextureUnit = 0, kEnvironmentUnit = 1, kEmissiveUnit = 3;
constexpr GLuint kPrefilteredUnit = 4, kOcclusionRoughnessMetallicUnit = 5, kNormalUnit = 6;

/// What holds for all surfaces of a view, in view space; laid out as std140 has it.
struct ViewUniforms {
    glm::mat4 clip_from_view;
    glm::mat3x4 world_from_view;  // of directions
    glm::vec4 light_color;        // a: the part of it that is left beside the surroundings
    glm::vec4 attenuation, light_position, light_direction;
    glm::vec4 cone;                      // x, y: 1 - cos where the light is full, and where it ends
    std::array<glm::vec4, 9> harmonics;  // scene::EnvironmentLight's
};

void set(GLint location, const glm::vec3& value) { glUniform3fv(location, 1, glm::value_ptr(value)); }

/// 1 - cos, exact near 0.
double short_of_one(double degrees) {
    const double sine = std::sin(degrees * scene::kRadiansPerDegree / 2);
    return 2 * sine * sine;
}

std::array<glm::dvec3, 9> harmonics_of(const plan::View& view, GpuScene* scene) {
    if (!scene || !scene->is_lit_by_environment() || !view.background.cube_map) return {};
    return scene->environment_light(*view.background.cube_map).harmonics;
}

ViewUniforms view_uniforms_of(const CameraMatrices& camera, const plan::View& view, GpuScene* scene) {
    const scene::Light& light = view.light;
    ViewUniforms uniforms{};
    uniforms.clip_from_view = glm::mat4(camera.clip_from_view);
    uniforms.world_from_view = glm::mat3x4(glm::mat3(glm::transpose(glm::dmat3(camera.view_from_world))));
    const bool beside = light.headlight && view.background.cube_map;
    uniforms.light_color = glm::vec4(glm::vec3(light.color), beside ? scene::kHeadlightInEnvironment : 1);
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
    std::ranges::transform(harmonics_of(view, scene), uniforms.harmonics.begin(),
                           [](const glm::dvec3& rgb) { return glm::vec4(glm::vec3(rgb), 0); });
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

/// The point in a node's space that lies at the eye, or of a flattened part's the nearest: least squares,
/// damped where a direction vanishes. It need not be exact.
glm::dvec3 point_at_eye(const glm::dmat4& view_from_node) {
    const glm::dmat3 matrix(view_from_node), transposed = glm::transpose(matrix);
    glm::dmat3 normal = transposed * matrix;
    const double damping = 1e-12 * (normal[0][0] + normal[1][1] + normal[2][2]);
    for (int i = 0; i < 3; ++i) normal[i][i] += damping;
    return -glm::inverse(normal) * (transposed * glm::dvec3(view_from_node[3]));
}

/// The origin of local_position() relative to the geometry's.
glm::vec3 local_origin(const plan::DrawItem& item, const GpuGeometry& geometry) {
    return geometry.is_double_single() ? glm::vec3(point_at_eye(item.view_from_node) - geometry.origin)
                                       : glm::vec3(0);
}

/// `local` is local_origin().
glm::mat4 view_from_local(const plan::DrawItem& item, const GpuGeometry& geometry, const glm::vec3& local) {
    glm::dmat4 matrix = item.view_from_node;
    matrix[3] = item.view_from_node * glm::dvec4(geometry.origin + glm::dvec3(local), 1);
    return glm::mat4(matrix);
}

/// Of the current program, where the next draw lies.
void set_transform(const plan::DrawItem& item, const GpuGeometry& geometry) {
    const glm::vec3 origin = local_origin(item, geometry);
    const glm::mat4 matrix = view_from_local(item, geometry, origin);
    glUniformMatrix4fv(view_from_local_at, 1, GL_FALSE, glm::value_ptr(matrix));
    if (geometry.is_double_single()) set(origin_at, origin);
}

/// Relative to local_position().
glm::vec4 in_local_space(const glm::dvec4& clip_plane, const plan::DrawItem& item,
                         const GpuGeometry& geometry) {
    const glm::dvec3 origin = geometry.origin + glm::dvec3(local_origin(item, geometry));
    return {glm::dvec3(clip_plane), glm::dot(clip_plane, glm::dvec4(origin, 1))};
}

/// Of the current program, which has room for clip_capacity() of them.
void set_clip_planes(const plan::DrawItem& item, const GpuGeometry& geometry) {
    if (item.clip_planes.empty()) return;
    std::vector<glm::vec4> planes;
    planes.reserve(scene::kMostClipPlanes + 1);
    for (const glm::dvec4& plane : item.clip_planes) planes.push_back(in_local_space(plane, item, geometry));
    planes.resize(static_cast<std::size_t>(clip_capacity(planes.size())), glm::vec4(0, 0, 0, 1));
    glUniform4fv(clip_planes_at, static_cast<GLsizei>(planes.size()), glm::value_ptr(planes[0]));
}

/// Of the current program, for an item with a cut. 1 / distance is linear in the image: on the ray w · (x, y,
/// -1) of a pixel the plane n · p = h lies at w = h / (n · (x, y, -1)), and depth is near / w.
void set_cap_depth(const plan::DrawItem& item, const glm::dmat4& clip_from_view) {
    std::array<GLint, 4> viewport{};
    glGetIntegerv(GL_VIEWPORT, viewport.data());
    const glm::dvec3 normal(item.cut_plane);
    const glm::dvec2 scale(clip_from_view[0][0], clip_from_view[1][1]), shift(clip_from_view[2]);
    const glm::dvec2 slope = glm::dvec2(normal) / scale;
    const glm::dvec3 reciprocal(2.0 * slope / glm::dvec2(viewport[2], viewport[3]),
                                glm::dot(slope, shift - 1.0) - normal.z);
    const double height = -item.cut_plane.w;
    // An eye in the plane sees no cap.
    const double near = height != 0 ? clip_from_view[3][2] / height : 0;
    set(cap_depth_at, glm::vec3(near * reciprocal));
}

bool is_two_sided(const plan::DrawItem& item) { return item.cull_mode != plan::CullMode::back; }

glm::vec3 base_of(const scene::Material& material) {
    return glm::vec3(material.emission) + glm::vec3(material.ambient);
}

SurfaceVariant::Light kind_of(const scene::Light& light, const CameraMatrices& camera) {
    // It stays at the true eye, which in a mirror is not the one that sees.
    const bool reflected = glm::determinant(glm::dmat3(camera.view_from_world)) < 0;
    if (light.headlight) return reflected ? SurfaceVariant::Light::point : SurfaceVariant::Light::headlight;
    return light_kind(light.type);
}

}  // namespace

void SurfacePrograms::begin(const CameraMatrices& camera, const plan::View& view, GpuScene* scene) {
    scene_ = scene;
    clip_from_view_ = camera.clip_from_view;
    cube_map_ = view.background.cube_map;
    light_ = kind_of(view.light, camera);
    methods_ = view.methods;
    if (!view_uniforms_) view_uniforms_ = make_dynamic_buffer("uniforms", sizeof(ViewUniforms));
    const ViewUniforms uniforms = view_uniforms_of(camera, view, scene);
    glNamedBufferSubData(view_uniforms_.get(), 0, sizeof uniforms, &uniforms);
    glBindBufferBase(GL_UNIFORM_BUFFER, kViewUniformsBinding, view_uniforms_.get());
}

SurfaceVariant SurfacePrograms::variant_of(SurfaceKind kind, const plan::DrawItem& item,
                                           const GpuGeometry& geometry) const {
    const bool textured = item.texture != scene::kNone;
    SurfaceVariant variant{kind, light_, textured, reflects_environment(item),
                           clip_capacity(item.clip_planes.size())};
    variant.colored = item.colored;
    variant.emissive = item.emissive;
    variant.metallic_roughness = item.metallic_roughness;
    variant.mapped = plan::is_mapped(item);
    variant.coated = item.coated;
    variant.cap = item.cut != nullptr;
    if (!variant.metallic_roughness && !variant.mapped) variant.lit_at = methods_.light;
    variant.double_single = geometry.is_double_single();
    variant.anisotropic =
        (textured || variant.mapped) && methods_.texture_filter == plan::Methods::TextureFilter::anisotropic;
    return variant;
}

bool SurfacePrograms::reflects_environment(const plan::DrawItem& item) const {
    return item.environment || item.metallic_roughness;
}

const GlTexture& SurfacePrograms::texture_or_white(scene::Index texture) {
    if (texture != scene::kNone) return scene_->texture(texture);
    if (!white_) {
        constexpr std::array<std::uint8_t, 4> kWhite{255, 255, 255, 255};
        white_ = make_texture(GL_RGBA8, 1, 1);
        glClearTexImage(white_.get(), 0, GL_RGBA, GL_UNSIGNED_BYTE, kWhite.data());
    }
    return white_;
}

void SurfacePrograms::bind_textures(const plan::DrawItem& item) {
    if (item.texture != scene::kNone) glBindTextureUnit(kTextureUnit, scene_->texture(item.texture).get());
    if (item.emissive) glBindTextureUnit(kEmissiveUnit, texture_or_white(item.emissive_texture).get());
    if (reflects_environment(item)) glBindTextureUnit(kEnvironmentUnit, scene_->cube_map(*cube_map_).get());
    if (item.metallic_roughness)
        glBindTextureUnit(kPrefilteredUnit, scene_->environment_light(*cube_map_).prefiltered.get());
    if (!plan::is_mapped(item)) return;
    glBindTextureUnit(kOcclusionRoughnessMetallicUnit,
                      texture_or_white(item.occlusion_roughness_metallic_texture).get());
    glBindTextureUnit(kNormalUnit, texture_or_white(item.normal_texture).get());
}

/// A mirror that is seen in another, or is none for want of room, reflects as plain surfaces do.
double reflectivity_of(const plan::DrawItem& item, const scene::Material& material, bool mirror) {
    return item.environment || mirror ? material.reflectivity : 0;
}

/// Of the programs' uniform `specular`.
glm::vec3 highlight_of(const plan::DrawItem& item, const scene::Material& material) {
    if (!item.metallic_roughness) return glm::vec3(material.specular);
    const scene::MetallicRoughness& surface = *material.metallic_roughness;
    return {surface.metallic, surface.roughness, surface.clear_coat};
}

void SurfacePrograms::use(SurfaceKind kind, const plan::DrawItem& item, const GpuGeometry& geometry,
                          const scene::Material& material) {
    programs_.use(variant_of(kind, item, geometry));
    set_transform(item, geometry);
    const glm::mat3 normals = normal_matrix(glm::dmat3(item.view_from_node), item.mirrored);
    glUniformMatrix3fv(normal_matrix_at, 1, GL_FALSE, glm::value_ptr(normals));
    bind_textures(item);
    set(base_at, item.colored ? glm::vec3(material.emission) : base_of(material));
    if (item.emissive) set(emissive_at, glm::vec3(material.emissive));
    if (item.colored) set(ambient_at, glm::vec3(material.ambient));
    set(diffuse_at, glm::vec3(material.diffuse));
    set(specular_at, highlight_of(item, material));
    glUniform1f(shininess_at, static_cast<float>(material.shininess));
    glUniform1f(two_sided_at, is_two_sided(item) || kind == SurfaceKind::edges ? 1.0F : 0.0F);
    if (kind == SurfaceKind::glass || kind == SurfaceKind::per_pixel_glass)
        glUniform1f(alpha_at, static_cast<float>(material.diffuse.a));
    const bool mirror = kind == SurfaceKind::mirror;
    if (reflects_environment(item) || mirror)
        glUniform1f(reflectivity_at, static_cast<float>(reflectivity_of(item, material, mirror)));
    if (plan::is_mapped(item)) {
        const bool has_normals = item.normal_texture != scene::kNone;
        glUniform1f(normal_scale_at, has_normals ? static_cast<float>(material.normal_scale) : 0.0F);
    }
    set_clip_planes(item, geometry);
    if (item.cut) set_cap_depth(item, clip_from_view_);
}

/// Returns false if all of the item's triangles would be culled.
bool SurfacePrograms::find_facing(const plan::DrawItem& item, const GpuGeometry& geometry) {
    const std::size_t triangles = static_cast<std::size_t>(geometry.index_count) / 3;
    if (item.cull_mode == plan::CullMode::none || geometry.clusters.empty()) {
        facing_.assign(1, {0, triangles});
        return true;
    }
    const glm::dvec3 eye =
        -glm::inverse(glm::dmat3(item.view_from_node)) * glm::dvec3(item.view_from_node[3]);
    plan::find_facing(geometry.clusters, triangles, eye, facing_);
    return !facing_.empty();
}

/// Of what is facing, with the few triangles between.
void SurfacePrograms::add_instance(const plan::DrawItem& item, const GpuGeometry& geometry,
                                   const scene::Material& material) {
    GpuInstance& instance = instances_.emplace_back();
    instance.view_from_local = view_from_local(item, geometry, glm::vec3(0));
    instance.normal_matrix = glm::mat3x4(normal_matrix(glm::dmat3(item.view_from_node), item.mirrored));
    instance.base_sides = {base_of(material), is_two_sided(item) ? 1 : 0};
    instance.diffuse_reflectivity = {glm::vec3(material.diffuse), reflectivity_of(item, material, false)};
    instance.specular_shininess = {highlight_of(item, material), material.shininess};
    if (!item.clip_planes.empty()) instance.clip_plane = in_local_space(item.clip_planes[0], item, geometry);
    const std::size_t first = facing_.front().first;
    const std::size_t count = facing_.back().first + facing_.back().count - first;
    draws_.push_back({static_cast<GLuint>(3 * count), 1,
                      (item.mirrored ? geometry.first_turned_index : geometry.first_index) +
                          static_cast<GLuint>(3 * first),
                      geometry.first_vertex, static_cast<GLuint>(draws_.size())});
}

void SurfacePrograms::write_instances() {
    if (!draw_buffer_) {
        instance_buffer_ = make_dynamic_buffer("instances", kMostInstances * sizeof(GpuInstance));
        draw_buffer_ = make_dynamic_buffer("draws", kMostInstances * sizeof(IndirectDraw));
    }
    const auto write = [](const GlBuffer& buffer, const auto& elements) {
        const std::span bytes = std::as_bytes(std::span(elements));
        glNamedBufferSubData(buffer.get(), 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
    };
    write(instance_buffer_, instances_);
    write(draw_buffer_, draws_);
}

/// The number of the first items that one draw call draws. Their buffers are shared.
std::size_t SurfacePrograms::run_length(std::span<const plan::DrawItem> items) {
    const GeometryBuffers* buffers = scene_->geometry(items.front()).buffers.get();
    std::size_t length = 1;
    while (length < std::min(items.size(), kMostInstances) &&
           plan::share_draw(items.front(), items[length]) &&
           scene_->geometry(items[length]).buffers.get() == buffers)
        ++length;
    return length;
}

/// By one draw call.
void SurfacePrograms::draw_run(std::span<const plan::DrawItem> items, const PipelineState& state,
                               const scene::Material* material, plan::FrameStats& stats) {
    const plan::DrawItem& first = items.front();
    instances_.clear();
    draws_.clear();
    for (const plan::DrawItem& item : items) {
        const GpuGeometry& geometry = scene_->geometry(item);
        if (find_facing(item, geometry))
            add_instance(item, geometry, material ? *material : plan::material_of(item, *scene_->scene()));
    }
    if (draws_.empty()) return;
    write_instances();
    SurfaceVariant variant = variant_of(SurfaceKind::faces, first, scene_->geometry(first));
    variant.instanced = true;
    programs_.use(variant);
    bind_textures(first);
    PipelineState applied = state.for_item(first);
    applied.clockwise_front = false;  // the triangles of mirrored items are turned
    apply(applied);
    glBindVertexArray(scene_->geometry(first).buffers->vertex_array.get());
    glBindVertexBuffer(kInstanceBinding, instance_buffer_.get(), 0, sizeof(GpuInstance));
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, draw_buffer_.get());
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(draws_.size()),
                                0);
    stats.draws += static_cast<int>(draws_.size());
    for (const IndirectDraw& draw : draws_) stats.triangles += draw.index_count / 3;
}

void SurfacePrograms::draw_faces(std::span<const plan::DrawItem> items, const PipelineState& state,
                                 const scene::Material* material, plan::FrameStats& stats) {
    std::uint64_t triangles = 0;
    for (const plan::DrawItem& item : items) triangles += plan::triangle_count(item, *scene_->scene());
    const std::uint64_t flushed_at_once = std::max(kFlushedTriangles, triangles / kMostFlushes);
    std::uint64_t flushed = stats.triangles;
    while (!items.empty()) {
        const plan::DrawItem& first = items.front();
        const GpuGeometry& geometry = scene_->geometry(first);
        std::size_t length = 1;
        if (geometry.buffers->shared && !first.emissive && !plan::is_mapped(first) &&
            first.clip_planes.size() <= 1) {
            length = run_length(items);
            draw_run(items.first(length), state, material, stats);
        } else if (find_facing(first, geometry)) {
            use(SurfaceKind::faces, first, geometry,
                material ? *material : plan::material_of(first, *scene_->scene()));
            apply(state.for_item(first));
            draw_triangles(geometry, facing_, stats);
        }
        items = items.subspan(length);
        if (stats.triangles - flushed < flushed_at_once) continue;
        glFlush();
        flushed = stats.triangles;
    }
}

void PlainProgram::use(const plan::DrawItem& item, const GpuGeometry& geometry) {
    const PlainVariant variant{color_ ? PlainVariant::Output::color : PlainVariant::Output::node_id,
                               geometry.is_double_single(), clip_capacity(item.clip_planes.size()),
                               item.cut != nullptr};
    if (current_ != variant) {
        current_ = variant;
        programs_.use(variant);
        set_clip(clip_from_view_);
        if (color_) set(solid_color_at, glm::vec3(*color_));
    }
    if (!color_) glUniform1i(node_at, item.node);
    set_transform(item, geometry);
    set_clip_planes(item, geometry);
    if (item.cut) set_cap_depth(item, clip_from_view_);
}

void set_first_triangle(GLuint number) { glUniform1ui(first_triangle_at, number); }

}  // namespace vrut::gl
