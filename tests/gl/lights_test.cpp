#include <cmath>

#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

constexpr scene::LightData::Type kPoint = scene::LightData::Type::point,
                                 kDirectional = scene::LightData::Type::directional,
                                 kSpot = scene::LightData::Type::spot;

scene::Material rich(double shininess) {
    scene::Material material = material_of({0.5, 0.3, 0.1}, {0.2, 0.3, 0.5}, shininess);
    material.ambient = {0.05, 0.1, 0.02, 1};
    return material;
}

scene::Light light_at(scene::LightData::Type type, const glm::dvec3& position,
                      const glm::dvec3& towards = glm::dvec3(0)) {
    scene::Light light;
    light.type = type;
    light.headlight = false;
    light.position = position;
    light.direction = glm::normalize(towards - position);
    return light;
}

/// A plate whose diffuse colour is 0.8 0.4 0.2, without highlights.
std::shared_ptr<const scene::PlacedScene> plate(double half = 3) {
    return scene_of({{1, quad(half), material_of({0.8, 0.4, 0.2}), glm::dmat4(1)}});
}

/// At the pixel nearest to where a point of the scene is seen.
glm::ivec3 seen_at(const scene::Image& image, const plan::View& view, const glm::dvec3& point) {
    const double aspect = static_cast<double>(view.width) / view.height;
    const glm::dvec4 clip = math::clip_from_view(scene::projection_of(view.camera, aspect), 0.1, 100) *
                            scene::view_from_world(view.camera) * glm::dvec4(point, 1);
    return pixel_of(image, static_cast<int>((clip.x / clip.w + 1) / 2 * view.width),
                    static_cast<int>((1 - clip.y / clip.w) / 2 * view.height));
}

void check_color(const glm::ivec3& is, const glm::ivec3& should) {
    CAPTURE(is.r);
    CAPTURE(is.g);
    CAPTURE(is.b);
    for (int channel = 0; channel < 3; ++channel) CHECK(std::abs(is[channel] - should[channel]) <= 1);
}

}  // namespace

TEST_CASE("lights of each kind, computed and drawn") {
    RendererFixture studio;
    for (const scene::LightData::Type type : {kPoint, kDirectional, kSpot})
        for (const double shininess : {0.0, 1.0, 40.0}) {
            CAPTURE(static_cast<int>(type));
            CAPTURE(shininess);
            plan::View view = view_from({1, 1.5, 5});
            for (const glm::dvec3& at : {glm::dvec3(2, 1, 3), glm::dvec3(-1, 0.5, 2), glm::dvec3(0, 0, 9)}) {
                view.light = light_at(type, at, {0.3, 0.1, 0});
                view.light.color = {0.9, 0.7, 0.5, 0.1};
                view.light.attenuation = {0.5, 0.1, 0.05};
                studio.check(scene_of({{1, quad(2), rich(shininess), glm::dmat4(1)}}), view);
                studio.check(scene_of({{1, sphere(1.4, 8), rich(shininess), turned_by(20, {1, 0, 0})}}),
                             view);
                studio.check(scene_of({{1, box({1, 0.8, 1.2}), rich(shininess), scaled_by({-1, 1, 0.7})}}),
                             view);
            }
        }
}

TEST_CASE("a point light: by hand") {
    RendererFixture studio;
    plan::View view = view_from({1, 2, 5});
    view.light = light_at(kPoint, {0, 0, 2});
    view.light.attenuation = {0, 0, 0.5};  // 1 / (0.5 * 4) straight below
    const scene::Image image = studio.draw(plate(), view);
    check_color(seen_at(image, view, {0, 0, 0}), {102, 51, 26});
    // At 2 to the side: the distance's square is 8, the cosine 1 / sqrt 2: 0.8 / 4 / 1.4142.
    check_color(seen_at(image, view, {2, 0, 0}), {36, 18, 9});
    // From behind the plate it lights nothing.
    view.light.position = {0, 0, -2};
    check_color(seen_at(studio.draw(plate(), view), view, {0, 0, 0}), {0, 0, 0});
}

TEST_CASE("a directional light shines alike everywhere, whatever its attenuation and place") {
    RendererFixture studio;
    plan::View view = view_from({1, 2, 5});
    view.light = light_at(kDirectional, {0, std::sqrt(3.0), 1});  // 60 degrees off the normal
    const scene::Image image = studio.draw(plate(), view);
    for (const glm::dvec3& point : {glm::dvec3(0, 0, 0), glm::dvec3(2, 0, 0), glm::dvec3(-2, -2, 0)})
        check_color(seen_at(image, view, point), {102, 51, 26});
    view.light.attenuation = {9, 7, 5};
    view.light.position = {100, 200, -300};
    view.light.angle = 3;
    CHECK(studio.draw(plate(), view).rgba == image.rgba);
}

