#pragma once

#include <filesystem>
#include <map>
#include <memory>

#include "engine/log_file.hpp"
#include "stage.hpp"

namespace stage {

/// Writes a stage's recordings into a folder at once; how it went is told when its message has been handled.
class FolderOfLogs {
public:
    explicit FolderOfLogs(std::filesystem::path folder) : folder_(std::move(folder)) {}

    RoomOptions options() {
        RoomOptions options;
        options.recordings = {
            [this](std::int64_t recording, const std::string& name, const RecordingSink::Header& header) {
                auto log = server::engine::open_log(folder_, name);
                if (!log)
                    return tell([=, why = log.error()](Room& to, SessionTime at) {
                        to.recording_opened(recording, tl::unexpected(why), at);
                    });
                files_[recording] = std::move(log->file);
                write(recording, header(log->name, server::engine::iso_time_now()));
                tell([=, opened = log->name](Room& to, SessionTime at) {
                    to.recording_opened(recording, opened, at);
                });
            },
            [this](std::int64_t recording, const std::string& line) { write(recording, line); },
            [this](std::int64_t recording) {
                files_.erase(recording);
                tell([=](Room& to, SessionTime at) { to.recording_ended(recording, std::nullopt, at); });
            }};
        return options;
    }
    /// To be called after each message.
    void tell_results(Stage& stage) {
        for (const auto& result : std::exchange(results_, {})) result(stage.room, stage.now);
    }

private:
    using Result = std::function<void(Room&, SessionTime)>;
    void tell(Result result) { results_.push_back(std::move(result)); }
    void write(std::int64_t recording, const std::string& line) {
        if (!files_.contains(recording)) return;
        const auto written = files_[recording]->append(line + '\n');
        if (written) return;
        files_.erase(recording);
        tell(
            [=, why = written.error()](Room& to, SessionTime at) { to.recording_ended(recording, why, at); });
    }

    std::filesystem::path folder_;
    std::map<std::int64_t, std::unique_ptr<server::engine::LogFile>> files_;
    std::vector<Result> results_;
};

}  // namespace stage
