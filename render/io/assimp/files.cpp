#include "io/assimp/files.hpp"

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <fstream>
#include <memory>

#include "base/file_bytes.hpp"
#include "io/foreign_paths.hpp"
#include "io/vrut/tokenizer.hpp"

namespace vrut::io {

namespace {

/// A file, read only.
class FileStream : public Assimp::IOStream {
public:
    FileStream(const std::filesystem::path& path, FileReplacement replacement)
        : stream_(path, std::ios::binary), replacement_(std::move(replacement)) {
        std::error_code error;
        const std::uintmax_t size = std::filesystem::file_size(path, error);
        if (!error) size_ = static_cast<std::size_t>(size);
    }
    bool good() const { return stream_.good(); }

    std::size_t Read(void* out, std::size_t size, std::size_t count) override {
        if (size == 0) return 0;
        const std::size_t items = std::min(count, (size_ - position_) / size);
        stream_.seekg(static_cast<std::streamoff>(position_));
        stream_.read(static_cast<char*>(out), static_cast<std::streamsize>(items * size));
        const auto read = static_cast<std::size_t>(stream_.gcount());
        stream_.clear();
        const auto& [place, bytes] = replacement_;
        for (std::size_t i = 0; i < bytes.size(); ++i)
            if (place + i >= position_ && place + i < position_ + read)
                static_cast<char*>(out)[place + i - position_] = bytes[i];
        position_ += read;
        return read / size;
    }
    std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
    aiReturn Seek(std::size_t offset, aiOrigin origin) override {
        const std::size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? position_ : size_;
        if (offset > size_ - base) return aiReturn_FAILURE;
        position_ = base + offset;
        return aiReturn_SUCCESS;
    }
    std::size_t Tell() const override { return position_; }
    std::size_t FileSize() const override { return size_; }
    void Flush() override {}

private:
    std::ifstream stream_;
    FileReplacement replacement_;
    std::size_t size_ = 0, position_ = 0;
};

}  // namespace

SceneFiles::SceneFiles(std::filesystem::path scene_file)
    : scene_file_(std::move(scene_file)), main_name_(scene_file_.filename().string()) {}

void SceneFiles::replace(std::uint64_t place, std::string bytes) { replacement_ = {place, std::move(bytes)}; }

tl::expected<std::filesystem::path, std::string> SceneFiles::find(const std::string& name) const {
    if (name == main_name_) return scene_file_;
    const auto folder = scene_file_.parent_path();
    return base::find_below(folder, file_name_of_uri(folder, name));
}

bool SceneFiles::Exists(const char* name) const { return find(name).has_value(); }

Assimp::IOStream* SceneFiles::Open(const char* name, const char* /*mode*/) {
    const auto file = find(name);
    const FileReplacement replacement = name == main_name_ ? replacement_ : FileReplacement();
    auto stream =
        file && !base::file_error(*file) ? std::make_unique<FileStream>(*file, replacement) : nullptr;
    if (stream && stream->good()) return stream.release();
    // assimp looks again under names that it makes up from the first.
    if (rejection_.empty())
        rejection_ = "'" + excerpt(name) +
                     "': " + (!file ? file.error() : base::file_error(*file).value_or("it cannot be opened"));
    return nullptr;
}

void SceneFiles::Close(Assimp::IOStream* stream) { delete stream; }

}  // namespace vrut::io
