#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <tl/expected.hpp>

#include "event_log.hpp"

namespace vrut::server::room {

/// Writes event logs into a folder, one at a time. A log that cannot be written any more, has grown to
/// `largest` bytes, or whose last line took `slowest` to be written, ends: who writes waits for the disk.
class Recorder {
public:
    static constexpr std::uintmax_t kLargest = std::uintmax_t{1} << 30;

    /// An empty folder: there is nowhere to record to.
    explicit Recorder(std::filesystem::path folder, std::uintmax_t largest = kLargest,
                      std::chrono::milliseconds slowest = std::chrono::seconds(1))
        : folder_(std::move(folder)), largest_(largest), slowest_(slowest) {}

    bool has_folder() const { return !folder_.empty(); }
    bool active() const { return file_.is_open(); }
    /// Begins NAME.jsonl, or where `name` is empty one that is named after the time; the name, or why not.
    tl::expected<std::string, std::string> open(const std::string& name);
    void write(const std::string& line);
    /// Why the last log that was not closed has ended, a sentence.
    const std::string& end() const { return end_; }
    void close();

private:
    void stop(const std::string& why);

    std::filesystem::path folder_, path_;
    std::ofstream file_;
    std::uintmax_t largest_, size_ = 0;
    std::chrono::milliseconds slowest_;
    std::string end_;
};

/// Now, as in "2026-01-31T12:34:56Z".
std::string iso_time_now();

}  // namespace vrut::server::room
