#include <cstdint>

#include "vrut_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    auto scene = vrut::read_vrut_text({reinterpret_cast<const char*>(data), size}, "fuzz.vrut");
    if (scene) vrut::place(*std::move(scene));
    return 0;
}
