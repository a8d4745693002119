#include <algorithm>

#include "reference_image.hpp"
#include "scene/style.hpp"

using namespace vrut;

namespace {

/// To 2^-20, so that a place 10^7 away holds them exactly.
scene::Geometry rounded(scene::Geometry geometry) {
    geometry.bounds = {};
    for (glm::dvec3& position : geometry.positions) {
        position = glm::round(position * 1048576.0) / 1048576.0;
        geometry.bounds.add(position);
    }
    return geometry;
}

ReferenceParts things() {
    scene::Material glass = material_of({0.1, 0.6, 0.4}, {0.5, 0.5, 0.5}, 9);
    glass.diffuse.a = 0.5;
    scene::Material mirror = material_of({0.1, 0.1, 0.1});
    mirror.reflectivity = 0.7;
    return {{1, rounded(sphere(0.875, 9)), material_of({0.5, 0.2, 0.1}, {0.4, 0.5, 0.6}, 20), glm::dmat4(1)},
            {2, mapped(quad(4), 1, {0, 0, -2}), mirror, glm::dmat4(1)},
            {3, rounded(mapped(sphere(0.5, 7), 1, {1, 0.5, 0.25})), glass, glm::dmat4(1)}};
}

ReferenceParts map_all(ReferenceParts parts, double scale, const glm::dvec3& offset) {
    for (Part& part : parts) part.geometry = mapped(part.geometry, scale, offset);
    return parts;
}

plan::View seen_from(double scale, const glm::dvec3& offset) {
    return picture(glm::dvec3(1, 2, 4) * scale + offset, glm::dvec3(0.25, 0, 0) * scale + offset);
}

}  // namespace

TEST_CASE("far from the origin, and of any size, the picture is the same") {
    const reference::ReferenceImage here = traced(scene_of(things()), seen_from(1, {0, 0, 0}));
    const auto check = [&](const ReferenceParts& parts, const plan::View& view) {
        const reference::ReferenceImage there = traced(scene_of(parts), view);
        CHECK(there.node == here.node);
        CHECK(difference_of(there, here) < 1e-9);
    };
    CHECK(std::count(here.node.begin(), here.node.end(), scene::kNone) < 500);
    CHECK(std::count(here.node.begin(), here.node.end(), 3) > 20);
    const glm::dvec3 far(1e7, -1e7, 1e7);
    check(map_all(things(), 1, far), seen_from(1, far));
    for (const double scale : {1e-6, 1e6})
        check(map_all(things(), scale, {0, 0, 0}), seen_from(scale, {0, 0, 0}));

    // By matrices: moved there, and from there back; mirrored twice; turned all the way round.
    ReferenceParts parts = things();
    for (Part& part : parts) part.matrix = moved_by(far);
    check(parts, seen_from(1, far));
    parts = map_all(things(), 1, far);
    for (Part& part : parts) part.matrix = moved_by(-far);
    check(parts, seen_from(1, {0, 0, 0}));
    for (Part& part : parts) part.matrix = scaled_by({-1, 1, 1}) * scaled_by({-1, 1, 1}) * moved_by(-far);
    check(parts, seen_from(1, {0, 0, 0}));
    parts = things();
    for (Part& part : parts) part.matrix = turned_by(180, {1, 2, 3}) * turned_by(180, {1, 2, 3});
    check(parts, seen_from(1, {0, 0, 0}));
}

TEST_CASE("the order of the file is nothing to it") {
    ReferenceParts parts = things();
    const plan::View view = seen_from(1, {0, 0, 0});
    const reference::ReferenceImage should = traced(scene_of(parts), view);
    std::reverse(parts.begin(), parts.end());
    CHECK(traced(scene_of(parts), view).color == should.color);
}

TEST_CASE("a pixel is the mean of its samples, not rounded before") {
    // Left of the middle of the second pixel white, then black.
    plan::View step = pixels(4, 2);
    step.samples = 4;
    step.background.color = {0, 0, 0};
    const Part half{1, quad(9), glowing({1, 1, 1}), moved_by({-9.5, 0, 0})};
    const reference::ReferenceImage edge = traced(scene_of({half}), step);
    for (const double row : {0, 4}) {
        const auto first = static_cast<std::size_t>(row);
        check_same(edge.color[first], glm::dvec3(1));
        check_same(edge.color[first + 1], glm::dvec3(0.5));
        check_same(edge.color[first + 2], glm::dvec3(0));
    }
    const Part top{1, quad(9), glowing({1, 1, 1}), moved_by({0, 9.75, 0})};  // a quarter of the upper row
    const reference::ReferenceImage upper = traced(scene_of({top}), step);
    check_same(upper.color[4], glm::dvec3(0.25));  // one of the offsets 1/8, 3/8, 5/8, 7/8 is less
    check_same(upper.color[0], glm::dvec3(0));
}

TEST_CASE("stylized faces are all in one colour, and hide what is behind") {
    ReferenceParts parts = things();
    plan::View view = seen_from(1, {0, 0, 0});
    view.mode = plan::DrawMode::stylized;
    const reference::ReferenceImage shown = traced(scene_of(parts), view);
    for (Part& part : parts) part.material = scene::stylized_faces();
    view.mode = plan::DrawMode::realistic;
    const reference::ReferenceImage should = traced(scene_of(parts), view);
    CHECK(difference_of(shown, should) == 0);
    CHECK(shown.node == should.node);
}

TEST_CASE("in a stylized picture mirrors are surfaces like others") {
    scene::Material mirror = glowing({1, 1, 1});
    mirror.reflectivity = 1;
    for (const double side : {5.0, -5.0}) {
        plan::View view = picture({1, 2, side}, {0, 0, 0});
        view.mode = plan::DrawMode::stylized;
        const auto shown = traced(scene_of({{1, quad(1), mirror, glm::dmat4(1)}}), view);
        view.mode = plan::DrawMode::realistic;
        const auto should = traced(scene_of({{1, quad(1), scene::stylized_faces(), glm::dmat4(1)}}), view);
        CHECK(difference_of(shown, should) == 0);
        CHECK(shown.node == should.node);  // from behind: none
        CHECK((std::count(shown.node.begin(), shown.node.end(), scene::kNone) < 48 * 32) == (side > 0));
    }
}

TEST_CASE("a wireframe has no faces") {
    plan::View view = seen_from(1, {0, 0, 0});
    view.wireframe = true;
    const reference::ReferenceImage shown = traced(scene_of(things()), view);
    CHECK(std::count(shown.node.begin(), shown.node.end(), scene::kNone) == 48 * 32);
    check_same(shown.color[700], plan::kDefaultBackground);
}

TEST_CASE("bytes are rounded to the nearest, halves up") {
    reference::ReferenceImage picture{
        3, 1, {{0, 1, 0.5}, {0.49 / 255, 0.51 / 255, 1 - 0.49 / 255}, {0.002, 1.5 / 255, 0.9981}}, {}};
    CHECK(reference::image_of(picture).rgba ==
          std::vector<std::uint8_t>{0, 255, 128, 255, 0, 1, 255, 255, 1, 2, 255, 255});
}

TEST_CASE("views of one pixel's width or height") {
    for (const auto& [width, height] : {std::pair{1, 2048}, std::pair{2048, 1}, std::pair{1, 1}}) {
        plan::View view = seen_from(1, {0, 0, 0});
        view.width = width;
        view.height = height;
        const reference::ReferenceImage shown = traced(scene_of(things()), view);
        CHECK(shown.color.size() == static_cast<std::size_t>(width * height));
        CHECK(std::count(shown.node.begin(), shown.node.end(), scene::kNone) < width * height);
    }
}
