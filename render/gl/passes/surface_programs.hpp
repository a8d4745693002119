#pragma once

#include <map>
#include <tuple>

#include "gl/gpu_scene.hpp"
#include "gl/shader_program.hpp"
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
/// ever. A program is compiled for what surfaces and lights ask of it, when they first do.
class SurfacePrograms {
public:
    enum class SurfaceKind {
        faces,
        edges,            ///< without sides: their normals are turned to the viewer
        glass,            ///< faces, their colour multiplied by alpha
        per_pixel_glass,  ///< the same, into the lists of per_pixel_lists.glsl
        mirror,           ///< faces, mixed with what lies at their pixels in the texture of kReflectionUnit
    };
    static constexpr GLuint kReflectionUnit = 2;

    /// What is drawn from here on is seen so, with the textures of `scene`, which must live as long.
    void begin(const CameraMatrices& camera, const plan::View& view, GpuScene* scene);
    /// Makes the program for this item the current one and gives it all that it needs.
    void use(SurfaceKind kind, const plan::DrawItem& item, const GpuGeometry& geometry,
             const scene::Material& material);

private:
    enum class LightKind { headlight, point, directional, spot };
    struct ProgramKey {
        SurfaceKind kind = SurfaceKind::faces;
        LightKind light = LightKind::headlight;
        bool textured = false;
        bool environment = false;
        bool clipped = false;
        plan::Methods::Lighting lit_at = plan::Methods::Lighting::pixel;

        bool operator<(const ProgramKey& other) const {
            const auto key = [](const ProgramKey& v) {
                return std::tie(v.kind, v.light, v.textured, v.environment, v.clipped, v.lit_at);
            };
            return key(*this) < key(other);
        }
    };
    static LightKind kind_of(const scene::Light& light, const CameraMatrices& camera);
    static GlProgram make(const ProgramKey& key);

    LightKind light_ = LightKind::headlight;
    plan::Methods::Lighting lit_at_ = plan::Methods::Lighting::pixel;
    std::map<ProgramKey, GlProgram> programs_;
    GlBuffer view_uniforms_;
    GpuScene* scene_ = nullptr;
    std::optional<std::array<scene::Index, 6>> cube_map_;
};

/// One colour everywhere.
class SolidColorProgram {
public:
    void use(const glm::dvec3& color, const glm::dmat4& clip_from_view);

private:
    GlProgram program_;
};

/// The number of a node everywhere, into a target of integers.
class NodeIdProgram {
public:
    void use(const glm::dmat4& clip_from_view);
    /// Of what is drawn from here on.
    void set_node(scene::Index number);

private:
    GlProgram program_;
};

/// The buffers of shaders/per_pixel_lists.glsl.
inline constexpr GLuint kFragmentsBinding = 0, kHeadsBinding = 1;

/// With a per_pixel_glass program: the number of the next draw's first triangle. At equal depth the triangle
/// with the higher number is in front.
void set_first_triangle(GLuint number);

/// Where the next draw of the current program lies.
void set_transform(const plan::DrawItem& item, const GpuGeometry& geometry);

}  // namespace vrut::gl
