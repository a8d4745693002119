#include "mesh/bvh.hpp"

#include <doctest/doctest.h>

#include <random>

using namespace vrut;

namespace {

constexpr double kFarthest = std::numeric_limits<double>::infinity();

/// How often each box is met by a ray.
template <typename T>
std::vector<int> met_of(const std::vector<typename mesh::Bvh<T>::Box>& boxes, const mesh::SlabRay& ray) {
    std::vector<int> met(boxes.size());
    mesh::Bvh<T>(boxes).visit([&](const auto& box) { return ray.entry(box); }, kFarthest,
                              [&](std::uint32_t i) { ++met[i]; });
    return met;
}

}  // namespace

TEST_CASE_TEMPLATE("boxes in one place, and none at all", T, float, double) {
    const std::vector<typename mesh::Bvh<T>::Box> same(1000, {{1, 1, 1}, {2, 2, 2}});
    const glm::dvec3 slack(1e-14);
    CHECK(met_of<T>(same, {{1.5, 1.5, 9}, {0, 0, -1}, slack}) == std::vector<int>(1000, 1));
    CHECK(met_of<T>(same, {{3, 1.5, 9}, {0, 0, -1}, slack}) == std::vector<int>(1000, 0));
    CHECK(met_of<T>({}, {{0, 0, 0}, {0, 0, -1}, slack}).empty());
}

TEST_CASE_TEMPLATE("the hierarchy is no deeper than its stack", T, float, double) {
    // Ever smaller towards a corner, where thousands coincide.
    std::vector<typename mesh::Bvh<T>::Box> boxes;
    for (int axis = 0; axis < 3; ++axis)
        for (int bit = 0; bit < 40; ++bit) {
            glm::vec<3, T> corner(0);
            corner[axis] = std::ldexp(T(1), -bit);
            boxes.push_back({corner, corner});
        }
    boxes.resize(boxes.size() + 5000, {glm::vec<3, T>(0), glm::vec<3, T>(0)});
    int met = 0;
    mesh::Bvh<T>(boxes).visit([](const auto&) { return 0.0; }, kFarthest, [&](std::uint32_t) { ++met; });
    CHECK(met == static_cast<int>(boxes.size()));
}

TEST_CASE_TEMPLATE("each box that a bound admits is met once", T, float, double) {
    std::mt19937 random(3);
    std::normal_distribution<T> any(0, 1);
    std::vector<typename mesh::Bvh<T>::Box> boxes;
    for (int i = 0; i < 5000; ++i) {
        const glm::vec<3, T> center(any(random), any(random) * T(1e-4), any(random) * T(1000));
        const glm::vec<3, T> half(std::abs(any(random)), 0, std::abs(any(random)));
        boxes.push_back({center - half, center + half});
    }
    const mesh::Bvh<T> tree(boxes);
    for (int k = 0; k < 50; ++k) {
        const glm::vec<3, T> point(any(random), any(random), any(random) * T(1000));
        const auto squared_distance = [&](const auto& box) {
            const glm::vec<3, T> off = point - glm::clamp(point, box.min, box.max);
            return glm::dot(off, off);
        };
        const T farthest = T(k * k);
        std::vector<int> met(boxes.size());
        tree.visit(squared_distance, farthest, [&](std::uint32_t i) { ++met[i]; });
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            // A leaf's boxes are met together.
            if (squared_distance(boxes[i]) <= farthest) CHECK(met[i] == 1);
            CHECK(met[i] <= 1);
        }
        // Lowered to what is found, the first that is left is the nearest.
        T nearest = std::numeric_limits<T>::infinity(), least = nearest;
        tree.visit(squared_distance, nearest,
                   [&](std::uint32_t i) { nearest = std::min(nearest, squared_distance(boxes[i])); });
        for (const auto& box : boxes) least = std::min(least, squared_distance(box));
        CHECK(nearest == least);
    }
}
