#include "measurement/chain_shapes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "measurement/vectors.hpp"

namespace vrut::measurement {

namespace {

constexpr std::size_t kFewestPoints = 5;
constexpr double kTolerance = 1e-4;  // in radii
constexpr double kLeastArc = 30 * std::numbers::pi / 180;
constexpr double kLongestStep = 60 * std::numbers::pi / 180;
constexpr double kStraightness = 1e-6;
constexpr std::size_t kMostTested = 16;  // points of a run whenever it goes on
/// In squares of the points' extent: what spans less has no plane.
constexpr double kLeastArea = 1e-6;
constexpr double kClearlyOff = 1e-3;  // of the radius: ten times what noise may do to a circle

/// Points about their mean, divided by their extent.
struct Scaled {
    glm::dvec3 mean{0};
    double extent = 0;
    std::vector<glm::dvec3> points;
};

std::optional<Scaled> scaled(std::span<const glm::dvec3> points) {
    Scaled scaled;
    const auto count = static_cast<double>(points.size());
    for (const glm::dvec3& point : points) scaled.mean += (point - points[0]) / count;
    scaled.mean += points[0];
    for (const glm::dvec3& point : points)
        scaled.extent = std::max(scaled.extent, safe_length(point - scaled.mean));
    if (!(scaled.extent > 0) || !std::isfinite(scaled.extent)) return {};
    scaled.points.reserve(points.size());
    for (const glm::dvec3& point : points) scaled.points.push_back((point - scaled.mean) / scaled.extent);
    return scaled;
}

/// The normal around which the points run counter-clockwise. None if they span no area.
std::optional<glm::dvec3> normal_around(std::span<const glm::dvec3> points) {
    glm::dvec3 area(0);
    for (std::size_t i = 0; i < points.size(); ++i)
        area += glm::cross(points[i], points[(i + 1) % points.size()]);
    const double length = glm::length(area);
    if (!(length > kLeastArea)) return {};
    return area / length;
}

struct FlatCircle {
    glm::dvec2 center{0};
    double radius = 0;
};

std::optional<FlatCircle> least_squares(std::span<const glm::dvec2> points) {
    const auto count = static_cast<double>(points.size());
    glm::dvec2 mean(0);
    for (const glm::dvec2& p : points) mean += p / count;
    double mean_square = 0;
    for (const glm::dvec2& p : points) mean_square += glm::dot(p - mean, p - mean) / count;
    double xx = 0, xy = 0, yy = 0;
    glm::dvec2 right(0);
    for (const glm::dvec2& p : points) {
        const glm::dvec2 q = p - mean;
        xx += q.x * q.x;
        xy += q.x * q.y;
        yy += q.y * q.y;
        right += q * (0.5 * (glm::dot(q, q) - mean_square));
    }
    const double determinant = xx * yy - xy * xy;
    if (!(determinant > 0)) return {};
    const glm::dvec2 offset(right.x * yy - right.y * xy, right.y * xx - right.x * xy);
    FlatCircle circle{mean + offset / determinant, 0};
    for (const glm::dvec2& p : points) circle.radius += glm::distance(p, circle.center) / count;
    return circle;
}

bool are_on(const FlatCircle& circle, std::span<const glm::dvec2> points, double tolerance) {
    return std::all_of(points.begin(), points.end(), [&](const glm::dvec2& p) {
        return std::abs(glm::distance(p, circle.center) - circle.radius) <= tolerance;
    });
}

/// How far the points run around the center, in radians; 0 if they turn back or leave out an arc, or one step
/// is more than a share of it all.
double arc_around(const glm::dvec2& center, std::span<const glm::dvec2> points, bool closed,
                  double largest_share) {
    double arc = 0, longest = 0;
    const std::size_t steps = closed ? points.size() : points.size() - 1;
    for (std::size_t i = 0; i < steps; ++i) {
        const glm::dvec2 a = points[i] - center, b = points[(i + 1) % points.size()] - center;
        const double step = std::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b));
        if (!(step > 0 && step < kLongestStep)) return 0;
        arc += step;
        longest = std::max(longest, step);
    }
    return longest <= largest_share * arc ? arc : 0;
}

enum class Extent { whole, part };

/// fit_circle(). A part of an arc may be short, but is within 1e-4 of its own extent, and no step is more
/// than half of it: otherwise few points of a small arc and one far away lie on a large circle.
std::optional<CirclePoints> fit(std::span<const glm::dvec3> chain, Extent extent) {
    if (chain.size() < kFewestPoints) return {};
    const bool closed = chain.front() == chain.back();
    const auto points = scaled(closed ? chain.first(chain.size() - 1) : chain);
    if (!points || points->points.size() < kFewestPoints) return {};
    const auto normal = normal_around(points->points);
    if (!normal) return {};
    const glm::dvec3& q = points->points[0];
    const glm::dvec3 x = unit(q - *normal * glm::dot(*normal, q)), y = glm::cross(*normal, x);
    double height = 0;
    std::vector<glm::dvec2> flat;
    flat.reserve(points->points.size());
    for (const glm::dvec3& p : points->points) {
        flat.emplace_back(glm::dot(x, p), glm::dot(y, p));
        height = std::max(height, std::abs(glm::dot(*normal, p)));
    }
    const auto circle = least_squares(flat);
    if (!circle) return {};
    const double size = extent == Extent::whole ? circle->radius : std::min(1.0, circle->radius);
    if (!(height <= kTolerance * size) || !are_on(*circle, flat, kTolerance * size)) return {};
    const double arc = arc_around(circle->center, flat, closed, extent == Extent::whole ? 1 : 0.5);
    if (!(arc > (extent == Extent::whole ? kLeastArc : 0) && arc < 2 * std::numbers::pi + kTolerance))
        return {};
    const glm::dvec3 center = points->mean + (x * circle->center.x + y * circle->center.y) * points->extent;
    const glm::dvec2 to_first = glm::normalize(flat[0] - circle->center) * (circle->radius * points->extent);
    return CirclePoints{center, center + x * to_first.x + y * to_first.y,
                        center - x * to_first.y + y * to_first.x};
}

