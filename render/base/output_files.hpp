#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <vector>

namespace vrut::base {

/// Why a file cannot be written, in one sentence that names it; caught by write_scene().
struct WriteError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A group of files written as a transaction: each is written under a temporary name, and commit() renames
/// all of them. Without commit() existing files stay untouched.
class OutputFiles {
public:
    /// None of `kept` is written over.
    explicit OutputFiles(std::vector<std::filesystem::path> protected_files = {})
        : protected_files_(std::move(protected_files)) {}
    ~OutputFiles();
    OutputFiles(const OutputFiles&) = delete;
    OutputFiles& operator=(const OutputFiles&) = delete;

    /// Makes the folder, where it is missing, in a folder that is there. Throws WriteError.
    void write(const std::filesystem::path& target, const std::function<void(std::ostream&)>& content);
    /// Puts the files in their places in the order in which they were written. Throws WriteError.
    void commit();

private:
    struct Staged {
        std::filesystem::path temporary, target;
    };
    std::vector<std::filesystem::path> protected_files_;
    std::vector<Staged> staged_;
    std::vector<std::filesystem::path> made_folders_;
};

}  // namespace vrut::base
