#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "base/abandonable_task.hpp"
#include "level_table.hpp"
#include "scenes/library.hpp"
#include "scenes/loaded_scene.hpp"

namespace vrut::server::scenes {

/// As load_scene(), with what is kept of the scene: its changes, and the axis that was chosen for up, which
/// counts before that of `options`. `chosen` counts before both, and is kept.
tl::expected<LoadedScene, std::string> load_kept_scene(const std::filesystem::path& path,
                                                       const std::string& name,
                                                       const io::ReadProgress& progress,
                                                       ImportOptions options,
                                                       std::optional<protocol::UpAxis> chosen = {});

struct SceneLoading {
    std::string name;
    double fraction = 0;
};

struct SceneLoaded {
    std::string name;
    tl::expected<LoadedScene, std::string> scene;  ///< or why it is rejected
    protocol::LevelTable levels = {};              ///< of the scene on this machine
};

/// Reads one scene at a time on a thread of its own, which is left behind where it hangs on a disk.
class SceneLoader {
public:
    /// Both are called on that thread, and not after the destructor has begun: `on_progress` at most ten
    /// times a second, `on_loaded` once at the end.
    SceneLoader(std::function<void(SceneLoading)> on_progress, std::function<void(SceneLoaded)> on_loaded);
    ~SceneLoader();
    SceneLoader(const SceneLoader&) = delete;
    SceneLoader& operator=(const SceneLoader&) = delete;

    /// From start() until finish().
    bool busy() const { return task_.has_value(); }
    /// Reads a scene as load_kept_scene() does, and the levels that are kept for `renderer`; not while
    /// busy(). Throws std::system_error where no thread can be had.
    void start(const std::filesystem::path& path, const protocol::Open& asked, const std::string& renderer,
               const ImportOptions& options);
    /// To be called after `on_loaded`.
    void finish() { task_.reset(); }
    /// Asks for the end of the reading; the destructor waits the less for it.
    void stop() {
        if (task_) task_->stop();
    }

private:
    struct Listener;

    std::shared_ptr<Listener> listener_;
    std::optional<base::AbandonableTask<void>> task_;
};

}  // namespace vrut::server::scenes
