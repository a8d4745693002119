#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>

#include "io/assimp/ply_check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto path =
        std::filesystem::temp_directory_path() / ("vrut-fuzz-" + std::to_string(getpid()) + ".ply");
    std::ofstream(path, std::ios::binary) << std::string_view(reinterpret_cast<const char*>(data), size);
    const auto checked = vrut::io::check_ply(path);
    if (!checked && (checked.error().empty() || checked.error().find('\n') != std::string::npos))
        throw std::logic_error("not one sentence");
    std::filesystem::remove(path);
    return 0;
}
