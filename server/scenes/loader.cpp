#include "scenes/loader.hpp"

#include <mutex>
#include <utility>

#include "base/clock.hpp"
#include "scenes/change_store.hpp"
#include "scenes/level_store.hpp"

namespace vrut::server::scenes {

namespace {

struct Closing {};

}  // namespace

/// Shared with the thread, which may outlive the loader.
struct SceneLoader::Listener {
    std::mutex mutex;
    std::function<void(SceneLoading)> on_progress;
    std::function<void(SceneLoaded)> on_loaded;

    void report(SceneLoading loading) {
        const std::lock_guard lock(mutex);
        if (on_progress) on_progress(std::move(loading));
    }
    void report(SceneLoaded loaded) {
        const std::lock_guard lock(mutex);
        if (on_loaded) on_loaded(std::move(loaded));
    }
    void close() {
        const std::lock_guard lock(mutex);
        on_progress = nullptr;
        on_loaded = nullptr;
    }
};

namespace {

/// Reports how far the reading is, until it is given up.
io::ReadProgress progress_of(const std::string& name, std::function<void(SceneLoading)> report,
                             const std::stop_token& stop) {
    return [name, report = std::move(report), stop, last = base::Clock::now()](double fraction) mutable {
        constexpr std::chrono::milliseconds kBetweenReports{100};
        if (stop.stop_requested()) throw Closing();
        if (base::Clock::now() - last < kBetweenReports) return;
        last = base::Clock::now();
        report({name, fraction});
    };
}

/// Throws what `progress` throws, unless it is a std::exception.
SceneLoaded load(const std::filesystem::path& path, const std::string& name, const std::string& renderer,
                 const io::ReadProgress& progress, const ImportOptions& options) try {
    SceneLoaded loaded{name, load_scene(path, name, progress, options)};
    progress(1);
    if (!loaded.scene) return loaded;
    loaded.levels = levels_of(loaded.scene->sha256, renderer);
    loaded.scene->changes = stored_changes(loaded.scene->sha256);
    return loaded;
} catch (const std::exception& error) {
    return {name, tl::unexpected(std::string(error.what()))};
}

}  // namespace

SceneLoader::SceneLoader(std::function<void(SceneLoading)> on_progress,
                         std::function<void(SceneLoaded)> on_loaded)
    : listener_(std::make_shared<Listener>()) {
    listener_->on_progress = std::move(on_progress);
    listener_->on_loaded = std::move(on_loaded);
}

SceneLoader::~SceneLoader() { listener_->close(); }

void SceneLoader::start(const std::filesystem::path& path, const std::string& name,
                        const std::string& renderer, const ImportOptions& options) {
    task_.emplace([path, name, renderer, options, listener = listener_](const std::stop_token& stop) {
        const auto report = [listener](SceneLoading loading) { listener->report(std::move(loading)); };
        listener->report(load(path, name, renderer, progress_of(name, report, stop), options));
    });
}

}  // namespace vrut::server::scenes
