#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "reference/tracer.hpp"
#include "reference_image.hpp"

using namespace vrut;

namespace {

/// Cuts off what lies above.
const scene::ClipPlane kTop{{0, 0, 1}, 0};

plan::View cut(plan::View view, std::vector<scene::ClipPlane> planes) {
    view.clip_planes = std::move(planes);
    view.light = directional({0, 0, -1});
    return view;
}

/// With highlights, which a cap has not.
scene::Material shiny(const glm::dvec3& diffuse) { return material_of(diffuse, {1, 1, 1}, 1); }

const glm::dvec3 kRed{0.7, 0.2, 0.1}, kBlue{0.1, 0.2, 0.6};

std::vector<reference::Tracer::VisibleHit> hits_in(const ReferenceParts& parts, plan::View view) {
    view.scene = scene_of(parts);
    return reference::Tracer(view).hits_at({0.5, 0.5});
}

void check_cap(const ReferenceParts& parts, const plan::View& view, std::size_t plane, double distance) {
    const auto hits = hits_in(parts, view);
    REQUIRE(hits.size() == 1);
    const reference::TriangleHit& hit = hits[0].hit;
    REQUIRE(hit.cap);
    CHECK(hit.cap->plane == plane);
    CHECK(hit.distance == doctest::Approx(distance).epsilon(1e-12));
    CHECK(hit.cap->normal == view.clip_planes[plane].normal);
}

bool meets_cap(const ReferenceParts& parts, const plan::View& view) {
    const auto hits = hits_in(parts, view);
    return !hits.empty() && hits[0].hit.cap;
}

/// A tube around the z axis, of a rectangular or of a round section.
scene::Geometry ring(unsigned columns, unsigned rows, double radius, double thickness) {
    const auto turn = [](double part) {
        const double angle = 2 * std::numbers::pi * (part < 1 ? part : 0);
        return glm::dvec2(std::cos(angle), std::sin(angle));
    };
    return surface(columns, rows, [&](double u, double v) {
        const glm::dvec2 across = thickness * turn(v);
        return glm::dvec3((radius + across.x) * turn(u), across.y);
    });
}

/// How many pixels show the colour, and how many neither that nor the background.
struct Count {
    int color = 0, other = 0;
};

Count count(const reference::ReferenceImage& image, const glm::dvec3& color) {
    Count count;
    for (const glm::dvec3& pixel : image.color) {
        if (glm::length(pixel - color) < 1e-12)
            ++count.color;
        else if (glm::length(pixel - scene::kDefaultBackground) > 1e-12)
            ++count.other;
    }
    return count;
}

}  // namespace

TEST_CASE("a part that is cut shows its cap, by the plane's normal and without a highlight") {
    const ReferenceParts parts{{1, box({1, 1, 1}), shiny(kRed)}};
    const plan::View view = cut(look({0.3, 0.2, 5}, {0.3, 0.2, 0}), {{{0, 0, 1}, 0.25}});
    check_same(seen(parts, view), kRed);
    check_cap(parts, view, 0, 4.75);
    CHECK(traced(scene_of(parts), view).node[0] == 1);
    plan::View uncut = view;
    uncut.clip_planes.clear();
    CHECK(seen(parts, uncut).b > kRed.b + 0.5);
}

TEST_CASE("the cap fills the section of a part, and nothing else") {
    const auto drawn = [](const scene::Geometry& geometry, const glm::dmat4& matrix) {
        return count(traced(scene_of({{1, geometry, shiny(kRed), matrix}}), cut(pixels(40, 40), {kTop})),
                     kRed);
    };
    const auto check_area = [](const Count& count, double area, double outline, int walls = 0) {
        CHECK(std::abs(count.color - area) < outline / 2);
        CHECK(count.other <= walls);  // of a hole, seen aslant
    };
    const double pi = std::numbers::pi;
    for (const double sign : {1.0, -1.0}) {  // mirrored, too
        CAPTURE(sign);
        const glm::dmat4 matrix = scaled_by({sign, 1, 1});
        check_area(drawn(welded(sphere(10.2, 24)), matrix), pi * 10.2 * 10.2, 2 * pi * 10.2);
        check_area(drawn(box({7, 5, 9}), matrix), 140, 48);
        check_area(drawn(ring(60, 20, 11, 5), matrix), pi * (16 * 16 - 6 * 6), 2 * pi * 22, 20);
        check_area(drawn(ring(4, 4, 11, 5), matrix), 2 * (16 * 16 - 6 * 6), 4 * std::sqrt(2.0) * 22, 20);
    }
}

