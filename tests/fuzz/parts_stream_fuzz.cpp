#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "io/scene_serialization.hpp"

namespace {

struct Ended {};

vrut::io::PartsResult read(std::string_view bytes) {
    const auto source = [&](void* to, std::size_t size) {
        if (size > bytes.size()) throw Ended();
        bytes.copy(static_cast<char*>(to), size);
        bytes.remove_prefix(size);
    };
    return vrut::io::deserialize_parts(source, 1 << 20, "fuzz.glb");
}

}  // namespace

/// What could be read is, written again, as long as before.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) try {
    auto parts = read({reinterpret_cast<const char*>(data), size});
    if (!parts) return 0;
    std::size_t written = 0;
    vrut::io::serialize_parts(*parts, [&](std::string_view piece) { written += piece.size(); });
    if (written > size) throw std::logic_error("longer than it was");
    if (auto scene = vrut::io::build_scene(*std::move(parts), "fuzz.glb"))
        vrut::scene::place(*std::move(scene));
    return 0;
} catch (const Ended&) {
    return 0;
}
