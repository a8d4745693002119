#include "measurement/measure.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <tl/expected.hpp>
#include <variant>

#include "measurement/edge_loop.hpp"
#include "measurement/placement.hpp"
#include "measurement/vectors.hpp"

namespace vrut::measurement {

namespace {

/// In radians, 0.01 degrees: short edges of floats are off by more than rounding of doubles.
constexpr double kParallelTolerance = 0.01 * std::numbers::pi / 180;
constexpr double kCircleTolerance = 1e-6;  // of the radius, and of a right angle's cosine
constexpr double kDegrees = 180 / std::numbers::pi;

template <typename T>
using OrProblem = tl::expected<T, std::string>;

tl::unexpected<std::string> problem(std::string sentence) { return tl::unexpected(std::move(sentence)); }

/// An endless line or plane.
struct Direction {
    glm::dvec3 vector{0};  // along the line, or normal to the plane; unit
    bool is_plane = false;
};

std::optional<std::string> broken_circle(const PlacedFeature& feature) {
    const double a = safe_length(feature.second), b = safe_length(feature.third);
    const double cosine = glm::dot(unit(feature.second), unit(feature.third));
    if (a > 0 && std::abs(a - b) <= kCircleTolerance * a && std::abs(cosine) <= kCircleTolerance) return {};
    return "its part is scaled unevenly: it is no circle any more";
}

OrProblem<Direction> direction_of(const PlacedFeature& feature) {
    Direction direction{unit(feature.along), feature.snap == Snap::plane};
    if (feature.snap != Snap::edge) {
        direction.vector = unit(glm::cross(unit(feature.second), unit(feature.third)));
        if (!(sine(feature.second, feature.third) > kLeastSine)) direction.vector = glm::dvec3(0);
    }
    if (direction.vector == glm::dvec3(0)) return problem("its part is flattened: it has no direction");
    if (feature.snap == Snap::center)
        if (auto broken = broken_circle(feature)) return problem(std::move(*broken));
    return direction;
}

/// 0 to a right angle, in radians.
double angle_between(const Direction& a, const Direction& b) {
    const double across = glm::length(glm::cross(a.vector, b.vector));
    const double along = std::abs(glm::dot(a.vector, b.vector));
    return a.is_plane == b.is_plane ? std::atan2(across, along) : std::atan2(along, across);
}

std::string degrees_text(double radians) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.3g degrees", radians * kDegrees);
    return text.data();
}

class Measurement {
public:
    Measurement(const scene::PlacedScene& placed, std::span<const Feature> features, MeshEdgesMemo& memo)
        : placed_(placed), features_(features), memo_(memo), at_(placed_features(placed, features)) {}

    OrProblem<Measured> of(Kind kind) const {
        switch (kind) {
            case Kind::distance:
                return distance();
            case Kind::parallel:
                return parallel();
            case Kind::angle:
                return at_.size() == 2 ? angle_of_two() : angle_of_three();
            case Kind::radius:
                return at_.size() == 1 ? radius_of_circle() : radius_of_three();
            case Kind::length:
                return at_[0].snap == Snap::edge ? length_of_edge() : length_of_loop();
        }
        return Measured();
    }
    bool is_shown() const {
        for (const PlacedFeature& feature : at_)
            if (!scene::is_shown(placed_, feature.node, std::nullopt)) return false;
        return true;
    }

private:
    OrProblem<Measured> distance() const {
        const glm::dvec3 components = at_[1].at - at_[0].at;
        return Measured{safe_length(components), components, first_points(), {}};
    }

    OrProblem<Measured> parallel() const {
        const auto first = direction_of(at_[0]);
        if (!first) return problem(first.error());
        const Snap snap = at_[1].snap;
        if (snap == Snap::edge || snap == Snap::plane || snap == Snap::center) {
            const auto second = direction_of(at_[1]);
            if (!second) return problem(second.error());
            const double angle = angle_between(*first, *second);
            if (angle > kParallelTolerance)
                return problem("the two are not parallel: they are at " + degrees_text(angle));
            if (second->is_plane && !first->is_plane) {
                const glm::dvec3 to_foot = second->vector * glm::dot(second->vector, at_[1].at - at_[0].at);
                return Measured{safe_length(to_foot), {}, {world(at_[0].at), world(at_[0].at + to_foot)}, {}};
            }
        }
        const glm::dvec3 offset = at_[1].at - at_[0].at;
        const glm::dvec3 along = first->vector * glm::dot(first->vector, offset);
        const glm::dvec3 from_foot = first->is_plane ? along : offset - along;
        return Measured{safe_length(from_foot), {}, {world(at_[1].at - from_foot), world(at_[1].at)}, {}};
    }

    OrProblem<Measured> angle_of_two() const {
        const auto first = direction_of(at_[0]), second = direction_of(at_[1]);
        if (!first) return problem(first.error());
        if (!second) return problem(second.error());
        return Measured{angle_between(*first, *second) * kDegrees, {}, first_points(), {}};
    }

