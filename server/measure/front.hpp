#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vrut::server::measure {

/// What something costs and how wrong it is: less is better of both.
struct Tradeoff {
    double cost = 0, error = 0;
};

/// Indices, by rising cost, of the points that no other beats: none is as cheap and as accurate and better in
/// one of the two. Of equal points the first.
std::vector<std::size_t> front(std::span<const Tradeoff> points);

/// Returns whether `a` beats `b`: it costs and errs nowhere more, and somewhere less. Of as many numbers.
bool beats(std::span<const double> a, std::span<const double> b);

/// Corners of the line below and left of which nothing lies: from each point of the front at its error to the
/// next one's cost, then down; from the first straight down from `top`, from the last on to `right`.
std::vector<Tradeoff> staircase(std::span<const Tradeoff> points, double top, double right);

/// Where a logarithmic axis shows errors of 0: the power of ten at most as high as half of the smallest
/// error above 0.
double floor_of(std::span<const Tradeoff> points);

/// Of the points of a front, by rising cost, at most `most`: each costs at least `ratio` times the one before
/// it, and has at most `gain` times its error. They are spread evenly by the logarithm of their cost, and the
/// last, the most accurate, is always among them, however little it gains.
std::vector<std::size_t> thinned(std::span<const Tradeoff> points, double ratio, double gain,
                                 std::size_t most);

}  // namespace vrut::server::measure
