#pragma once

#include <filesystem>
#include <string>

#include "room/replay.hpp"

namespace vrut::test {

/// The session that VRUT_LOG names, of tests/data/logs.
std::string session_name();
/// NAME and `ending` in the folder of the logs.
std::filesystem::path session_file(const std::string& ending);
server::room::EventLog read_session();
/// The scenes that the logs were recorded with, of tests/data/scenes.
tl::expected<server::scenes::LoadedScene, std::string> find_scene(const std::string& name,
                                                                  const std::string& sha256,
                                                                  std::optional<protocol::UpAxis> = {});

}  // namespace vrut::test
