#include "room/swings.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "messages.hpp"
#include "room/hinges.hpp"

namespace vrut::server::room {

namespace {

const scene::Node& node_in(const scene::Scene& scene, scene::Index node) {
    return scene.nodes()[static_cast<std::size_t>(node)];
}

std::string id_of(const scene::Scene& scene, scene::Index node) {
    return std::to_string(node_in(scene, node).id);
}

}  // namespace

double Swings::Swing::part_at(SessionTime time) const {
    const double since = static_cast<double>((time - start).count()) / 1000;
    const double share = ms > 0 ? std::clamp(since / ms, 0.0, 1.0) : 1;
    return share == 1 ? to : from + (to - from) * share * share * (3 - 2 * share);
}

void Swings::begin(const scene::PlacedScene& placed, scene::Index node, std::optional<double> open, double ms,
                   SessionTime start) {
    const auto before = std::ranges::find(swings_, node, &Swing::node);
    const bool goes = before != swings_.end();
    const double from =
        goes ? before->part_at(start)
             : opened_part(node_in(*placed.scene, node), placed.nodes[static_cast<std::size_t>(node)].matrix);
    const double aim = goes ? before->to : from;
    const double to = open.value_or(aim > 0 ? 0 : 1);
    if (goes) swings_.erase(before);
    begin_at(node, from, to, ms * std::abs(to - from), start);
}

void Swings::advance(const scene::Scene& scene, SessionTime now, Nodes& nodes) {
    std::erase_if(swings_, [&](const Swing& swing) {
        const double part = swing.part_at(now);
        const scene::Node& node = node_in(scene, swing.node);
        nodes[std::to_string(node.id)].matrix = part == 0 ? node.matrix : opened(node, part);
        return part == swing.to;
    });
}

void Swings::hurry() {
    for (Swing& swing : swings_) swing.ms = 0;
}

void Swings::end_changed(const scene::Scene& scene, const Nodes& before, const Nodes& next) {
    const auto matrix_in = [](const Nodes& nodes, const std::string& id) {
        const auto found = nodes.find(id);
        return found == nodes.end() ? std::nullopt : found->second.matrix;
    };
    std::erase_if(swings_, [&](const Swing& swing) {
        const std::string id = id_of(scene, swing.node);
        return matrix_in(next, id) != matrix_in(before, id);
    });
}

std::map<std::string, protocol::SwingState> Swings::states(const scene::Scene& scene) const {
    std::map<std::string, protocol::SwingState> states;
    for (const Swing& swing : swings_) states[id_of(scene, swing.node)] = {swing.to};
    return states;
}

void Swings::use_tap(const scene::PlacedScene& placed, SessionTime now) {
    if (!tap_ || tap_->due > now) return;
    const Tap tap = *std::exchange(tap_, std::nullopt);
    begin(placed, tap.node, {}, protocol::Swing{}.ms, tap.due);
}

}  // namespace vrut::server::room
