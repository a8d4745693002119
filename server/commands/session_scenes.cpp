#include "commands/session_scenes.hpp"

#include <utility>

#include "commands/commands.hpp"
#include "observe/log.hpp"
#include "observe/progress.hpp"

namespace vrut::server::commands {

namespace fs = std::filesystem;

SessionScenes::SessionScenes(const fs::path& log, fs::path given, const io::ReadOptions& read)
    : given_(std::move(given)), options_{{}, read} {
    const fs::path beside = log.parent_path();
    folders_ = {given_.parent_path(), given_.parent_path() / "..", beside, beside / "..", fs::path()};
    for (const fs::path& own : scene_folders()) {
        folders_.push_back(own);
        folders_.push_back(own / "car");
    }
}

tl::expected<scenes::LoadedScene, std::string> SessionScenes::find(const std::string& name,
                                                                   const std::string& sha256,
                                                                   std::optional<protocol::UpAxis> up_axis) {
    scenes::ImportOptions options = options_;
    if (up_axis) options.read.z_up = *up_axis == protocol::UpAxis::z;
    if (fs::path given = std::exchange(given_, {}); !given.empty()) {
        auto scene = scenes::load_scene(given, name, observe::loading_bar(name), options);
        if (scene && scene->sha256 != sha256)
            observe::log_warning("another_scene", {{"file", given.string()},
                                                   {"reason", "it is not the scene that was recorded"}});
        return scene;
    }
    bool found = false;
    for (const fs::path& folder : folders_) {
        const fs::path file = folder / name;
        if (!fs::is_regular_file(file)) continue;
        found = true;
        if (scenes::sha256_of(file) == sha256)
            return scenes::load_scene(file, name, observe::loading_bar(name), options);
    }
    return tl::unexpected("the scene '" + name + "' " +
                          (found ? "has changed since it was recorded" : "is not found") +
                          "; name it with --scene");
}

}  // namespace vrut::server::commands
