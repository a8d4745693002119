#include "warp/warp.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "depth_map_of.hpp"

using namespace vrut;
using namespace vrut::warp;

namespace {

constexpr int kWidth = 160, kHeight = 96;
constexpr double kAspect = static_cast<double>(kWidth) / kHeight;

/// What a camera sees of the world in one direction: where, in which colour, and its reciprocal distance
/// along the view; 0: the sky.
struct Seen {
    glm::dvec3 point{0}, color{0};
    double reciprocal = 0;
};

/// A wall at z = -10 up to y = 3, and before it a square at z = -5 between x, y = -1 and 1. Both have waves
/// of colour.
Seen seen(const scene::Camera& camera, const glm::dvec2& point) {
    const glm::dvec3 ray = scene::direction_through(camera, kAspect, point);
    const auto at = [&](double z) { return camera.eye + ray * ((z - camera.eye.z) / ray.z); };
    const auto color = [](const glm::dvec3& p, double blue) {
        return glm::dvec3(0.5 + 0.4 * std::sin(2 * p.x), 0.5 + 0.4 * std::cos(2 * p.y + 1), blue);
    };
    const auto along = [&](const glm::dvec3& p) {
        return 1 / glm::dot(p - camera.eye, scene::view_direction(camera));
    };
    if (ray.z >= 0) return {};
    const glm::dvec3 square = at(-5), wall = at(-10);
    if (std::abs(square.x) < 1 && std::abs(square.y) < 1) return {square, color(square, 1), along(square)};
    if (wall.y < 3) return {wall, color(wall, 0), along(wall)};
    return {};
}

/// x and y from -1 (left, top) to 1 (right, bottom), and the distance along the view.
glm::dvec3 projected(const scene::Camera& camera, const glm::dvec3& point) {
    const glm::dvec4 view = scene::view_from_world(camera) * glm::dvec4(point, 1);
    const math::Projection sides = scene::projection_of(camera, kAspect);
    return {view.x / -view.z / sides.right, view.y / view.z / sides.top, -view.z};
}

/// Of the middle of a pixel, rows from the bottom up.
glm::dvec2 middle_of(int x, int y) { return {2 * (x + 0.5) / kWidth - 1, 1 - 2 * (y + 0.5) / kHeight}; }

struct Taken {
    scene::Image image;
    DepthMap depth;
};

Taken taken(const scene::Camera& camera) {
    Taken result;
    result.image.resize(kWidth, kHeight);
    std::vector<float> depth;
    constexpr double kNear = 0.1;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const Seen what = seen(camera, middle_of(x, y));
            const std::size_t i = 4 * static_cast<std::size_t>(y * kWidth + x);
            for (int k = 0; k < 3; ++k)
                result.image.rgba[i + static_cast<std::size_t>(k)] =
                    static_cast<std::uint8_t>(std::lround(255 * what.color[k]));
            result.image.rgba[i + 3] = 255;
            depth.push_back(static_cast<float>(kNear * what.reciprocal));
        }
    result.depth = depth_map_of(depth, kWidth, kHeight, kNear, depth_map_size(kWidth, kHeight, 4));
    return result;
}

/// The part of the pixels of `to`, of those that `from` saw too, that are off by more than 24 steps in a
/// channel.
double wrong_part(const scene::Image& image, const scene::Camera& from, const scene::Camera& to) {
    constexpr int kMost = 24;
    int wrong = 0, all = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const Seen what = seen(to, middle_of(x, y));
            if (what.reciprocal == 0) continue;
            const glm::dvec3 before = projected(from, what.point);
            if (before.z <= 0 || std::max(std::abs(before.x), std::abs(before.y)) > 1) continue;
            if (glm::distance(seen(from, {before.x, before.y}).point, what.point) > 1e-6) continue;
            ++all;
            const std::size_t i = 4 * static_cast<std::size_t>(y * kWidth + x);
            for (int k = 0; k < 3; ++k)
                if (std::abs(image.rgba[i + static_cast<std::size_t>(k)] - 255 * what.color[k]) > kMost) {
                    ++wrong;
                    break;
                }
        }
    return static_cast<double>(wrong) / all;
}

scene::Camera camera_at(const glm::dvec3& eye, const glm::dvec3& focus) {
    scene::Camera camera;
    camera.eye = eye;
    camera.focus = focus;
    return scene::with_orthogonal_up(camera);
}

}  // namespace

