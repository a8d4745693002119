// Studies of picks that snap to features, for measuring.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "noisy_solids.hpp"
#include "solids.hpp"

namespace vrut::stability {

namespace {

using measurement::Snap;
using measurement::Snapped;

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kPicks = 200;
const std::vector<double> kNoises{1e-7, 1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1};

/// Where picks aim.
enum class Aim { corner, edge, rim, top, side };

/// Of the picks at noisy solids.
struct Outcome {
    int picks = 0, missed = 0, mistaken = 0;
    double worst = 0;  ///< error of what was found rightly, in deviations of the noise
};

/// A number from 0 to 1.
double share(Noise& noise) { return (noise.next() + 1) / 2; }

template <typename Items>
const auto& one_of(const Items& items, Noise& noise) {
    const double place = share(noise) * static_cast<double>(items.size());
    return items[std::min(items.size() - 1, static_cast<std::size_t>(place))];
}

double distance_to_chain(const glm::dvec3& point, const Points& chain) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
        const glm::dvec3 edge = chain[i + 1] - chain[i];
        const double along = glm::dot(point - chain[i], edge) / glm::dot(edge, edge);
        least = std::min(least, glm::distance(point, chain[i] + edge * std::clamp(along, 0.0, 1.0)));
    }
    return least;
}

