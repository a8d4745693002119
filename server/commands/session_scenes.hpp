#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "scenes/library.hpp"

namespace vrut::server::commands {

/// Scenes of a recorded session: the one that was named, else files of their names beside that, beside the
/// log, in the folder above it, among the program's scenes or here, with the same content.
class SessionScenes {
public:
    /// `given` may be empty.
    SessionScenes(const std::filesystem::path& log, std::filesystem::path given, const io::ReadOptions& read);

    /// As room::SceneFinder.
    tl::expected<scenes::LoadedScene, std::string> find(const std::string& name, const std::string& sha256,
                                                        std::optional<protocol::UpAxis> up_axis);

private:
    std::filesystem::path given_;  // for the first
    std::vector<std::filesystem::path> folders_;
    const scenes::ImportOptions options_;
};

}  // namespace vrut::server::commands
