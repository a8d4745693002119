#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "gl/handles.hpp"
#include "plan/draw_budget.hpp"
#include "plan/view.hpp"
#include "scene/scene.hpp"

namespace vrut::gl {

/// Programs that do not depend on what a scene holds.
enum class FixedProgram {
    accumulate,
    background_environment,
    background_image,
    composite_lists,
    marker,
    outline,
    resolve_planes,
    resolve_rgba,
    row_distance,
};
inline constexpr std::size_t kFixedPrograms = 9;

/// How many clip planes a program has for an item with so many. The programs are few: unused planes keep all.
int clip_capacity(std::size_t planes);

/// Draws geometries without light.
struct PlainVariant {
    enum class Output {
        color,    ///< one everywhere
        node_id,  ///< the number of a node everywhere, into a target of integers
    };
    Output output = Output::color;
    bool double_single = false;  ///< GpuGeometry::is_double_single()
    int clip_planes = 0;         ///< clip_capacity()
    bool cap = false;            ///< at the depth of a clip plane

    bool operator==(const PlainVariant&) const = default;
    bool operator<(const PlainVariant& other) const {
        return std::tie(output, double_single, clip_planes, cap) <
               std::tie(other.output, other.double_single, other.clip_planes, other.cap);
    }
};

/// What a surface and the light ask of the program that shades it. Each variant is a program of its own.
struct SurfaceVariant {
    enum class Kind {
        faces,
        edges,            ///< without sides: their normals are turned to the viewer
        glass,            ///< faces, their colour multiplied by alpha
        per_pixel_glass,  ///< the same, into the lists of per_pixel_lists.glsl
        mirror,           ///< faces, mixed with what lies at their pixels in a texture
    };
    enum class Light { headlight, point, directional, spot };

    Kind kind = Kind::faces;
    Light light = Light::headlight;
    bool textured = false;
    bool environment = false;  ///< reflects the environment map
    int clip_planes = 0;       ///< clip_capacity()
    plan::Methods::Lighting lit_at = plan::Methods::Lighting::pixel;
    bool double_single = false;  ///< GpuGeometry::is_double_single()
    bool anisotropic = false;    ///< filter of its texture
    /// Faces whose matrices and material are attributes of instances (GpuInstance) instead of uniforms.
    bool instanced = false;
    bool colored = false;             ///< by the colours of its vertices
    bool emissive = false;            ///< sends light by itself
    bool metallic_roughness = false;  ///< lit by it, not by Phong's equation
    bool mapped = false;              ///< plan::is_mapped()
    bool coated = false;              ///< mirrors the environment above metal and roughness
    bool cap = false;                 ///< faces at the depth of a clip plane

    bool operator<(const SurfaceVariant& other) const {
        const auto key = [](const SurfaceVariant& v) {
            return std::tie(v.kind, v.light, v.textured, v.environment, v.clip_planes, v.lit_at,
                            v.double_single, v.anisotropic, v.instanced, v.colored, v.emissive,
                            v.metallic_roughness, v.mapped, v.coated, v.cap);
        };
        return key(*this) < key(other);
    }
};

SurfaceVariant::Light light_kind(scene::LightData::Type type);

/// Those that some view of some scene needs.
std::vector<PlainVariant> reachable_plain_variants();
std::vector<SurfaceVariant> reachable_surface_variants();

/// Those that views of a scene without View::clip_planes may need: in every drawing mode, with each of its
/// materials on any node, each of its lights or none, and its environment map or none.
std::vector<SurfaceVariant> surface_variants(const scene::Scene& scene, const plan::Methods& methods);

/// GLSL, with its version and all that it includes and defines.
struct ProgramSource {
    std::string vertex, fragment;
};
ProgramSource source_of(FixedProgram program);
ProgramSource source_of(const PlainVariant& variant);
ProgramSource source_of(const SurfaceVariant& variant);

/// The programs of a context, for all passes: each is compiled when it is first used, if not before.
class Programs {
public:
    /// Makes it the current one.
    void use(FixedProgram program);
    void use(const PlainVariant& variant);
    void use(const SurfaceVariant& variant);
    /// Compiles what views of a scene may need until `budget` is spent: each program spends
    /// DrawBudget::kMostUpload. Returns true when all are compiled.
    bool compile_step(const scene::Scene& scene, const plan::Methods& methods, plan::DrawBudget& budget);
    /// How many were compiled so far.
    int compiled() const { return compiled_; }

private:
    bool is_compiled(FixedProgram program) const;
    bool is_compiled(const SurfaceVariant& variant) const;
    bool is_compiled(const PlainVariant& variant) const;
    const GlProgram& at(FixedProgram program);
    const GlProgram& at(const PlainVariant& variant);
    const GlProgram& at(const SurfaceVariant& variant);

    std::array<GlProgram, kFixedPrograms> fixed_;
    std::map<PlainVariant, GlProgram> plain_;
    std::map<SurfaceVariant, GlProgram> surfaces_;
    int compiled_ = 0;
};

}  // namespace vrut::gl
