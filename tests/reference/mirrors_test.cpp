#include "plan/mirror_plan.hpp"
#include "reference_image.hpp"

using namespace vrut;

namespace {

scene::Material mirror(double reflectivity, const glm::dvec3& own = glm::dvec3(0)) {
    scene::Material material = glowing(own);
    material.reflectivity = reflectivity;
    return material;
}

/// In the plane through `point` at right angles to `normal`, large.
Part mirror_at(scene::Id id, const glm::dvec3& point, const glm::dvec3& normal,
               const scene::Material& material) {
    const glm::dvec3 n = glm::normalize(normal);
    const glm::dvec3 u = glm::normalize(glm::cross(glm::dvec3(0.3, 1, 0.2), n));
    glm::dmat4 matrix(1);
    matrix[0] = {u, 0};
    matrix[1] = {glm::cross(n, u), 0};
    matrix[2] = {n, 0};
    matrix[3] = {point, 1};
    return {id, quad(40), material, matrix};
}

scene::Texture checks() {
    scene::Texture texture;
    texture.image = {2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 0, 255}};
    return texture;
}

/// A shiny ball, a box with a picture, and a pane before them.
ReferenceParts room(const glm::dmat4& placed) {
    scene::Geometry plate = quad(1);
    plate.texcoords = {{0, 0}, {3, 0}, {3, 3}, {0, 3}};
    scene::Material pictured = material_of({1, 1, 1}, {0.2, 0.2, 0.2}, 3);
    pictured.texture = 0;
    scene::Material glass = glowing({0.1, 0.6, 0.4}, 0.4);
    return {{2, sphere(0.8, 12), material_of({0.5, 0.2, 0.1}, {0.4, 0.5, 0.6}, 20),
             placed * moved_by({-1, 0, 0})},
            {3, plate, two_sided(pictured), placed * moved_by({1, 0.2, 0.3}) * turned_by(60, {1, 1, 0})},
            {4, quad(1.5), two_sided(glass), placed * moved_by({0.3, 0, 1.5}) * turned_by(130, {0, 1, 0.2})}};
}

constexpr glm::dvec3 kPoint{0.5, -1.5, -2}, kNormal{0.3, 1, 0.6};

}  // namespace

TEST_CASE("a mirror shows what the reflected things would show behind it") {
    const math::Plane plane{glm::normalize(kNormal), kPoint};
    const glm::dmat4 reflection = math::reflection_about(plane);
    plan::View view = picture({0.5, 4, 5}, {0.2, -0.5, -1}, 96, 64);
    for (const bool headlight : {true, false}) {
        plan::View reflected_light = view;
        view.light = reflected_light.light = {};
        view.light.headlight = headlight;
        view.light.position = {2, 4, 6};
        view.light.attenuation = reflected_light.light.attenuation = {0.3, 0.1, 0.01};
        const glm::dvec3 source = headlight ? view.camera.eye : view.light.position;
        reflected_light.light.headlight = false;
        reflected_light.light.position = glm::dvec3(reflection * glm::dvec4(source, 1));

        // The things themselves stand where the eye does not see them: both pictures show reflections only.
        ReferenceParts with = room(glm::dmat4(1));
        with.push_back(mirror_at(1, kPoint, kNormal, mirror(1)));
        const auto shown = traced(scene_of(with, {checks()}), view);
        const auto should = traced(scene_of(room(reflection), {checks()}), reflected_light);
        const auto direct = traced(scene_of(room(glm::dmat4(1)), {checks()}), view);
        double worst = 0;
        int compared = 0;
        for (std::size_t i = 0; i < shown.color.size(); ++i) {
            if (direct.node[i] != scene::kNone || shown.node[i] == scene::kNone) continue;
            const glm::dvec3 off = glm::abs(shown.color[i] - should.color[i]);
            worst = std::max({worst, off.r, off.g, off.b});
            compared += should.node[i] != scene::kNone;
        }
        CHECK(worst < 1e-12);
        CHECK(compared > 80);
    }
}

TEST_CASE("a mirror mixes its own colour with the reflection, from both sides") {
    // In the plane z = 0, the eye at 45 degrees.
    for (const double side : {1.0, -1.0}) {
        const Part ball{2, sphere(1, 8), glowing({0.2, 1, 0.4}), moved_by({3, 0, 3 * side})};
        const Part plate{1, quad(1), mirror(0.25, {2, 0.5, 0}), glm::dmat4(1)};
        plan::View view = look({-3, 0, 3 * side}, {0, 0, 0});
        check_same(seen({ball, plate}, view), {0.75 + 0.25 * 0.2, 0.75 * 0.5 + 0.25, 0.25 * 0.4});
        view.background.color = {0, 0, 1};
        check_same(seen({plate}, view), {0.75, 0.375, 0.25});
        // What stands behind the mirror's plane is no part of its picture.
        const Part behind{2, sphere(1, 8), glowing({0.2, 1, 0.4}), moved_by({3, 0, -3 * side})};
        check_same(seen({behind, plate}, view), {0.75, 0.375, 0.25});
        CHECK(traced(scene_of({ball, plate}), view).node[0] == 1);
    }
}

