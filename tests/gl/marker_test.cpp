#include <algorithm>
#include <cmath>
#include <random>

#include "plan/frame_plan.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

const glm::ivec3 kSign{204, 10, 82}, kRim{255, 255, 255};
const scene::Material kPaint = material_of({0.2, 0.3, 0.4});

glm::dvec3 at_pixel(double x, double y, const plan::View& view) {
    return {x - view.width / 2.0, view.height / 2.0 - y, 0};
}

/// A view of height 600, in which a sign's radius is 5 and its rim 1 wide, before black.
plan::View view_with_mark(double x, double y) {
    plan::View view = pixel_view(80, 600);
    view.background.color = {0, 0, 0};
    view.markers = markers_at({at_pixel(x, y, view)});
    return view;
}

std::shared_ptr<const scene::PlacedScene> nothing() { return scene_of({}); }

/// How much of a sign shows over black at a place, from 0 to 1.
double opacity(const scene::Image& image, int x, int y) { return pixel_of(image, x, y).r / 204.0; }

double drawn_area(const scene::Image& image) {
    double area = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) area += pixel_of(image, x, y) != glm::ivec3(0);
    return area;
}

struct MarkerPixel {
    glm::dvec3 point, normal;
};

/// A point of some triangle, as a picking ray would find it.
MarkerPixel spot_on(const scene::Geometry& geometry, std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    const auto triangle = static_cast<std::size_t>(random() % geometry.triangles.size());
    const auto corner = [&](int k) { return geometry.positions[geometry.triangles[triangle][k]]; };
    const double a = std::sqrt(unit(random)), b = unit(random);
    return {corner(0) * (1 - a) + corner(1) * (a * (1 - b)) + corner(2) * (a * b),
            glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)))};
}

glm::dvec3 direction(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(-1, 1);
    return glm::normalize(glm::dvec3(unit(random), unit(random), unit(random)));
}

/// The sign's colour at a point that is drawn somewhere in the picture.
glm::ivec3 color_at(const scene::Image& image, const plan::View& view, const glm::dvec3& point) {
    const double aspect = static_cast<double>(view.width) / view.height;
    const glm::dvec4 clip = math::clip_from_view(scene::projection_of(view.camera, aspect), 0.1, 100) *
                            scene::view_from_world(view.camera) * glm::dvec4(point, 1);
    const glm::dvec2 pixel{(clip.x / clip.w + 1) / 2 * view.width, (1 - clip.y / clip.w) / 2 * view.height};
    const int x = std::clamp(static_cast<int>(pixel.x), 0, view.width - 1);
    return pixel_of(image, x, std::clamp(static_cast<int>(pixel.y), 0, view.height - 1));
}

}  // namespace

TEST_CASE("a marker is a round sign of one colour with a rim, on light and on dark") {
    RendererFixture studio;
    for (const double level : {0.0, 1.0}) {
        CAPTURE(level);
        plan::View view = view_with_mark(40.5, 300.5);
        view.background.color = glm::dvec3(level);
        const scene::Image image = studio.draw(nothing(), view);
        int signs = 0, rims = 0, others = 0;
        for (int y = 0; y < 600; ++y)
            for (int x = 0; x < 80; ++x) {
                const double away = std::hypot(x - 40, y - 300);
                const glm::ivec3 pixel = pixel_of(image, x, y);
                if (away <= 3.5) signs += pixel == kSign;
                if (away > 4 && away < 5) rims += pixel.g > 10;
                if (away >= 5.5) others += pixel == glm::ivec3(static_cast<int>(level * 255));
            }
        CHECK(signs == 37);
        CHECK(rims == 20);
        CHECK(others == 80 * 600 - 97);
        CHECK(pixel_of(image, 44, 300).g == 133);  // half rim
        const int half_covered = pixel_of(image, 45, 300).g;
        CHECK(half_covered <= (level == 0 ? 128 : 255));
        CHECK(half_covered >= (level == 0 ? 127 : 255));
    }
}

TEST_CASE("markers move by parts of a pixel, and cover as much everywhere") {
    RendererFixture studio;
    int last = 0;
    double least = 1e9, most = 0;
    for (const double part : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
        const scene::Image image = studio.draw(nothing(), view_with_mark(40 + part, 300.5));
        const int right = pixel_of(image, 45, 300).g;
        CHECK((right > last || part == 0));
        last = right;
        double covered = 0;
        for (int y = 290; y < 310; ++y)
            for (int x = 30; x < 50; ++x) covered += std::min(1.0, opacity(image, x, y));
        least = std::min(least, covered);
        most = std::max(most, covered);
    }
    CHECK(least > 25 * 3.14159);
    CHECK(most < least * 1.01);
}

