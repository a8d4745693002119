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

/// Checks what assimp 5.2 takes on trust: that JSON and nodes are not nested without bound, nodes form a
/// tree, accessors lie in their buffers and hold what their use asks for, addresses are such as it parses,
/// and what it copies is at most 64 times the files' size, or 256 MiB. Hides from it what is not shown anyway
/// and costs memory, or crashes it: skins, animations, other vertex attributes, and extensions but for
/// KHR_lights_punctual, KHR_materials_pbrSpecularGlossiness and KHR_draco_mesh_compression. Hides the aspect
/// ratio of cameras, with which versions of assimp compute different fields of view.
/// Else why the file is none, without its name.
tl::expected<CheckedGltf, std::string> check_gltf(const std::filesystem::path& path);

}  // namespace vrut::io