double angle_of(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// In radians, of a plane's front.
double normal_error(const Snapped& plane, const glm::dvec3& right) {
    const auto& p = plane.feature.points;
    return angle_of(glm::cross(p[1] - p[0], p[2] - p[0]), right);
}

/// Picks at one solid, at features of one kind.
class Picks {
public:
    Picks(const Solid& solid, double noise, Aim aim, Noise& random)
        : solid_(solid),
          sigma_(noise * solid.edge_length),
          aim_(aim),
          random_(random),
          noisy_(solid, sigma_, random) {
        edges_.reserve(solid_.edges.size());
        for (const Points& edge : solid_.edges) edges_.push_back(noisy_.moved(edge));
        all_edges_ = edges_;
        all_edges_.reserve(edges_.size() + solid_.other_edges.size());
        for (const Points& edge : solid_.other_edges) all_edges_.push_back(noisy_.moved(edge));
        rim_ = noisy_.moved(solid_.rim);
    }

    void add_one(Outcome& outcome) {
        place();
        const glm::dvec3 aside(random_.next(), random_.next(), 0);
        const double radius = aim_ == Aim::top || aim_ == Aim::side ? 0 : 0.5 * kConeRadius;
        const glm::dvec3 out = aim_ == Aim::side ? glm::dvec3(at_.x, at_.y, 0.2) : glm::dvec3(0.15, 0.1, 1);
        const auto found = noisy_.snapped(at_ + aside * radius, at_ + glm::normalize(out) * kEyeDistance);
        ++outcome.picks;
        const std::optional<double> error = found ? right_error(*found) : std::nullopt;
        outcome.missed += !error;
        outcome.mistaken += found && is_mistaken(*found);
        if (error) outcome.worst = std::max(outcome.worst, *error / sigma_);
    }

private:
    /// Chooses where the next pick aims: at features as the noisy mesh has them.
    void place() {
        switch (aim_) {
            case Aim::corner:
                feature_ = {one_of(solid_.corners, random_)};
                at_ = noisy_.moved(feature_[0]);
                break;
            case Aim::edge:
                do {
                    feature_ = one_of(edges_, random_);
                    place_on_chain(feature_);
                } while (std::min({glm::distance(at_, feature_.front()), glm::distance(at_, feature_.back()),
                                   glm::distance(at_, middle(feature_))}) < 3 * kConeRadius);
                break;
            case Aim::rim:
                place_on_chain(rim_);
                break;
            case Aim::top:
                do place_in_triangle(solid_.top);
                while (is_near_edges());
                break;
            case Aim::side:
                do place_in_triangle(solid_.side);
                while (std::min(-at_.z, at_.z + 10 * solid_.edge_length) < 3 * kConeRadius);
        }
    }
    void place_on_chain(const Points& chain) {
        const double place = share(random_) * static_cast<double>(chain.size() - 1);
        const std::size_t i = std::min(chain.size() - 2, static_cast<std::size_t>(place));
        at_ = glm::mix(chain[i], chain[i + 1], share(random_));
    }
    void place_in_triangle(const std::vector<std::array<glm::dvec3, 3>>& triangles) {
        const auto& t = one_of(triangles, random_);
        double u = share(random_), v = share(random_);
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        const glm::dvec3 a = noisy_.moved(t[0]);
        at_ = a + (noisy_.moved(t[1]) - a) * u + (noisy_.moved(t[2]) - a) * v;
    }
    bool is_near_edges() const {
        const auto is_near = [&](const Points& chain) {
            return distance_to_chain(at_, chain) < 3 * kConeRadius;
        };
        return is_near(rim_) || std::any_of(edges_.begin(), edges_.end(), is_near);
    }
    static glm::dvec3 middle(const Points& edge) { return (edge.front() + edge.back()) * 0.5; }

    /// In the unit of the noise, times the length of an edge for angles; none where it is not what was aimed
    /// at.
    std::optional<double> right_error(const Snapped& found) const {
        const Points& p = found.feature.points;
        switch (aim_) {
            case Aim::corner:
                if (found.feature.snap != Snap::vertex || !is_at(p[0], at_)) return {};
                return glm::distance(p[0], feature_[0]);
            case Aim::edge:
                if (found.feature.snap != Snap::edge || !is_whole(found, feature_)) return {};
                return distance_to_chain(p[0], feature_);
            case Aim::rim:
                if (found.feature.snap != Snap::center || circle_error(found) > 0.01) return {};
                return circle_error(found);
            case Aim::top:
                if (found.feature.snap != Snap::plane || plane_error(found) > kDegree) return {};
                return plane_error(found) * solid_.edge_length;
            case Aim::side:
                break;
        }
        return is_mistaken(found) ? std::nullopt : std::optional(0.0);
    }
    static bool is_at(const glm::dvec3& a, const glm::dvec3& b) { return glm::distance(a, b) <= kConeRadius; }
    static bool is_whole(const Snapped& edge, const Points& right) {
        const Points& p = edge.feature.points;
        return (is_at(p[1], right.front()) && is_at(p[2], right.back())) ||
               (is_at(p[2], right.front()) && is_at(p[1], right.back()));
    }
    double circle_error(const Snapped& circle) const {
        const Points& p = circle.feature.points;
        const double below = glm::distance(p[0], {0, 0, -solid_.depth});
        return std::max(std::min(glm::length(p[0]), below), std::abs(glm::distance(p[0], p[1]) - 1));
    }
    double plane_error(const Snapped& plane) const {
        if (aim_ != Aim::side) return normal_error(plane, {0, 0, 1});
        // A facet is that of the mesh.
        const glm::dvec3 at = plane.feature.points[0];
        return std::max(0.0, normal_error(plane, {at.x, at.y, 0}) - solid_.edge_length / 2);
    }

    bool is_on_rim(const glm::dvec3& at) const {
        const glm::dvec3 below(0, 0, solid_.depth);
        return std::min(distance_to_chain(at, rim_), distance_to_chain(at + below, rim_)) <= kConeRadius;
    }
    /// That it says something of the part which is not so. A point, a vertex, and a straight piece of an edge
    /// or a rim are of the mesh.
    bool is_mistaken(const Snapped& found) const {
        const glm::dvec3& at = found.feature.points[0];
        switch (found.feature.snap) {
            case Snap::midpoint:
                return std::none_of(all_edges_.begin(), all_edges_.end(),
                                    [&](const Points& edge) { return is_at(at, middle(edge)); });
            case Snap::center:
                return rim_.empty() || circle_error(found) > 0.01;
            case Snap::edge:
                return !is_on_rim(at) &&
                       std::none_of(all_edges_.begin(), all_edges_.end(), [&](const Points& edge) {
                           return distance_to_chain(at, edge) <= kConeRadius;
                       });
            case Snap::plane:
                return (aim_ == Aim::top || aim_ == Aim::side) && plane_error(found) > kDegree;
            default:
                return false;
        }
    }

    const Solid& solid_;
    double sigma_;
    Aim aim_;
    Noise& random_;
    NoisySolid noisy_;
    std::vector<Points> edges_, all_edges_;
    Points rim_;
    Points feature_;  // what is aimed at
    glm::dvec3 at_{0};
};

bool has_any(const Solid& solid, Aim aim) {
    if (aim == Aim::rim) return !solid.rim.empty();
    if (aim == Aim::side) return !solid.side.empty();
    return aim == Aim::top || !solid.edges.empty();
}

/// Adds picks at the solids that have what is aimed at, each with noise of its own a few times.
void pick(double noise, Aim aim, Outcome& outcome) {
    constexpr int kTimes = 10;
    std::vector<Solid> solids{coarse_box(), plate_with_hole(), fine_cylinder()};
    std::erase_if(solids, [&](const Solid& solid) { return !has_any(solid, aim); });
    Noise random;
    const int count = kPicks / kTimes / static_cast<int>(solids.size());
    for (int time = 0; time < kTimes; ++time)
        for (const Solid& solid : solids) {
            Picks picks(solid, noise, aim, random);
            for (int i = 0; i < count; ++i) picks.add_one(outcome);
        }
}

double percent(int part, int whole) { return 100.0 * part / whole; }

Study noisy(const Laboratory& laboratory, const std::string& file, const std::string& title, Aim aim) {
    Study study{file, title, "deviation of the vertices / length of an edge",
                "picks that do not find it, in percent"};
    study.bound = 2;
    study.cost = "None.";
    for (const double noise : laboratory.chosen(kNoises)) {
        Outcome outcome;
        pick(noise, aim, outcome);
        study.method.points.push_back({noise, percent(outcome.missed, outcome.picks)});
    }
    return study;
}

/// The circle through three points; its radius is 0 where there is none.
double radius_through(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double area = glm::length(glm::cross(b - a, c - a));
    return area > 0 ? glm::distance(a, b) * glm::distance(b, c) * glm::distance(c, a) / (2 * area) : 0;
}

/// As a file of floats holds it.
glm::dvec3 rounded(const glm::dvec3& p) { return glm::dvec3(glm::vec3(p)); }

/// A round slice of radius 1, of an arc of `count` segments; closed if it is the whole circle.
Outline slice(double arc, unsigned count) {
    Outline outline;
    outline.reserve(count + 2);
    const bool whole = arc == 360;
    for (unsigned i = 0; i < count + !whole; ++i) {
        const double angle = arc * kDegree * i / count;
        outline.emplace_back(std::cos(angle), std::sin(angle));
    }
    if (!whole) outline.emplace_back(-0.5 * std::cos(arc * kDegree / 2), -0.5 * std::sin(arc * kDegree / 2));
    return outline;
}

void keep_top(scene::Geometry& geometry) {
    std::erase_if(geometry.triangles, [&](const glm::uvec3& t) {
        return std::min({geometry.positions[t.x].z, geometry.positions[t.y].z, geometry.positions[t.z].z}) <
               0;
    });
}

/// The largest errors of the radius of a slice, which is turned, moved and rounded a few times; 1 where no
/// circle is found.
struct RadiusErrors {
    double snapped = 0, of_three = 0;
};
RadiusErrors radius_errors(const Outline& outline, unsigned count, bool is_solid = true) {
    constexpr int kTimes = 20;
    RadiusErrors worst;
    Noise noise;
    for (int time = 0; time < kTimes; ++time) {
        const glm::dvec3 axis(noise.next(), noise.next(), noise.next());
        const glm::dmat4 turn = turned_by(180 * noise.next(), glm::normalize(axis));
        const auto placed_at = [&](const glm::dvec3& p) { return glm::dvec3(turn * glm::dvec4(p, 1)); };
        scene::Geometry geometry = prism(outline, 0.5);
        if (!is_solid) keep_top(geometry);
        for (glm::dvec3& p : geometry.positions) p = rounded(placed_at(p));
        const auto scene = scene_of({{1, with_bounds(std::move(geometry)), material_of({1, 1, 1})}});
        const auto vertex = [&](unsigned i) { return placed_at({outline[i % outline.size()], 0}); };
        const unsigned i = count / 2;
        const glm::dvec3 at = glm::mix(vertex(i), vertex(i + 1), 0.3), from = at + placed_at({0.3, 0.2, 5});
        measurement::MeshEdgesMemo memo;
        const auto found = clicked(*scene, at, from, memo);
        const bool is_circle = found && found->feature.snap == Snap::center;
        const auto& points = found ? found->feature.points : Points{};
        worst.snapped =
            std::max(worst.snapped, is_circle ? std::abs(glm::distance(points[0], points[1]) - 1) : 1);
        const double of_three =
            radius_through(rounded(vertex(i - 1)), rounded(vertex(i)), rounded(vertex(i + 1)));
        worst.of_three = std::max(worst.of_three, std::abs(of_three - 1));
    }
    return worst;
}

/// A sliver beside large triangles, all in one plane.
scene::Geometry face_with_sliver(double ratio, const glm::dmat3& turn, bool is_rounded) {
    scene::Geometry face;
    face.positions = {{0, 0, 0}, {1, 0, 0}, {0.4, 1 / ratio, 0}, {0.5, 2, 0}, {0.5, -1, 0}};
    face.triangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 3}, {1, 0, 4}};
    for (glm::dvec3& p : face.positions) p = is_rounded ? rounded(turn * p) : turn * p;
    return with_bounds(std::move(face));
}

