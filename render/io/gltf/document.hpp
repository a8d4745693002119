#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/gltf/check.hpp"

namespace vrut::io {

using Index32 = std::optional<std::uint32_t>;

struct GltfBuffer {
    std::uint64_t length = 0;
    std::string uri;  // of a data URI the beginning
};

struct GltfBufferView {
    std::uint64_t buffer = 0, offset = 0, length = 0, stride = 0;
};

struct GltfAccessor {
    Index32 view, sparse_indices, sparse_values;
    std::uint64_t offset = 0, sparse_indices_offset = 0, sparse_values_offset = 0;
    std::uint32_t count = 0, component_type = 0, sparse_count = 0, sparse_component_type = 0;
    std::uint64_t components = 0;
    bool sparse = false;
};

struct GltfPrimitive {
    std::uint32_t mode = 4;
    Index32 indices, positions, normals, texcoords;
    std::string_view texcoords_name, indices_name;
};

struct GltfNode {
    std::vector<std::uint32_t> children;
    Index32 mesh;
};

/// The members of a glTF file that are checked; names are glTF's.
struct GltfDocument {
    std::vector<GltfBuffer> buffers;
    std::vector<std::uint32_t> image_buffer_views;  // those of images
    std::vector<GltfBufferView> buffer_views;
    std::vector<GltfAccessor> accessors;
    std::vector<std::vector<GltfPrimitive>> meshes;
    std::vector<GltfNode> nodes;
    std::vector<std::vector<std::uint32_t>> scenes;  // root nodes of each
    std::uint32_t scene = 0;
};

/// Renames a member or an extension, so that assimp does not find it. `name` points into the head.
void hide_member(CheckedGltf& gltf, std::string_view name);

/// Returns the document of the head's JSON, which begins at byte `start`. Hides members that are not shown,
/// and checks URIs and MIME types of images. Names in the document point into the head. Throws JsonError.
GltfDocument read_gltf(CheckedGltf& gltf, std::size_t start);

}  // namespace vrut::io
