#pragma once

#include <filesystem>
#include <string>
#include <tl/expected.hpp>

#include "io/conversion_warnings.hpp"

namespace vrut::io {

/// A glTF file for assimp.
struct CheckedGltf {
    /// The file's first bytes, up to the end of its JSON, in which the members are renamed that are not read.
    std::string head;
    /// Triangles of the meshes that the scene shows, each mesh once: assimp leaves out those with indices out
    /// of range.
    std::uint64_t triangles = 0;
    ConversionWarnings warnings;
};

/// Validates what assimp 5.2 does not: nesting depth, that nodes form a tree, that accessors fit their
/// buffers and suit their use, URIs, and memory (at most 64 times the file sizes, or 256 MiB). Renames
/// members that are not shown and cost memory or crash assimp: skins, animations, other vertex attributes,
/// and extensions except KHR_lights_punctual, KHR_materials_pbrSpecularGlossiness and
/// KHR_draco_mesh_compression. Hides the aspect ratio of cameras, from which versions of assimp compute
/// different fields of view. Returns an error without the file's name.
tl::expected<CheckedGltf, std::string> check_gltf(const std::filesystem::path& path);

}  // namespace vrut::io
