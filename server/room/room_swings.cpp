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

scene::Index Room::hinged(scene::Index node) const {
    while (node != scene::kNone && !at(*scene_, node).hinge) node = at(*scene_, node).parent;
    return node;
}

void Room::apply(const Received& received, const protocol::Swing& swing) {
    const scene::Index node = scene_->scene->find_node(swing.node);
    const std::string name = "node " + std::to_string(swing.node);
    if (node == scene::kNone) return reject(received, code::unknown_node, "there is no " + name);
    const scene::Index moved = hinged(node);
    if (moved == scene::kNone)
        return reject(received, code::failed, name + " has no hinge, nor has what it is part of");
    const bool is_new = !state_.nodes->contains(std::to_string(at(*scene_, moved).id));
    if (is_new && state_.nodes->size() >= protocol::kMaxNodes)
        return reject(received, code::too_many,
                      "'nodes' holds " + std::to_string(protocol::kMaxNodes) + " entries at most");
    steer(received);
    begin_swing(moved, swing.open, swing.ms, time_);
    advance_swings();
    answer(received);  // whose revision tells where it goes
}

double Room::InSwing::part_at(SessionTime time) const {
    const double since = static_cast<double>((time - start).count()) / 1000;
    const double share = ms > 0 ? std::clamp(since / ms, 0.0, 1.0) : 1;
    return share == 1 ? to : from + (to - from) * share * share * (3 - 2 * share);
}

void Room::begin_swing(scene::Index node, std::optional<double> open, double ms, SessionTime start) {
    const auto before = std::find_if(swings_.begin(), swings_.end(),
                                     [&](const InSwing& swing) { return swing.node == node; });
    const bool goes = before != swings_.end();
    const double from =
        goes ? before->part_at(start)
             : opened_part(at(*scene_, node), scene_->nodes[static_cast<std::size_t>(node)].matrix);
    const double aim = goes ? before->to : from;
    const double to = open.value_or(aim > 0 ? 0 : 1);
    if (goes) swings_.erase(before);
    swings_.push_back({node, from, to, start, ms * std::abs(to - from)});
}

void Room::advance_swings() {
    if (swings_.empty()) return;
    if (!changing_.empty()) document();
    changing_.clear();  // what moves is nobody's doing
    auto nodes = *state_.nodes;
    std::erase_if(swings_, [&](const InSwing& swing) {
        const double part = swing.part_at(time_);
        const scene::Node& node = at(*scene_, swing.node);
        nodes[std::to_string(node.id)].matrix = part == 0 ? node.matrix : opened(node, part);
        return part == swing.to;
    });
    protocol::State next = state_;
    next.nodes.set(std::move(nodes));
    next.swings.set(swing_states());
    std::shared_ptr<const scene::PlacedScene> placed = scene_;
    // Neither can fail: the nodes are the scene's, and a rotation is a matrix that a patch may have.
    if (use_nodes(next, placed) || use_camera(next, *placed, {})) return swings_.clear();
    const bool moves_camera = camera_of(next.camera) != camera();
    state_ = std::move(next);
    scene_ = std::move(placed);
    if (moves_camera) gestures_.restart(camera());
    update_visible();
}

std::map<std::string, protocol::SwingState> Room::swing_states() const {
    std::map<std::string, protocol::SwingState> states;
    for (const InSwing& swing : swings_) states[std::to_string(at(*scene_, swing.node).id)] = {swing.to};
    return states;
}

void Room::end_swings() {
    for (InSwing& swing : swings_) swing.ms = 0;
    advance_swings();
}

void Room::end_swings_of(protocol::State& next) {
    const auto matrix_in = [](const protocol::State& state, const std::string& id) {
        const auto found = state.nodes->find(id);
        return found == state.nodes->end() ? std::nullopt : found->second.matrix;
    };
    std::erase_if(swings_, [&](const InSwing& swing) {
        const std::string id = std::to_string(at(*scene_, swing.node).id);
        return matrix_in(next, id) != matrix_in(state_, id);
    });
    next.swings.set(swing_states());
}

void Room::use_tap(const std::optional<mesh::Hit>& hit, SessionTime at) {
    const scene::Index node = hit ? hinged(hit->node) : scene::kNone;
    if (node != scene::kNone) tap_ = {node, at + navigation::Clicks::kNextWithin};
}

std::optional<SessionTime> Room::deadline() const {
    std::optional<SessionTime> first = steering_.deadline();
    const auto add = [&](const std::optional<SessionTime>& due) {
        if (due) first = std::min(first.value_or(*due), *due);
    };
    if (tap_) add(tap_->due);
    add(pointing_deadline());
    if (walls_) add(walls_->due);
    return first;
}

}  // namespace vrut::server::room
