#include "io/read_scene.hpp"

#include <algorithm>

#include "base/file_bytes.hpp"
#include "io/assimp/scene.hpp"
#include "io/camera_focus.hpp"
#include "io/gltf/reader.hpp"
#include "io/osb/scene.hpp"
#include "io/scene_textures.hpp"
#include "io/studio/studio.hpp"
#include "io/vrut/text_reader.hpp"

namespace vrut::io {

namespace {

struct ReaderEntry {
    const char* extension;
    PartsResult (*read)(const std::filesystem::path& path, const ReadProgress& progress,
                        const ReadOptions& options);
    bool foreign;  ///< a foreign library reads what matters of it
    bool defines_up_axis;
};

constexpr ReaderEntry kReaders[] = {
    {".vrut", read_vrut_file, false, true},
    {".osb", read_osb_scene, false, true},
    {".glb", read_gltf_scene, true, true},
    {".gltf", read_gltf_scene, true, true},
    {".obj", read_assimp_scene<AssimpFormat::obj>, true, false},
    {".stl", read_assimp_scene<AssimpFormat::stl>, true, false},
    {".ply", read_assimp_scene<AssimpFormat::ply>, true, false},
    {".dae", read_assimp_scene<AssimpFormat::collada>, true, true},
    {".fbx", read_assimp_scene<AssimpFormat::fbx>, true, true},
};

/// null: none reads this ending, in whatever case.
const ReaderEntry* reader_of(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    for (const ReaderEntry& format : kReaders)
        if (extension == format.extension) return &format;
    return nullptr;
}

bool wants_studio(const ReaderEntry& format, const scene::SceneParts& parts, Studio studio) {
    if (studio != Studio::automatic) return studio == Studio::on;
    return format.read != read_vrut_file && std::ranges::none_of(parts.nodes, [](const auto& part) {
               return std::holds_alternative<scene::LightData>(part.node.data);
           });
}

}  // namespace

ReadResult build_scene(scene::SceneParts parts, const std::string& file) {
    std::vector<std::size_t> lines;
    for (const auto& part : parts.nodes) lines.push_back(part.line);
    auto scene = scene::Scene::build(std::move(parts));
    if (scene) return *std::move(scene);
    // The root that build adds itself is never at fault.
    const std::size_t line = scene.error().node < lines.size() ? lines[scene.error().node] : 0;
    return tl::unexpected(file + ":" + (line > 0 ? std::to_string(line) + ":" : "") + " " +
                          scene.error().message);
}

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) {
        return c < 0x80 ? static_cast<char>(std::tolower(c)) : static_cast<char>(c);
    });
    return extension;
}

bool has_reader(const std::filesystem::path& path) { return reader_of(path) != nullptr; }

std::string read_extensions() {
    std::string list;
    for (const ReaderEntry& format : kReaders)
        list += (list.empty() ? "" : ", ") + std::string(format.extension);
    return list;
}

bool lacks_up_axis(const std::filesystem::path& path) {
    const ReaderEntry* const format = reader_of(path);
    return format != nullptr && !format->defines_up_axis;
}

bool has_foreign_reader(const std::filesystem::path& path) {
    const ReaderEntry* const format = reader_of(path);
    return format != nullptr && format->foreign;
}

PartsResult read_scene_parts(const std::filesystem::path& path, const ReadProgress& progress,
                             const ReadOptions& options) {
    const std::string file = path.string();
    const ReaderEntry* const format = reader_of(path);
    if (const auto fault = base::file_error(path)) return tl::unexpected(file + ": " + *fault);
    if (lower_extension(path) == ".csb")
        return tl::unexpected(file +
                              ": the CSB format is not supported, for it has no public specification; "
                              "convert it to .osb with OpenSG");
    if (format == nullptr)
        return tl::unexpected(file + ": this file extension cannot be read; supported are " +
                              read_extensions());
    PartsResult parts = format->read(path, progress, options);
    if (parts && !set_samplers(*parts)) parts->notices.push_back(file + ": " + kUnchangedTextures);
    if (parts && format->read != read_vrut_file) focus_on_what_is_seen(*parts);
    if (parts && wants_studio(*format, *parts, options.studio)) add_studio(*parts);
    return parts;
}

ReadResult read_scene(const std::filesystem::path& path, const ReadProgress& progress,
                      const ReadOptions& options) {
    auto parts = read_scene_parts(path, progress, options);
    if (!parts) return tl::unexpected(parts.error());
    return build_scene(*std::move(parts), path.string());
}

}  // namespace vrut::io
