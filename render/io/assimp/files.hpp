#pragma once

#include <assimp/IOSystem.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <tl/expected.hpp>

namespace vrut::io {

/// Bytes that take the place of others in a file.
struct FileReplacement {
    std::uint64_t place = 0;
    std::string bytes;
};

/// The files that assimp may open: the scene's file, by the name main_name(), and files in its folder or
/// below, symbolic links resolved.
class SceneFiles : public Assimp::IOSystem {
public:
    explicit SceneFiles(std::filesystem::path scene_file);
    /// The scene's file is read as if these bytes stood there.
    void replace(std::uint64_t place, std::string bytes);

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
    FileReplacement replacement_;
    std::string main_name_;
    std::string rejection_;
};

}  // namespace vrut::io
