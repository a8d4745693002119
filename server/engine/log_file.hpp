#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace vrut::server::engine {

/// A file that grows at its end. Each call may take as long as its disk does.
class LogFile {
public:
    virtual ~LogFile() = default;
    /// Or why not all of it was written.
    virtual tl::expected<void, std::string> append(std::string_view text) = 0;
    /// The file goes, where it is still what this one made.
    virtual void remove() = 0;
};

struct OpenedLog {
    std::string name;  ///< without its ending
    std::unique_ptr<LogFile> file;
};

/// Makes NAME.jsonl in a folder, where nothing of that name may be, not even a link; an empty `name`: one
/// that is made of the time. Or a sentence, also where the disk has no room for a first few lines.
tl::expected<OpenedLog, std::string> open_log(const std::filesystem::path& folder, const std::string& name);

/// Now, as in "2026-01-31T12:34:56Z".
std::string iso_time_now();

}  // namespace vrut::server::engine
