#include "io/gltf/meshopt.hpp"

#include <meshoptimizer.h>

#include "io/import_checks.hpp"

namespace vrut::io {

namespace {

constexpr const char* kInvalid = "an EXT_meshopt_compression object is invalid: its ";

bool is_vertex_mode(const GltfJson& compression) { return string_in(compression, "mode") == "ATTRIBUTES"; }

/// meshoptimizer takes for granted what is checked here.
void decode_filter(const std::string& filter, std::string& data, std::size_t count, std::size_t stride) {
    if (filter.empty() || filter == "NONE") return;
    if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
        meshopt_decodeFilterOct(data.data(), count, stride);
    else if (filter == "QUATERNION" && stride == 8)
        meshopt_decodeFilterQuat(data.data(), count, stride);
    else if (filter == "EXPONENTIAL")
        meshopt_decodeFilterExp(data.data(), count, stride);
    else
        throw ImportError(std::string(kInvalid) + "filter does not fit");
}

}  // namespace

std::uint64_t decompressed_size(const GltfJson& compression) {
    const std::uint64_t count = size_in(compression, "count"), stride = size_in(compression, "byteStride");
    if (count > UINT32_MAX) throw ImportError(std::string(kInvalid) + "count is too large");
    const bool fits = is_vertex_mode(compression) ? stride > 0 && stride <= 256 && stride % 4 == 0
                                                  : stride == 2 || stride == 4;
    if (!fits) throw ImportError(std::string(kInvalid) + "byteStride does not fit its mode");
    return count * stride;
}

std::string decompress_meshopt(const GltfJson& compression, std::string_view bytes) {
    std::string data(static_cast<std::size_t>(decompressed_size(compression)), '\0');
    const auto stride = static_cast<std::size_t>(size_in(compression, "byteStride"));
    const std::size_t count = data.size() / stride;
    const auto* const from = reinterpret_cast<const unsigned char*>(bytes.data());
    const std::string& mode = string_in(compression, "mode");
    int error = 0;
    if (mode == "ATTRIBUTES")
        error = meshopt_decodeVertexBuffer(data.data(), count, stride, from, bytes.size());
    else if (mode == "TRIANGLES" && count % 3 == 0)
        error = meshopt_decodeIndexBuffer(data.data(), count, stride, from, bytes.size());
    else if (mode == "INDICES")
        error = meshopt_decodeIndexSequence(data.data(), count, stride, from, bytes.size());
    else
        throw ImportError(std::string(kInvalid) + "mode does not fit");
    if (error != 0) throw ImportError("data compressed by EXT_meshopt_compression is damaged");
    if (is_vertex_mode(compression)) decode_filter(string_in(compression, "filter"), data, count, stride);
    return data;
}

}  // namespace vrut::io
