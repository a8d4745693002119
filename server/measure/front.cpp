#include "measure/front.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace vrut::server::measure {

std::vector<std::size_t> front(std::span<const Tradeoff> points) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        if (points[a].cost != points[b].cost) return points[a].cost < points[b].cost;
        return points[a].error < points[b].error;
    });
    std::vector<std::size_t> kept;
    double best = std::numeric_limits<double>::infinity();
    for (const std::size_t i : order)
        if (points[i].error < best) {
            best = points[i].error;
            kept.push_back(i);
        }
    return kept;
}

bool beats(std::span<const double> a, std::span<const double> b) {
    return std::ranges::equal(a, b, std::less_equal()) && !std::ranges::equal(a, b);
}

std::vector<Tradeoff> staircase(std::span<const Tradeoff> points, double top, double right) {
    std::vector<Tradeoff> corners;
    double error = top;
    for (const std::size_t i : front(points)) {
        corners.push_back({points[i].cost, error});
        error = points[i].error;
        corners.push_back({points[i].cost, error});
    }
    if (!corners.empty()) corners.push_back({right, error});
    return corners;
}

double floor_of(std::span<const Tradeoff> points) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const Tradeoff& point : points)
        if (point.error > 0) smallest = std::min(smallest, point.error);
    if (std::isinf(smallest)) return 1e-6;
    return std::pow(10, std::floor(std::log10(smallest / 2)));
}

std::vector<std::size_t> thinned(std::span<const Tradeoff> points, double ratio, double gain,
                                 std::size_t most) {
    if (points.empty()) return {};
    const double range = points.back().cost / points.front().cost;
    const double step = std::max(ratio, std::pow(range, 1 / std::max(1.0, static_cast<double>(most) - 1)));
    const auto is_worth = [&](std::size_t i, std::size_t below, double dearer) {
        return points[i].cost >= points[below].cost * dearer && points[i].error <= points[below].error * gain;
    };
    std::vector<std::size_t> kept{0};
    for (std::size_t i = 1; i < points.size(); ++i)
        if (is_worth(i, kept.back(), step)) kept.push_back(i);
    const std::size_t last = points.size() - 1;
    if (kept.back() == last) return kept;
    const bool is_near = points[last].cost < points[kept.back()].cost * ratio;
    if (is_near || kept.size() >= most) kept.pop_back();
    kept.push_back(last);
    return kept;
}

}  // namespace vrut::server::measure
