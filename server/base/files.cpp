#include "base/files.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace vrut::server::base {

void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) throw std::runtime_error(path.string() + " cannot be written: " + std::strerror(errno));
}

}  // namespace vrut::server::base
