#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "temporary_folder.hpp"

/// Writes heap.gltf: triangles without extent, of 12 bytes a vertex, which take a while to be read. Returns
/// its path.
inline std::filesystem::path write_heap(const TemporaryFolder& folder, std::size_t triangles) {
    const std::string count = std::to_string(3 * triangles), size = std::to_string(36 * triangles);
    std::filesystem::resize_file(folder.write("heap.bin", ""), 36 * triangles);
    return folder.write("heap.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"name": "Heap", "mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": )" +
                                         count + R"(}], "bufferViews": [{"buffer": 0, "byteLength": )" +
                                         size + R"(}], "buffers": [{"uri": "heap.bin", "byteLength": )" +
                                         size + "}]}");
}
