// What picks snap to, and what measures come to as the parts stand.
#include <cmath>

#include "measurement/measure.hpp"
#include "measurement/snap_around.hpp"
#include "room/room.hpp"

namespace vrut::server::room {

using measurement::Snap;
using protocol::Error;
namespace code = protocol::error_code;

namespace {

// protocol's own words are in the same order.
static_assert(static_cast<int>(Snap::plane) == static_cast<int>(protocol::Snap::plane));
static_assert(static_cast<int>(measurement::Kind::length) == static_cast<int>(protocol::MeasureKind::length));

measurement::Feature feature_of(const protocol::Feature& feature) {
    return {feature.node, static_cast<Snap>(feature.snap), feature.points};
}

std::vector<measurement::Feature> features_of(const protocol::MeasureState& measure) {
    std::vector<measurement::Feature> features;
    features.reserve(measure.picks.size());
    for (const protocol::Feature& pick : measure.picks) features.push_back(feature_of(pick));
    return features;
}

protocol::MeasuredState measured_state_of(const measurement::Measured& measured) {
    protocol::MeasuredState state{measured.value, measured.components, measured.line, {}};
    if (!measured.problem.empty()) state.problem = measured.problem;
    return state;
}

std::vector<Snap> snaps_of(const std::vector<protocol::Snap>& snaps) {
    std::vector<Snap> result;
    result.reserve(snaps.size());
    for (const protocol::Snap snap : snaps) result.push_back(static_cast<Snap>(snap));
    return result;
}

}  // namespace

std::optional<protocol::Snapped> Room::snapped_at(const Frame& seen, const protocol::Pick& pick) const {
    const double pixel = 2 * std::tan(seen.camera.fov * scene::kRadiansPerDegree / 2) / seen.view_size.height;
    const auto best = measurement::snap_around(
        *scene_, ray_at(seen, pick.x, pick.y),
        [&](const mesh::Ray& ray) { return hit_along(ray, pick.through); },
        {pick.snap->within * pixel, snaps_of(pick.snap->to), visible_.clip_planes}, mesh_edges_);
    if (!best) return {};
    const auto& feature = best->feature;
    return protocol::Snapped{
        {feature.node, static_cast<protocol::Snap>(feature.snap), feature.points}, best->point, best->line};
}

std::optional<Error> Room::check_measures(const protocol::State& next) const {
    if (next.measures == state_.measures) return {};
    for (const auto& [name, measure] : *next.measures) {
        const std::string where = "'measures." + name.substr(0, 40) + "'";
        for (const protocol::Feature& pick : measure.picks)
            if (scene_->scene->find_node(pick.node) == scene::kNone)
                return Error{
                    {}, code::unknown_node, where + ": there is no node " + std::to_string(pick.node)};
        const auto kind = static_cast<measurement::Kind>(measure.kind);
        if (const auto wrong = measurement::invalid(kind, features_of(measure)))
            return Error{{}, code::out_of_range, where + ": " + *wrong};
    }
    return {};
}

void Room::measure() {
    if (measured_in_ == scene_ && measured_of_ == state_.measures) return;
    measured_in_ = scene_;
    measured_of_ = state_.measures;
    std::map<std::string, protocol::MeasuredState> measured;
    for (const auto& [name, measure] : *state_.measures)
        measured[name] = measured_state_of(measurement::measure(
            *scene_, static_cast<measurement::Kind>(measure.kind), features_of(measure), mesh_edges_));
    state_.measured.set(std::move(measured));
}

}  // namespace vrut::server::room
