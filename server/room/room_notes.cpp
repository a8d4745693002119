// Notes: markers with what is known of how they came.
#include "room/room.hpp"

namespace vrut::server::room {

using protocol::Error;

std::optional<Error> Room::use_notes(protocol::State& next, const scene::PlacedScene& placed) const {
    if (next.markers == state_.markers) return std::nullopt;
    auto notes = *next.markers;
    for (auto& [name, note] : notes) {
        const auto before = state_.markers->find(name);
        if (!note.view || (before != state_.markers->end() && before->second == note)) continue;
        const auto camera =
            overlaid(camera_of(*note.view), {}, placed, "'markers." + name.substr(0, 40) + ".view'");
        if (!camera) return camera.error();
        note.view = pose_of(*camera);
    }
    next.markers.set(std::move(notes));
    return std::nullopt;
}

}  // namespace vrut::server::room
