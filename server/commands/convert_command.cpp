#include <unistd.h>

#include <fstream>
#include <iostream>
#include <optional>
#include <stdexcept>

#include "commands/commands.hpp"
#include "io/write_scene.hpp"
#include "observe/progress.hpp"
#include "scenes/import_process.hpp"

namespace vrut::server::commands {

namespace {

/// Shows a part of the work as it goes on; off a terminal nothing does.
std::function<void(double)> shown(std::optional<observe::Progress>& bar, double from, double to,
                                  const std::string& what) {
    if (!bar) return {};
    return [&bar, from, to, what](double part) { bar->show(from + (to - from) * part, what); };
}

/// The library of materials that a line of OBJ names; empty for other lines.
std::string material_library(const std::string& line) {
    constexpr std::string_view kKeyword = "mtllib ";
    if (!line.starts_with(kKeyword)) return {};
    const std::size_t first = line.find_first_not_of(' ', kKeyword.size());
    const std::size_t last = line.find_last_not_of(" \r");
    return first < last ? line.substr(first, last + 1 - first) : "";
}

/// The files beside a scene's own that it is read from and that might be written over: pictures, and the
/// materials of OBJ.
std::vector<std::filesystem::path> files_beside(const std::filesystem::path& in, const scene::Scene& scene) {
    std::vector<std::filesystem::path> files;
    for (const scene::Texture& texture : scene.textures()) files.push_back(in.parent_path() / texture.file);
    if (io::lower_extension(in) != ".obj") return files;
    std::ifstream stream(in);
    for (std::string line; std::getline(stream, line);)
        if (const std::string library = material_library(line); !library.empty())
            files.push_back(in.parent_path() / library);
    return files;
}

std::vector<std::string> convert(const ConvertArguments& arguments) {
    std::optional<observe::Progress> bar;
    if (isatty(STDERR_FILENO) == 1) bar.emplace();
    const auto scene =
        scenes::import_scene(arguments.in, shown(bar, 0, 0.6, "reading " + arguments.in.filename().string()),
                             {{}, arguments.read});
    if (!scene) throw std::runtime_error(scene.error());
    auto lost = io::write_scene(*scene, arguments.out,
                                shown(bar, 0.6, 1, "writing " + arguments.out.filename().string()),
                                files_beside(arguments.in, *scene));
    if (!lost) throw std::runtime_error(lost.error());
    std::vector<std::string> notices = scene->notices();
    notices.insert(notices.end(), lost->begin(), lost->end());
    return notices;
}

}  // namespace

void convert_command(const ConvertArguments& arguments) {
    if (!io::has_writer(arguments.out))
        throw std::invalid_argument(arguments.out.string() +
                                    ": the name of a converted scene ends in one of " +
                                    io::written_extensions());
    std::error_code error;
    if (std::filesystem::equivalent(arguments.in, arguments.out, error))
        throw std::invalid_argument(arguments.out.string() + ": a scene is not converted into its own file");
    for (const std::string& notice : convert(arguments)) std::cerr << notice << "\n";
}

}  // namespace vrut::server::commands