TEST_CASE("a spot's edge is the smoothstep between nine tenths of its cone and the cone") {
    RendererFixture studio;
    plan::View view = view_from({0, 0, 12});
    view.camera.fov = 25;
    view.width = 960;
    view.height = 640;
    view.light = light_at(kSpot, {0, 0, 4});
    view.light.angle = 60;
    const auto at = [](double degrees) { return glm::dvec3(4 * std::tan(glm::radians(degrees)), 0, 0); };
    const scene::Image image = studio.draw(plate(), view);
    check_color(seen_at(image, view, {0.01, 0.01, 0}), {204, 102, 51});
    CHECK(seen_at(image, view, at(26)).r > 175);  // 204 times the cosine alone
    CHECK(seen_at(image, view, at(31)) == glm::ivec3(0));
    CHECK(seen_at(image, view, {0, -at(31).x, 0}) == glm::ivec3(0));
    // Halfway between the two cosines there is half of it.
    const double middle =
        glm::degrees(std::acos((std::cos(glm::radians(27.0)) + std::cos(glm::radians(30.0))) / 2));
    CHECK(std::abs(seen_at(image, view, at(middle)).r - 0.5 * 204 * std::cos(glm::radians(middle))) < 6);
    view.width = 96;
    view.height = 64;
    for (const double angle : {150.0, 60.0, 20.0, 5.0}) {
        CAPTURE(angle);
        view.light.angle = angle;
        studio.check(plate(), view);
    }
}

TEST_CASE("spots as narrow and as wide as can be") {
    RendererFixture studio;
    plan::View view = view_from({0, 0, 12});
    view.light = light_at(kSpot, {0, 0, 4});
    // A tenth of a degree, looked at where it ends: 3.1 to 3.5 thousandths beside its middle.
    view.camera.eye.x = view.camera.focus.x = 0.0033;
    view.camera.fov = 0.004;
    view.light.angle = 0.1;
    const PictureMismatch narrow = studio.check(plate(), view);
    CHECK(narrow.surfaces == view.width * view.height);
    const scene::Image image = studio.draw(plate(), view);
    int steps = 0;
    for (int x = 1; x < view.width; ++x) steps += pixel_of(image, x, 32) != pixel_of(image, x - 1, 32);
    CHECK(steps > 20);

    view = view_from({0, 0, 12});
    view.light = light_at(kSpot, {0, 0, 4});
    view.light.angle = 0;
    CHECK(seen_at(studio.draw(plate(), view), view, {0.5, 0.5, 0}) == glm::ivec3(0));
    view.light.angle = 360;
    const scene::Image all = studio.draw(plate(), view);
    view.light.type = kPoint;
    const scene::Image point = studio.draw(plate(), view);
    check_color(seen_at(all, view, {1, 1, 0}), seen_at(point, view, {1, 1, 0}));
}

TEST_CASE("lights at odd places") {
    RendererFixture studio;
    plan::View view = view_from({1, 2, 5});
    // On the surface itself, and beyond what float can square.
    view.light = light_at(kPoint, {0, 0, 0}, {0, 0, 1});
    check_color(seen_at(studio.draw(plate(), view), view, {1, 1, 0}), {0, 0, 0});
    view.light = light_at(kPoint, {0, std::sqrt(3.0) * 1e30, 1e30});
    check_color(seen_at(studio.draw(plate(), view), view, {1, 1, 0}), {102, 51, 26});
    // Far from the world's origin, like all that it lights.
    const glm::dvec3 far{1e7, -1e7, 1e7};
    view.light = light_at(kSpot, far + glm::dvec3(1, 0.5, 3), far);
    view.camera.eye += far;
    view.camera.focus += far;
    studio.check(scene_of({{1, sphere(1.4, 8), rich(10), moved_by(far)}}), view);
}

TEST_CASE("the light of a node: where it stands, along its own -z, as the file says") {
    scene::SceneParts parts;
    scene::LightData data{kSpot, {1, 0.5, 0.25, 1}, {1, 2, 3}, 33};
    const auto add = [&](scene::Id id, scene::Id parent, const glm::dmat4& matrix,
                         decltype(scene::Node::data) what) {
        const scene::NodeType type = std::holds_alternative<scene::LightData>(what)
                                         ? scene::NodeType::light
                                         : scene::NodeType::assembly;
        parts.nodes.push_back(
            {scene::Node{id, {}, type, scene::kNone, {}, false, matrix, std::move(what)}, parent});
    };
    add(1, 0, moved_by({1, 2, 3}), scene::GroupData{});
    add(2, 1, turned_by(90, {0, 1, 0}) * scaled_by({1, 1, 5}), data);
    add(3, 1, scaled_by({0, 0, 0}), data);
    const scene::PlacedScene placed = scene::place(*scene::Scene::build(std::move(parts)));
    const scene::Light light = scene::light_of(placed, placed.scene->find_node(2));
    CHECK(light.type == kSpot);
    CHECK_FALSE(light.headlight);
    CHECK(light.color == glm::dvec4(1, 0.5, 0.25, 1));
    CHECK(light.attenuation == glm::dvec3(1, 2, 3));
    CHECK(light.angle == 33);
    CHECK(light.position == glm::dvec3(1, 2, 3));
    CHECK(glm::distance(light.direction, glm::dvec3(-1, 0, 0)) < 1e-12);
    CHECK(scene::light_of(placed, placed.scene->find_node(3)).direction == glm::dvec3(0, 0, -1));
}
