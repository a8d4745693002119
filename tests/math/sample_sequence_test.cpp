#include "math/sample_sequence.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <set>
#include <utility>

using namespace vrut;

TEST_CASE("the first sample is the pixel's centre, and all lie in the pixel") {
    CHECK(math::sample_offset(0) == glm::dvec2(0));
    for (std::uint32_t i = 0; i < 4096; ++i) {
        const glm::dvec2 offset = math::sample_offset(i);
        CHECK((offset.x >= -0.5 && offset.x < 0.5));
        CHECK((offset.y >= -0.5 && offset.y < 0.5));
    }
}

TEST_CASE("each beginning of 2^k samples has one in each elementary interval") {
    for (int k = 0; k <= 8; ++k)
        for (int columns = 0; columns <= k; ++columns) {
            CAPTURE(k);
            CAPTURE(columns);
            std::set<std::pair<int, int>> cells;
            for (std::uint32_t i = 0; i < 1U << k; ++i) {
                const glm::dvec2 at = math::sample_offset(i) + 0.5;
                cells.insert({static_cast<int>(std::floor(std::ldexp(at.x, columns))),
                              static_cast<int>(std::floor(std::ldexp(at.y, k - columns)))});
            }
            CHECK(cells.size() == std::size_t{1} << k);
        }
}

TEST_CASE("the samples of a still picture lie around the centre") {
    for (const std::uint32_t count : {4U, 16U, 64U}) {
        CAPTURE(count);
        glm::dvec2 sum(0);
        for (std::uint32_t i = 0; i < count; ++i) sum += math::sample_offset(i);
        CHECK(glm::length(sum / static_cast<double>(count)) < 0.25 / count);
    }
}