TEST_CASE("a thing that reaches through a mirror is cut at its plane") {
    // The reflected ray would meet the wall below the plane only.
    const Part plate{1, quad(1), mirror(1), glm::dmat4(1)};
    scene::Geometry low = quad(1);  // x = 2, from z = -2 to z = 1
    low.positions = {{2, -1, -2}, {2, -1, 1}, {2, 1, 1}, {2, 1, -2}};
    low.normals.clear();
    low.bounds = {};
    for (const glm::dvec3& position : low.positions) low.bounds.add(position);
    plan::View view = look({-3, 0, 3}, {0, 0, 0});  // meets x = 2 at z = 2 after the reflection
    view.background.color = {0, 0, 0};
    check_same(seen({{2, low, two_sided(glowing({1, 1, 1})), glm::dmat4(1)}, plate}, view), glm::dvec3(0));
    view.camera.eye = {-3, 0, 1};  // at z = 2/3
    check_same(seen({{2, low, two_sided(glowing({1, 1, 1})), glm::dmat4(1)}, plate}, view), glm::dvec3(1));
}

TEST_CASE("the light stays where it is, and C is the way back along the reflected ray") {
    // By hand: eye, mirror z = 0 met at the origin, then a plate facing the eye's side at x = 3.
    scene::Geometry wall = quad(1);
    wall.normals.clear();
    scene::Material material = material_of({0.3, 0.2, 0.1}, {0.5, 0.5, 0.5}, 3);
    const Part plate{1, quad(1), mirror(1), glm::dmat4(1)};
    const Part target{2, wall, material, moved_by({3, 0, 4}) * turned_by(-90, {0, 1, 0})};  // faces -x
    plan::View view = look({-3, 0, 4}, {0, 0, 0});
    const glm::dvec3 point(3, 0, 4), normal(-1, 0, 0);
    const glm::dvec3 to_light = glm::normalize(view.camera.eye - point);  // the headlight at the true eye
    const glm::dvec3 back = glm::normalize(-point);
    const double lambert = glm::dot(normal, to_light);
    const double highlight = std::pow(std::max(glm::dot(2 * lambert * normal - to_light, back), 0.0), 3);
    check_same(seen({plate, target}, view),
               (glm::dvec3(0.3, 0.2, 0.1) + glm::dvec3(0.5) * highlight) * lambert);
}

TEST_CASE("within a mirror mirrors are ordinary surfaces, from both sides") {
    const Part plate{1, quad(1), mirror(0.5, {0.2, 0.2, 0.2}), glm::dmat4(1)};
    for (const double turn : {0.0, 180.0}) {
        const Part other{2, quad(2), mirror(0.9, {0.6, 0.4, 0.8}),
                         moved_by({0, 0, 9}) * turned_by(turn, {0, 1, 0})};
        check_same(seen({plate, other}, look({-0.1, 0, 3}, {0, 0, 0})), {0.4, 0.3, 0.5});
    }
}

TEST_CASE("a mirror does not show what lies in its own place") {
    const glm::dmat4 turned = moved_by({0.1, -0.2, 0.3}) * turned_by(37, {1, 2, 3});
    plan::View view = picture(glm::dvec3(turned * glm::dvec4(-0.3, 0.2, 3, 1)), glm::dvec3(turned[3]), 8, 8);
    view.camera.fov = 10;
    view.background.color = {0.2, 0.8, 0.4};
    // One geometry of one node, or of two.
    const auto plates = [&](const std::vector<scene::Material>& materials) {
        scene::SceneParts parts;
        parts.geometries = {quad(1)};
        parts.materials = materials;
        for (scene::Index i = 0; i < static_cast<scene::Index>(materials.size()); ++i)
            parts.nodes.push_back({scene::Node{9 - i,
                                               {},
                                               scene::NodeType::geometry,
                                               scene::kNone,
                                               {},
                                               true,
                                               turned,
                                               scene::GeometryData{0, i}},
                                   0});
        return std::make_shared<const scene::PlacedScene>(
            scene::place(*scene::Scene::build(std::move(parts))));
    };
    const scene::Material plate = mirror(0.5, {0.6, 0.2, 0.2});
    const reference::ReferenceImage alone = traced(plates({plate}), view);
    check_same(alone.color[27], {0.4, 0.5, 0.3});
    for (const scene::Material& twin :
         {two_sided(glowing({1, 1, 0})), mirror(1), two_sided(glowing({1, 0, 1}, 0.5))})
        CHECK(difference_of(traced(plates({plate, twin}), view), alone) < 1e-12);
}

