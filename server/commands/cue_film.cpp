#include "commands/cue_film.hpp"

#include <cmath>
#include <stdexcept>

#include "commands/film.hpp"
#include "commands/room_film.hpp"
#include "cue_list.hpp"

namespace vrut::server::commands {

namespace {

constexpr const char* kClient = "render";  // as in room_of()

/// What the client asks for. Throws std::runtime_error.
void ask(room::Room& room, const std::string& list, decltype(protocol::ClientMessage::payload) payload) {
    room.handle_message(kClient, {1, std::move(payload)}, room.time());
    for (const room::Answer& answer : room.take_answers())
        if (!answer.rejection.empty()) throw std::runtime_error(list + ": " + answer.rejection);
}

/// Brings the list into the room. Throws where something of it does not go with the scene.
void bring(room::Room& room, const std::filesystem::path& path) {
    const std::string text = read_text("--cues", path);
    const protocol::Checked checked = room.check_cues(text);
    if (!checked.problems.empty())
        throw std::runtime_error(path.string() + ": " + checked.problems.front().message);
    if (checked.fitting.empty()) throw std::runtime_error(path.string() + ": the list has no cues");
    const auto patch = protocol::parse_cue_patch(text);
    if (!patch) throw std::runtime_error(path.string() + ": " + patch.error().message);
    ask(room, path.string(), *patch);
}

}  // namespace

void draw_cues(const RenderArguments& arguments) {
    room::Room room = room_of(arguments);
    bring(room, arguments.cues);
    const auto& cues = room.state().cues;
    const std::vector<std::string> names = protocol::names_in_order(cues);
    const auto ms_at = [&](const std::string& name) {
        // The film begins at the first one.
        return (name == names.front() ? 0 : cues->at(name).ms) + arguments.hold * 1000;
    };
    double ms = 0;
    for (const std::string& name : names) ms += ms_at(name);
    const int images_per_second = arguments.fps.value_or(kImagesPerSecond);
    const room::SessionTime end(std::llround(ms * 1000));
    RoomFilm film({arguments.output, arguments.width, arguments.height, images_per_second,
                   arguments.jpeg_quality, images_until(end, images_per_second), true},
                  arguments.samples, arguments.device);
    ms = 0;
    for (const std::string& name : names) {
        const room::SessionTime begin(std::llround(ms * 1000));
        film.draw_until(begin, room);
        room.advance(begin);
        protocol::Cue cue{name, {}, {}, {}};
        if (name == names.front()) cue.ms = 0;
        ask(room, arguments.cues.string(), cue);
        ms += ms_at(name);
    }
    film.draw_until(end, room);
    film.finish(room);
}

}  // namespace vrut::server::commands
