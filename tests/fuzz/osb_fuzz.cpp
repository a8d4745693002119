#include <cstdint>

#include "io/osb/scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    auto parts = vrut::io::read_osb_parts({reinterpret_cast<const char*>(data), size}, "fuzz.osb");
    if (!parts) return 0;
    auto scene = vrut::io::build_scene(*std::move(parts), "fuzz.osb");
    if (scene) vrut::scene::place(*std::move(scene));
    return 0;
}
