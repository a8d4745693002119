#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <vector>

namespace vrut::base {

/// A file cannot be written. The message names it and is one sentence. write_scene() catches it.
struct WriteError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A group of files written as a transaction: each is written under a temporary name, and commit() renames
/// all of them. Without commit() existing files stay untouched.
class OutputFiles {
public:
    /// write() throws for a target that is one of `protected_files`.
    explicit OutputFiles(std::vector<std::filesystem::path> protected_files = {})
        : protected_files_(std::move(protected_files)) {}
    ~OutputFiles();
    OutputFiles(const OutputFiles&) = delete;
    OutputFiles& operator=(const OutputFiles&) = delete;

    /// Writes the target's temporary file. Creates the target's folder if only that folder is missing. Throws
    /// WriteError.
    void write(const std::filesystem::path& target, const std::function<void(std::ostream&)>& content);
    /// Renames the temporary files to their targets, in the order of the writes. Throws WriteError.
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
