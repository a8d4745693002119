#include "warp/depth_map.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "depth_map_of.hpp"

using namespace vrut::warp;

namespace {

constexpr double kNear = 0.5;

/// Depth of an image whose pixels have reciprocal distances `of` their column and row, from the top left.
template <class Of>
std::vector<float> depth_of(int width, int height, Of of) {
    std::vector<float> depth;
    for (int y = height - 1; y >= 0; --y)
        for (int x = 0; x < width; ++x) depth.push_back(static_cast<float>(kNear * of(x, y)));
    return depth;
}

}  // namespace

TEST_CASE("a plane keeps its distances, within half a step") {
    const auto plane = [](int x, int y) { return 0.2 + 0.001 * x + 0.002 * y; };
    const int width = 160, height = 88;
    const DepthMap map =
        depth_map_of(depth_of(width, height, plane), width, height, kNear, depth_map_size(width, height, 4));
    CHECK(map.columns == 40);
    CHECK(map.rows == 22);
    CHECK(map.scale == doctest::Approx(plane(width - 1, height - 1)));
    CHECK(map.near == map.far);
    for (int row = 0; row + 1 < map.rows; ++row)
        for (int column = 0; column + 1 < map.columns; ++column) {
            const std::size_t i = static_cast<std::size_t>(row * map.columns + column);
            // Their mean is that of their middle.
            const double expected = plane(0, 0) + 0.001 * (4 * column + 1.5) + 0.002 * (4 * row + 1.5);
            CHECK(map.scale * map.near[i] / DepthMap::kSteps ==
                  doctest::Approx(expected).epsilon(0).scale(1).epsilon(1.1 * map.scale / DepthMap::kSteps));
        }
}

TEST_CASE("however steep a plane is, no edge goes through it") {
    for (const double slope : {0.001, 0.005, 0.02, 0.05}) {
        CAPTURE(slope);
        const auto plane = [&](int x, int y) { return 0.01 + slope * (x + 0.5 * y); };
        const DepthMap map = depth_map_of(depth_of(32, 24, plane), 32, 24, kNear, depth_map_size(32, 24, 4));
        CHECK(map.near == map.far);
    }
}

TEST_CASE("an edge divides a block by what lies nearer") {
    // Nearer in the lower left half of the block.
    const auto edge = [](int x, int y) { return y >= x ? 1.0 : 0.25; };
    const DepthMap map = depth_map_of(depth_of(4, 4, edge), 4, 4, kNear, depth_map_size(4, 4, 4));
    REQUIRE(map.near.size() == 1);
    CHECK(map.near[0] == DepthMap::kSteps);
    CHECK(map.far[0] == 64);
    // And one pixel more.
    CHECK(map.mask[0] == 0xfff7);
}

TEST_CASE("what is infinitely far is 0") {
    const DepthMap empty =
        depth_map_of(depth_of(8, 8, [](int, int) { return 0.0; }), 8, 8, kNear, depth_map_size(8, 8, 4));
    CHECK(empty.near == std::vector<std::uint8_t>(4, 0));
    CHECK(empty.scale == 0);
}

TEST_CASE("what an image's depth has not counts, too, where it is nearer") {
    constexpr int kWidth = 24, kHeight = 16;
    const auto size = depth_map_size(kWidth, kHeight, 4);
    const std::vector<float> wall = depth_of(kWidth, kHeight, [](int, int) { return 0.5; });
    // A pane before the left half, whose lower half is behind the wall.
    std::vector<float> pane(static_cast<std::size_t>(kAddedSide * size.columns * kAddedSide * size.rows), 0);
    const int columns = kAddedSide * size.columns, rows = kAddedSide * size.rows;
    for (int y = 0; y < rows; ++y)  // from the bottom up
        for (int x = 0; x < columns / 2; ++x)
            pane[static_cast<std::size_t>(y * columns + x)] = y < rows / 2 ? 0.01F : 0.4F;
    const DepthMap map = depth_map_of(wall, kWidth, kHeight, kNear, size, pane);
    const DepthMap alone = depth_map_of(wall, kWidth, kHeight, kNear, size);
    for (int row = 0; row < size.rows; ++row)
        for (int column = 0; column < size.columns; ++column) {
            CAPTURE(row);
            CAPTURE(column);
            const auto block = static_cast<std::size_t>(row * size.columns + column);
            const bool is_before = row < size.rows / 2 && column < size.columns / 2;
            CHECK(map.far[block] / 255.0 * map.scale ==
                  doctest::Approx(is_before ? 0.4 / kNear : alone.far[block] / 255.0 * alone.scale)
                      .epsilon(0.01));
        }
}