    OrProblem<Measured> angle_of_three() const {
        const glm::dvec3 a = unit(at_[0].at - at_[1].at), b = unit(at_[2].at - at_[1].at);
        if (a == glm::dvec3(0) || b == glm::dvec3(0))
            return problem("two of its points are one: there is no angle");
        const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
        return Measured{angle * kDegrees, {}, first_points(), {}};
    }

    OrProblem<Measured> radius_of_circle() const {
        if (auto broken = broken_circle(at_[0])) return problem(std::move(*broken));
        return Measured{safe_length(at_[0].second), {}, {world(at_[0].at), world(at_[0].second)}, {}};
    }

    OrProblem<Measured> radius_of_three() const {
        const glm::dvec3 a = at_[1].at - at_[0].at, b = at_[2].at - at_[0].at;
        const double size = std::max(largest(a), largest(b));
        if (!(sine(a, b) > kLeastSine) || !(sine(a, b - a) > kLeastSine))
            return problem("its points lie on one line: there is no circle through them");
        const glm::dvec3 p = a / size, q = b / size, normal = glm::cross(p, q);
        const glm::dvec3 center =
            (glm::cross(normal, p) * glm::dot(q, q) + glm::cross(q, normal) * glm::dot(p, p)) /
            (2 * glm::dot(normal, normal));
        return Measured{glm::length(center) * size, {}, {world(center * size), world(glm::dvec3(0))}, {}};
    }

    OrProblem<Measured> length_of_edge() const {
        return Measured{safe_length(at_[0].along), {}, {end_of_edge(1), end_of_edge(2)}, {}};
    }
    glm::dvec3 end_of_edge(std::size_t point) const {
        return in_world(placed_, at_[0].node, features_[0].points[point]);
    }

    OrProblem<Measured> length_of_loop() const {
        const scene::Node& node = placed_.scene->nodes()[static_cast<std::size_t>(at_[0].node)];
        const auto* data = std::get_if<scene::GeometryData>(&node.data);
        if (!data || data->geometry == scene::kNone) return problem("its edge is not in the part any more");
        const MeshEdges& edges = memo_.of(placed_.scene, data->geometry);
        const auto half_edge = edges.mesh().find_half_edge(features_[0].points[1], features_[0].points[2]);
        if (!half_edge || !edges.is_feature(*half_edge))
            return problem("its edge is not in the part any more");
        const std::vector<unsigned> loop = edge_loop(edges, *half_edge);
        if (loop.empty()) return problem("its loop is not closed");
        return measured_loop(edges.mesh(), loop);
    }

    Measured measured_loop(const WeldedMesh& mesh, const std::vector<unsigned>& loop) const {
        const glm::dmat3 linear(placed_.world[static_cast<std::size_t>(at_[0].node)]);
        double length = 0;
        std::vector<glm::dvec3> line;
        line.reserve(loop.size());
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const glm::dvec3& start = mesh.positions()[loop[i]];
            const glm::dvec3& end = mesh.positions()[loop[(i + 1) % loop.size()]];
            length += safe_length(linear * (end - start));
            line.push_back(in_world(placed_, at_[0].node, start));
        }
        return {length, {}, thinned_loop(line), {}};
    }

    glm::dvec3 world(const glm::dvec3& offset) const {
        return in_world(placed_, at_[0].node, features_[0].points[0]) + offset;
    }
    std::vector<glm::dvec3> first_points() const {
        std::vector<glm::dvec3> points;
        points.reserve(at_.size());
        for (std::size_t i = 0; i < at_.size(); ++i)
            points.push_back(in_world(placed_, at_[i].node, features_[i].points[0]));
        return points;
    }

    const scene::PlacedScene& placed_;
    std::span<const Feature> features_;
    MeshEdgesMemo& memo_;
    std::vector<PlacedFeature> at_;
};

std::optional<std::string> unplaced(const scene::PlacedScene& placed, std::span<const Feature> features) {
    for (const Feature& feature : features) {
        const scene::Index node = placed.scene->find_node(feature.node);
        const std::string number = std::to_string(feature.node);
        if (node == scene::kNone) return "there is no node " + number;
        if (!scene::is_finite(placed.world[static_cast<std::size_t>(node)]))
            return "node " + number + " lies beyond the range of numbers";
    }
    return {};
}

Measured without_value(std::string why) { return {{}, {}, {}, std::move(why)}; }

}  // namespace

Measured measure(const scene::PlacedScene& placed, Kind kind, std::span<const Feature> features,
                 MeshEdgesMemo& memo) {
    if (auto wrong = invalid(kind, features)) return without_value(std::move(*wrong));
    if (auto wrong = unplaced(placed, features)) return without_value(std::move(*wrong));
    const Measurement measurement(placed, features, memo);
    OrProblem<Measured> measured = measurement.of(kind);
    if (!measured) return without_value(std::move(measured.error()));
    if (!std::isfinite(*measured->value)) return without_value("its value lies beyond the range of numbers");
    if (!measurement.is_shown()) measured->line.clear();
    return *std::move(measured);
}

}  // namespace vrut::measurement
