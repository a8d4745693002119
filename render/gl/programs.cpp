#include "gl/programs.hpp"

#include <cassert>

#include "gl/shader_program.hpp"
#include "gl/shader_sources.hpp"

namespace vrut::gl {

namespace {

using Kind = SurfaceVariant::Kind;
using Light = SurfaceVariant::Light;

struct StageFiles {
    std::string_view vertex, fragment;
};

StageFiles files_of(FixedProgram program) {
    switch (program) {
        case FixedProgram::background_environment:
            return {"screen.vert", "background_environment.frag"};
        case FixedProgram::background_image:
            return {"screen.vert", "background_image.frag"};
        case FixedProgram::composite_lists:
            return {"screen.vert", "composite_lists.frag"};
        case FixedProgram::marker:
            return {"marker.vert", "marker.frag"};
        case FixedProgram::node_id:
            return {"solid_color.vert", "node_id.frag"};
        case FixedProgram::outline:
            return {"screen.vert", "outline.frag"};
        case FixedProgram::row_distance:
            return {"screen.vert", "row_distance.frag"};
        case FixedProgram::solid_color:
            break;
    }
    return {"solid_color.vert", "solid_color.frag"};
}

/// Edges take the colour of their material alone. A planar mirror shows the scene, not the environment, and
/// no mirror shows another; what it shows may be clipped, and lies beside the eye that carries the headlight.
bool is_reachable(const SurfaceVariant& variant) {
    const bool plain = !variant.environment && !variant.clipped;
    if (variant.kind == Kind::edges && (variant.textured || !plain)) return false;
    if (variant.kind == Kind::mirror && !plain) return false;
    return !(variant.clipped && variant.light == Light::headlight);
}

GlProgram compile(const ProgramSource& source) { return make_program(source.vertex, source.fragment); }

}  // namespace

std::vector<SurfaceVariant> reachable_surface_variants() {
    using Lighting = plan::Methods::Lighting;
    std::vector<SurfaceVariant> variants;
    for (const Kind kind : {Kind::faces, Kind::edges, Kind::glass, Kind::per_pixel_glass, Kind::mirror})
        for (const Light light : {Light::headlight, Light::point, Light::directional, Light::spot})
            for (const Lighting lit_at : {Lighting::pixel, Lighting::vertex})
                for (int bits = 0; bits < 8; ++bits) {
                    const SurfaceVariant variant{
                        kind, light, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, lit_at};
                    if (is_reachable(variant)) variants.push_back(variant);
                }
    return variants;
}

ProgramSource source_of(FixedProgram program) {
    const StageFiles files = files_of(program);
    return {shader_source(files.vertex), shader_source(files.fragment)};
}

ProgramSource source_of(const SurfaceVariant& variant) {
    constexpr std::array<std::string_view, 4> kLights{"HEADLIGHT", "POINT", "DIRECTIONAL", "SPOT"};
    std::vector<std::string_view> defines;
    const auto define = [&](bool wanted, std::string_view name) {
        if (wanted) defines.push_back(name);
    };
    define(true, kLights[static_cast<std::size_t>(variant.light)]);
    define(variant.kind == Kind::edges, "EDGES");
    define(variant.textured, "TEXTURED");
    define(variant.environment, "ENVIRONMENT");
    define(variant.kind == Kind::glass || variant.kind == Kind::per_pixel_glass, "GLASS");
    define(variant.kind == Kind::per_pixel_glass, "LAYERED");
    define(variant.kind == Kind::mirror, "MIRROR");
    define(variant.clipped, "CLIPPED");
    const bool at_vertex = variant.lit_at == plan::Methods::Lighting::vertex;
    define(at_vertex, "LIT_AT_VERTEX");
    define(!at_vertex || variant.environment, "NEEDS_NORMAL");
    return {shader_source("surface.vert", defines), shader_source("surface.frag", defines)};
}

void Programs::use(FixedProgram program) {
    GlProgram& compiled = fixed_[static_cast<std::size_t>(program)];
    if (!compiled) compiled = compile(source_of(program));
    glUseProgram(compiled.get());
}

void Programs::use(const SurfaceVariant& variant) {
    GlProgram& compiled = surfaces_[variant];
    if (!compiled) {
        assert(is_reachable(variant));
        compiled = compile(source_of(variant));
    }
    glUseProgram(compiled.get());
}

}  // namespace vrut::gl
