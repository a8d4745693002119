#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace vrut::server::base {

/// Writes a whole file. Throws std::runtime_error with a sentence that names it.
void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

}  // namespace vrut::server::base
