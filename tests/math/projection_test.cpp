#include "math/projection.hpp"

#include <doctest/doctest.h>

#include <numbers>

#include "math/frustum.hpp"

using namespace vrut;

namespace {

glm::dvec2 ndc_of(const glm::dmat4& clip_from_view, const glm::dvec3& point) {
    const glm::dvec4 clip = clip_from_view * glm::dvec4(point, 1);
    return glm::dvec2(clip) / clip.w;
}

/// What a tilted wall sees: no side is the mirror image of its opposite.
constexpr math::Projection kOffCentre{-0.25, 1.5, -0.5, 0.125};

}  // namespace

TEST_CASE("a symmetric projection has the tangents of half its angles") {
    const math::Projection projection = math::symmetric_projection(std::numbers::pi / 2, 1.5);
    CHECK(projection.top == doctest::Approx(1).epsilon(1e-15));
    CHECK(projection.right == doctest::Approx(1.5).epsilon(1e-15));
    CHECK(projection.left == -projection.right);
    CHECK(projection.bottom == -projection.top);
}

TEST_CASE("the corners of a projection's plane are the corners of clip space, symmetric or not") {
    for (const math::Projection& p : {kOffCentre, math::symmetric_projection(0.7, 1.5)})
        for (const double distance : {1.0, 20.0})
            for (const glm::dmat4& matrix :
                 {math::clip_from_view(p, 0.5, 100), math::reversed_clip_from_view(p, 0.5)}) {
                const auto corner = [&](double x, double y) {
                    return ndc_of(matrix, glm::dvec3(x, y, -1) * distance);
                };
                CHECK(glm::distance(corner(p.left, p.bottom), {-1, -1}) < 1e-14);
                CHECK(glm::distance(corner(p.right, p.top), {1, 1}) < 1e-14);
                CHECK(glm::distance(corner(p.at({0.5, -0.25}).x, p.at({0.5, -0.25}).y), {0.5, -0.25}) <
                      1e-14);
            }
}

TEST_CASE("near and far are the ends of depth; reversed, far is at infinity") {
    const auto depth = [](const glm::dmat4& matrix, double distance) {
        const glm::dvec4 clip = matrix * glm::dvec4(0, 0, -distance, 1);
        return clip.z / clip.w;
    };
    const glm::dmat4 ordinary = math::clip_from_view(kOffCentre, 0.5, 100);
    CHECK(depth(ordinary, 0.5) == doctest::Approx(-1));
    CHECK(depth(ordinary, 100) == doctest::Approx(1));
    const glm::dmat4 reversed = math::reversed_clip_from_view(kOffCentre, 0.5);
    CHECK(depth(reversed, 0.5) == 1);
    CHECK(depth(reversed, 50) == 0.01);
}

TEST_CASE("an offset moves the picture in normalized device coordinates") {
    const glm::dvec3 point(0.3, -0.2, -2);
    const glm::dvec2 moved = ndc_of(math::reversed_clip_from_view(kOffCentre, 0.1, {0.5, -0.25}), point);
    CHECK(glm::distance(moved, ndc_of(math::reversed_clip_from_view(kOffCentre, 0.1), point) +
                                   glm::dvec2(0.5, -0.25)) < 1e-14);
}

TEST_CASE("a part of a picture is a projection of its own") {
    const math::Projection part = math::cropped(kOffCentre, {{0, -1}, {1, 0.5}});
    CHECK(part == math::Projection{kOffCentre.at({0, 0}).x, kOffCentre.right, kOffCentre.bottom,
                                   kOffCentre.at({0, 0.5}).y});
    const math::Frustum frustum = math::frustum_of(kOffCentre);
    const auto is_seen = [&](double x, double y) {
        const glm::dvec3 at(x, y, -1);
        return !math::is_outside(frustum, glm::dmat4(1), {at, at});
    };
    CHECK(is_seen(1.49, 0.12));
    CHECK_FALSE(is_seen(1.51, 0.12));
    CHECK(is_seen(-0.24, -0.49));
    CHECK_FALSE(is_seen(-0.26, -0.49));
}