TEST_CASE("a sign is as large at all distances, and in proportion to the picture's height") {
    RendererFixture studio;
    plan::View view = view_with_mark(40.5, 300.5);
    const std::vector<std::uint8_t> first = studio.draw(nothing(), view).rgba;
    const glm::dvec3 from_eye = view.markers->front().point - view.camera.eye;
    for (const double factor : {1e-9, 1e-3, 0.3, 7.0, 1e4, 1e9}) {
        view.markers = markers_at({view.camera.eye + from_eye * factor});
        const scene::Image image = studio.draw(nothing(), view);
        CHECK(image.rgba == first);
    }
    for (const int height : {100, 360, 600, 1200, 2400}) {
        CAPTURE(height);
        plan::View other = pixel_view(200, height);
        other.background.color = {0, 0, 0};
        other.markers = markers_at({{0, 0, 0}});
        const double radius = std::max(3.0, height / 120.0);
        CHECK(std::sqrt(drawn_area(studio.draw(nothing(), other)) / 3.14159) ==
              doctest::Approx(radius + 0.3).epsilon(0.12));
    }
}

TEST_CASE("a marker fades behind what is opaque, little by little at its edge") {
    RendererFixture studio;
    plan::View view = pixel_view(200, 600);
    view.background.color = {0, 0, 0};
    const scene::Material black = material_of({0, 0, 0});
    view.markers = markers_at({{0, 0, -100}});
    const Part wall{2, quad(200), black, moved_by({0, 0, -100})};
    std::vector<double> seen;
    for (int quarter = -24; quarter <= 24; ++quarter) {
        const double edge = quarter / 4.0;
        // From the left to `edge` pixels beyond the point.
        const auto scene =
            scene_of({{1, rectangle(0, 200, 100 + edge, 400, view), black, glm::dmat4(1)}, wall});
        seen.push_back(opacity(studio.draw(scene, view), 100, 300));
    }
    CHECK(seen.front() == 1);
    CHECK(seen.back() == doctest::Approx(0.3).epsilon(0.02));
    CHECK(std::is_sorted(seen.rbegin(), seen.rend()));
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    CHECK(seen.size() >= 6);
    double largest = 0;
    for (std::size_t i = 1; i < seen.size(); ++i) largest = std::max(largest, seen[i] - seen[i - 1]);
    CHECK(largest < 0.3);
    // Before the same thing it is whole; a little behind the surface it is not.
    const auto curtain = scene_of({{1, quad(200), black, glm::dmat4(1)}});
    for (const double depth : {50.0, 0.0, -10.0, -250.0}) {
        view.markers = markers_at({{0, 0, depth}});
        CHECK(opacity(studio.draw(curtain, view), 100, 300) ==
              doctest::Approx(depth < 0 ? 0.3 : 1).epsilon(0.02));
    }
    view.mode = plan::DrawMode::stylized;
    view.markers = markers_at({{20, 5, 0}});
    CHECK(pixel_of(studio.draw(curtain, view), 120, 295) == kSign);
    view.markers = markers_at({{20, 5, -10}});
    CHECK(pixel_of(studio.draw(curtain, view), 120, 295) != kSign);
    // Nothing hides anything in a wireframe.
    for (const plan::DrawMode mode : {plan::DrawMode::realistic, plan::DrawMode::stylized}) {
        view.mode = mode;
        view.wireframe = true;
        CHECK(pixel_of(studio.draw(curtain, view), 120, 295) == kSign);
    }
}

TEST_CASE("glass covers no marker") {
    RendererFixture studio;
    scene::Material glass = material_of({0, 0, 0});
    plan::View view = pixel_view(200, 600);
    view.markers = markers_at({{0, 0, -10}});
    for (const double alpha : {0.99, 1.0}) {
        glass.diffuse.a = alpha;
        const scene::Image image = studio.draw(scene_of({{1, quad(200), glass, glm::dmat4(1)}}), view);
        CHECK((pixel_of(image, 100, 300) == kSign) == (alpha < 1));
    }
}

TEST_CASE("no surface hides a marker that lies on it, from near, from far, and at a glance") {
    RendererFixture studio;
    std::mt19937 random(5);
    for (const scene::Geometry& geometry : {sphere(1, 12), box({1, 0.6, 0.8}), sphere(1, 4, false)}) {
        const auto scene = scene_of({{1, geometry, kPaint, turned_by(20, {0, 0, 1})}});
        for (std::size_t round = 0; round < 150; ++round) {
            const double distance = std::array{1e-3, 0.1, 1.0, 10.0, 1e4}[round % 5];
            const MarkerPixel spot = spot_on(geometry, random);
            glm::dvec3 way = direction(random);
            if (round % 3 == 0)
                way = glm::normalize(glm::cross(way, spot.normal)) +
                      spot.normal * (distance < 0.1 ? 0.1 : 0.01);
            if (glm::dot(way, spot.normal) < 0) way = -way;
            if (glm::dot(way, spot.normal) < 0.009) continue;
            const glm::dmat3 turn(turned_by(20, {0, 0, 1}));
            const glm::dvec3 point = turn * spot.point;
            plan::View view = view_from(point + turn * way * distance, point);
            view.height = 300;
            view.mode = round % 2 ? plan::DrawMode::realistic : plan::DrawMode::stylized;
            view.markers = markers_at({point});
            CAPTURE(round);
            CAPTURE(distance);
            CHECK(color_at(studio.draw(scene, view), view, point) == kSign);
        }
    }
}

