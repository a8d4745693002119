#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <tl/expected.hpp>

namespace vrut {

/// Why a path names no file that could be read, without its name; nothing where it names one.
std::optional<std::string> file_fault(const std::filesystem::path& path);

/// The file that `name`, relative to a scene's folder, means there or below, links followed; or why it is
/// none that may be read: what lies outside of the folder is not.
tl::expected<std::filesystem::path, std::string> find_below(const std::filesystem::path& folder,
                                                            const std::string& name);

/// A whole file, or why it cannot be read, without its name. Files of more than `most` bytes are refused.
tl::expected<std::string, std::string> read_bytes(const std::filesystem::path& path,
                                                  std::uintmax_t most = UINTMAX_MAX);

}  // namespace vrut
