#include "base/output_files.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

namespace vrut::base {

namespace fs = std::filesystem;

OutputFiles::~OutputFiles() {
    std::error_code ignored;
    for (const Staged& file : staged_) fs::remove(file.temporary, ignored);
    for (const fs::path& folder : made_folders_) fs::remove(folder, ignored);  // if it is empty
}

void OutputFiles::write(const fs::path& target, const std::function<void(std::ostream&)>& content) {
    std::error_code error;
    if (!target.parent_path().empty() && fs::create_directory(target.parent_path(), error))
        made_folders_.push_back(target.parent_path());
    if (fs::is_directory(target, error)) throw WriteError(target.string() + ": it is a folder");
    for (const fs::path& file : protected_files_)
        if (fs::equivalent(file, target, error))
            throw WriteError(target.string() + ": the scene was read from this file: choose another name");
    const std::string hidden = "." + target.filename().string() + "." + std::to_string(getpid()) + ".part";
    staged_.push_back({target.parent_path() / hidden, target});
    errno = 0;
    try {
        std::ofstream stream;
        stream.exceptions(std::ios::failbit | std::ios::badbit);
        stream.open(staged_.back().temporary, std::ios::binary);
        content(stream);
        stream.close();
    } catch (const std::ios::failure&) {
        const std::string cause = errno != 0 ? std::strerror(errno) : "the folder takes no more";
        throw WriteError(target.string() + ": it cannot be written: " + cause);
    }
}

void OutputFiles::commit() {
    for (const Staged& file : staged_) {
        std::error_code error;
        fs::rename(file.temporary, file.target, error);
        if (error) throw WriteError(file.target.string() + ": it cannot be written: " + error.message());
    }
    staged_.clear();
    made_folders_.clear();
}

}  // namespace vrut::base
