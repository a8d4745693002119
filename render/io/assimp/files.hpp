#pragma once

#include <assimp/IOSystem.hpp>
#include <filesystem>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace vrut::io {

/// Returns the name of the file that a URI refers to, in the folder or below: the URI as written if there is
/// such a file, else with percent-encoding decoded (`%20` is a space).
std::string file_name_of_uri(const std::filesystem::path& folder, const std::string& address);

/// The same for paths of the machine that wrote the file, which may have `\` between folders and blanks or a
/// carriage return behind them: if there is no such file, the one of that name beside the scene's, or else in
/// `textures/` there.
std::string file_name_of_foreign_path(const std::filesystem::path& folder, const std::string& address);

/// The files that assimp may open: the scene's file, by the name main_name(), and files in its folder or
/// below, symbolic links resolved.
class SceneFiles : public Assimp::IOSystem {
public:
    /// assimp reads `head` instead of the file's first bytes, as many as it has.
    SceneFiles(std::filesystem::path scene_file, std::string head);

    /// The name of the scene's file for assimp, which chooses the importer by its extension.
    const std::string& main_name() const { return main_name_; }
    /// Why the first file that assimp could not open was rejected; empty if there was none.
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
