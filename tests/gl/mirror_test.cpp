#include <cmath>

#include "plan/frame_plan.hpp"
#include "plan/mirror_plan.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

const scene::Material kRed = material_of({0.8, 0.2, 0.1}, {0.4, 0.4, 0.4}, 20);
const scene::Material kGreen = material_of({0.1, 0.7, 0.2});
const scene::Material kBlue = material_of({0.2, 0.3, 0.9});

scene::Material mirror_of(double reflectivity, const glm::dvec3& diffuse = {0.3, 0.2, 0.1}) {
    scene::Material material = material_of(diffuse);
    material.reflectivity = reflectivity;
    return material;
}

scene::Material two_sided(scene::Material material) {
    material.two_sided = true;
    return material;
}

/// A ball, a box and a plate around the origin, above y = 0.
std::vector<Part> things() {
    return {{11, sphere(0.6, 8), kRed, moved_by({-0.8, 0.8, 0.2})},
            {12, box({0.3, 0.5, 0.4}), kGreen, moved_by({0.7, 0.6, 0.4}) * turned_by(30, {0, 1, 0})},
            {13, quad(0.5), two_sided(kBlue), moved_by({0, 1.2, -0.8}) * turned_by(25, {1, 1, 0})}};
}

/// With mirrors.
std::vector<Part> with(std::vector<Part> parts, const std::vector<Part>& more) {
    parts.insert(parts.end(), more.begin(), more.end());
    return parts;
}

Part mirror_at(scene::Id id, const glm::dmat4& matrix, double half = 2, double reflectivity = 1) {
    return {id, quad(half), mirror_of(reflectivity), matrix};
}

glm::dmat4 floor_turn() { return turned_by(-90, {1, 0, 0}); }

std::size_t mirrors_in(const std::vector<Part>& parts, plan::View view) {
    view.scene = scene_of(parts);
    return plan::plan_frame(view).scene.mirrors.size();
}

/// Checks, and tells how many pixels were compared that show a surface.
void check_mirror(RendererFixture& studio, const std::vector<Part>& parts, const plan::View& view,
                  int surfaces = 400) {
    CHECK(studio.check(scene_of(parts), view).surfaces > surfaces);
}

}  // namespace

TEST_CASE("a mirror at any angle shows what lies before it") {
    RendererFixture studio;
    for (const double degrees : {0.0, 45.0, 77.0, -30.0})
        for (const double lean : {0.0, -20.0}) {
            CAPTURE(degrees);
            CAPTURE(lean);
            const glm::dmat4 matrix =
                moved_by({0, 0.8, -1.7}) * turned_by(degrees, {0, 1, 0}) * turned_by(lean, {1, 0, 0});
            const auto parts = with(things(), {mirror_at(1, matrix)});
            check_mirror(studio, parts, view_from({0.5, 1.5, 5}, {0, 0.6, 0}));
            CHECK(mirrors_in(parts, view_from({0.5, 1.5, 5}, {0, 0.6, 0})) == 1);
        }
    check_mirror(studio, with(things(), {mirror_at(1, floor_turn())}), view_from({1, 2, 5}));
}

TEST_CASE("a mirror from behind, under a mirroring matrix, and flattened") {
    RendererFixture studio;
    const plan::View view = view_from({0.5, 1.5, 5}, {0, 0.6, 0});
    for (const glm::dmat4& matrix : {turned_by(170, {0, 1, 0}), scaled_by({-1, 1, 1}), scaled_by({1, 1, -1}),
                                     turned_by(10, {0, 1, 0}) * scaled_by({2, 1, 1e-9}),
                                     turned_by(190, {0, 1, 0}) * scaled_by({1, 2, 1})}) {
        const auto parts = with(things(), {mirror_at(1, moved_by({0, 0.8, -1.7}) * matrix, 1.5, 0.7)});
        check_mirror(studio, parts, view);
        CHECK(mirrors_in(parts, view) == 1);
    }
    // Wound both ways.
    scene::Geometry wound = quad(1.5);
    std::swap(wound.triangles[1].y, wound.triangles[1].z);
    check_mirror(studio, with(things(), {{1, wound, mirror_of(0.7), moved_by({0, 0.8, -1.7})}}), view);
    // A determinant of 0 leaves the plane, or takes it.
    const auto flat = with(things(), {mirror_at(1, moved_by({0, 0.8, -1.7}) * scaled_by({1, 1, 0}))});
    const auto thin = with(things(), {mirror_at(1, moved_by({0, 0.8, -1.7}))});
    CHECK(studio.draw(scene_of(flat), view).rgba == studio.draw(scene_of(thin), view).rgba);
    for (const glm::dvec3& factors : {glm::dvec3(0, 1, 1), glm::dvec3(0, 0, 0)}) {
        const auto gone = with(things(), {mirror_at(1, moved_by({0, 0.8, -1.7}) * scaled_by(factors))});
        CHECK(studio.draw(scene_of(gone), view).rgba == studio.draw(scene_of(things()), view).rgba);
        CHECK(mirrors_in(gone, view) == 0);
    }
}