TEST_CASE("a cap ends at the other planes, and each plane has its own") {
    const ReferenceParts parts{{1, welded(sphere(2, 12)), shiny(kRed)}};
    const std::vector<scene::ClipPlane> edge{{{0, 0, 1}, 0.5}, {{1, 0, 0}, 0.25}};
    for (const double x : {-1.0, 0.0, 0.2, 0.3, 0.5}) {
        CAPTURE(x);
        const glm::dvec3 direction = glm::normalize(glm::dvec3(-1, 0, -2));
        const glm::dvec3 eye = glm::dvec3(x, 0.1, 0.5) - direction * 6.0;
        const plan::View view = cut(look(eye, eye + direction), edge);
        if (x < 0.25)
            check_cap(parts, view, 0, 6);
        else
            check_cap(parts, view, 1, 6 + (x - 0.25) / -direction.x);
    }
    std::vector<scene::ClipPlane> box_of_planes;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            glm::dvec3 normal(0);
            normal[axis] = sign;
            box_of_planes.push_back({normal, 0.5});
        }
    for (std::size_t i = 0; i < 6; ++i) {
        const glm::dvec3 aside(0.1, 0.2, 0.15), out = box_of_planes[i].normal;
        const glm::dvec3 target = aside - out * glm::dot(aside, out);
        check_cap(parts, cut(look(target + out * 4.0, target), box_of_planes), i, 3.5);
    }
    const std::vector<scene::ClipPlane> slab{{{0, 0, 1}, 0.001}, {{0, 0, -1}, 0.001}};
    check_cap(parts, cut(look({0.3, 0.2, 4}, {0.3, 0.2, 0}), slab), 0, 3.999);
    check_cap(parts, cut(look({0.3, 0.2, -4}, {0.3, 0.2, 0}), slab), 1, 3.999);
    const std::vector<scene::ClipPlane> nothing{{{0, 0, 1}, -0.001}, {{0, 0, -1}, -0.001}};
    CHECK(hits_in(parts, cut(look({0.3, 0.2, 4}, {0.3, 0.2, 0}), nothing)).empty());
}

TEST_CASE("no cap: without them, of open and of flattened parts, and from the kept side") {
    scene::Geometry open = box({1, 1, 1});
    open.triangles.pop_back();
    const scene::Material material = two_sided(shiny(kRed));
    const plan::View view = cut(look({0.3, 0.2, 5}, {0.3, 0.2, 0}), {kTop});
    CHECK(meets_cap({{1, box({1, 1, 1}), material}}, view));
    CHECK_FALSE(meets_cap({{1, open, material}}, view));
    plan::View flat = view;
    flat.scene = scene_of({{1, box({1, 1, 1}), material, turned_by(45, {1, 0, 0}) * scaled_by({1, 1, 0})}});
    CHECK_FALSE(reference::Tracer(flat).parts()[0].cap_material);
    scene::ClipPlane bare = kTop;
    bare.caps = false;
    const auto inside = hits_in({{1, box({1, 1, 1}), material}}, cut(view, {bare}));
    REQUIRE(inside.size() == 1);
    CHECK_FALSE(inside[0].hit.cap);
    CHECK(inside[0].hit.distance == doctest::Approx(6));

    const ReferenceParts parts{{1, box({1, 1, 1}), material}};
    const auto below = hits_in(parts, cut(look({0.3, 0.2, -5}, {0.3, 0.2, 0}), {kTop}));
    REQUIRE(below.size() == 1);
    CHECK_FALSE(below[0].hit.cap);
    CHECK(below[0].hit.distance == doctest::Approx(4));
    CHECK(hits_in(parts, cut(look({0.3, 0.2, -0.5}, {0.3, 0.2, 0}), {kTop})).empty());  // and out at the top
    CHECK(meets_cap(parts, cut(look({0.3, 0.2, 0.5}, {0.3, 0.2, 0}), {kTop})));         // in what is cut away
}

TEST_CASE("where a ray comes through the plane beside a part it may meet the part further on") {
    const scene::Material material = shiny(kRed);
    const glm::dvec3 direction = glm::normalize(glm::dvec3(-1, 0, -1));
    const plan::View view = cut(look(glm::dvec3(1.3, 0.2, 0) - direction * 2.0, {1.3, 0.2, 0}), {kTop});
    for (const scene::Geometry& geometry : {box({1, 1, 1}), welded(sphere(1.2, 12))}) {
        const auto hits = hits_in({{1, geometry, material}}, view);
        REQUIRE(hits.size() == 1);
        CHECK_FALSE(hits[0].hit.cap);
        CHECK(hits[0].hit.distance > 2);
    }
    const glm::dmat4 upright = turned_by(90, {1, 0, 0});
    for (const double x : {-2.0, 0.0, 2.0})
        CHECK(meets_cap({{1, ring(12, 8, 2, 0.5), material, upright}},
                        cut(look({x, 0.1, 9}, {x, 0.1, 0}), {kTop})) == (x != 0));
}

