#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "base/clock.hpp"
#include "engine/file_work.hpp"
#include "engine/log_file.hpp"
#include "room/recording.hpp"

namespace vrut::server::engine {

/// Writes recordings to files, each on a thread of its own, for which nothing waits. One whose file cannot be
/// written, has grown too large or is too slow to take its lines ends. To be used on one thread, which also
/// gets the results.
class RecordingWriter {
public:
    /// Opens the file of a recording; see open_log().
    using Open = std::function<tl::expected<OpenedLog, std::string>(const std::string& name)>;
    /// See room::Room::recording_opened() and recording_ended().
    using OnOpened = std::function<void(std::int64_t recording, tl::expected<std::string, std::string> name)>;
    using OnEnded = std::function<void(std::int64_t recording, std::optional<std::string> why)>;
    struct Limits {
        std::uintmax_t file_bytes = std::uintmax_t{1} << 30;
        std::size_t waiting_bytes = std::size_t{16} << 20;  ///< of lines that wait for the disk
        base::Clock::duration oldest =
            std::chrono::seconds(5);  ///< so long may one wait, or the file's opening
        int threads = 4;              ///< which may be left behind in calls that never return
    };

    RecordingWriter(Open open, std::shared_ptr<ResultPost> post, OnOpened on_opened, OnEnded on_ended,
                    Limits limits);
    /// What waits is written if the disk takes it within a second.
    ~RecordingWriter();
    RecordingWriter(const RecordingWriter&) = delete;
    RecordingWriter& operator=(const RecordingWriter&) = delete;

    void begin(std::int64_t recording, const std::string& name, const room::RecordingSink::Header& header,
               base::Clock::time_point now);
    void write(std::int64_t recording, std::string line, base::Clock::time_point now);
    void end(std::int64_t recording, base::Clock::time_point now);
    void end_all(base::Clock::time_point now);
    /// When check() is to be called next, if at all.
    std::optional<base::Clock::time_point> due() const;
    /// Ends those whose disk is too slow.
    void check(base::Clock::time_point now);

private:
    struct Queue;
    struct Log {
        std::shared_ptr<Queue> queue;
        std::optional<std::string> name;  ///< none: it is not open yet
    };
    void opened(std::int64_t recording, const tl::expected<std::string, std::string>& name);
    void ended(std::int64_t recording, const std::optional<std::string>& why);
    /// Its thread is left to itself.
    void give_up(std::int64_t recording, const std::string& why);

    Open open_;
    std::shared_ptr<ResultPost> post_;
    OnOpened on_opened_;
    OnEnded on_ended_;
    Limits limits_;
    std::map<std::int64_t, Log> logs_;
    std::shared_ptr<std::atomic<int>> threads_ = std::make_shared<std::atomic<int>>(0);
};

}  // namespace vrut::server::engine
