#include "io/write_scene.hpp"

#include <algorithm>

#include "base/output_files.hpp"
#include "io/gltf/writer.hpp"
#include "io/obj_writer.hpp"
#include "io/read_scene.hpp"
#include "io/stl_writer.hpp"
#include "io/texture_writer.hpp"
#include "io/vrut/text_writer.hpp"

namespace vrut::io {

namespace {

void write_vrut_file(const scene::Scene& scene, const std::filesystem::path& path, base::OutputFiles& files,
                     ConversionWarnings&, const WriteProgress&) {
    const auto texture_files = write_textures(scene, path, files);
    files.write(path, [&](std::ostream& out) { write_vrut_text(scene, out, {}, texture_files); });
}

struct WriterEntry {
    const char* extension;
    void (*write)(const scene::Scene& scene, const std::filesystem::path& path, base::OutputFiles& files,
                  ConversionWarnings& warnings,
                  const WriteProgress& progress);  // throws WriteError
};

constexpr WriterEntry kWriters[] = {
    {".vrut", write_vrut_file},
    {".obj", write_obj},
    {".stl", write_stl},
    {".glb", write_glb},
};

const WriterEntry* writer_of(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    const auto* const found =
        std::find_if(std::begin(kWriters), std::end(kWriters),
                     [&](const WriterEntry& format) { return extension == format.extension; });
    return found == std::end(kWriters) ? nullptr : found;
}

}  // namespace

bool has_writer(const std::filesystem::path& path) { return writer_of(path) != nullptr; }

std::string written_extensions() {
    std::string list;
    for (const WriterEntry& format : kWriters)
        list += (list.empty() ? "" : ", ") + std::string(format.extension);
    return list;
}

WriteResult write_scene(const scene::Scene& scene, const std::filesystem::path& path,
                        const WriteProgress& progress, std::vector<std::filesystem::path> protected_files) {
    const WriterEntry* const format = writer_of(path);
    if (format == nullptr)
        return tl::unexpected(path.string() + ": this file extension cannot be written; supported are " +
                              written_extensions());
    try {
        base::OutputFiles files(std::move(protected_files));
        ConversionWarnings warnings;
        format->write(scene, path, files, warnings, progress);
        files.commit();
        std::vector<std::string> lost;
        warnings.append_to(lost, path.string());
        return lost;
    } catch (const base::WriteError& fault) {
        return tl::unexpected(std::string(fault.what()));
    }
}

}  // namespace vrut::io
