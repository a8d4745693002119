#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <tl/expected.hpp>

#include "scene_state.hpp"

namespace vrut {

/// Reads a scene file; `name` is by which it was asked for. Or one sentence on what is wrong.
tl::expected<LoadedScene, std::string> load_scene(const std::filesystem::path& path, const std::string& name,
                                                  const std::function<void(double)>& progress = {});

/// The folder of scenes that clients may open.
class SceneLibrary {
public:
    /// Without a folder there are none.
    SceneLibrary() = default;
    explicit SceneLibrary(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// The file of this name, which may lie in a folder below, but nowhere else; or why there is none.
    tl::expected<std::filesystem::path, std::string> find(const std::string& name) const;

private:
    std::filesystem::path folder_;
};

/// SHA-256 of a file in hexadecimal. Throws std::runtime_error.
std::string sha256_of(const std::filesystem::path& path);

}  // namespace vrut
