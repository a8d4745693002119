#include "log.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <optional>

#include "report.hpp"

namespace vrut {

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

/// How many lines of one event may still come.
class Budget {
public:
    /// None where this one may not; else how many could not since the last that could.
    std::optional<std::uint64_t> spend() {
        const Clock::time_point now = Clock::now();
        const double since = std::chrono::duration<double>(now - std::exchange(last_, now)).count();
        left_ = std::min(left_ + since * kPerSecond, kBurst);
        if (left_ < 1) {
            ++left_out_;
            return std::nullopt;
        }
        --left_;
        return std::exchange(left_out_, 0);
    }

private:
    using Clock = std::chrono::steady_clock;
    double left_ = kBurst;
    Clock::time_point last_ = Clock::now();
    std::uint64_t left_out_ = 0;
};

/// Events are named in the program, so there are few.
std::optional<std::uint64_t> spend(std::string_view event) {
    static std::mutex mutex;
    static std::map<std::string, Budget, std::less<>> budgets;
    const std::lock_guard lock(mutex);
    auto budget = budgets.find(event);
    if (budget == budgets.end()) budget = budgets.emplace(event, Budget()).first;
    return budget->second.spend();
}

void write(spdlog::level::level_enum level, std::string_view event, LogFields fields) {
    spdlog::logger& logger = *spdlog::default_logger_raw();
    if (!logger.should_log(level)) return;
    const auto left_out = level == spdlog::level::debug ? std::optional<std::uint64_t>(0) : spend(event);
    if (!left_out) return;
    std::string line;
    append(line, {"event", event});
    for (const LogField& field : fields) append(line, field);
    if (*left_out > 0) append(line, {"left_out", *left_out});
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

}  // namespace vrut
