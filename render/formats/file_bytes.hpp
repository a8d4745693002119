#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <tl/expected.hpp>

namespace vrut {

/// Why a path names no file that could be read, without its name; nothing where it names one.
std::optional<std::string> file_fault(const std::filesystem::path& path);

/// A whole file, or why it cannot be read, without its name. Files of more than `most` bytes are refused.
tl::expected<std::string, std::string> read_bytes(const std::filesystem::path& path,
                                                  std::uintmax_t most = UINTMAX_MAX);

}  // namespace vrut
