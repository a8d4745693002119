#include <doctest/doctest.h>

#include "math/frustum.hpp"
#include "plan/frame_plan.hpp"
#include "random_parts.hpp"
#include "shapes.hpp"
#include "views.hpp"

using namespace vrut;

namespace {

std::size_t planned(plan::View view, const scene::Geometry& geometry,
                    const glm::dmat4& matrix = glm::dmat4(1)) {
    view.scene = scene_of({{1, geometry, kBronze, matrix}});
    return plan::plan_frame(view).scene.opaque.size();
}

/// Whether some of a triangle's corners (in clip space) is left when it is cut along the sides of the
/// picture.
bool shows(std::vector<glm::dvec4> polygon) {
    const auto cut = [&](const auto& inside) {
        std::vector<glm::dvec4> left;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const glm::dvec4 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
            if (inside(a) >= 0) left.push_back(a);
            if ((inside(a) < 0) != (inside(b) < 0))
                left.push_back(a + (b - a) * (inside(a) / (inside(a) - inside(b))));
        }
        polygon = left;
    };
    cut([](const glm::dvec4& p) { return p.w; });
    for (int axis = 0; axis < 2; ++axis)
        for (const double sign : {-1.0, 1.0}) cut([&](const glm::dvec4& p) { return p.w + sign * p[axis]; });
    return !polygon.empty();
}

bool shows(const scene::PlacedScene& placed, std::size_t node, const plan::View& view) {
    const double aspect = static_cast<double>(view.width) / view.height;
    const glm::dmat4 clip_from_node =
        math::clip_from_view(scene::projection_of(view.camera, aspect), 0.1, 100) *
        scene::view_from_world(view.camera) * placed.world[node];
    const auto& data = std::get<scene::GeometryData>(placed.scene->nodes()[node].data);
    const scene::Geometry& geometry = placed.scene->geometries()[static_cast<std::size_t>(data.geometry)];
    for (const glm::uvec3& triangle : geometry.triangles) {
        const auto corner = [&](int k) {
            return clip_from_node * glm::dvec4(geometry.positions[triangle[k]], 1);
        };
        if (shows({corner(0), corner(1), corner(2)})) return true;
    }
    return false;
}

}  // namespace

TEST_CASE("what lies more than a pixel beside the picture, or behind the eye, is not planned") {
    const plan::View view = pixel_view(80, 60);
    CHECK(planned(view, rectangle(10, 10, 20, 20, view)) == 1);
    CHECK(planned(view, rectangle(-1000, -1000, 1000, 1000, view)) == 1);
    struct Beside {
        double left, top, right, bottom;
    };
    for (const double gap : {0.9, 1.1}) {
        CAPTURE(gap);
        for (const Beside& b :
             {Beside{-20, 20, -gap, 30}, {80 + gap, 20, 99, 30}, {20, -20, 30, -gap}, {20, 60 + gap, 30, 99}})
            CHECK(planned(view, rectangle(b.left, b.top, b.right, b.bottom, view)) == (gap < 1 ? 1u : 0u));
    }
    const scene::Geometry ball = sphere(1, 8);
    CHECK(planned(view, ball, moved_by({0, 0, 29.5})) == 1);   // around the eye
    CHECK(planned(view, ball, moved_by({0, 0, 30.99})) == 1);  // the last of it before the eye
    CHECK(planned(view, ball, moved_by({0, 0, 31.01})) == 0);
    CHECK(planned(view, quad(1e5), moved_by({0, 0, 31})) == 0);
    // A bar to the left of the picture, its right end far from the eye or near: a box along the axes of view
    // around it reaches into the picture both times.
    const auto leaning = [](double degrees) { return moved_by({-60, 0, 0}) * turned_by(degrees, {0, 1, 0}); };
    CHECK(planned(view, box({40, 0.1, 0.1}), leaning(45)) == 1);
    CHECK(planned(view, box({40, 0.1, 0.1}), leaning(-45)) == 0);
}

TEST_CASE("an area of the picture sees what shows there and no more") {
    const plan::View view = pixel_view(80, 60);
    const glm::dmat4 from_world = scene::view_from_world(view.camera);
    const auto sees = [&](const math::NdcRect& area, double left, double right) {
        return !math::is_outside(math::frustum_of(math::cropped(plan::projection_of(view), area)), from_world,
                                 rectangle(left, 20, right, 30, view).bounds);
    };
    const math::NdcRect quarter{{0.5, -1}, {1, 1}};  // from pixel 60
    CHECK(sees(quarter, 50, 61));
    CHECK_FALSE(sees(quarter, 50, 59.9));
    CHECK(sees(quarter, 79, 90));
    CHECK_FALSE(sees(quarter, 80.1, 90));
    const math::NdcRect strip{{-0.25, -1}, {-0.2, 1}};  // pixels 30 to 32
    CHECK(sees(strip, 31.9, 40));
    CHECK_FALSE(sees(strip, 32.1, 40));
    CHECK_FALSE(sees(strip, 20, 29.9));
}

TEST_CASE("what shows is planned: random parts, from within and from near") {
    Dice dice(7);
    int left_out = 0, showing = 0;
    for (int round = 0; round < 100; ++round) {
        plan::View view = view_from(dice.vector(5), dice.vector(5));
        view.camera.fov = dice.between(5, 150);
        view.width = static_cast<int>(dice.between(1, 200));
        view.scene = scene_of(random_parts(dice, kBronze));
        std::vector<bool> found(view.scene->nodes.size());
        for (const plan::DrawItem& item : plan::plan_frame(view).scene.opaque)
            found[static_cast<std::size_t>(item.node)] = true;
        for (std::size_t node = 1; node < found.size(); ++node) {
            const bool there = shows(*view.scene, node, view);
            CHECK((found[node] || !there));
            left_out += !found[node];
            showing += there;
        }
    }
    CHECK(showing > 300);
    // Few are missed: those that pass before a corner of the picture.
    CHECK(left_out + showing > 3800);
}