TEST_CASE("an image that comes in strips has the map of one that comes at once") {
    constexpr int kWidth = 93, kHeight = 51;
    const std::vector<float> depth =
        depth_of(kWidth, kHeight, [](int x, int y) { return (3 * x + 7 * y) % 11; });
    for (const double pixels : {3.0, 4.0, 9.5}) {
        const DepthMapSize size = depth_map_size(kWidth, kHeight, pixels);
        const DepthMap at_once = depth_map_of(depth, kWidth, kHeight, kNear, size);
        for (const int rows : {1, 7, 50}) {
            CAPTURE(pixels);
            CAPTURE(rows);
            DepthSamples samples(kWidth, kHeight, size);
            for (int first = 0; first < kHeight; first += rows)
                samples.add(std::span(depth).subspan(
                    static_cast<std::size_t>(first * kWidth),
                    static_cast<std::size_t>(std::min(rows, kHeight - first) * kWidth)));
            CHECK(samples.map(kNear) == at_once);
        }
    }
}

TEST_CASE("images of any size have at most kMostBlocks blocks a side") {
    for (const auto& size : {std::pair(1, 1), std::pair(1280, 3), std::pair(1281, 720), std::pair(3, 4000)}) {
        const int width = size.first, height = size.second;
        CAPTURE(width);
        const DepthMap map = depth_map_of(depth_of(width, height, [](int x, int) { return 1.0 + x; }), width,
                                          height, kNear, depth_map_size(width, height, 4));
        CHECK(map.columns >= 1);
        CHECK(map.columns <= kMostBlocks);
        CHECK(map.rows <= kMostBlocks);
        CHECK(map.near.size() == static_cast<std::size_t>(map.columns * map.rows));
    }
}

TEST_CASE("what is encoded is decoded again, and nothing else is") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(0, 1);
    const auto noise = [&](int x, int y) { return x + y < 60 ? 0.0 : any(random); };
    const DepthMap map = depth_map_of(depth_of(100, 50, noise), 100, 50, kNear, depth_map_size(100, 50, 4));
    const std::string bytes = encode(map);
    const auto again = decode(bytes, map.columns, map.rows, map.scale);
    REQUIRE(again);
    CHECK(*again == map);

    CHECK_FALSE(decode(bytes, map.columns + 1, map.rows, map.scale));
    CHECK_FALSE(decode(bytes, map.rows, map.columns - 1, map.scale));
    CHECK_FALSE(decode(bytes, 0, 0, map.scale));
    CHECK_FALSE(decode(bytes, 100'000, 100'000, map.scale));
    CHECK_FALSE(decode("", map.columns, map.rows, map.scale));
    for (std::size_t cut = 0; cut < bytes.size(); cut += 7)
        CHECK_FALSE(decode(bytes.substr(0, cut), map.columns, map.rows, map.scale));
    for (int i = 0; i < 2000; ++i) {
        std::string damaged = bytes;
        damaged[random() % damaged.size()] = static_cast<char>(random());
        decode(damaged, map.columns, map.rows, map.scale);  // whatever comes, it comes to an end
    }
}

TEST_CASE("smooth surfaces take little room") {
    const auto ball = [](int x, int y) {
        const double dx = (x - 320) / 200.0, dy = (y - 180) / 150.0, inside = 1 - dx * dx - dy * dy;
        return inside > 0 ? 0.2 + 0.1 * std::sqrt(inside) : 0.05 + 0.0001 * y;
    };
    const DepthMap map = depth_map_of(depth_of(640, 360, ball), 640, 360, kNear, depth_map_size(640, 360, 4));
    CHECK(encode(map).size() < map.near.size() / 2);
}
