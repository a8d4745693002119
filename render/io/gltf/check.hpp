#pragma once

#include <filesystem>
#include <string>
#include <tl/expected.hpp>

#include "io/conversion_warnings.hpp"

namespace vrut::io {

/// A glTF file for assimp.
struct CheckedGltf {
    /// The file's first bytes, up to the end of its JSON. Members that are not read are renamed in it.
    std::string head;
    /// Triangles of the meshes that the scene shows, each mesh counted once. assimp leaves out triangles with
    /// an index out of range.
    std::uint64_t triangles = 0;
    ConversionWarnings warnings;
};

/// Returns what assimp reads of a glTF file, or a sentence about the file's error, without the file's name.
/// Validates what assimp 5.2 does not: the nesting depth, that nodes form a tree, that accessors fit their
/// buffers and their use, URIs, and memory (at most 64 times the file sizes, or 256 MiB). Renames members
/// that are not shown and cost memory or crash assimp: skins, animations, other vertex attributes, and
/// extensions except KHR_lights_punctual, KHR_materials_pbrSpecularGlossiness and KHR_draco_mesh_compression.
/// Renames the aspect ratio of cameras too, from which versions of assimp compute different fields of view.
tl::expected<CheckedGltf, std::string> check_gltf(const std::filesystem::path& path);

}  // namespace vrut::io
