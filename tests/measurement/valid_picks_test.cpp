#include <doctest/doctest.h>

#include <limits>

#include "measurement/measure.hpp"

using namespace vrut;
using measurement::Feature;
using measurement::Kind;
using measurement::Snap;

namespace {

const Feature kPoint{1, Snap::point, {{0, 0, 0}}}, kVertex{1, Snap::vertex, {{1, 0, 0}}},
    kEdge{1, Snap::edge, {{0, 0, 0}, {-1, 0, 0}, {1, 0, 0}}},
    kPlane{1, Snap::plane, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
    kCenter{1, Snap::center, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
    kLoop{1, Snap::loop, {{0, 0, 0}, {-1, 0, 0}, {1, 0, 0}}};

std::string wrong(Kind kind, const std::vector<Feature>& picks) {
    return measurement::invalid(kind, picks).value_or("");
}

Feature with_points(Feature feature, std::vector<glm::dvec3> points) {
    feature.points = std::move(points);
    return feature;
}

}  // namespace

TEST_CASE("each kind needs its number of picks") {
    CHECK(wrong(Kind::distance, {kPoint}) == "a distance needs 2 picks, not 1");
    CHECK(wrong(Kind::distance, {kPoint, kPoint, kPoint}) == "a distance needs 2 picks, not 3");
    CHECK(wrong(Kind::parallel, {kEdge}) == "a parallel distance needs 2 picks, not 1");
    CHECK(wrong(Kind::angle, {kEdge}) == "an angle needs 2 or 3 picks, not 1");
    CHECK(wrong(Kind::radius, {kPoint, kPoint}) == "a radius needs 1 or 3 picks, not 2");
    CHECK(wrong(Kind::length, {}) == "a length needs 1 pick, not 0");
}

TEST_CASE("each kind needs its kinds of picks") {
    CHECK(wrong(Kind::parallel, {kVertex, kEdge}) ==
          "a parallel distance starts from an edge, a plane or a center, not from a vertex");
    CHECK(wrong(Kind::angle, {kEdge, kLoop}) ==
          "an angle of 2 picks is between edges, planes or centers, and a loop is none of them");
    CHECK(wrong(Kind::radius, {kEdge}) == "a radius of 1 pick needs a center, not an edge");
    CHECK(wrong(Kind::length, {kCenter}) == "a length needs an edge or a loop, not a center");
}

TEST_CASE("each pick needs its points") {
    CHECK(wrong(Kind::length, {with_points(kEdge, {{0, 0, 0}})}) == "an edge has 3 points, not 1");
    CHECK(wrong(Kind::distance, {kPoint, with_points(kVertex, {})}) == "a vertex has 1 point, not 0");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(wrong(Kind::distance, {kPoint, with_points(kPoint, {{0, nan, 0}})}) ==
          "the points of a point must be finite numbers");
    CHECK(wrong(Kind::length, {with_points(kEdge, {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}})}) ==
          "the edge has no length");
    CHECK(wrong(Kind::length, {with_points(kLoop, {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}})}) ==
          "the edge of the loop has no length");
    CHECK(wrong(Kind::angle, {kEdge, with_points(kPlane, {{0, 0, 0}, {1, 1, 0}, {2, 2, 0}})}) ==
          "the points of the plane lie on one line");
    CHECK(wrong(Kind::radius, {with_points(kCenter, {{0, 0, 0}, {0, 0, 0}, {2, 2, 0}})}) ==
          "the points of the circle lie on one line");
}

TEST_CASE("nothing is wrong with picks that can be measured") {
    for (const Feature& feature : {kPoint, kVertex, kEdge, kPlane, kCenter, kLoop}) {
        CHECK(wrong(Kind::distance, {feature, kPoint}).empty());
        CHECK(wrong(Kind::parallel, {kPlane, feature}).empty());
        CHECK(wrong(Kind::angle, {feature, kPoint, feature}).empty());
        CHECK(wrong(Kind::radius, {feature, kPoint, feature}).empty());
    }
    CHECK(wrong(Kind::angle, {kEdge, kCenter}).empty());
    CHECK(wrong(Kind::radius, {kCenter}).empty());
    CHECK(wrong(Kind::length, {kEdge}).empty());
    CHECK(wrong(Kind::length, {kLoop}).empty());
}