TEST_CASE("a plane through the eye hides what lies beyond it, and has no cap") {
    const ReferenceParts parts{{1, box({1, 1, 1}), two_sided(shiny(kRed))}};
    for (const double z : {0.5, 3.0}) {
        const auto down = hits_in(parts, cut(look({0.3, 0.2, z}, {0.3, 0.2, -9}), {{{0, 0, 1}, z}}));
        REQUIRE(down.size() == 1);
        CHECK_FALSE(down[0].hit.cap);
        CHECK(hits_in(parts, cut(look({0.3, 0.2, -z}, {0.3, 0.2, 9}), {{{0, 0, 1}, -z}})).empty());
    }
}

TEST_CASE("of several parts at a point of a plane the cap of the highest id is seen") {
    const auto color = [](scene::Id red, scene::Id blue) {
        return seen({{red, box({1, 1, 1}), shiny(kRed)}, {blue, welded(sphere(1, 8)), shiny(kBlue)}},
                    cut(look({0.3, 0.2, 5}, {0.3, 0.2, 0}), {kTop}));
    };
    check_same(color(1, 2), kBlue);
    check_same(color(2, 1), kRed);
}

TEST_CASE("a cap is opaque, and what lies before its plane is gone") {
    const scene::Material glass = glowing({0, 1, 0}, 0.5), clear = glowing({0, 1, 0}, 0);
    const plan::View view = cut(look({0.3, 0.2, 5}, {0.3, 0.2, 0}), {kTop});
    const Part above{3, quad(2), glass, moved_by({0, 0, 1})},
        below{4, quad(2), glass, moved_by({0, 0, -0.5})};
    check_same(seen({{1, box({1, 1, 1}), shiny(kRed)}, above, below}, view), kRed);
    check_same(seen({above, below}, view), (glm::dvec3(0, 1, 0) + scene::kDefaultBackground) / 2.0);
    for (const scene::Material& material : {glass, clear})
        check_same(seen({{1, box({1, 1, 1}), material}}, view), {0, 1, 0});
}

TEST_CASE("in an override style the cap has that material") {
    plan::View view = cut(look({0.3, 0.2, 5}, {0.3, 0.2, 0}), {kTop});
    view.mode = scene::DrawMode::stylized;
    const scene::Material& blue = scene::stylized_faces();
    check_same(seen({{1, box({1, 1, 1}), glowing({1, 1, 1}, 0.5)}}, view),
               glm::dvec3(blue.ambient) + glm::dvec3(blue.diffuse));
}

TEST_CASE("a mirror shows parts cut, from the kept side") {
    scene::Material mirror = material_of({0, 0, 0});
    mirror.reflectivity = 1;
    const ReferenceParts parts{{1, quad(9), mirror},
                               {2, box({1, 1, 1}), two_sided(glowing(kRed)), moved_by({0, 0, 4})}};
    const auto color = [&](const std::vector<scene::ClipPlane>& planes) {
        return seen(parts, cut(look({3, 0, 3}, {1.5, 0, 0}), planes));  // which is reflected to {0, 0, 3}
    };
    check_same(color({}), kRed);
    check_same(color({{{0, 0, 1}, 2.9}}), scene::kDefaultBackground);
    check_same(color({{{0, 0, 1}, 4}}), kRed);
    check_same(color({{{0, 0, -1}, -2}}), scene::kDefaultBackground);  // the mirror is cut away
    check_same(color({{{1, 0, 0}, 1}}), scene::kDefaultBackground);
    check_same(color({{{1, 0, 0}, 2}}), kRed);
    check_same(color({{{-1, 0, 0}, -0.6}}), scene::kDefaultBackground);
}

TEST_CASE("far from the origin a section is the same") {
    const std::vector<scene::ClipPlane> planes{{glm::normalize(glm::dvec3(1, 2, 3)), 0.3}, {{0, 1, 0}, 0.4}};
    const auto image = [&](const glm::dvec3& by) {
        plan::View view = cut(picture(glm::dvec3(3, 4, 5) + by, by), planes);
        for (scene::ClipPlane& plane : view.clip_planes) plane.distance += glm::dot(plane.normal, by);
        const glm::dmat4 matrix = moved_by(by) * scaled_by({-1, 2, 1.5});
        return traced(scene_of({{1, welded(sphere(1, 12)), shiny(kRed), matrix},
                                {2, box({0.5, 0.4, 0.9}), shiny(kBlue), matrix}}),
                      view);
    };
    CHECK(difference_of(image(glm::dvec3(0)), image({1e7, -1e7, 2e7})) < 1e-6);
}
