#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <tl/expected.hpp>

#include "level_table.hpp"
#include "scene/import_process.hpp"
#include "scene/loaded_scene.hpp"

namespace vrut::server::scene {

struct SceneLoading {
    std::string name;
    double fraction = 0;
};

struct SceneLoaded {
    std::string name;
    tl::expected<LoadedScene, std::string> scene;  ///< or why it is refused
    protocol::LevelTable levels = {};              ///< of the scene on this machine
};

/// Reads one scene at a time on a thread of its own.
class SceneLoader {
public:
    /// Both are called on that thread: `on_progress` at most ten times a second, `on_loaded` once at the end.
    SceneLoader(std::function<void(SceneLoading)> on_progress, std::function<void(SceneLoaded)> on_loaded)
        : on_progress_(std::move(on_progress)), on_loaded_(std::move(on_loaded)) {}
    ~SceneLoader();

    /// From start() until finish().
    bool busy() const { return busy_; }
    /// Reads also the levels that are kept for `renderer`. Throws std::system_error where no thread can be
    /// had.
    void start(const std::filesystem::path& path, const std::string& name, const std::string& renderer,
               const std::optional<ImportLimits>& limits);
    /// To be called after `on_loaded`.
    void finish();

private:
    std::function<void(SceneLoading)> on_progress_;
    std::function<void(SceneLoaded)> on_loaded_;
    bool busy_ = false;
    std::atomic<bool> closing_{false};
    std::thread thread_;
};

}  // namespace vrut::server::scene
