#include <stdexcept>

#include "commands.hpp"

namespace vrut {

std::filesystem::path default_scene() {
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
    const std::filesystem::path installed = program.parent_path().parent_path() / "share/vrut-preview/scenes";
    for (const std::filesystem::path& folder : {installed, std::filesystem::path(VRUT_SOURCE_SCENES)}) {
        std::filesystem::path car = folder / "car/car.vrut";
        if (std::filesystem::exists(car)) return car;
    }
    throw std::runtime_error("the car is neither in " + installed.string() +
                             " nor in " VRUT_SOURCE_SCENES "; name a scene to serve");
}

}  // namespace vrut