TEST_CASE("a mirror's own colour has the part that its reflectivity leaves") {
    RendererFixture studio;
    for (const double reflectivity : {0.01, 0.3, 0.9, 1.0}) {
        CAPTURE(reflectivity);
        plan::View view = view_from({0.5, 2, 5}, {0, 0.6, 0});
        check_mirror(studio, with(things(), {mirror_at(1, floor_turn(), 3, reflectivity)}), view);
    }
    // By hand: headlight straight on, 0.8 * 0.3 + 0.2 * 100/255 = 0.3184 and so on.
    plan::View view = view_from({0, 0, 5});
    view.background.color = {100 / 255.0, 0, 1};
    const scene::Image image = studio.draw(scene_of({{1, quad(1), mirror_of(0.2), glm::dmat4(1)}}), view);
    const glm::ivec3 should = bytes_of({0.8 * 0.3 + 0.2 * 100 / 255, 0.8 * 0.2, 0.8 * 0.1 + 0.2});
    for (int channel = 0; channel < 3; ++channel)
        CHECK(std::abs(pixel_of(image, 48, 32)[channel] - should[channel]) <= 1);
}

TEST_CASE("several mirrors: the nearer one hides the farther, each has its own image, one bounce") {
    RendererFixture studio;
    const Part back = mirror_at(1, moved_by({0, 0.8, -1.7}) * turned_by(8, {0, 1, 0}), 2);
    const Part side = mirror_at(2, moved_by({-1.5, 0.8, 0}) * turned_by(80, {0, 1, 0}), 1.2);
    const Part front = mirror_at(3, moved_by({0.5, 0.4, 1.2}) * turned_by(-20, {0, 1, 0}), 0.6, 0.8);
    const Part floor = mirror_at(4, floor_turn(), 3, 0.5);
    const Part facing = mirror_at(5, moved_by({0, 0.8, 2.5}) * turned_by(178, {0, 1, 0}), 0.5);
    for (const auto& mirrors : {std::vector<Part>{back, front},
                                {front, back, side},
                                {back, facing},
                                {back, side, front, floor, facing}}) {
        plan::View view = view_from({0.9, 1.5, 5}, {0, 0.6, 0});
        const auto parts = with(things(), mirrors);
        check_mirror(studio, parts, view, 1000);
        CHECK(mirrors_in(parts, view) == mirrors.size());
        view.camera.eye = {-1, 2.5, 3};
        view.camera = scene::with_orthogonal_up(view.camera);
        check_mirror(studio, parts, view, 1000);
    }
}

TEST_CASE("what lies behind a mirror's plane is not seen in it, and what goes through it is cut off") {
    RendererFixture studio;
    const plan::View view = view_from({0.5, 2, 5}, {0, 0, 0});
    for (const double height : {-3.0, -0.7, -0.3, 0.0, 0.2, 0.61, 1.0}) {
        CAPTURE(height);
        const Part floor = mirror_at(1, floor_turn(), 3);
        check_mirror(
            studio,
            {floor,
             {2, sphere(0.6, 8), kRed, moved_by({-0.8, height, 0.2})},
             {3, box({0.3, 0.5, 0.4}), kGreen, moved_by({0.7, height, 0.4}) * turned_by(30, {0, 1, 1})}},
            view);
    }
    // Walls stand on the floor, and one lies in its plane beside it.
    const Part floor = mirror_at(1, floor_turn(), 1);
    check_mirror(studio,
                 {floor,
                  {2, box({0.5, 0.5, 0.1}), kRed, moved_by({0, 0.5, -0.5})},
                  {3, quad(0.5), two_sided(kBlue), moved_by({1.5, 0, 0}) * floor_turn()}},
                 view);
}

TEST_CASE("lights of all kinds stay at their places in a mirror") {
    RendererFixture studio;
    plan::View view = view_from({0.5, 1.5, 5}, {0, 0.6, 0});
    const auto parts = with(things(), {mirror_at(1, moved_by({0, 0.8, -1.7}) * turned_by(15, {0, 1, 0})),
                                       mirror_at(2, floor_turn(), 2, 0.6)});
    view.light.attenuation = {0.5, 0.1, 0.02};
    check_mirror(studio, parts, view);
    view.light.headlight = false;
    view.light.position = {1, 3, -1};
    view.light.direction = glm::normalize(glm::dvec3(-0.4, -1, 0.5));
    view.light.angle = 70;
    for (const auto type :
         {scene::LightData::Type::point, scene::LightData::Type::directional, scene::LightData::Type::spot}) {
        CAPTURE(static_cast<int>(type));
        view.light.type = type;
        check_mirror(studio, parts, view);
    }
}

TEST_CASE("what a mirror shows is drawn only where the mirror is seen") {
    RendererFixture studio;
    const plan::View view = view_from({0.5, 1.5, 5}, {0, 0.6, 0});
    const Part mirror = mirror_at(1, moved_by({0, 0.8, -1.7}));
    check_mirror(studio, with(things(), {mirror}), view);
    const std::uint64_t open = studio.stats.triangles;
    const auto walled = with(things(), {mirror, {5, quad(4), two_sided(kGreen), moved_by({0, 0.8, -1.5})}});
    CHECK(mirrors_in(walled, view) == 1);
    check_mirror(studio, walled, view);
    CHECK(studio.stats.triangles < open * 2 / 3);
    // A corner of it that looks out is enough.
    check_mirror(studio,
                 with(things(), {mirror, {5, quad(1.6), two_sided(kGreen), moved_by({0.6, 0.8, -1.5})}}),
                 view);
    CHECK(studio.stats.triangles > open);
}
