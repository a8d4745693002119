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

/// The kept up axis of a file whose format does not define it.
std::optional<protocol::UpAxis> kept_up_axis(const std::filesystem::path& path,
                                             const io::ReadProgress& progress) {
    constexpr std::chrono::milliseconds kBetweenPolls{50};
    std::error_code error;
    if (!io::lacks_up_axis(path) || !std::filesystem::is_regular_file(path, error)) return std::nullopt;
    base::AbandonableTask<std::string> sum(
        [path](const std::stop_token& stop) { return sha256_of(path, stop); });
    while (!sum.is_done_within(kBetweenPolls))
        if (progress) progress(0);
    return stored_up_axis(sum.get());
}

/// Throws what `progress` throws, unless it is a std::exception.
SceneLoaded load(const std::filesystem::path& path, const protocol::Open& asked, const std::string& renderer,
                 const io::ReadProgress& progress, const ImportOptions& options) try {
    SceneLoaded loaded{asked.scene, load_kept_scene(path, asked.scene, progress, options, asked.up_axis)};
    progress(1);
    if (!loaded.scene) return loaded;
    loaded.levels = levels_of(loaded.scene->sha256, renderer);
    return loaded;
} catch (const std::exception& error) {
    return {asked.scene, tl::unexpected(std::string(error.what()))};
}

}  // namespace

tl::expected<LoadedScene, std::string> load_kept_scene(const std::filesystem::path& path,
                                                       const std::string& name,
                                                       const io::ReadProgress& progress,
                                                       ImportOptions options,
                                                       std::optional<protocol::UpAxis> chosen) {
    if (const auto axis = chosen ? chosen : kept_up_axis(path, progress))
        options.read.z_up = *axis == protocol::UpAxis::z;
    auto scene = load_scene(path, name, progress, options);
    if (!scene) return scene;
    if (chosen) store_up_axis(scene->sha256, *chosen);
    if (auto changes = stored_changes(scene->changes_key()))
        scene->changes = *std::move(changes);
    else
        scene->changes_fault = std::move(changes.error());
    return scene;
}

SceneLoader::SceneLoader(std::function<void(SceneLoading)> on_progress,
                         std::function<void(SceneLoaded)> on_loaded)
    : listener_(std::make_shared<Listener>()) {
    listener_->on_progress = std::move(on_progress);
    listener_->on_loaded = std::move(on_loaded);
}

SceneLoader::~SceneLoader() { listener_->close(); }

void SceneLoader::start(const std::filesystem::path& path, const protocol::Open& asked,
                        const std::string& renderer, const ImportOptions& options) {
    task_.emplace([path, asked, renderer, options, listener = listener_](const std::stop_token& stop) {
        const auto report = [listener](SceneLoading loading) { listener->report(std::move(loading)); };
        listener->report(load(path, asked, renderer, progress_of(asked.scene, report, stop), options));
    });
}

}  // namespace vrut::server::scenes
