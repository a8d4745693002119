#include "gl/programs.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>

#include "gl/shader_program.hpp"
#include "gl/shader_sources.hpp"
#include "plan/draw_groups.hpp"

namespace vrut::gl {

namespace {

using SurfaceKind = SurfaceVariant::Kind;
using Light = SurfaceVariant::Light;

struct StageFiles {
    std::string_view vertex, fragment;
};

StageFiles files_of(FixedProgram program) {
    switch (program) {
        case FixedProgram::accumulate:
            return {"screen.vert", "accumulate.frag"};
        case FixedProgram::background_environment:
            return {"screen.vert", "background_environment.frag"};
        case FixedProgram::background_image:
            return {"screen.vert", "background_image.frag"};
        case FixedProgram::composite_lists:
            return {"screen.vert", "composite_lists.frag"};
        case FixedProgram::marker:
            return {"marker.vert", "marker.frag"};
        case FixedProgram::outline:
            return {"screen.vert", "outline.frag"};
        case FixedProgram::resolve_planes:
            return {"screen.vert", "resolve_planes.frag"};
        case FixedProgram::resolve_rgba:
            return {"screen.vert", "resolve_rgba.frag"};
        case FixedProgram::row_distance:
            break;
    }
    return {"screen.vert", "row_distance.frag"};
}

/// One plane is what a mirror takes, or one section. The last is for all of a view's planes and a mirror's.
constexpr std::array<int, 4> kClipCapacities{0, 1, 8, scene::kMostClipPlanes + 1};
/// What shaders know them by.
std::string_view clip_define(int capacity) {
    return capacity == 1 ? "CLIPPED 1" : capacity == 8 ? "CLIPPED 8" : "CLIPPED 13";
}
static_assert(kClipCapacities.back() == 13);

/// Edges take the colour of their material alone. A planar mirror shows the scene, not the environment, and
/// no mirror shows another. An instance has one clip plane at most.
/// Metal and roughness need an environment, and are lit at pixels, as what a normal map bends.
bool is_reachable(const SurfaceVariant& variant) {
    const bool varied = variant.metallic_roughness || variant.mapped;
    if (variant.kind == SurfaceKind::edges &&
        (variant.textured || variant.colored || variant.emissive || varied || variant.environment))
        return false;
    if (variant.kind == SurfaceKind::mirror && variant.environment && !variant.metallic_roughness)
        return false;
    if (variant.cap && (variant.kind != SurfaceKind::faces || variant.textured || variant.environment ||
                        variant.colored || variant.emissive || varied || variant.instanced))
        return false;
    if (variant.anisotropic && !(variant.textured || variant.mapped)) return false;
    if (variant.metallic_roughness && !variant.environment) return false;
    if (variant.coated && !variant.metallic_roughness) return false;
    if (varied && variant.lit_at != plan::Methods::Lighting::pixel) return false;
    if (variant.instanced &&
        (variant.kind != SurfaceKind::faces || variant.double_single || variant.colored || variant.emissive ||
         variant.mapped || variant.clip_planes > 1))
        return false;
    return true;
}

bool has_double_single(const scene::Scene& scene) {
    for (std::size_t i = 0; i < scene.geometries().size(); ++i)
        if (scene.needs_double_single(static_cast<scene::Index>(i))) return true;
    return false;
}

/// What a scene's surfaces and lights may ask of programs.
struct SceneFeatures {
    bool small_geometries = false, double_single = false;
    bool texcoords = false, colors = false, planes = false, environment_map = false;
    bool emissive = false, metallic_roughness = false, mapped = false, coated = false;
    bool opaque_textured = false, glass = false, glass_textured = false;
    bool reflective = false, reflective_glass = false;
    std::array<bool, 4> lights{};  ///< by SurfaceVariant::Light
    bool mirrors() const { return planes && reflective; }
};

void add_material(SceneFeatures& features, const scene::Scene& scene, const scene::Material& material) {
    const bool glass = scene.is_transparent(material), textured = material.texture != scene::kNone;
    features.glass |= glass;
    features.emissive |= material.emissive != glm::dvec3(0);
    if (const auto& surface = material.metallic_roughness) {
        features.metallic_roughness = true;
        features.coated |= surface->clear_coat > 0 || material.reflectivity > 0;
    }
    features.mapped |= material.normal_texture != scene::kNone ||
                       material.occlusion_roughness_metallic_texture != scene::kNone;
    (glass ? features.glass_textured : features.opaque_textured) |= textured;
    (glass ? features.reflective_glass : features.reflective) |= material.reflectivity > 0;
}

SceneFeatures features_of(const scene::Scene& scene) {
    SceneFeatures features;
    features.double_single = has_double_single(scene);
    for (std::size_t i = 0; i < scene.geometries().size(); ++i) {
        features.small_geometries |= scene.geometries()[i].triangles.size() <= plan::kMostTrianglesOfSmall;
        features.texcoords |= !scene.geometries()[i].texcoords.empty();
        features.colors |= !scene.geometries()[i].colors.empty();
        features.planes |= scene.plane(static_cast<scene::Index>(i)).has_value();
    }
    for (const scene::Material& material : scene.materials()) add_material(features, scene, material);
    for (const scene::Node& node : scene.nodes()) {
        if (const auto* light = std::get_if<scene::LightData>(&node.data))
            features.lights[static_cast<std::size_t>(light_kind(light->type))] = true;
        if (const auto* background = std::get_if<scene::BackgroundData>(&node.data))
            features.environment_map |= background->cube_textures.has_value();
    }
    features.lights[static_cast<std::size_t>(Light::headlight)] = true;
    // A mirror shows what the headlight lights, from beside it.
    if (features.mirrors()) features.lights[static_cast<std::size_t>(Light::point)] = true;
    return features;
}

bool may_need(const SceneFeatures& features, const SurfaceVariant& variant) {
    const bool is_glass = variant.kind == SurfaceKind::glass || variant.kind == SurfaceKind::per_pixel_glass;
    const bool textured = is_glass ? features.glass_textured : features.opaque_textured;
    const bool reflective = is_glass ? features.reflective_glass : features.reflective;
    if (!features.lights[static_cast<std::size_t>(variant.light)]) return false;
    if (variant.double_single && !features.double_single) return false;
    if (variant.colored && !features.colors) return false;
    if (variant.emissive && !features.emissive) return false;
    if (variant.metallic_roughness && !features.metallic_roughness) return false;
    if (variant.coated && !features.coated) return false;
    if (variant.mapped && !(features.mapped && features.texcoords)) return false;
    if (variant.instanced && !features.small_geometries) return false;
    if (is_glass && !features.glass) return false;
    if (variant.kind == SurfaceKind::mirror && !features.mirrors()) return false;
    if (variant.textured && !(textured && features.texcoords)) return false;
    if (variant.environment && !((reflective || variant.metallic_roughness) && features.environment_map))
        return false;
    if (variant.cap) return false;
    // A mirror clips what it shows, and the headlight is not at the eye of its view.
    if (variant.clip_planes == 0) return true;
    return variant.clip_planes == 1 && features.mirrors() && variant.light != Light::headlight &&
           variant.kind != SurfaceKind::edges && variant.kind != SurfaceKind::mirror;
}

GlProgram compile(const ProgramSource& source) { return make_program(source.vertex, source.fragment); }

}  // namespace

SurfaceVariant::Light light_kind(scene::LightData::Type type) {
    switch (type) {
        case scene::LightData::Type::directional:
            return Light::directional;
        case scene::LightData::Type::spot:
            return Light::spot;
        case scene::LightData::Type::point:
            break;
    }
    return Light::point;
}

int clip_capacity(std::size_t planes) {
    return *std::ranges::find_if(kClipCapacities,
                                 [&](int capacity) { return static_cast<std::size_t>(capacity) >= planes; });
}

std::vector<PlainVariant> reachable_plain_variants() {
    std::vector<PlainVariant> variants;
    for (const PlainVariant::Output output : {PlainVariant::Output::color, PlainVariant::Output::node_id})
        for (const bool double_single : {false, true})
            for (const int planes : kClipCapacities)
                for (const bool cap : {false, true}) variants.push_back({output, double_single, planes, cap});
    return variants;
}

std::vector<SurfaceVariant> reachable_surface_variants() {
    using Lighting = plan::Methods::Lighting;
    std::vector<SurfaceVariant> variants;
    for (const SurfaceKind kind : {SurfaceKind::faces, SurfaceKind::edges, SurfaceKind::glass,
                                   SurfaceKind::per_pixel_glass, SurfaceKind::mirror})
        for (const Light light : {Light::headlight, Light::point, Light::directional, Light::spot})
            for (const Lighting lit_at : {Lighting::pixel, Lighting::vertex})
                for (const int clip_planes : kClipCapacities)
                    for (int bits = 0; bits < 2048; ++bits) {
                        const SurfaceVariant variant{kind,
                                                     light,
                                                     (bits & 1) != 0,
                                                     (bits & 2) != 0,
                                                     clip_planes,
                                                     lit_at,
                                                     (bits & 4) != 0,
                                                     (bits & 8) != 0,
                                                     (bits & 16) != 0,
                                                     (bits & 32) != 0,
                                                     (bits & 64) != 0,
                                                     (bits & 128) != 0,
                                                     (bits & 256) != 0,
                                                     (bits & 512) != 0,
                                                     (bits & 1024) != 0};
                        if (is_reachable(variant)) variants.push_back(variant);
                    }
    return variants;
}

std::vector<SurfaceVariant> surface_variants(const scene::Scene& scene, const plan::Methods& methods) {
    const SceneFeatures features = features_of(scene);
    std::vector<SurfaceVariant> variants = reachable_surface_variants();
    const bool anisotropic = methods.texture_filter == plan::Methods::TextureFilter::anisotropic;
    std::erase_if(variants, [&](const SurfaceVariant& variant) {
        const bool at_pixel = variant.metallic_roughness || variant.mapped;
        return variant.lit_at != (at_pixel ? plan::Methods::Lighting::pixel : methods.light) ||
               variant.anisotropic != ((variant.textured || variant.mapped) && anisotropic) ||
               !may_need(features, variant);
    });
    return variants;
}

ProgramSource source_of(FixedProgram program) {
    const StageFiles files = files_of(program);
    return {shader_source(files.vertex), shader_source(files.fragment)};
}

ProgramSource source_of(const PlainVariant& variant) {
    std::vector<std::string_view> defines;
    if (variant.double_single) defines.push_back("DOUBLE_SINGLE");
    if (variant.clip_planes > 0) defines.push_back(clip_define(variant.clip_planes));
    if (variant.cap) defines.push_back("CAP");
    const bool color = variant.output == PlainVariant::Output::color;
    return {shader_source("solid_color.vert", defines),
            shader_source(color ? "solid_color.frag" : "node_id.frag", defines)};
}

ProgramSource source_of(const SurfaceVariant& variant) {
    constexpr std::array<std::string_view, 4> kLights{"HEADLIGHT", "POINT", "DIRECTIONAL", "SPOT"};
    std::vector<std::string_view> defines;
    const auto define = [&](bool wanted, std::string_view name) {
        if (wanted) defines.push_back(name);
    };
    define(true, kLights[static_cast<std::size_t>(variant.light)]);
    define(variant.instanced, "INSTANCED");
    define(variant.kind == SurfaceKind::edges, "EDGES");
    define(variant.textured, "TEXTURED");
    define(variant.colored, "COLORED");
    define(variant.emissive, "EMISSIVE");
    define(variant.metallic_roughness, "METALLIC_ROUGHNESS");
    define(variant.mapped, "MAPPED");
    define(variant.coated, "COATED");
    define(variant.environment, "ENVIRONMENT");
    define(variant.kind == SurfaceKind::glass || variant.kind == SurfaceKind::per_pixel_glass, "GLASS");
    define(variant.kind == SurfaceKind::per_pixel_glass, "LAYERED");
    define(variant.kind == SurfaceKind::mirror, "MIRROR");
    define(variant.clip_planes > 0, clip_define(variant.clip_planes));
    define(variant.cap, "CAP");
    define(variant.double_single, "DOUBLE_SINGLE");
    define(variant.anisotropic, "ANISOTROPIC");
    const bool at_vertex = variant.lit_at == plan::Methods::Lighting::vertex;
    define(at_vertex, "LIT_AT_VERTEX");
    define(!at_vertex || variant.environment, "NEEDS_NORMAL");
    return {shader_source("surface.vert", defines), shader_source("surface.frag", defines)};
}

const GlProgram& Programs::at(FixedProgram program) {
    GlProgram& compiled = fixed_[static_cast<std::size_t>(program)];
    if (!compiled) {
        compiled = compile(source_of(program));
        ++compiled_;
    }
    return compiled;
}

const GlProgram& Programs::at(const PlainVariant& variant) {
    GlProgram& compiled = plain_[variant];
    if (!compiled) {
        compiled = compile(source_of(variant));
        ++compiled_;
    }
    return compiled;
}

const GlProgram& Programs::at(const SurfaceVariant& variant) {
    GlProgram& compiled = surfaces_[variant];
    if (!compiled) {
        assert(is_reachable(variant));
        compiled = compile(source_of(variant));
        ++compiled_;
    }
    return compiled;
}

bool Programs::is_compiled(FixedProgram program) const {
    return bool(fixed_[static_cast<std::size_t>(program)]);
}

bool Programs::is_compiled(const PlainVariant& variant) const { return plain_.contains(variant); }

bool Programs::is_compiled(const SurfaceVariant& variant) const { return surfaces_.contains(variant); }

void Programs::use(FixedProgram program) { glUseProgram(at(program).get()); }

void Programs::use(const PlainVariant& variant) { glUseProgram(at(variant).get()); }

void Programs::use(const SurfaceVariant& variant) { glUseProgram(at(variant).get()); }

bool Programs::compile_step(const scene::Scene& scene, const plan::Methods& methods,
                            plan::DrawBudget& budget) {
    constexpr std::int64_t kProgram = plan::DrawBudget::kMostUpload;
    const auto compile_next = [&](auto program) {
        const int before = compiled_;
        if (budget.is_spent() && !is_compiled(program)) return false;
        at(program);
        budget.spend((compiled_ - before) * kProgram);
        return true;
    };
    const bool double_single = has_double_single(scene);
    for (std::size_t i = 0; i < kFixedPrograms; ++i)
        if (!compile_next(static_cast<FixedProgram>(i))) return false;
    for (const PlainVariant& variant : reachable_plain_variants())
        if (variant.clip_planes == 0 && !variant.cap && variant.double_single <= double_single &&
            !compile_next(variant))
            return false;
    return std::ranges::all_of(surface_variants(scene, methods), compile_next);
}

}  // namespace vrut::gl
