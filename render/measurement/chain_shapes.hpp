#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

namespace vrut::measurement {

/// A circle: its center, and two of its points, a quarter turn apart and counter-clockwise along the points
/// that it was fitted to.
using CirclePoints = std::array<glm::dvec3, 3>;

/// Fits a circle to the points of a chain, which is closed if its last point is the first one again. None
/// unless they are at least 5, within 1e-4 of the radius of the circle, and run around it in one sense, by
/// more than 30 degrees. Least squares of Kåsa, "A circle fitting procedure and its error analysis", IEEE
/// Transactions on Instrumentation and Measurement 25(1), 1976, in the plane of the largest area.
std::optional<CirclePoints> fit_circle(std::span<const glm::dvec3> chain);

/// From one place in a chain to a later one.
struct Run {
    std::size_t first = 0, last = 0;
};

/// Returns the longest run of points around the edge from `edge` to the next point that fit_circle() takes
/// for a circle, and that the chain leaves clearly at both ends. None if there is none.
std::optional<Run> arc_around_edge(std::span<const glm::dvec3> chain, std::size_t edge);

/// The parts of a chain that are straight, each as long as can be: within 1e-6 of their length, and
/// `rounding` besides.
std::vector<Run> straight_runs(std::span<const glm::dvec3> chain, double rounding);

}  // namespace vrut::measurement