Study of_few_edges(const Laboratory& laboratory, const std::string& file, const std::string& title,
                   bool is_solid) {
    Study study{file, title, "degrees of an edge", "error of the radius, of itself"};
    study.bound = 1e-6;
    study.method.title = "least squares of all vertices";
    study.baseline.title = "through three vertices";
    study.cost = "None.";
    for (const double count :
         laboratory.chosen({512, 256, 128, 64, 32, 24, 20, 18, 17, 16, 12, 10, 9, 8, 6, 5, 4})) {
        const auto edges = static_cast<unsigned>(count);
        const RadiusErrors errors = radius_errors(slice(360, edges), edges, is_solid);
        study.method.points.push_back({360 / count, errors.snapped});
        study.baseline.points.push_back({360 / count, errors.of_three});
    }
    return study;
}

/// The largest errors of the normal of a face, which is turned a few times, where a sliver is picked; 1 where
/// no plane is found.
Study of_slivers(const Laboratory& laboratory, const std::string& file, const std::string& title,
                 bool is_rounded) {
    Study study{file, title, "length of a sliver / its width", "error of the plane's normal, in radians"};
    study.method.title = "largest triangle in the plane of the picked one";
    study.baseline.title = "the picked triangle";
    study.cost = "None.";
    for (const double ratio : laboratory.chosen({1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8})) {
        double worst = 0, worst_alone = 0;
        Noise noise;
        for (int time = 0; time < kPicks; ++time) {
            const glm::dvec3 axis(noise.next(), noise.next(), noise.next());
            const glm::dmat3 turn(turned_by(180 * noise.next(), glm::normalize(axis)));
            const glm::dvec3 normal = turn[2];
            const scene::Geometry face = face_with_sliver(ratio, turn, is_rounded);
            const auto scene = scene_of({{1, face, material_of({1, 1, 1})}});
            const glm::dvec3 at = (face.positions[0] + face.positions[1] + face.positions[2]) / 3.0;
            const mesh::Ray ray{at + normal * kEyeDistance, -normal};
            const auto hit = mesh::pick(*scene, ray);
            if (!hit) continue;
            measurement::MeshEdgesMemo memo;
            const auto found =
                measurement::snap(*scene, *hit, ray, {.radius = kCone, .to = {Snap::plane}}, memo);
            worst = std::max(worst, found ? normal_error(*found, normal) : 1);
            worst_alone = std::max(worst_alone, angle_of(hit->normal, normal));
        }
        study.method.points.push_back({ratio, worst});
        study.baseline.points.push_back({ratio, worst_alone});
    }
    return study;
}

}  // namespace

