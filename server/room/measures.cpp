#include "room/measures.hpp"

#include <cmath>

#include "measurement/measure.hpp"
#include "measurement/snap_around.hpp"

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

std::optional<protocol::Snapped> Measures::snapped(const scene::PlacedScene& placed, const SeenFrame& seen,
                                                   const protocol::Pick& pick, const Hit& hit,
                                                   std::span<const scene::ClipPlane> clip_planes) const {
    const double pixel = 2 * std::tan(seen.camera.fov * scene::kRadiansPerDegree / 2) / seen.view_size.height;
    const auto best =
        measurement::snap_around(placed, seen.ray_at(pick.x, pick.y), hit,
                                 {pick.snap->within * pixel, snaps_of(pick.snap->to), clip_planes}, edges_);
    if (!best) return {};
    const auto& feature = best->feature;
    return protocol::Snapped{
        {feature.node, static_cast<protocol::Snap>(feature.snap), feature.points}, best->point, best->line};
}

std::optional<Error> Measures::problem_of(const protocol::SharedMap<protocol::MeasureState>& measures,
                                          const scene::Scene& scene) {
    for (const auto& [name, measure] : *measures) {
        const std::string where = "'measures." + name.substr(0, 40) + "'";
        for (const protocol::Feature& pick : measure.picks)
            if (scene.find_node(pick.node) == scene::kNone)
                return Error{
                    {}, code::unknown_node, where + ": there is no node " + std::to_string(pick.node)};
        const auto kind = static_cast<measurement::Kind>(measure.kind);
        if (const auto wrong = measurement::invalid(kind, features_of(measure)))
            return Error{{}, code::out_of_range, where + ": " + *wrong};
    }
    return {};
}

std::optional<Measures::Results> Measures::changed(
    const protocol::SharedMap<protocol::MeasureState>& measures,
    const std::shared_ptr<const scene::PlacedScene>& placed) {
    if (placed_ == placed && measures_ == measures) return std::nullopt;
    placed_ = placed;
    measures_ = measures;
    Results measured;
    for (const auto& [name, measure] : *measures)
        measured[name] = measured_state_of(measurement::measure(
            *placed, static_cast<measurement::Kind>(measure.kind), features_of(measure), edges_));
    return measured;
}

}  // namespace vrut::server::room
