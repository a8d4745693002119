#include "cut.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vrut {

namespace {

constexpr double kArcHeight = 1e-5;  // metres, of an arc over its chords
constexpr double kMostSteps = 1000;  // of an arc, however large
constexpr double kTopAbove = 0.5;    // metres: what cuts seen from the top leave alone below

glm::dvec2 project(Outline::From from, const glm::dvec3& p) {
    switch (from) {
        case Outline::From::top:
            return {p.x, p.z};
        case Outline::From::front:
        case Outline::From::rear:
            return {p.x, p.y};
        default:
            return {p.z, p.y};
    }
}

glm::dvec3 lift(Outline::From from, const glm::dvec2& d) {
    switch (from) {
        case Outline::From::top:
            return {d.x, 0, d.y};
        case Outline::From::front:
        case Outline::From::rear:
            return {d.x, d.y, 0};
        default:
            return {0, d.y, d.x};
    }
}

/// Of the half of the car that the outline means.
CutDistance half(Outline::From from, const glm::dvec3& p) {
    switch (from) {
        case Outline::From::left:
            return {-p.x, {-1, 0, 0}};
        case Outline::From::right:
            return {p.x, {1, 0, 0}};
        case Outline::From::top:
            return {kTopAbove - p.y, {0, -1, 0}};
        case Outline::From::front:
            return {-p.z, {0, 0, -1}};
        case Outline::From::rear:
            return {p.z, {0, 0, 1}};
        case Outline::From::sides:
            break;
    }
    return {-1e9, {0, 0, 0}};
}

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Signed distance from a polygon, and its gradient.
std::pair<double, glm::dvec2> polygon_distance(const std::vector<glm::dvec2>& points, const glm::dvec2& p) {
    double nearest = 1e300;
    glm::dvec2 away(0), outward(0);
    bool inside = false;
    glm::dvec2 a = points.back();
    for (const glm::dvec2& b : points) {
        const glm::dvec2 along = b - a, from_a = p - a;
        const double t = std::clamp(glm::dot(from_a, along) / glm::dot(along, along), 0.0, 1.0);
        const glm::dvec2 offset = from_a - t * along;
        if (const double square = glm::dot(offset, offset); square < nearest) {
            nearest = square;
            away = offset;
            outward = {along.y, -along.x};
        }
        if ((a.y > p.y) != (b.y > p.y) && (cross(along, from_a) > 0) == (b.y > a.y)) inside = !inside;
        a = b;
    }
    const double distance = std::sqrt(nearest), sign = inside ? -1 : 1;
    return {sign * distance, distance > 1e-9 ? sign / distance * away : glm::normalize(outward)};
}

}  // namespace

