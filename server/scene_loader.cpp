#include "scene_loader.hpp"

#include "scene_library.hpp"

namespace vrut {

namespace {

struct Closing {};

}  // namespace

SceneLoader::~SceneLoader() {
    closing_ = true;
    finish();
}

void SceneLoader::start(const std::filesystem::path& path, const std::string& name) {
    finish();
    busy_ = true;
    thread_ = std::thread([this, path, name] {
        constexpr std::chrono::milliseconds kBetweenReports{100};
        Clock::time_point last = Clock::now();
        const auto progress = [&](double fraction) {
            if (closing_) throw Closing();
            if (Clock::now() - last < kBetweenReports) return;
            last = Clock::now();
            mailbox_.push(SceneLoading{name, fraction});
        };
        try {
            mailbox_.push(SceneLoaded{name, load_scene(path, name, progress)});
        } catch (const Closing&) {
        } catch (const std::exception& error) {
            mailbox_.push(SceneLoaded{name, tl::unexpected(std::string(error.what()))});
        }
    });
}

void SceneLoader::finish() {
    if (thread_.joinable()) thread_.join();
    busy_ = false;
}

}  // namespace vrut
