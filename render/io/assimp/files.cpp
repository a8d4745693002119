#include "io/assimp/files.hpp"

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <fstream>
#include <memory>

#include "base/file_bytes.hpp"
#include "io/vrut/tokenizer.hpp"

namespace vrut::io {

namespace {

/// A file, read only, with `head` in place of its first bytes.
class FileStream : public Assimp::IOStream {
public:
    FileStream(const std::filesystem::path& path, std::string_view head)
        : stream_(path, std::ios::binary), head_(head) {
        std::error_code error;
        const std::uintmax_t size = std::filesystem::file_size(path, error);
        if (!error) size_ = static_cast<std::size_t>(size);
    }
    bool good() const { return stream_.good(); }

    std::size_t Read(void* out, std::size_t size, std::size_t count) override {
        if (size == 0) return 0;
        const std::size_t items = std::min(count, (size_ - position_) / size);
        char* const bytes = static_cast<char*>(out);
        const std::size_t from_head = head_.copy(bytes, items * size, std::min(position_, head_.size()));
        stream_.seekg(static_cast<std::streamoff>(position_ + from_head));
        stream_.read(bytes + from_head, static_cast<std::streamsize>(items * size - from_head));
        const std::size_t read = from_head + static_cast<std::size_t>(stream_.gcount());
        stream_.clear();
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
    std::string_view head_;
    std::size_t size_ = 0, position_ = 0;
};

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

/// `%20` for a space, and so on.
std::string without_percent_codes(std::string_view uri) {
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const int high = uri[i] == '%' && i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
        const int low = high >= 0 ? hex_digit(uri[i + 2]) : -1;
        if (low < 0) {
            name += uri[i];
            continue;
        }
        name += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return name;
}

}  // namespace

std::string file_name_of_uri(const std::filesystem::path& folder, const std::string& address) {
    return base::find_below(folder, address) ? address : without_percent_codes(address);
}

std::string file_name_of_foreign_path(const std::filesystem::path& folder, const std::string& address) {
    std::string name = file_name_of_uri(folder, address);
    if (base::find_below(folder, name)) return name;
    name = file_name_of_uri(folder, address.substr(0, address.find_last_not_of(" \t\r\n") + 1));
    if (base::find_below(folder, name)) return name;
    std::replace(name.begin(), name.end(), '\\', '/');
    if (base::find_below(folder, name)) return name;
    const std::string last = name.substr(name.rfind('/') + 1);
    for (const std::string& found : {last, "textures/" + last})
        if (base::find_below(folder, found)) return found;
    return name;
}

SceneFiles::SceneFiles(std::filesystem::path scene_file, std::string head)
    : scene_file_(std::move(scene_file)),
      head_(std::move(head)),
      main_name_(scene_file_.filename().string()) {}

tl::expected<std::filesystem::path, std::string> SceneFiles::find(const std::string& name) const {
    if (name == main_name_) return scene_file_;
    const auto folder = scene_file_.parent_path();
    return base::find_below(folder, file_name_of_uri(folder, name));
}

bool SceneFiles::Exists(const char* name) const { return find(name).has_value(); }

Assimp::IOStream* SceneFiles::Open(const char* name, const char* /*mode*/) {
    const auto file = find(name);
    auto stream = file && !base::file_error(*file)
                      ? std::make_unique<FileStream>(*file, name == main_name_ ? head_ : std::string_view())
                      : nullptr;
    if (stream && stream->good()) return stream.release();
    // assimp looks again under names that it makes up from the first.
    if (rejection_.empty())
        rejection_ = "'" + excerpt(name) +
                     "': " + (!file ? file.error() : base::file_error(*file).value_or("it cannot be opened"));
    return nullptr;
}

void SceneFiles::Close(Assimp::IOStream* stream) { delete stream; }

}  // namespace vrut::io
