#include "room/recorder.hpp"

#include <cerrno>
#include <cstring>
#include <ctime>

#include "base/clock.hpp"
#include "observe/log.hpp"

namespace vrut::server::room {

namespace {

constexpr std::size_t kRoom = std::size_t{64} * 1024;

std::string formatted_now(const char* format) {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[40];
    return {text, std::strftime(text, sizeof text, format, &utc)};
}

}  // namespace

std::string iso_time_now() { return formatted_now("%Y-%m-%dT%H:%M:%SZ"); }

tl::expected<std::string, std::string> Recorder::open(const std::string& name) {
    const std::string wanted = name.empty() ? formatted_now("session-%Y%m%d-%H%M%S") : name;
    std::string chosen = wanted;
    const auto taken = [&] { return std::filesystem::exists(folder_ / (chosen + ".jsonl")); };
    for (int n = 2; name.empty() && taken(); ++n) chosen = wanted + "-" + std::to_string(n);
    if (taken()) return tl::unexpected("there is a recording '" + name + "' already");
    path_ = folder_ / (chosen + ".jsonl");
    file_.open(path_, std::ios::binary);
    // Whether there is room is better known before anything is told of a recording.
    file_ << std::string(kRoom, ' ') << std::flush;
    if (!file_) {
        const std::string why = std::strerror(errno);
        close();
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
        return tl::unexpected(path_.filename().string() + " cannot be written: " + why);
    }
    file_.close();
    file_.open(path_, std::ios::binary | std::ios::trunc);
    size_ = 0;
    observe::log_info("recording_begun", {{"file", path_.string()}});
    return chosen;
}

void Recorder::write(const std::string& line) {
    const base::Clock::time_point start = base::Clock::now();
    // Whole lines reach the file at once: a log whose end is missing is still a log.
    file_ << line << '\n' << std::flush;
    const int error = errno;
    size_ += line.size() + 1;
    if (!file_)
        stop(std::strerror(error));
    else if (size_ >= largest_)
        stop("it has grown too large");
    else if (base::Clock::now() - start >= slowest_)
        stop("its disk is too slow");
}

void Recorder::stop(const std::string& why) {
    end_ = "The recording '" + path_.stem().string() + "' has ended: " + why;
    observe::log_warning("recording_ended", {{"file", path_.string()}, {"reason", why}});
    close();
}

void Recorder::close() {
    file_.close();
    file_.clear();
}

}  // namespace vrut::server::room
