#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "event_log.hpp"
#include "room/room.hpp"

namespace vrut::server::room {

/// A recorded session, as read.
struct EventLog {
    protocol::LogHeader header;
    std::vector<protocol::LogLine> lines;
    /// Why its end is missing, a sentence that names file and line; empty: as far as can be seen it is there.
    std::string cut = {};
};

/// Reads the log in file `name`, or fails with one sentence that names file and line. A last line that is not
/// whole is left out: the session was cut off.
tl::expected<EventLog, std::string> read_event_log(std::istream&& stream, const std::string& name);

/// Finds a scene of a log by its name and SHA-256, read with this axis up, or why it cannot be had.
using SceneFinder = std::function<tl::expected<scenes::LoadedScene, std::string>(
    const std::string& name, const std::string& sha256, std::optional<protocol::UpAxis> up_axis)>;

/// What a replay reports.
struct ReplayWatcher {
    /// Before each line, with its time, up to which the room may be advanced.
    std::function<void(SessionTime at, Room& room)> before_line = {};
    /// Behind each frame that was drawn in the session; the room shows what it showed.
    std::function<void(std::int64_t frame, const Room& room)> on_drawn = {};
};

/// Does what one line says, in a room that replays. Or what is wrong with it.
std::optional<std::string> play(Room& room, const protocol::LogLine& line, const SceneFinder& find_scene,
                                const ReplayWatcher& watcher = {});

/// Plays a session again, with its own times: the same log and scene give the same camera to the last bit.
/// The room as it stands at the last line; or why not.
tl::expected<Room, std::string> replay(const EventLog& log, const SceneFinder& find_scene,
                                       const ReplayWatcher& watcher = {});

}  // namespace vrut::server::room