TEST_CASE("geometry that is not flat, or transparent, is no mirror") {
    plan::View view = look({-3, 0, 3}, {0, 0, 0});
    view.background.color = {0, 0, 0};
    scene::Geometry bent = quad(1);
    bent.positions[2].z = 0.01;
    bent.bounds.add(bent.positions[2]);
    check_same(seen({{1, bent, mirror(0.5, {1, 1, 1}), glm::dmat4(1)}}, view), glm::dvec3(1));
    scene::Material glass = glowing({1, 1, 1}, 0.5);
    glass.reflectivity = 0.5;
    check_same(seen({{1, quad(1), glass, glm::dmat4(1)}}, view), glm::dvec3(0.5));
    // Glass is shown from its front only; a mirror from behind, too.
    view.camera.eye = {-3, 0, -3};
    check_same(seen({{1, quad(1), glass, glm::dmat4(1)}}, view), glm::dvec3(0));
    check_same(seen({{1, quad(1), mirror(0.5, {1, 1, 1}), glm::dmat4(1)}}, view), glm::dvec3(0.5));
}

TEST_CASE("a mirror that is flat by its matrix' grace, and glass before and in a mirror") {
    plan::View view = look({-3, 0, 3}, {0, 0, 0});
    view.background.color = {0, 0, 0};
    const Part ball{2, sphere(1, 8), glowing({0.2, 1, 0.4}), moved_by({3, 0, 3})};
    // A flat geometry under a singular matrix that keeps its plane.
    check_same(seen({ball, {1, quad(1), mirror(1), scaled_by({1, 1, 0})}}, view), {0.2, 1, 0.4});
    const Part before{3, quad(0.4), two_sided(glowing({1, 0, 0}, 0.5)),
                      moved_by({-1.5, 0, 1.5}) * turned_by(-45, {0, 1, 0})};
    const Part within{4, quad(0.4), two_sided(glowing({0, 0, 1}, 0.5)),
                      moved_by({1.5, 0, 1.5}) * turned_by(45, {0, 1, 0})};
    const Part plate{1, quad(0.5), mirror(1), glm::dmat4(1)};
    check_same(seen({ball, plate, before}, view), {0.5 + 0.1, 0.5, 0.2});
    check_same(seen({ball, plate, within}, view), {0.1, 0.5, 0.5 + 0.2});
    check_same(seen({ball, plate, within, before}, view), {0.5 + 0.05, 0.25, 0.25 + 0.1});
}

TEST_CASE("LODs in a mirror are the eye's") {
    scene::SceneParts parts;
    parts.materials = {mirror(1), glowing({1, 0, 0}), glowing({0, 1, 0})};
    parts.geometries = {quad(1), sphere(1, 8)};
    const auto geometry_node = [](scene::Id id, scene::Index geometry, scene::Index material) {
        return scene::Node{id,
                           {},
                           scene::NodeType::geometry,
                           scene::kNone,
                           {},
                           true,
                           glm::dmat4(1),
                           scene::GeometryData{geometry, material}};
    };
    parts.nodes = {
        {geometry_node(1, 0, 0), 0},
        {scene::Node{
             2, {}, scene::NodeType::lod, scene::kNone, {}, true, moved_by({3, 0, 3}), scene::LodData{{7}}},
         0},
        {geometry_node(3, 1, 1), 2},
        {geometry_node(4, 1, 2), 2}};
    auto scene = scene::Scene::build(std::move(parts));
    REQUIRE(scene);
    const auto placed = std::make_shared<scene::PlacedScene>(scene::place(*std::move(scene)));
    // 6 from the ball by air, 8.5 by way of the mirror; then 7.07.
    check_same(traced(placed, look({-3, 0, 3}, {0, 0, 0})).color[0], {1, 0, 0});
    check_same(traced(placed, look({-4, 0, 4}, {0, 0, 0})).color[0], {0, 1, 0});
}

TEST_CASE("any number of mirrors reflect") {
    const int count = 3 * static_cast<int>(plan::kMaxMirrors);
    ReferenceParts parts{
        {1000, quad(999), glowing({0.2, 1, 0.4}), moved_by({0, 0, 9}) * turned_by(180, {0, 1, 0})}};
    for (int i = 0; i < count; ++i) parts.push_back({i + 1, quad(0.4), mirror(1), moved_by({i, 0, 0})});
    const auto scene = scene_of(parts);
    for (int i = 0; i < count; ++i) {
        const plan::View view = look({i + 0.1, 0.1, 5}, {i + 0.1, 0.1, 0});
        check_same(traced(scene, view).color[0], {0.2, 1, 0.4});
    }
}

TEST_CASE("a mirror may be wound both ways") {
    scene::Geometry wound = quad(1);
    std::swap(wound.triangles[1].y, wound.triangles[1].z);
    const Part plate{1, wound, mirror(1), glm::dmat4(1)};
    const Part ball{2, sphere(1, 8), glowing({0.2, 1, 0.4}), moved_by({3, 0, 3})};
    for (const double x : {-0.5, 0.5})  // on one triangle and on the other
        check_same(seen({plate, ball}, look({-3 + x, -x, 3}, {x, -x, 0})), {0.2, 1, 0.4});
}