Study corners_of_noisy_meshes(const Laboratory& laboratory) {
    Study study = noisy(laboratory, "noisy-corners", "Picking corners of noisy meshes", Aim::corner);
    study.method.title = "where folds of more than 20 degrees meet";
    study.bound = 3;
    study.explanation =
        "A corner is a vertex of the mesh, with its noise. Where a pick is beside the part, all eight rays "
        "around it may pass the corner by.";
    return study;
}

Study edges_of_noisy_meshes(const Laboratory& laboratory) {
    Study study = noisy(laboratory, "noisy-edges", "Picking straight edges of noisy meshes", Aim::edge);
    study.limit = 3e-6;
    study.method.title = "folds in a row, within the rounding of floats";
    study.explanation =
        "An edge of several pieces falls apart in more noise than the rounding of floats: its pieces are "
        "picked, without midpoints. An edge of one piece is found in any noise.";
    return study;
}

Study circles_of_noisy_meshes(const Laboratory& laboratory) {
    Study study = noisy(laboratory, "noisy-circles", "Picking circles of noisy meshes", Aim::rim);
    study.limit = 3e-4;
    study.method.title = "least squares, within 1e-4 of the radius";
    study.explanation = "In more noise it is a polygon: pieces of its rim are picked.";
    return study;
}

