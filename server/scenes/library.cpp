#include "scenes/library.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <deque>
#include <fstream>
#include <memory>
#include <new>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "base/abandonable_task.hpp"
#include "base/utf8.hpp"
#include "io/vrut/text_writer.hpp"

namespace vrut::server::scenes {

namespace fs = std::filesystem;

namespace {

/// Clients see the scene's name, and not where its file lies.
std::vector<protocol::Notice> with_name(std::vector<protocol::Notice> notices, const std::string& path,
                                        const std::string& name) {
    for (protocol::Notice& notice : notices)
        if (notice.message.starts_with(path)) notice.message.replace(0, path.size(), name);
    return notices;
}

}  // namespace

tl::expected<LoadedScene, std::string> load_scene(const fs::path& path, const std::string& name,
                                                  const io::ReadProgress& progress,
                                                  const ImportOptions& options) try {
    constexpr std::chrono::milliseconds kBetweenPolls{50};
    base::AbandonableTask<std::string> sum(
        [path](const std::stop_token& stop) { return sha256_of(path, stop); });  // while the file is read
    auto scene = import_scene(path, progress, options);
    if (!scene) return tl::unexpected(scene.error());
    do {
        if (progress) progress(1);
    } while (!sum.is_done_within(kBetweenPolls));
    LoadedScene loaded;
    loaded.name = name;
    loaded.sha256 = sum.get();
    if (io::lacks_up_axis(path))
        loaded.up_axis = options.read.z_up ? protocol::UpAxis::z : protocol::UpAxis::y;
    if (progress) progress(1);
    loaded.placed = std::make_shared<const scene::PlacedScene>(scene::place(*std::move(scene)));
    loaded.notices = with_name(all_notices(*loaded.placed), path.string(), name);
    if (const std::size_t bytes = most_state_bytes(loaded); bytes > kMaxStateBytes)
        return tl::unexpected(path.string() + ": its cameras, lights, materials and backgrounds take " +
                              std::to_string(bytes) + " bytes in the state that clients get, and at most " +
                              std::to_string(kMaxStateBytes) + " are possible: give them shorter names");
    return loaded;
} catch (const std::bad_alloc&) {
    return tl::unexpected(out_of_memory(path));
}

namespace {

bool can_be_asked_for(const std::string& name) {
    return name.size() <= protocol::kMaxSceneName &&
           vrut::base::find_invalid_utf8(name) == std::string_view::npos;
}

}  // namespace

SceneLibrary::SceneLibrary(fs::path folder, ImportOptions options, fs::path start)
    : folder_(std::move(folder)), start_(std::move(start)), options_(std::move(options)) {
    if (start_.empty()) return;
    std::error_code error;
    const fs::path file = fs::weakly_canonical(start_, error);
    start_name_ = start_.filename().string();
    if (folder_.empty()) return;
    const fs::path below = file.lexically_relative(fs::weakly_canonical(folder_, error));
    if (!below.empty() && *below.begin() != "..")
        start_name_ = below.generic_string();
    else if (find_in_folder(start_name_))
        start_name_ = (file.parent_path().filename() / file.filename()).generic_string();
}

tl::expected<fs::path, std::string> SceneLibrary::find(const std::string& name) const {
    if (!start_.empty() && name == start_name_) return start_;
    return find_in_folder(name);
}

tl::expected<fs::path, std::string> SceneLibrary::find_in_folder(const std::string& name) const {
    if (folder_.empty())
        return tl::unexpected(
            std::string("this server has no folder of scenes to open: start it with --scenes"));
    const std::string sentence = "there is no scene '" + name.substr(0, 100) + "'";
    const fs::path relative(name);
    const bool leaves = std::find(relative.begin(), relative.end(), "..") != relative.end();
    if (name.empty() || name.find('\0') != std::string::npos || relative.is_absolute() || leaves)
        return tl::unexpected(sentence);
    // Links are followed first: what counts is where the file lies.
    std::error_code error;
    const fs::path folder = fs::canonical(folder_, error);
    if (error) return tl::unexpected("the folder of scenes cannot be read: " + error.message());
    const fs::path file = fs::canonical(folder / relative, error);
    if (error) return tl::unexpected(sentence);
    const bool below =
        std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
    if (!below || !fs::is_regular_file(file, error)) return tl::unexpected(sentence);
    return file;
}

/// What is opened is the link's target, which may have another ending.
bool SceneLibrary::leads_to_scene(const std::string& link) const {
    const auto file = find_in_folder(link);
    return file && io::has_reader(*file);
}

std::vector<std::string> SceneLibrary::names() const {
    std::vector<std::string> names = names_in_folder();
    if (!start_.empty()) {
        std::erase(names, start_name_);
        names.resize(std::min(names.size(), kMostNames - 1));
        if (can_be_asked_for(start_name_)) names.push_back(start_name_);
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::vector<std::string> SceneLibrary::names_in_folder() const {
    std::vector<std::string> names;
    if (folder_.empty()) return names;
    std::size_t entries = 0;
    std::deque<fs::path> folders = {fs::path()};  // below folder_
    for (; !folders.empty() && entries < kMostEntries; folders.pop_front()) {
        std::error_code error;
        for (fs::directory_iterator entry(folder_ / folders.front(), error), end;
             !error && entry != end && entries < kMostEntries; entry.increment(error)) {
            ++entries;
            const fs::path below = folders.front() / entry->path().filename();
            const std::string name = below.generic_string();
            if (!can_be_asked_for(name)) continue;
            std::error_code ignored;
            const bool link = entry->is_symlink(ignored);
            if (!link && entry->is_directory(ignored))
                folders.push_back(below);
            else if (link ? leads_to_scene(name) : io::has_reader(below) && entry->is_regular_file(ignored))
                names.push_back(name);
        }
    }
    std::sort(names.begin(), names.end());
    names.resize(std::min(names.size(), kMostNames));
    return names;
}

namespace {

class Sha256 {
public:
    Sha256() : good_(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1) {}
    void add(std::string_view bytes) {
        good_ = good_ && EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1;
    }
    /// In hexadecimal. Throws std::runtime_error.
    std::string digest() {
        unsigned char digest[EVP_MAX_MD_SIZE];
        unsigned length = 0;
        if (!good_ || EVP_DigestFinal_ex(context_.get(), digest, &length) != 1)
            throw std::runtime_error("SHA-256 cannot be computed");
        std::string text;
        for (unsigned i = 0; i < length; ++i) {
            constexpr char kDigits[] = "0123456789abcdef";
            text += {kDigits[digest[i] >> 4], kDigits[digest[i] & 15]};
        }
        return text;
    }

private:
    std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_{EVP_MD_CTX_new(), EVP_MD_CTX_free};
    bool good_;
};

}  // namespace

std::string sha256_of(const fs::path& path, const std::stop_token& stop) {
    std::ifstream stream;
    if (fs::is_regular_file(path)) stream.open(path, std::ios::binary);  // another may never end
    std::vector<char> block(1 << 20);
    const bool opened = stream.is_open();
    Sha256 sum;
    while (opened && stream) {
        if (stop.stop_requested()) throw std::runtime_error(path.string() + " is no longer read");
        stream.read(block.data(), static_cast<std::streamsize>(block.size()));
        sum.add({block.data(), static_cast<std::size_t>(stream.gcount())});
    }
    if (!opened || stream.bad()) throw std::runtime_error(path.string() + " cannot be read");
    return sum.digest();
}

std::string sha256_of_text(std::string_view text) {
    Sha256 sum;
    sum.add(text);
    return sum.digest();
}

std::string sha256_of_scene(const scene::Scene& scene) {
    std::vector<std::string> images;  // by their contents, wherever they lie
    for (const scene::Texture& texture : scene.textures()) {
        const std::vector<std::uint8_t>& rgba = texture.image.rgba;
        Sha256 sum;
        sum.add(std::to_string(texture.image.width) + "x");
        sum.add({reinterpret_cast<const char*>(rgba.data()), rgba.size()});
        images.push_back(sum.digest());
    }
    std::ostringstream text;
    io::write_vrut_text(scene, text, {}, images);
    return sha256_of_text(text.view());
}

}  // namespace vrut::server::scenes
