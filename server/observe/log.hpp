#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>

namespace vrut::server::observe {

/// A member of a line of the log. Texts may come from anywhere: a client, a file, a driver.
struct LogField {
    std::string_view name;
    std::variant<std::string_view, std::int64_t, std::uint64_t, double> value;
};
using LogFields = std::initializer_list<LogField>;

/// One line of standard error for one event: `time=… level=info event=joined client=c1 name="Anna B."`, as
/// logfmt has it. A text of more than letters, digits and -._:/@+ stands as a JSON string of ASCII, at most
/// 300 bytes of it, so that no text can end a line, make up a field or steer a terminal. Of one event up to
/// 100 lines come at once, and one a second from there on, so that nobody fills a disk; debug lines are not
/// limited. A line for which standard error has no room at once, since nobody reads it, is left out. The next
/// one of the event tells how many were.
void log_debug(std::string_view event, LogFields fields);
void log_info(std::string_view event, LogFields fields);
void log_warning(std::string_view event, LogFields fields);

/// From here on lines go to standard error.
void start_log();
/// Of each line, as spdlog has it.
inline constexpr const char* kLogPattern = "time=%Y-%m-%dT%H:%M:%S.%e%z level=%^%l%$ %v";

}  // namespace vrut::server::observe
