#pragma once

#include <doctest/doctest.h>

#include <cmath>

#include "reference/reference.hpp"
#include "shapes.hpp"

namespace vrut {

using ReferenceParts = std::vector<Part>;

/// One pixel, which looks from `eye` to `focus`.
inline plan::View look(const glm::dvec3& eye, const glm::dvec3& focus) {
    plan::View view;
    view.camera.eye = eye;
    view.camera.focus = focus;
    const glm::dvec3 along = glm::normalize(focus - eye);
    view.camera.up = std::abs(along.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    view.camera = scene::with_orthogonal_up(view.camera);
    view.width = view.height = 1;
    return view;
}

/// A small picture from there.
inline plan::View picture(const glm::dvec3& eye, const glm::dvec3& focus, int width = 48, int height = 32) {
    plan::View view = look(eye, focus);
    view.width = width;
    view.height = height;
    return view;
}

/// Straight on to the plane z = 0, where a unit is a pixel.
inline plan::View pixels(int width, int height) {
    plan::View view = picture({0, 0, height / 2.0}, {0, 0, 0}, width, height);
    view.camera.fov = 90;
    return view;
}

inline reference::ReferenceImage traced(const std::shared_ptr<const scene::PlacedScene>& scene,
                                        plan::View view) {
    view.scene = scene;
    return reference::trace(view);
}

/// What the one pixel shows.
inline glm::dvec3 seen(const ReferenceParts& parts, const plan::View& view) {
    return traced(scene_of(parts), view).color[0];
}

inline void check_same(const glm::dvec3& is, const glm::dvec3& should, double tolerance = 1e-12) {
    CAPTURE(should.r);
    CAPTURE(should.g);
    CAPTURE(should.b);
    CHECK(std::abs(is.r - should.r) <= tolerance);
    CHECK(std::abs(is.g - should.g) <= tolerance);
    CHECK(std::abs(is.b - should.b) <= tolerance);
}

/// The largest difference of any component.
inline double difference_of(const reference::ReferenceImage& a, const reference::ReferenceImage& b) {
    REQUIRE(a.color.size() == b.color.size());
    double worst = 0;
    for (std::size_t i = 0; i < a.color.size(); ++i)
        for (int k = 0; k < 3; ++k) worst = std::max(worst, std::abs(a.color[i][k] - b.color[i][k]));
    return worst;
}

/// Of that colour under any light.
inline scene::Material glowing(const glm::dvec3& color, double alpha = 1) {
    scene::Material material = material_of({0, 0, 0});
    material.emission = {color, 1};
    material.diffuse.a = alpha;
    return material;
}

inline scene::Material two_sided(scene::Material material) {
    material.two_sided = true;
    return material;
}

inline scene::Light directional(const glm::dvec3& direction) {
    scene::Light light;
    light.headlight = false;
    light.type = scene::LightData::Type::directional;
    light.direction = glm::normalize(direction);
    return light;
}

}  // namespace vrut
