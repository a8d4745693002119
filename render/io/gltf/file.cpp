#include "io/gltf/file.hpp"

#include <array>

#include "base/file_bytes.hpp"
#include "io/import_checks.hpp"
#include "io/read_scene.hpp"

namespace vrut::io {

namespace {

constexpr std::string_view kGlbMagic = "glTF";
constexpr const char* kVersion1 = "it is glTF 1.0: export it as glTF 2.0";

/// The chunks of a binary file, read in their order.
class ChunkReader {
public:
    explicit ChunkReader(base::FileReader file) : file_(std::move(file)), left_(file_.size()) {}

    /// The next word, little-endian; none at the end of the file.
    std::optional<std::uint32_t> word() {
        std::uint32_t value = 0;  // little-endian as the machine is
        if (left_ < sizeof value || !file_.read(reinterpret_cast<char*>(&value), sizeof value))
            return std::nullopt;
        left_ -= sizeof value;
        return value;
    }

    /// The contents of a chunk, and the padding behind them, which some programs leave out of the length.
    std::string contents(std::uint32_t length, const char* name) {
        if (length > left_) throw ImportError("its " + std::string(name) + " chunk exceeds the file");
        std::string bytes(length, '\0');
        std::array<char, 3> padding{};
        const std::size_t padded = std::min<std::size_t>(left_ - length, (4 - length % 4) % 4);
        if (!file_.read(bytes.data(), bytes.size()) || !file_.read(padding.data(), padded))
            throw ImportError(std::string(base::kCutShort));
        left_ -= length + padded;
        return bytes;
    }

private:
    base::FileReader file_;
    std::uintmax_t left_;
};

GltfFile read_binary_file(const std::filesystem::path& path) {
    constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
    auto opened = base::FileReader::open(path);
    if (!opened) throw ImportError(opened.error());
    ChunkReader chunks(*std::move(opened));
    chunks.word();  // the magic number
    const auto version = chunks.word();
    if (version == 1U) throw ImportError(kVersion1);
    if (version != 2U) throw ImportError("it is a binary glTF (GLB) file of another version than 2");
    chunks.word();  // the length, which the file itself tells
    const auto length = chunks.word(), type = chunks.word();
    if (type != kJsonChunk) throw ImportError("it is a binary glTF (GLB) file without a JSON chunk");
    GltfFile file;
    std::string json = chunks.contents(*length, "JSON");
    json.resize(json.find_last_not_of('\0') + 1);  // with which some programs pad it
    file.document = parse_gltf_json(json);
    const auto binary_length = chunks.word(), binary_type = chunks.word();
    if (binary_type == kBinaryChunk) file.binary = chunks.contents(*binary_length, "binary");
    return file;  // what follows is not for this version
}

GltfFile read_text_file(const std::filesystem::path& path) {
    const auto text = base::read_bytes(path);
    if (!text) throw ImportError(text.error());
    return {parse_gltf_json(*text), std::nullopt};
}

bool is_binary(const std::filesystem::path& path) {
    auto file = base::FileReader::open(path);
    if (!file) throw ImportError(file.error());
    std::string first(kGlbMagic.size(), '\0');
    return file->size() >= first.size() && file->read(first.data(), first.size()) && first == kGlbMagic;
}

}  // namespace

GltfFile read_gltf_file(const std::filesystem::path& path) {
    const bool binary = is_binary(path);
    if (!binary && lower_extension(path) == ".glb") throw ImportError("it is not a binary glTF (GLB) file");
    GltfFile file = binary ? read_binary_file(path) : read_text_file(path);
    const GltfJson& asset = object_in(file.document, "asset");
    const GltfJson version = asset.value("version", GltfJson());
    const std::string number = version.is_string() ? version.get<std::string>() : version.dump();
    if (number.starts_with('1')) throw ImportError(kVersion1);
    if (!number.starts_with('2'))
        throw ImportError("its asset.version is not that of a glTF 2.0 file: export it as glTF 2.0");
    return file;
}

}  // namespace vrut::io
