#include "io/gltf/buffers.hpp"

#include <algorithm>
#include <set>

#include "base/file_bytes.hpp"
#include "io/foreign_paths.hpp"
#include "io/gltf/data_uri.hpp"
#include "io/gltf/meshopt.hpp"
#include "io/import_checks.hpp"
#include "io/vrut/tokenizer.hpp"

namespace vrut::io {

namespace {

constexpr std::uint64_t kMostTimes = 64, kAlwaysAllowed = std::uint64_t{256} << 20;

/// The scene's and its buffers', each once, as they lie on the disk: buffers may say anything. At most 2^50.
std::uint64_t size_of_files(const std::filesystem::path& path, const GltfJson& document) {
    const auto folder = path.parent_path();
    std::set<std::filesystem::path> files = {path};
    for (const GltfJson& buffer : array_in(document, "buffers"))
        if (const std::string& uri = string_in(buffer, "uri"); !uri.empty() && !is_data_uri(uri))
            if (const auto file = base::find_below(folder, file_name_of_uri(folder, uri)))
                files.insert(*file);
    std::uint64_t total = 0;
    for (const auto& file : files) {
        std::error_code error;
        const std::uintmax_t size = std::filesystem::file_size(file, error);
        constexpr std::uint64_t kMost = std::uint64_t{1} << 50;
        if (!error) total = std::min(total + std::min<std::uint64_t>(size, kMost), kMost);
    }
    return total;
}

/// null: it is not compressed.
const GltfJson* compression_of(const GltfJson& view) {
    const GltfJson& compression = extension_in(view, "EXT_meshopt_compression");
    return compression.empty() ? nullptr : &compression;
}

}  // namespace

GltfBuffers::GltfBuffers(const std::filesystem::path& path, GltfFile& file)
    : path_(path),
      file_(file),
      buffers_(array_in(file.document, "buffers").size()),
      decompressed_(array_in(file.document, "bufferViews").size()),
      most_memory_(std::max(kMostTimes * size_of_files(path, file.document), kAlwaysAllowed)) {}

void GltfBuffers::charge(std::uint64_t bytes) {
    memory_ += std::min(bytes, most_memory_ + 1);
    if (memory_ > most_memory_)
        throw ImportError("loading it would need more than " + std::to_string(most_memory_ >> 20) +
                          " MiB of memory");
}

const GltfJson& GltfBuffers::view_json(std::uint32_t index) const {
    if (index >= decompressed_.size()) throw ImportError("there is no bufferView " + std::to_string(index));
    return array_in(file_.document, "bufferViews")[index];
}

std::uint64_t GltfBuffers::stride(std::uint32_t index) const {
    const GltfJson& json = view_json(index);
    const GltfJson* const compression = compression_of(json);
    const std::uint64_t stride = size_in(compression != nullptr ? *compression : json, "byteStride");
    if (compression == nullptr && stride > 252) throw ImportError("a bufferView's byteStride exceeds 252");
    return stride;
}

std::string_view GltfBuffers::view(std::uint32_t index) {
    const GltfJson& json = view_json(index);
    const GltfJson* const compression = compression_of(json);
    if (compression == nullptr) return range(json);
    std::optional<std::string>& data = decompressed_[index];
    if (!data) {
        charge(decompressed_size(*compression));
        data = decompress_meshopt(*compression, range(*compression));
    }
    return *data;
}

std::string_view GltfBuffers::range(const GltfJson& part) {
    const std::string_view bytes = buffer(required_index_in(part, "buffer"));
    const std::uint64_t offset = size_in(part, "byteOffset"), length = size_in(part, "byteLength");
    if (offset > bytes.size() || length > bytes.size() - offset)
        throw ImportError("a bufferView exceeds its buffer");
    return bytes.substr(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
}

std::string_view GltfBuffers::buffer(std::uint32_t index) {
    if (index >= buffers_.size()) throw ImportError("there is no buffer " + std::to_string(index));
    const GltfJson& json = array_in(file_.document, "buffers")[index];
    const std::uint64_t length = size_in(json, "byteLength");
    std::optional<std::string>& data = buffers_[index];
    if (!data) {
        charge(length);
        data = load(json, index);
        if (data->size() < length)
            throw ImportError("buffer " + std::to_string(index) + " has " + std::to_string(data->size()) +
                              " bytes, but its byteLength is " + std::to_string(length));
    }
    return std::string_view(*data).substr(0, static_cast<std::size_t>(length));
}

std::string GltfBuffers::load(const GltfJson& buffer, std::uint32_t index) {
    const std::string& uri = string_in(buffer, "uri");
    if (is_data_uri(uri)) return decode_data_uri(uri);
    if (!uri.empty()) return read_file(uri, size_in(buffer, "byteLength"));
    if (index > 0 || !file_.binary) throw ImportError("buffer " + std::to_string(index) + " has no data");
    return *std::move(file_.binary);
}

/// At most `size` bytes.
std::string GltfBuffers::read_file(const std::string& uri, std::uint64_t size) const {
    const auto folder = path_.parent_path();
    const auto fail = [&](const std::string& why) { throw ImportError("'" + excerpt(uri) + "': " + why); };
    const auto path = base::find_below(folder, file_name_of_uri(folder, uri));
    if (!path) fail(path.error());
    auto file = base::FileReader::open(*path);
    if (!file) fail(file.error());
    std::string bytes(static_cast<std::size_t>(std::min<std::uint64_t>(size, file->size())), '\0');
    if (!file->read(bytes.data(), bytes.size())) fail(std::string(base::kCutShort));
    return bytes;
}

}  // namespace vrut::io
