#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "measure/calibrate.hpp"
#include "measure/front.hpp"

using namespace vrut;
using namespace vrut::server::measure;

namespace {

std::vector<double> costs_of(const std::vector<Tradeoff>& points, const std::vector<std::size_t>& chosen) {
    std::vector<double> costs;
    for (const std::size_t i : chosen) costs.push_back(points[i].cost);
    return costs;
}

Cost cost(double ms, double bytes) {
    Cost cost;
    cost.ms.median = ms;
    cost.bytes.median = bytes;
    return cost;
}

Error error(double flip) {
    Error error;
    error.flip.mean = flip;
    return error;
}

}  // namespace

TEST_CASE("the front holds what no other point beats, by rising cost") {
    const std::vector<Tradeoff> points{{4, 1}, {1, 8}, {2, 9}, {2, 4}, {5, 1}, {3, 4}};
    CHECK(front(points) == std::vector<std::size_t>{1, 3, 0});
    CHECK(front({}).empty());
}

TEST_CASE("what costs and errs nowhere more, and somewhere less, beats the other") {
    using Point = std::array<double, 3>;
    CHECK(beats(Point{1, 2, 3}, Point{1, 2, 4}));
    CHECK(beats(Point{0, 1, 2}, Point{1, 2, 4}));
    CHECK_FALSE(beats(Point{1, 2, 3}, Point{1, 2, 3}));
    CHECK_FALSE(beats(Point{1, 3, 3}, Point{1, 2, 4}));
}

TEST_CASE("of equal points the first is in the front, and an exact one ends it") {
    const std::vector<Tradeoff> points{{2, 1}, {2, 1}, {3, 0}, {4, 0}, {3, 0}};
    CHECK(front(points) == std::vector<std::size_t>{0, 2});
}

TEST_CASE("the staircase goes across at a point's error and down at the next one's cost") {
    const std::vector<Tradeoff> points{{1, 4}, {2, 2}, {3, 3}};
    const auto corners = staircase(points, 10, 5);
    const std::vector<Tradeoff> expected{{1, 10}, {1, 4}, {2, 4}, {2, 2}, {5, 2}};
    REQUIRE(corners.size() == expected.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        CHECK(corners[i].cost == expected[i].cost);
        CHECK(corners[i].error == expected[i].error);
    }
    CHECK(staircase({}, 1, 1).empty());
}

TEST_CASE("exact points have a floor below all others") {
    CHECK(floor_of(std::vector<Tradeoff>{{1, 0}, {1, 0.03}, {1, 0.5}}) == doctest::Approx(0.01));
    CHECK(floor_of(std::vector<Tradeoff>{{1, 0.01}}) == doctest::Approx(0.001));
    CHECK(floor_of(std::vector<Tradeoff>{{1, 0}}) > 0);
}

TEST_CASE("levels are thinned to steps that are worth a name, and end at the most accurate") {
    std::vector<Tradeoff> points;
    for (int i = 0; i < 100; ++i) points.push_back({std::pow(1.05, i), std::pow(0.98, i)});
    const auto chosen = thinned(points, 1.25, 0.95, 8);
    CHECK(chosen.size() <= 8);
    CHECK(chosen.size() >= 5);
    CHECK(chosen.back() == points.size() - 1);
    for (std::size_t i = 1; i < chosen.size(); ++i)
        CHECK(points[chosen[i]].cost >= 1.25 * points[chosen[i - 1]].cost);
    const std::vector<Tradeoff> close{{1, 3}, {1.1, 2}, {2, 1}};
    CHECK(costs_of(close, thinned(close, 1.25, 0.95, 8)) == std::vector<double>{1, 2});
    CHECK(thinned(std::vector<Tradeoff>{{1, 3}, {1.1, 2}}, 1.25, 0.95, 8) == std::vector<std::size_t>{1});
    // What costs more and is hardly better is passed over.
    CHECK(thinned(std::vector<Tradeoff>{{1, 10}, {2, 9.9}, {3, 5}}, 1.25, 0.95, 8) ==
          std::vector<std::size_t>{0, 2});
    CHECK(thinned({}, 1.25, 0.95, 8).empty());
}

TEST_CASE("a most accurate level that gains little takes no place of a much cheaper one") {
    const auto levels = [](const std::vector<Tradeoff>& points, std::size_t most = 8) {
        return costs_of(points, thinned(points, 1.25, 0.92, most));
    };
    CHECK(levels({{30, 0.2}, {50, 0.1}, {80, 0.05}, {300, 0.047}}) == std::vector<double>{30, 50, 80, 300});
    CHECK(levels({{20, 0.2}, {60, 0.050}, {110, 0.0498}}) == std::vector<double>{20, 60, 110});
    CHECK(levels({{20, 0.1}, {400, 0.095}}) == std::vector<double>{20, 400});
    CHECK(levels({{20, 0.1}, {400, 0.095}}, 1) == std::vector<double>{400});  // no room
}

TEST_CASE("a level has its numbers, and a reason") {
    std::vector<Setting> settings(4);
    settings[0].scale = 0.25;
    settings[0].subsampled = true;
    settings[1].scale = 0.5;  // beaten by the next
    settings[3].samples = 4;  // no picture for a view that moves
    const std::vector<Cost> costs{cost(10, 0), cost(30, 0), cost(15, 62'500), cost(90, 0)};
    const std::vector<Error> errors{error(0.2), error(0.15), error(0.1), error(0.01)};
    const auto levels = choose_levels(settings, costs, errors);
    REQUIRE(levels.size() == 2);
    CHECK(levels[0].quality.scale == 0.25);
    CHECK(levels[0].quality.subsampling == vrut::protocol::Quality::Subsampling::yuv420);
    CHECK(levels[0].quality.error == 0.2);
    CHECK(levels[1].ms == 15);
    CHECK(levels[1].bytes == 62'500);
    CHECK(levels[1].reason ==
          "0.50 x the error, 2.50 x the cost of the one below: there after 25 ms; none comes nearer.");
}

TEST_CASE("a spread tells mean and percentiles") {
    const Spread spread = spread_of({4, 1, 3, 2, 5});
    CHECK(spread.mean == 3);
    CHECK(spread.median == 3);
    CHECK(spread.p5 == doctest::Approx(1.2));
    CHECK(spread.p95 == doctest::Approx(4.8));
    CHECK(spread_of({}).median == 0);
}

TEST_CASE("a picture is enlarged between its pixels") {
    scene::Image small;
    small.resize(2, 1);
    small.rgba = {0, 0, 0, 255, 100, 200, 40, 255};
    const scene::Image large = resized(small, 4, 2);
    REQUIRE(large.rgba.size() == 32);
    const std::vector<std::uint8_t> row{0, 0, 0, 255, 25, 50, 10, 255, 75, 150, 30, 255, 100, 200, 40, 255};
    CHECK(std::vector<std::uint8_t>(large.rgba.begin(), large.rgba.begin() + 16) == row);
    CHECK(std::vector<std::uint8_t>(large.rgba.begin() + 16, large.rgba.end()) == row);
    CHECK(resized(small, 2, 1).rgba == small.rgba);
}