TEST_CASE("the same camera sees the same image") {
    const scene::Camera camera = camera_at({0.3, 0.2, 1}, {0, 0, -5});
    const Taken from = taken(camera);
    CHECK(warped(from.image, from.depth, camera, camera, Background::turns).rgba == from.image.rgba);
    CHECK(warped(from.image, from.depth, camera, camera, Background::stays).rgba == from.image.rgba);
}

TEST_CASE("another camera sees what it would have taken, where the first one saw it, too") {
    const scene::Camera camera = camera_at({0, 0, 0}, {0, 0, -5});
    const Taken from = taken(camera);
    const struct {
        const char* what;
        scene::Camera to;
    } moves[] = {{"to the right", camera_at({0.3, 0, 0}, {0.3, 0, -5})},
                 {"up", camera_at({0, 0.2, 0}, {0, 0.2, -5})},
                 {"nearer", camera_at({0, 0, -0.8}, {0, 0, -5})},
                 {"back", camera_at({0, 0, 0.5}, {0, 0, -5})},
                 {"around", camera_at({0.6, 0.1, -0.1}, {0, 0, -5})},
                 {"aside", camera_at({0, 0, 0}, {0.5, 0.2, -5})}};
    for (const auto& move : moves) {
        CAPTURE(move.what);
        const scene::Image image = warped(from.image, from.depth, camera, move.to, Background::turns);
        // The warp moves one pixel of the background along with an edge.
        CHECK(wrong_part(image, camera, move.to) < 0.035);
        CHECK(wrong_part(from.image, camera, move.to) > 0.1);
    }
}

TEST_CASE("a wider angle of view makes all smaller") {
    scene::Camera camera = camera_at({0, 0, 0}, {0, 0, -5}), wide = camera;
    wide.fov = 55;
    const Taken from = taken(camera);
    CHECK(wrong_part(warped(from.image, from.depth, camera, wide, Background::turns), camera, wide) < 0.02);
}

TEST_CASE("what is infinitely far turns, or stays where it is") {
    const scene::Camera camera = camera_at({0, 3, 0}, {0, 4, -5}), aside = camera_at({0, 3, 0}, {1, 4, -5});
    Taken from = taken(camera);
    // A spot in the sky.
    const auto pixel = [](int x, int y) { return 4 * static_cast<std::size_t>(y * kWidth + x); };
    const int x = 80, y = 80;
    from.image.rgba[pixel(x, y)] = 200;
    const auto red = [&](Background background, int column, int row) {
        return warped(from.image, from.depth, camera, aside, background).rgba[pixel(column, row)];
    };
    CHECK(red(Background::stays, x, y) == 200);
    CHECK(red(Background::turns, x, y) == 0);
    const glm::dvec3 sky = camera.eye + 1e9 * scene::direction_through(camera, kAspect, middle_of(x, y));
    const glm::dvec3 there = projected(aside, sky);
    int most = 0;
    for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy)
            most =
                std::max<int>(most, red(Background::turns, static_cast<int>((there.x + 1) / 2 * kWidth) + dx,
                                        static_cast<int>((1 - there.y) / 2 * kHeight) + dy));
    CHECK(most > 50);
}

TEST_CASE("what is hidden shows what is beside it, and no depth leaves the image as it is") {
    const scene::Camera camera = camera_at({0, 0, 0}, {0, 0, -5}),
                        right = camera_at({0.6, 0, 0}, {0.6, 0, -5});
    const Taken from = taken(camera);
    const scene::Image image = warped(from.image, from.depth, camera, right, Background::turns);
    // Of the square, whose blue is 255, nothing stays behind: as many of its pixels are there as before.
    const auto blues = [](const scene::Image& of) {
        int count = 0;
        for (std::size_t i = 2; i < of.rgba.size(); i += 4) count += of.rgba[i] > 128;
        return count;
    };
    CHECK(blues(image) == doctest::Approx(blues(from.image)).epsilon(0.03));
    CHECK(warped(from.image, {}, camera, right, Background::turns).rgba == from.image.rgba);
}

TEST_CASE("a steep plane has no steps, whose triangles would be none of its surface") {
    const int columns = 12, rows = 9;
    DepthMap map{columns, rows, 1, {}, {}, {}};
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            map.far.push_back(static_cast<std::uint8_t>(1 + 12 * column + 13 * row));
    map.near = map.far;
    map.mask.assign(map.far.size(), 0xffff);
    const Layers layers = layers_of(map);
    CHECK(layers.near == map.near);
    CHECK(layers.far == map.far);
}
