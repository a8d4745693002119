#include <numbers>

#include "reference_image.hpp"

using namespace vrut;

namespace {

scene::Material shiny() {
    scene::Material material = material_of({0.5, 0.3, 0.2}, {0.3, 0.4, 0.1}, 7);
    material.ambient = {0.01, 0.02, 0.03, 1};
    material.emission = {0.02, 0, 0.01, 1};
    return material;
}

const glm::dvec3 kBase{0.03, 0.02, 0.04};  // its ambient and emission
const glm::dvec3 kEye{3, 1, 4}, kSeen{1, 2, 0};

/// On the plane z = 0, by the book; `to_light` is unit.
glm::dvec3 expected(const glm::dvec3& to_light, double intensity) {
    const glm::dvec3 to_eye = (kEye - kSeen) / glm::distance(kEye, kSeen);
    const glm::dvec3 mirrored(-to_light.x, -to_light.y, to_light.z);
    const double lambert = std::max(to_light.z, 0.0);
    const double highlight = std::pow(std::max(glm::dot(mirrored, to_eye), 0.0), 7);
    return kBase + (glm::dvec3(0.5, 0.3, 0.2) + glm::dvec3(0.3, 0.4, 0.1) * highlight) * lambert * intensity;
}

glm::dvec3 plate_under(const scene::Light& light) {
    plan::View view = look(kEye, kSeen);
    view.light = light;
    return seen({{1, quad(10), shiny(), glm::dmat4(1)}}, view);
}

scene::Light at(const glm::dvec3& position, scene::LightData::Type type = scene::LightData::Type::point) {
    scene::Light light;
    light.headlight = false;
    light.type = type;
    light.position = position;
    return light;
}

}  // namespace

TEST_CASE("a plate under the headlight") {
    const double distance = std::sqrt(21.0);  // of (2, -1, 4)
    const double cosine = 4 / distance;
    const double highlight = std::pow(2 * cosine * cosine - 1, 7);
    const glm::dvec3 color =
        kBase + (glm::dvec3(0.5, 0.3, 0.2) + glm::dvec3(0.3, 0.4, 0.1) * highlight) * cosine;
    check_same(plate_under({}), color);
    scene::Light fading;
    fading.attenuation = {0.5, 0.25, 0.125};
    check_same(plate_under(fading), kBase + (color - kBase) / (0.5 + 0.25 * distance + 0.125 * 21));
    fading.attenuation = {0, 0, 0};
    check_same(plate_under(fading), color);
    fading.attenuation = {0, 1e-9, 0};  // never below 1e-6
    check_same(plate_under(fading), glm::dvec3(1));
}

TEST_CASE("a point light and a directional one, before and behind the plate") {
    const glm::dvec3 offset = glm::dvec3(-1, 3, 2) - kSeen;
    check_same(plate_under(at({-1, 3, 2})), expected(glm::normalize(offset), 1));
    scene::Light fading = at({-1, 3, 2});
    fading.attenuation = {1, 0, 0.5};
    fading.color = {0.5, 0.25, 0.125, 0};  // its alpha is nothing
    const glm::dvec3 lit =
        (expected(glm::normalize(offset), 1) - kBase) / (1 + 0.5 * glm::dot(offset, offset));
    check_same(plate_under(fading), kBase + lit * glm::dvec3(0.5, 0.25, 0.125));
    check_same(plate_under(at({-1, 3, -2})), kBase);
    check_same(plate_under(at(kSeen)), kBase);

    scene::Light sun = directional({1, -2, -2});
    sun.attenuation = {9, 9, 9};  // nothing to it
    check_same(plate_under(sun), expected(glm::dvec3(-1, 2, 2) / 3.0, 1));
    check_same(plate_under(directional({1, -2, 2})), kBase);
}

TEST_CASE("a spot's cone") {
    const glm::dvec3 position(1, 2, 3);  // above what is seen
    scene::Light spot = at(position, scene::LightData::Type::spot);
    spot.angle = 60;
    const auto tilted = [&](double degrees) {
        const double a = degrees * std::numbers::pi / 180;
        spot.direction = {std::sin(a), 0, -std::cos(a)};
        return plate_under(spot);
    };
    const auto cosine = [](double degrees) { return std::cos(degrees * std::numbers::pi / 180); };
    const glm::dvec3 full = expected({0, 0, 1}, 1);
    check_same(tilted(0), full);
    check_same(tilted(26.9), full);
    check_same(tilted(30.001), kBase);
    check_same(tilted(180), kBase);
    const double t = (cosine(28.5) - cosine(30)) / (cosine(27) - cosine(30));
    check_same(tilted(28.5), kBase + (full - kBase) * (t * t * (3 - 2 * t)));
    spot.angle = 0;
    check_same(tilted(0), kBase);
    spot.angle = 360;
    check_same(tilted(120), full);
}

TEST_CASE("shininess 0 has its highlight wherever it is lit; one turned away has none") {
    plan::View view = look({4, 0, 1}, {0, 0, 0});
    view.light =
        directional({4, 0, -1});  // its reflection goes away from the viewer: exactly backwards is none
    const double lambert = 1 / std::sqrt(17.0);
    scene::Material plain = material_of({0.1, 0.1, 0.1}, {0.5, 0.5, 0.5}, 0);
    check_same(seen({{1, quad(1), plain, glm::dmat4(1)}}, view), glm::dvec3(0.6 * lambert));
    view.light = directional({-4, 0, -1});  // back to the light's side: R · C is below 0
    plain.shininess = 0.5;
    check_same(seen({{1, quad(1), plain, glm::dmat4(1)}}, view), glm::dvec3(0.1 * lambert));
    plain.shininess = 0;
    check_same(seen({{1, quad(1), plain, glm::dmat4(1)}}, view), glm::dvec3(0.6 * lambert));
}

TEST_CASE("a ball of many triangles is a ball") {
    constexpr double kRadius = 1.5;
    const plan::View view = picture({2, 1, 5}, {0.2, 0.1, 0});
    const auto ball = scene_of({{1, sphere(kRadius, 300), shiny(), glm::dmat4(1)}});
    const reference::ReferenceImage shown = traced(ball, view);
    const glm::dvec3 eye = view.camera.eye;
    int compared = 0;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            const glm::dvec2 at((x + 0.5) / view.width * 2 - 1, (y + 0.5) / view.height * 2 - 1);
            const glm::dvec3 ray = scene::direction_through(view.camera, 1.5, at);
            // |eye + t ray| = radius
            const double middle = -glm::dot(eye, ray);
            const double root = middle * middle - glm::dot(eye, eye) + kRadius * kRadius;
            const auto pixel =
                static_cast<std::size_t>(view.height - 1 - y) * static_cast<std::size_t>(view.width) +
                static_cast<std::size_t>(x);
            if (std::abs(root) < 0.05) continue;  // near its outline
            CHECK((shown.node[pixel] == scene::kNone) == (root < 0));
            if (root < 0) continue;
            const glm::dvec3 normal = (eye + ray * (middle - std::sqrt(root))) / kRadius;
            const double cosine = -glm::dot(normal, ray);
            const double highlight = std::pow(std::max(2 * cosine * cosine - 1, 0.0), 7);
            check_same(shown.color[pixel],
                       kBase + (glm::dvec3(0.5, 0.3, 0.2) + glm::dvec3(0.3, 0.4, 0.1) * highlight) * cosine,
                       1e-3);
            ++compared;
        }
    CHECK(compared > 300);
}