TEST_CASE("no wall of a room hides a marker that lies on it") {
    RendererFixture studio;
    std::mt19937 random(6);
    const glm::dvec3 half{1, 0.6, 0.8};
    const scene::Geometry room = turned_inside_out(box(half));
    for (int round = 0; round < 200; ++round) {
        const glm::dvec3 point = spot_on(room, random).point;
        plan::View view = view_from(direction(random) * half * 0.95, point);
        view.height = 300;
        view.markers = markers_at({point});
        CAPTURE(round);
        CHECK(color_at(studio.draw(scene_of({{1, room, kPaint, glm::dmat4(1)}}), view), view, point) ==
              kSign);
    }
    // In a corner, where all three walls come nearer.
    plan::View view = view_from({0.5, -0.4, 0.5}, {-0.999, 0.599, -0.799});
    view.height = 300;
    view.markers = markers_at({-half * glm::dvec3(1, -1, 1)});
    CHECK(color_at(studio.draw(scene_of({{1, room, kPaint, glm::dmat4(1)}}), view), view,
                   view.markers->front().point) == kSign);
}

TEST_CASE("what marks take: nothing where none shows, else one pass and a draw for 256") {
    RendererFixture studio;
    const auto scene = scene_of({{1, quad(100), kPaint, glm::dmat4(1)}});
    plan::View view = pixel_view(80, 600);
    const scene::Image plain = studio.draw(scene, view);
    const auto draw = [&](std::vector<plan::PlacedMarker> markers) {
        view.markers = std::make_shared<const std::vector<plan::PlacedMarker>>(std::move(markers));
        const scene::Image image = studio.draw(scene, view);
        return image.rgba == plain.rgba;
    };
    CHECK(studio.stats.passes == 1);
    CHECK(studio.stats.draws == 1);
    const double nan = std::nan("");
    // Behind the eye, in it, beside the picture, at no place.
    CHECK(draw({{{0, 0, 301}},
                {view.camera.eye},
                {at_pixel(-7, 300, view)},
                {at_pixel(40, 607, view)},
                {{nan, 0, 0}},
                {{0, 0, -1e300}}}));
    CHECK(studio.stats.passes == 1);
    CHECK(studio.stats.draws == 1);
    for (const auto& [count, draws] : {std::pair{1, 1}, {256, 1}, {257, 2}}) {
        CHECK_FALSE(draw(std::vector<plan::PlacedMarker>(static_cast<std::size_t>(count))));
        CHECK(studio.stats.passes == 2);
        CHECK(studio.stats.draws == 1 + draws);
        CHECK(studio.stats.triangles == 2);
    }
    CHECK(plan::plan_frame(view).markers.empty());  // a view without a scene
    CHECK(draw({}));
}

TEST_CASE("markers at the picture's border are cut off there, and nearer ones lie over farther ones") {
    RendererFixture studio;
    plan::View view = view_with_mark(-2.5, 300.5);
    const scene::Image image = studio.draw(nothing(), view);
    CHECK(pixel_of(image, 0, 300) == kSign);
    CHECK(drawn_area(image) > 10);
    CHECK(drawn_area(image) < 30);
    view.markers = markers_at({at_pixel(-4.5, -3.5, view)});
    CHECK(drawn_area(studio.draw(nothing(), view)) == 0);
    const glm::dvec3 left = at_pixel(38, 300.5, view), right = at_pixel(42, 300.5, view);
    const glm::dvec3 far_left = view.camera.eye + (left - view.camera.eye) * 2.0;
    const glm::dvec3 far_right = view.camera.eye + (right - view.camera.eye) * 2.0;
    for (const auto& markers : {markers_at({left, far_right}), markers_at({far_right, left})}) {
        view.markers = markers;
        CHECK(pixel_of(studio.draw(nothing(), view), 42, 300) == kRim);
    }
    view.markers = markers_at({far_left, right});
    CHECK(pixel_of(studio.draw(nothing(), view), 37, 300) == kRim);
}

TEST_CASE("markers in pictures a pixel wide or high, and with many samples") {
    RendererFixture studio;
    for (const glm::ivec2 size : {glm::ivec2(1, 8192), {8192, 1}, {1, 1}}) {
        const int width = size.x, height = size.y;
        CAPTURE(width);
        plan::View view = pixel_view(width, height);
        view.background.color = {0, 0, 0};
        view.markers = markers_at({{0, 0, 0}});
        const scene::Image image = studio.draw(nothing(), view);
        CHECK(pixel_of(image, width / 2, height / 2) == kSign);
        CHECK(drawn_area(image) ==
              doctest::Approx(std::min(width * height, std::max(6, height / 60))).epsilon(0.2));
    }
    plan::View view = view_with_mark(40.5, 300.5);
    view.samples = 16;
    const scene::Image image =
        studio.draw(scene_of({{1, quad(300), material_of({0, 0, 0}), glm::dmat4(1)}}), view);
    for (int y = 297; y <= 303; ++y) CHECK(pixel_of(image, 40, y) == kSign);
}
