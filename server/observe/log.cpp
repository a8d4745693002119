#include "observe/log.hpp"

#include <poll.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>

#include "base/clock.hpp"
#include "report.hpp"

namespace vrut::server::observe {

namespace {

constexpr std::size_t kLongestText = 300;
constexpr double kBurst = 100, kPerSecond = 1;

bool is_plain(std::string_view text) {
    constexpr std::string_view kPlain =
        "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ-._:/@+";
    return !text.empty() && text.find_first_not_of(kPlain) == std::string_view::npos;
}

std::string as_text(std::string_view text) {
    if (text.size() > kLongestText) {
        std::size_t length = kLongestText;
        while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80) --length;
        return protocol::json_string(std::string(text.substr(0, length)) + "…");
    }
    return is_plain(text) ? std::string(text) : protocol::json_string(text);
}
template <class Number>
std::string as_text(Number number) {
    return fmt::format("{}", number);
}

void append(std::string& line, const LogField& field) {
    line += ' ';
    line += field.name;
    line += '=';
    line += std::visit([](const auto& value) { return as_text(value); }, field.value);
}

/// How many lines of one event may still come, and how many did not.
class Budget {
public:
    bool spend() {
        const base::Clock::time_point now = base::Clock::now();
        const double since = std::chrono::duration<double>(now - std::exchange(last_, now)).count();
        left_ = std::min(left_ + since * kPerSecond, kBurst);
        if (left_ < 1) return false;
        --left_;
        return true;
    }
    void leave_out() { ++left_out_; }
    /// Since the last that could.
    std::uint64_t take_left_out() { return std::exchange(left_out_, 0); }

private:
    double left_ = kBurst;
    base::Clock::time_point last_ = base::Clock::now();
    std::uint64_t left_out_ = 0;
};

/// For one line at least: a pipe has it while it takes 4096 bytes. Nobody waits for whoever reads it.
bool has_room(int file) {
    pollfd asked{file, POLLOUT, 0};
    return poll(&asked, 1, 0) == 1 && (asked.revents & POLLOUT) != 0;
}

void write(spdlog::level::level_enum level, std::string_view event, LogFields fields) {
    spdlog::logger& logger = *spdlog::default_logger_raw();
    if (!logger.should_log(level)) return;
    static std::mutex mutex;  // until it is written: what had room may not have it after another's line
    static std::map<std::string, Budget, std::less<>> budgets;  // events are named in the program: few
    const std::lock_guard lock(mutex);
    auto budget = budgets.find(event);
    if (budget == budgets.end()) budget = budgets.emplace(event, Budget()).first;
    if (!has_room(STDERR_FILENO) || (level != spdlog::level::debug && !budget->second.spend()))
        return budget->second.leave_out();
    std::string line;
    append(line, {"event", event});
    for (const LogField& field : fields) append(line, field);
    if (const std::uint64_t left_out = budget->second.take_left_out(); left_out > 0)
        append(line, {"left_out", left_out});
    logger.log(level, "{}", std::string_view(line).substr(1));
}

}  // namespace

void log_debug(std::string_view event, LogFields fields) { write(spdlog::level::debug, event, fields); }
void log_info(std::string_view event, LogFields fields) { write(spdlog::level::info, event, fields); }
void log_warning(std::string_view event, LogFields fields) { write(spdlog::level::warn, event, fields); }

void start_log() {
    spdlog::set_default_logger(spdlog::stderr_color_mt("vrut-preview"));
    spdlog::set_pattern(kLogPattern);
}

}  // namespace vrut::server::observe