std::vector<glm::dvec2> rounded_polygon(const std::vector<Outline::Corner>& corners) {
    const std::size_t n = corners.size();
    const auto place = [&](std::size_t i) { return corners[i % n].place; };
    // From a corner to where its arc begins, for a radius of 1.
    const auto reach_of = [&](std::size_t i) {
        const glm::dvec2 in = glm::normalize(place(i + n - 1) - place(i)),
                         out = glm::normalize(place(i + 1) - place(i));
        const double cosine = std::clamp(glm::dot(in, out), -1.0, 1.0);
        return std::sqrt((1 + cosine) / std::max(1 - cosine, 1e-12));
    };
    std::vector<double> radii(n);
    for (std::size_t i = 0; i < n; ++i) {
        const auto room = [&](std::size_t k) {  // on the edge from corner k to the next
            const double both =
                corners[k % n].radius * reach_of(k) + corners[(k + 1) % n].radius * reach_of(k + 1);
            return both > 0 ? std::min(1.0, glm::distance(place(k), place(k + 1)) / both) : 1.0;
        };
        radii[i] = corners[i].radius * std::min(room(i + n - 1), room(i)) * (1 - 1e-9);
    }
    std::vector<glm::dvec2> points;
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec2 in = glm::normalize(place(i + n - 1) - place(i)),
                         out = glm::normalize(place(i + 1) - place(i));
        const double turn = std::atan2(cross(-in, out), glm::dot(-in, out));
        if (radii[i] < 1e-7 || std::abs(turn) < 1e-6) {
            points.push_back(place(i));
            continue;
        }
        const double side = turn > 0 ? 1 : -1;
        const glm::dvec2 start = place(i) + radii[i] * reach_of(i) * in;
        const glm::dvec2 centre = start + radii[i] * side * glm::dvec2(in.y, -in.x);
        const double step = std::sqrt(8 * kArcHeight / radii[i]);
        const int steps = static_cast<int>(std::clamp(std::ceil(std::abs(turn) / step), 1.0, kMostSteps));
        const glm::dvec2 spoke = start - centre;
        for (int k = 0; k <= steps; ++k) {
            const double angle = turn * k / steps, c = std::cos(angle), s = std::sin(angle);
            points.emplace_back(centre + glm::dvec2(c * spoke.x - s * spoke.y, s * spoke.x + c * spoke.y));
        }
    }
    double area = 0;
    for (std::size_t i = 0; i < points.size(); ++i) area += cross(points[i], points[(i + 1) % points.size()]);
    if (area < 0) std::reverse(points.begin(), points.end());
    // No two in the same place: every edge has a direction.
    const auto same = [](const glm::dvec2& a, const glm::dvec2& b) { return glm::distance(a, b) < 1e-9; };
    points.erase(std::unique(points.begin(), points.end(), same), points.end());
    if (points.size() > 1 && same(points.front(), points.back())) points.pop_back();
    return points;
}

CutShape::CutShape(const Cut& cut) : gap_(cut.gap) {
    for (const Outline& outline : cut.within) {
        Ring ring{outline.from, rounded_polygon(outline.corners), glm::dvec2(1e300), glm::dvec2(-1e300)};
        for (const glm::dvec2& p : ring.points) {
            ring.low = glm::min(ring.low, p);
            ring.high = glm::max(ring.high, p);
        }
        rings_.push_back(std::move(ring));
    }
}

CutDistance CutShape::at(const glm::dvec3& point, double reach) const {
    CutDistance result{-1e300, {}};
    const auto take = [&](const CutDistance& distance) {
        if (distance.value > result.value) result = distance;
        return result.value > reach;
    };
    for (const Ring& ring : rings_) {
        const glm::dvec2 p = project(ring.from, point);
        const glm::dvec2 beyond = glm::max(ring.low - p, p - ring.high);
        if (take(half(ring.from, point)) || std::max(beyond.x, beyond.y) > reach)
            return {std::max({result.value, beyond.x, beyond.y}), glm::dvec3(0)};
    }
    for (const Ring& ring : rings_) {
        const auto [value, gradient] = polygon_distance(ring.points, project(ring.from, point));
        if (take({value, lift(ring.from, gradient)})) break;
    }
    return result;
}

double PanelField::at(const glm::dvec3& point, const glm::dvec3& normal) const {
    constexpr double kFar = 0.02;  // metres; farther from a border only the side counts
    // Along the surface it is farther than in the projection.
    const auto along = [&](const CutDistance& distance) {
        const double slope = glm::length(distance.gradient - glm::dot(distance.gradient, normal) * normal);
        return slope > 0 ? distance.value / std::max(slope, 0.2) : distance.value;
    };
    double field = -1e300;
    if (keep_ != scene::kNone) {
        const CutShape& cut = cuts_[static_cast<std::size_t>(keep_)];
        field = along(cut.at(point, kFar)) + (grow_ > 0 ? -grow_ : cut.gap() / 2 + margin_);
        if (field > kFar) return field;
    }
    const std::size_t before = keep_ == scene::kNone ? cuts_.size() : static_cast<std::size_t>(keep_);
    for (std::size_t i = 0; i < before; ++i) {
        const double limit = cuts_[i].gap() / 2 + margin_;
        field = std::max(field, limit - along(cuts_[i].at(point, kFar + limit)));
    }
    return field;
}

}  // namespace vrut
