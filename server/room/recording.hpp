#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "event_log.hpp"
#include "messages.hpp"

namespace vrut::server::room {

/// Takes the lines of recordings, of which each has a number. The room waits for none of it: how it goes is
/// reported to Room::recording_opened() and recording_ended().
struct RecordingSink {
    /// The first line of a log of this name, begun then (ISO 8601). May be called once, on any thread.
    using Header = std::function<std::string(const std::string& name, const std::string& started)>;

    /// Opens a log NAME, or where `name` is empty one that is named after the time.
    std::function<void(std::int64_t recording, const std::string& name, Header header)> begin;
    std::function<void(std::int64_t recording, std::string line)> write;
    /// No more lines come.
    std::function<void(std::int64_t recording)> end;
};

}  // namespace vrut::server::room
