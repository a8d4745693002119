#pragma once

#include <filesystem>
#include <fstream>

#include "room/replay.hpp"

/// The recorded session in a file, or why it cannot be read.
inline tl::expected<vrut::server::room::EventLog, std::string> log_in(const std::filesystem::path& path) {
    return vrut::server::room::read_event_log(std::ifstream(path, std::ios::binary), path.string());
}
