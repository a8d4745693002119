#pragma once

#include <assimp/IOSystem.hpp>
#include <filesystem>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace vrut::io {

/// What a file in the folder or below it is called that an address names: as the address writes it, or else,
/// where there is none by that name, without codes such as `%20` for a space.
std::string file_name_of_uri(const std::filesystem::path& folder, const std::string& address);

/// The same of formats that keep the paths of the machine where the file was made, with `\` between folders:
/// where there is no such file, the one of that name beside the scene's.
std::string file_name_of_foreign_path(const std::filesystem::path& folder, const std::string& address);

/// What assimp may open of the disk: one scene's file, by the name main_name(), and what lies in its folder
/// or below it, links followed.
class SceneFiles : public Assimp::IOSystem {
public:
    /// assimp reads `head` in place of as many bytes at the file's beginning.
    SceneFiles(std::filesystem::path scene_file, std::string head);

    /// What the scene's file is called towards assimp: its ending chooses the importer.
    const std::string& main_name() const { return main_name_; }
    /// Of the first file that was asked for and not given out, why; empty where there was none.
    const std::string& rejection() const { return rejection_; }

    bool Exists(const char* name) const override;
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* name, const char* mode) override;
    void Close(Assimp::IOStream* stream) override;

private:
    tl::expected<std::filesystem::path, std::string> find(const std::string& name) const;

    std::filesystem::path scene_file_;
    std::string head_;
    std::string main_name_;
    std::string rejection_;
};

}  // namespace vrut::io
