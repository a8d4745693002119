#pragma once

#include <filesystem>
#include <stop_token>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "messages.hpp"
#include "scenes/import_process.hpp"
#include "scenes/loaded_scene.hpp"

namespace vrut::server::scenes {

/// Reads a scene file in a process of its own (import_scene()), or fails with one sentence. `name` is the
/// name that the client asked for.
tl::expected<LoadedScene, std::string> load_scene(const std::filesystem::path& path, const std::string& name,
                                                  const io::ReadProgress& progress = {},
                                                  const ImportOptions& options = {});

/// The scenes that clients may open: those in a folder, and the one that the server starts with, wherever it
/// lies.
class SceneLibrary {
public:
    /// There are none.
    SceneLibrary() = default;
    /// An empty path: no folder, or no start scene.
    explicit SceneLibrary(std::filesystem::path folder, ImportOptions options = {},
                          std::filesystem::path start = {});

    /// The start scene's: its path in the folder, else its file's name, with the name of the folder above
    /// where the folder of scenes has another of that name.
    const std::string& start_name() const { return start_name_; }

    /// Of reading each of its scenes.
    const ImportOptions& options() const { return options_; }

    /// The file of this name, which may lie in a folder below, but nowhere else, or is the start scene; or
    /// why there is none.
    tl::expected<std::filesystem::path, std::string> find(const std::string& name) const;

    static constexpr std::size_t kMostNames = protocol::kMaxScenes, kMostEntries = 10'000;
    /// Names of scene files that find() finds, by their endings, sorted, at most kMostNames. In a folder of
    /// more than kMostEntries entries, folders below counted, some may be missing. Folders behind links are
    /// not looked into, and what cannot be read is passed over.
    std::vector<std::string> names() const;

private:
    tl::expected<std::filesystem::path, std::string> find_in_folder(const std::string& name) const;
    bool leads_to_scene(const std::string& link) const;
    std::vector<std::string> names_in_folder() const;

    std::filesystem::path folder_, start_;
    std::string start_name_;
    ImportOptions options_;
};

/// SHA-256 of a file in hexadecimal. Throws std::runtime_error, also where it is asked to stop.
std::string sha256_of(const std::filesystem::path& path, const std::stop_token& stop = {});
std::string sha256_of_text(std::string_view text);
/// Of all that a scene shows, its images among it: the same wherever its files lie.
std::string sha256_of_scene(const scene::Scene& scene);

}  // namespace vrut::server::scenes
