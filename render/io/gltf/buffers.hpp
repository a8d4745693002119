#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/gltf/file.hpp"

namespace vrut::io {

/// The buffers of a glTF file, each loaded when it is first asked for: the binary chunk, a data URI, or a
/// file in the scene's folder or below. It also keeps account of the memory that reading the file takes: at
/// most 64 times the size of its files, or 256 MiB. Its functions throw ImportError.
class GltfBuffers {
public:
    /// The file must outlive this object, which takes its binary chunk.
    GltfBuffers(const std::filesystem::path& path, GltfFile& file);

    /// The bytes of a buffer view, decompressed where it has EXT_meshopt_compression. They stay.
    std::string_view view(std::uint32_t index);
    /// A buffer view's byteStride; 0 where it has none.
    std::uint64_t stride(std::uint32_t index) const;

    /// Counts memory that the caller allocates. Throws where it exceeds what the file may take.
    void charge(std::uint64_t bytes);

private:
    const GltfJson& view_json(std::uint32_t index) const;
    std::string_view buffer(std::uint32_t index);
    std::string load(const GltfJson& buffer, std::uint32_t index);
    std::string read_file(const std::string& uri, std::uint64_t size) const;
    /// Of a buffer view, or of its compressed form.
    std::string_view range(const GltfJson& part);

    const std::filesystem::path& path_;
    GltfFile& file_;
    std::vector<std::optional<std::string>> buffers_, decompressed_;  // decompressed: buffer views
    std::uint64_t memory_ = 0, most_memory_;
};

}  // namespace vrut::io
