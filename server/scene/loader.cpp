#include "scene/loader.hpp"

#include "base/clock.hpp"
#include "scene/level_store.hpp"
#include "scene/library.hpp"

namespace vrut::server::scene {

namespace {

struct Closing {};

}  // namespace

SceneLoader::~SceneLoader() {
    closing_ = true;
    finish();
}

void SceneLoader::start(const std::filesystem::path& path, const std::string& name,
                        const std::string& renderer, const std::optional<ImportLimits>& limits) {
    finish();
    thread_ = std::thread([this, path, name, renderer, limits] {
        constexpr std::chrono::milliseconds kBetweenReports{100};
        base::Clock::time_point last = base::Clock::now();
        const auto progress = [&](double fraction) {
            if (closing_) throw Closing();
            if (base::Clock::now() - last < kBetweenReports) return;
            last = base::Clock::now();
            on_progress_({name, fraction});
        };
        try {
            auto scene = load_scene(path, name, progress, limits);
            protocol::LevelTable levels;
            if (scene) levels = levels_of(scene->sha256, renderer);
            on_loaded_({name, std::move(scene), std::move(levels)});
        } catch (const Closing&) {
        } catch (const std::exception& error) {
            on_loaded_({name, tl::unexpected(std::string(error.what()))});
        }
    });
    busy_ = true;
}

void SceneLoader::finish() {
    if (thread_.joinable()) thread_.join();
    busy_ = false;
}

}  // namespace vrut::server::scene
