#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "gl/gpu_scene.hpp"
#include "gl/passes/drawing.hpp"
#include "gl/programs.hpp"
#include "plan/frame_plan.hpp"
#include "plan/view.hpp"

namespace vrut::gl {

/// From where a target's contents are seen. In a mirror the view from the world is a reflected one.
struct CameraMatrices {
    glm::dmat4 clip_from_view{1};
    glm::dmat4 view_from_world{1};
};

/// Phong light (Macků 2016, eq. 6.4–6.9 in their robust form) per pixel, or per vertex: then what light adds
/// to the matte and to the shiny part of a surface is interpolated, and the rest is done at the pixel as
/// ever.
class SurfacePrograms {
public:
    using SurfaceKind = SurfaceVariant::Kind;
    static constexpr GLuint kReflectionUnit = 2;  ///< the texture of a mirror

    explicit SurfacePrograms(Programs& programs) : programs_(programs) {}
    /// What is drawn from here on is seen so, with the textures of `scene`, which must live as long.
    void begin(const CameraMatrices& camera, const plan::View& view, GpuScene* scene);
    /// Makes the program for this item the current one and gives it all that it needs.
    void use(SurfaceKind kind, const plan::DrawItem& item, const GpuGeometry& geometry,
             const scene::Material& material);
    /// Draws the faces of items in their order, with `state` and the sides that show. One draw call draws up
    /// to kMostInstances consecutive items of small geometries that share buffers and plan::share_draw().
    /// `material`: of all items; null: each has its own.
    void draw_faces(std::span<const plan::DrawItem> items, const PipelineState& state,
                    const scene::Material* material, plan::FrameStats& stats);
    static constexpr std::size_t kMostInstances = 256;

private:
    /// As glMultiDrawElementsIndirect() reads it.
    struct IndirectDraw {
        GLuint index_count, instance_count, first_index;
        GLint first_vertex;
        GLuint first_instance;
    };
    SurfaceVariant variant_of(SurfaceKind kind, const plan::DrawItem& item,
                              const GpuGeometry& geometry) const;
    void bind_textures(const plan::DrawItem& item);
    bool reflects_environment(const plan::DrawItem& item) const;
    const GlTexture& texture_or_white(scene::Index texture);
    std::size_t run_length(std::span<const plan::DrawItem> items);
    bool find_facing(const plan::DrawItem& item, const GpuGeometry& geometry);
    void add_instance(const plan::DrawItem& item, const GpuGeometry& geometry,
                      const scene::Material& material);
    void write_instances();
    void draw_run(std::span<const plan::DrawItem> items, const PipelineState& state,
                  const scene::Material* material, plan::FrameStats& stats);

    Programs& programs_;
    SurfaceVariant::Light light_ = SurfaceVariant::Light::headlight;
    plan::Methods methods_;
    GlBuffer view_uniforms_;
    GlTexture white_;  // stands for an image where there is none
    GpuScene* scene_ = nullptr;
    glm::dmat4 clip_from_view_{1};
    std::optional<std::array<scene::Index, 6>> cube_map_;
    std::vector<plan::TriangleRange> facing_;  // of the item to come
    std::vector<GpuInstance> instances_;       // of the draw call to come
    std::vector<IndirectDraw> draws_;
    GlBuffer instance_buffer_, draw_buffer_;
};

/// A program without light, in the variants that items need. No other may be used before the last item.
class PlainProgram {
public:
    /// `color`: everywhere; none: the numbers of items' nodes, into a target of integers.
    PlainProgram(Programs& programs, const std::optional<glm::dvec3>& color, const glm::dmat4& clip_from_view)
        : programs_(programs), color_(color), clip_from_view_(clip_from_view) {}
    /// Makes the one for this item the current one.
    void use(const plan::DrawItem& item, const GpuGeometry& geometry);

private:
    Programs& programs_;
    std::optional<glm::dvec3> color_;
    glm::dmat4 clip_from_view_;
    std::optional<PlainVariant> current_;
};

/// The buffers of shaders/per_pixel_lists.glsl.
inline constexpr GLuint kFragmentsBinding = 0, kHeadsBinding = 1;

/// With a per_pixel_glass program: the number of the next draw's first triangle. At equal depth the triangle
/// with the higher number is in front.
void set_first_triangle(GLuint number);

}  // namespace vrut::gl