/// The run, made longer at both ends while its points lie on one circle.
Run grown(std::span<const glm::dvec3> chain, Run run) {
    const auto are_on_one = [&](const Run& longer) {
        return fit(chain.subspan(longer.first, longer.last - longer.first + 1), Extent::part).has_value();
    };
    for (std::size_t step = std::bit_floor(chain.size()); step > 0; step /= 2)
        if (run.last + step < chain.size() && are_on_one({run.first, run.last + step})) run.last += step;
    for (std::size_t step = std::bit_floor(chain.size()); step > 0; step /= 2)
        if (run.first >= step && are_on_one({run.first - step, run.last})) run.first -= step;
    return run;
}

double distance_from(const CirclePoints& circle, const glm::dvec3& point) {
    const glm::dvec3 x = circle[1] - circle[0], y = circle[2] - circle[0], p = point - circle[0];
    const double radius = glm::length(x), height = glm::dot(glm::cross(x, y), p) / (radius * radius);
    const double across = glm::length(glm::dvec2(glm::dot(x, p), glm::dot(y, p))) / radius;
    return glm::length(glm::dvec2(height, across - radius));
}

/// Returns true if the chain leaves the circle at both ends of an arc, and does not just stray from it: a
/// part of a circle with noise would be an arc of a wrong radius.
bool ends_clearly(std::span<const glm::dvec3> chain, const Run& arc) {
    const auto circle = fit_circle(chain.subspan(arc.first, arc.last - arc.first + 1));
    if (!circle) return false;
    const double least = kClearlyOff * glm::distance((*circle)[0], (*circle)[1]);
    const bool closed = chain.front() == chain.back();
    const auto is_off = [&](std::size_t at) { return distance_from(*circle, chain[at]) > least; };
    const bool has_before = closed || arc.first > 0, has_after = closed || arc.last + 1 < chain.size();
    return (!has_before || is_off(arc.first > 0 ? arc.first - 1 : chain.size() - 2)) &&
           (!has_after || is_off(arc.last + 1 < chain.size() ? arc.last + 1 : 1));
}

}  // namespace

std::optional<CirclePoints> fit_circle(std::span<const glm::dvec3> chain) {
    return fit(chain, Extent::whole);
}

std::optional<Run> arc_around_edge(std::span<const glm::dvec3> chain, std::size_t edge) {
    constexpr std::size_t kSteps = kFewestPoints - 1;
    std::optional<Run> longest;
    for (std::size_t last = std::max(edge + 1, kSteps); last < chain.size() && last <= edge + kSteps;
         ++last) {
        const Run seed{last - kSteps, last};
        if (!fit(chain.subspan(seed.first, kFewestPoints), Extent::part)) continue;
        const Run run = grown(chain, seed);
        const bool is_longer = !longest || run.last - run.first > longest->last - longest->first;
        if (is_longer && fit_circle(chain.subspan(run.first, run.last - run.first + 1))) longest = run;
    }
    if (!longest || !ends_clearly(chain, *longest)) return {};
    return longest;
}

std::vector<Run> straight_runs(std::span<const glm::dvec3> chain, double rounding) {
    std::vector<Run> runs;
    const auto is_between = [&](std::size_t at, const Run& run) {
        const glm::dvec3 whole = chain[run.last] - chain[run.first], part = chain[at] - chain[run.first];
        const double length = safe_length(whole);
        const glm::dvec3 direction = unit(whole);
        const double along = glm::dot(direction, part);
        return along > 0 && along < length &&
               safe_length(part - direction * along) <= kStraightness * length + rounding;
    };
    // Points all along the run, as what each of them is off by adds up in a curve.
    const auto goes_on = [&](const Run& run, std::size_t next) {
        const std::size_t count = run.last - run.first, steps = std::min(count, kMostTested);
        for (std::size_t step = 1; step <= steps; ++step)
            if (!is_between(run.first + count * step / steps, {run.first, next})) return false;
        return true;
    };
    for (std::size_t next = 1; next < chain.size(); ++next) {
        if (!runs.empty() && goes_on(runs.back(), next))
            runs.back().last = next;
        else
            runs.push_back({next - 1, next});
    }
    return runs;
}

}  // namespace vrut::measurement