Study planes_of_noisy_meshes(const Laboratory& laboratory) {
    Study study = noisy(laboratory, "noisy-planes", "Picking planes of noisy meshes", Aim::top);
    study.limit = 3e-6;
    study.method.title = "large triangles, or two in one plane";
    study.explanation = "In more noise the plane of a large triangle is picked, and of a fine mesh a point.";
    return study;
}

Study mistakes_on_noisy_meshes(const Laboratory& laboratory) {
    Study study{"noisy-mistakes", "Picks of noisy meshes that find what is not there",
                "deviation of the vertices / length of an edge", "picks that find another thing, in percent"};
    study.bound = 0.5;
    study.limit = 3e-4;
    study.method.title = "first kind that is found in the cone";
    study.explanation =
        "From 3e-4 on midpoints of pieces of a coarse rim are found, from 0.01 on planes that lean by more "
        "than a degree, and at 0.1 folds in a face. Points, vertices "
        "and pieces of edges are of the mesh, and no mistakes.";
    study.cost = "None.";
    for (const double noise : laboratory.chosen(kNoises)) {
        Outcome outcome;
        for (const Aim aim : {Aim::corner, Aim::edge, Aim::rim, Aim::top, Aim::side})
            pick(noise, aim, outcome);
        study.method.points.push_back({noise, percent(outcome.mistaken, outcome.picks)});
    }
    return study;
}

Study values_of_noisy_meshes(const Laboratory& laboratory) {
    Study study{"noisy-values", "What is measured on noisy meshes",
                "deviation of the vertices / length of an edge", "error / deviation of the vertices"};
    study.bound = 6;
    study.method.title = "corner, circle and plane that were found";
    study.explanation =
        "A corner is off by its vertex's noise. The error of a plane is its normal's, times the length of an "
        "edge.";
    study.cost = "None.";
    for (const double noise : laboratory.chosen(kNoises)) {
        Outcome outcome;
        for (const Aim aim : {Aim::corner, Aim::rim, Aim::top}) pick(noise, aim, outcome);
        study.method.points.push_back({noise, outcome.worst});
    }
    return study;
}

Study circles_of_few_edges(const Laboratory& laboratory) {
    Study study = of_few_edges(laboratory, "coarse-circles", "Circles of ever fewer edges on a solid", true);
    study.limit = 45;
    study.explanation =
        "With 8 edges or fewer the rim turns by more than 40 degrees, in corners: it is a prism.";
    return study;
}

Study discs_of_few_edges(const Laboratory& laboratory) {
    Study study = of_few_edges(laboratory, "coarse-discs", "Discs of ever fewer edges", false);
    study.limit = 45;
    study.explanation =
        "With 8 edges or fewer the outline turns by more than 40 degrees, in corners: it is a polygon.";
    return study;
}

Study circles_of_short_arcs(const Laboratory& laboratory) {
    Study study{"short-arcs", "Ever shorter arcs of circles", "360 degrees / the arc",
                "error of the radius, of itself"};
    study.bound = 1e-5;
    study.limit = 12;
    study.method.title = "least squares of all vertices";
    study.baseline.title = "through three vertices";
    study.explanation =
        "What is found counts; the error is 1 where no circle is. Circles need more than 30 degrees, so that "
        "a bent line is none.";
    study.cost = "None.";
    for (const double arc : laboratory.chosen({360, 270, 180, 120, 90, 60, 45, 40, 36, 31, 30, 25, 20, 10})) {
        constexpr unsigned kEdges = 24;
        const RadiusErrors errors = radius_errors(slice(arc, kEdges), kEdges);
        study.method.points.push_back({360 / arc, errors.snapped});
        study.baseline.points.push_back({360 / arc, errors.of_three});
    }
    return study;
}

Study planes_of_slivers(const Laboratory& laboratory) {
    Study study = of_slivers(laboratory, "sliver-planes", "Picking the plane of a face with a sliver", false);
    study.bound = 1e-7;
    study.explanation =
        "Positions are doubles. The normal of a sliver is not exact; that of the largest triangle beside it "
        "counts.";
    return study;
}

Study planes_of_rounded_slivers(const Laboratory& laboratory) {
    Study study =
        of_slivers(laboratory, "rounded-slivers", "Picking the plane of a face with a rounded sliver", true);
    study.bound = 1e-6;
    study.limit = 1e7;
    study.explanation =
        "A sliver counts with its neighbours as far as rounding may have turned it out of their plane. One "
        "thinner than a millionth of its length has no plane.";
    return study;
}

}  // namespace vrut::stability
