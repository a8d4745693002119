#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <tl/expected.hpp>

namespace vrut::server::scenes {

/// Where the program keeps what survives a restart: the folder vrut-preview in $XDG_STATE_HOME, else in
/// ~/.local/state. Empty where neither is an absolute path.
std::filesystem::path state_folder();

/// Writes a file in it, whole or not at all, and makes the folders above. Throws std::runtime_error with a
/// sentence. From any thread.
void write_state_file(const std::filesystem::path& path, const std::string& text);

/// The text of a file of at most so many bytes, or in words that end a sentence why it cannot be read.
tl::expected<std::string, std::string> read_state_file(const std::filesystem::path& path,
                                                       std::uintmax_t most_bytes);

}  // namespace vrut::server::scenes
