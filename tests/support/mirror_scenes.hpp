#pragma once

#include "plan/frame_plan.hpp"
#include "plan/mirror_plan.hpp"
#include "shapes.hpp"

namespace vrut::mirror_scenes {

inline const scene::Material kRed = material_of({0.8, 0.2, 0.1}, {0.4, 0.4, 0.4}, 20);

/// Looks the same under any light.
inline scene::Material paint(const glm::dvec3& color, double alpha = 1) {
    scene::Material material;
    material.emission = {color, 1};
    material.diffuse = {0, 0, 0, alpha};
    material.two_sided = true;
    return material;
}

inline scene::Material mirror_of(double reflectivity, const glm::dvec3& color = {0.3, 0.2, 0.1}) {
    scene::Material material = paint(color);
    material.reflectivity = reflectivity;
    return material;
}

inline Part floor_mirror(scene::Id id, double half = 3) {
    return {id, quad(half), mirror_of(1), turned_by(-90, {1, 0, 0})};
}

inline plan::FramePlan plan_of(const std::vector<Part>& parts, plan::View view) {
    view.scene = scene_of(parts);
    return plan::plan_frame(view);
}

/// A ball before a hundred mirrors of several sizes, and one that is seen edge-on.
inline std::vector<Part> hundred_mirrors() {
    std::vector<Part> parts{{1000, sphere(0.5, 6), kRed, moved_by({0, 0, 2})}};
    for (int i = 0; i < 100; ++i) {
        const double half = 0.1 + 0.002 * ((i * 37) % 100);
        const int row = i / 10;
        parts.push_back({i + 1, quad(half), mirror_of(1),
                         moved_by({(i % 10) * 0.8 - 3.6, row * 0.7 - 3.2, 0}) * turned_by(i, {0, 1, 0})});
    }
    // Edge-on ones are small, however large they are.
    parts.push_back({200, quad(3), mirror_of(1), turned_by(90, {0, 1, 0})});
    return parts;
}

}  // namespace vrut::mirror_scenes
