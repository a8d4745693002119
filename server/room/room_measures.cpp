// What picks snap to, and what measures come to as the parts stand.
#include <array>
#include <cmath>
#include <numbers>

#include "measurement/measure.hpp"
#include "measurement/snapping.hpp"
#include "room/room.hpp"

namespace vrut::server::room {

using measurement::Snap;
using protocol::Error;
namespace code = protocol::error_code;

namespace {

/// Around a point of the view, so that a finger beside an edge finds it.
constexpr int kRays = 8;

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

/// What is found beside the ray itself must be an edge or the like: of a surface there is nothing to see.
std::vector<Snap> beside(std::vector<Snap> to) {
    if (to.empty()) return {Snap::vertex, Snap::midpoint, Snap::center, Snap::edge};
    std::erase_if(to, [](Snap snap) { return snap == Snap::point || snap == Snap::plane; });
    return to;
}

/// The more special one counts, and of two alike the nearer one.
bool is_better(const measurement::Snapped& a, const measurement::Snapped& b) {
    constexpr std::array kRank{6, 0, 1, 2, 3, 4, 5};  // by Snap
    const int rank_a = kRank[static_cast<std::size_t>(a.feature.snap)],
              rank_b = kRank[static_cast<std::size_t>(b.feature.snap)];
    return rank_a != rank_b ? rank_a < rank_b : a.offset < b.offset;
}

}  // namespace

std::optional<protocol::Snapped> Room::snapped_at(const Frame& seen, const protocol::Pick& pick) const {
    const double pixel = 2 * std::tan(seen.camera.fov * scene::kRadiansPerDegree / 2) / seen.view_size.height;
    const mesh::Ray ray = ray_at(seen, pick.x, pick.y);
    std::optional<measurement::Snapped> best;
    const auto look = [&](double x, double y, std::vector<Snap> to) {
        const std::optional<mesh::Hit> hit = hit_at(seen, x, y, pick.through);
        if (!hit) return;
        const auto found =
            measurement::snap(*scene_, *hit, ray,
                              {pick.snap->within * pixel, std::move(to), visible_.clip_planes}, mesh_edges_);
        if (found && (!best || is_better(*found, *best))) best = found;
    };
    const std::vector<Snap> to = snaps_of(pick.snap->to), around = beside(to);
    look(pick.x, pick.y, to);
    for (int i = 0; i < kRays && !around.empty(); ++i) {
        const double angle = 2 * std::numbers::pi * i / kRays;
        look(pick.x + pick.snap->within * std::cos(angle), pick.y + pick.snap->within * std::sin(angle),
             around);
    }
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
