#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <string_view>

#include "../assimp_leaks.hpp"
#include "io/assimp/scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    // By its ending assimp takes a file for text or binary.
    const auto path =
        std::filesystem::temp_directory_path() /
        ("vrut-fuzz-" + std::to_string(getpid()) + (bytes.starts_with("glTF") ? ".glb" : ".gltf"));
    std::ofstream(path, std::ios::binary) << bytes;
    auto parts = vrut::io::read_assimp_scene(path, vrut::io::AssimpFormat::gltf);
    auto scene =
        parts ? vrut::io::build_scene(*std::move(parts), "fuzz.gltf") : tl::unexpected(parts.error());
    if (scene) vrut::scene::place(*std::move(scene));
    std::filesystem::remove(path);
    return 0;
}
