#include "room/replay.hpp"

#include <istream>

namespace vrut::server::room {

tl::expected<EventLog, std::string> read_event_log(std::istream&& stream, const std::string& name) {
    if (!stream) return tl::unexpected(name + ": it cannot be opened");
    EventLog log;
    std::string text;
    for (std::size_t number = 1; std::getline(stream, text); ++number) {
        const bool unfinished = stream.eof();  // no line's end
        const std::string place = name + ":" + std::to_string(number) + ": ";
        const auto wrong = [&](const protocol::Error& error) {
            return tl::unexpected(place + error.message);
        };
        if (unfinished) log.cut = place + "the log is cut off here, and its end is missing";
        if (number == 1) {
            auto header = protocol::decode_log_header(text);
            if (!header) return wrong(header.error());
            log.header = *std::move(header);
            continue;
        }
        auto line = protocol::decode_log_line(text);
        if (!line && unfinished) break;
        if (!line) return wrong(line.error());
        log.lines.push_back(*std::move(line));
    }
    if (!log.header.state) return tl::unexpected(name + ": the file is empty");
    return log;
}

namespace {

/// What one line does; or what is wrong with it.
struct Player {
    Room& room;
    const protocol::LogLine& line;
    const SceneFinder& find_scene;
    const ReplayWatcher& watcher;

    std::optional<std::string> operator()(const protocol::ClientMessage& message) const {
        if (room.handle_message(line.client, message, line.at)) return std::nullopt;
        std::string why = "client '" + line.client + "' is not there";
        for (const Answer& answer : room.take_answers())
            if (!answer.rejection.empty()) why = answer.rejection;
        return "a message that was accepted is rejected now: " + why;
    }
    std::optional<std::string> operator()(const protocol::LogLine::Connected& connected) const {
        room.join(line.client, connected.role, line.at, connected.name, connected.resume);
        return std::nullopt;
    }
    std::optional<std::string> operator()(const protocol::LogLine::Disconnected&) const {
        room.leave(line.client, line.at);
        return std::nullopt;
    }
    std::optional<std::string> operator()(const protocol::LogLine::ControlPassed&) const {
        room.pass_control(line.client, line.at);
        return std::nullopt;
    }
    std::optional<std::string> operator()(const protocol::LogLine::Opened& opened) const {
        auto scene = find_scene(opened.scene, opened.sha256, opened.up_axis);
        if (!scene) return scene.error();
        scene->changes = opened.changes;
        room.show(*std::move(scene), line.at);
        return std::nullopt;
    }
    std::optional<std::string> operator()(const protocol::LogLine::Revised& revised) const {
        room.follow(revised, line.at);
        return std::nullopt;
    }
    std::optional<std::string> operator()(const protocol::LogLine::Drawn& drawn) const {
        room.advance(line.at);
        room.remember(drawn.frame);
        if (watcher.on_drawn) watcher.on_drawn(drawn.frame, room);
        return std::nullopt;
    }
};

}  // namespace

std::optional<std::string> play(Room& room, const protocol::LogLine& line, const SceneFinder& find_scene,
                                const ReplayWatcher& watcher) {
    return std::visit(Player{room, line, find_scene, watcher}, line.what);
}

tl::expected<Room, std::string> replay(const EventLog& log, const SceneFinder& find_scene,
                                       const ReplayWatcher& watcher) {
    auto scene = find_scene(log.header.scene, log.header.scene_sha256, log.header.up_axis);
    if (!scene) return tl::unexpected(scene.error());
    RoomOptions options;
    options.policy = kReplay;
    Room room(*std::move(scene), std::move(options));
    if (const auto restored = room.restore(log.header); !restored)
        return tl::unexpected("line 1: " + restored.error().message);
    std::size_t number = 1;
    for (const protocol::LogLine& line : log.lines) {
        ++number;
        if (watcher.before_line) watcher.before_line(line.at, room);
        if (const auto wrong = play(room, line, find_scene, watcher))
            return tl::unexpected("line " + std::to_string(number) + ": " + *wrong);
        room.take_answers();
        room.take_orders();
    }
    return room;
}

}  // namespace vrut::server::room
