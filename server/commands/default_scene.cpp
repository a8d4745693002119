#include <stdexcept>

#include "commands/commands.hpp"

namespace vrut::server::commands {

std::vector<std::filesystem::path> scene_folders() {
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
    const std::filesystem::path prefix = program.parent_path().parent_path();
    return {prefix / "share/vrut-preview/scenes", prefix / "scenes"};
}

std::filesystem::path default_scene() {
    std::string looked_in;
    for (const std::filesystem::path& folder : scene_folders()) {
        std::filesystem::path car = folder / "car/car.vrut";
        if (std::filesystem::exists(car)) return car;
        looked_in += (looked_in.empty() ? "" : " nor in ") + folder.string();
    }
    throw std::runtime_error("the car is neither in " + looked_in + "; name a scene to serve");
}

}  // namespace vrut::server::commands
