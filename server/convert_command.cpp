#include <unistd.h>

#include <iostream>
#include <optional>
#include <stdexcept>

#include "commands.hpp"
#include "import_process.hpp"
#include "progress.hpp"
#include "write_scene.hpp"

namespace vrut {

namespace {

/// Shows a part of the work as it goes on; off a terminal nothing does.
std::function<void(double)> shown(std::optional<Progress>& bar, double from, double to,
                                  const std::string& what) {
    if (!bar) return {};
    return [&bar, from, to, what](double part) { bar->show(from + (to - from) * part, what); };
}

std::vector<std::string> convert(const ConvertArguments& arguments) {
    std::optional<Progress> bar;
    if (isatty(STDERR_FILENO) == 1) bar.emplace();
    const auto scene =
        import_scene(arguments.in, shown(bar, 0, 0.6, "reading " + arguments.in.filename().string()));
    if (!scene) throw std::runtime_error(scene.error());
    auto lost = write_scene(*scene, arguments.out,
                            shown(bar, 0.6, 1, "writing " + arguments.out.filename().string()));
    if (!lost) throw std::runtime_error(lost.error());
    std::vector<std::string> told = scene->notices();
    told.insert(told.end(), lost->begin(), lost->end());
    return told;
}

}  // namespace

void convert_command(const ConvertArguments& arguments) {
    if (!has_writer(arguments.out))
        throw std::invalid_argument(arguments.out.string() + ": a converted scene's name ends in one of " +
                                    written_extensions());
    std::error_code error;
    if (std::filesystem::equivalent(arguments.in, arguments.out, error))
        throw std::invalid_argument(arguments.out.string() + ": a scene is not converted into its own file");
    for (const std::string& notice : convert(arguments)) std::cerr << notice << "\n";
}

}  // namespace vrut
