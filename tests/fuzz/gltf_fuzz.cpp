#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <string_view>

#include "io/gltf/reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto path =
        std::filesystem::temp_directory_path() / ("vrut-fuzz-" + std::to_string(getpid()) + ".gltf");
    std::ofstream(path, std::ios::binary) << std::string_view(reinterpret_cast<const char*>(data), size);
    auto parts = vrut::io::read_gltf_scene(path);
    auto scene =
        parts ? vrut::io::build_scene(*std::move(parts), "fuzz.gltf") : tl::unexpected(parts.error());
    if (scene) vrut::scene::place(*std::move(scene));
    std::filesystem::remove(path);
    return 0;
}
