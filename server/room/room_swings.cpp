// Doors, bonnets and lids: what turns about a hinge, by a message or a tap.
#include <algorithm>

#include "room/hinges.hpp"
#include "room/room.hpp"

namespace vrut::server::room {

namespace code = protocol::error_code;

namespace {

const scene::Node& at(const scene::PlacedScene& placed, scene::Index node) {
    return placed.scene->nodes()[static_cast<std::size_t>(node)];
}

}  // namespace

void Room::apply(const Received& received, const protocol::Swing& swing) {
    const scene::Index node = scene_->scene->find_node(swing.node);
    const std::string name = "node " + std::to_string(swing.node);
    if (node == scene::kNone) return reject(received, code::unknown_node, "there is no " + name);
    const scene::Index moved = hinged(*scene_->scene, node);
    if (moved == scene::kNone)
        return reject(received, code::failed, name + " has no hinge, nor has what it is part of");
    const bool is_new = !state_.nodes->contains(std::to_string(at(*scene_, moved).id));
    if (is_new && state_.nodes->size() >= protocol::kMaxNodes)
        return reject(received, code::too_many,
                      "'nodes' holds " + std::to_string(protocol::kMaxNodes) + " entries at most");
    steer(received);
    swings_.begin(*scene_, moved, swing.open, swing.ms, time_);
    advance_swings();
    answer(received);  // whose revision tells where it goes
}

void Room::advance_swings() {
    if (swings_.empty()) return;
    if (!revisions_.changing().empty()) document();
    revisions_.begin({});  // what moves is nobody's doing
    auto nodes = *state_.nodes;
    swings_.advance(*scene_->scene, time_, nodes);
    protocol::State next = state_;
    next.nodes.set(std::move(nodes));
    next.swings.set(swings_.states(*scene_->scene));
    std::shared_ptr<const scene::PlacedScene> placed = scene_;
    // Neither can fail: the nodes are the scene's, and a rotation is a matrix that a patch may have.
    if (use_nodes(next, placed) || use_camera(next, *placed, {})) return swings_.clear();
    const bool moves_camera = camera_of(next.camera) != camera();
    state_ = std::move(next);
    scene_ = std::move(placed);
    if (moves_camera) gestures_.restart(camera());
    update_visible();
}

/// At once.
void Room::end_swings() {
    swings_.hurry();
    advance_swings();
}

std::optional<SessionTime> Room::deadline() const {
    std::optional<SessionTime> first = steering_.deadline();
    const auto add = [&](const std::optional<SessionTime>& due) {
        if (due) first = std::min(first.value_or(*due), *due);
    };
    add(swings_.tap_due());
    add(pointings_.deadline());
    add(walls_.due());
    return first;
}

}  // namespace vrut::server::room
