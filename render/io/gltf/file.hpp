#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/gltf/json.hpp"

namespace vrut::io {

/// A glTF 2.0 file: its document, and of a binary file its binary chunk.
struct GltfFile {  // NOLINT(bugprone-exception-escape): moving a GltfJson does not throw
    GltfJson document;
    std::optional<std::string> binary;
};

/// Reads a text or binary glTF file, told apart by its first bytes. Throws ImportError, also for other
/// versions.
GltfFile read_gltf_file(const std::filesystem::path& path);

}  // namespace vrut::io
