// Studies of mirrors.
#include <algorithm>
#include <cmath>

#include "math/plane.hpp"
#include "pictures.hpp"
#include "reference/reference.hpp"
#include "scene/fitted_plane.hpp"
#include "shapes.hpp"

namespace vrut::stability {

namespace {

scene::Material mirror_material() {
    scene::Material material = material_of({0.1, 0.1, 0.1});
    material.reflectivity = 0.9;
    return material;
}

}  // namespace

Study many_mirrors(const Laboratory& laboratory) {
    Study study{"mirrors", "Flat mirrors in one picture", "mirrors",
                "pixels off by more than 8 of 255, in percent"};
    study.bound = 0.1;
    study.limit = 17;
    study.method.title = "the 16 largest show the scene";
    study.explanation = "The others are drawn as plain surfaces, which a small one may pass for.";
    for (const double count : laboratory.chosen({1, 2, 4, 8, 16, 17, 36, 64, 100})) {
        std::vector<Part> parts{
            {1000, sphere(0.5, 12), material_of({0.9, 0.2, 0.1}), moved_by({-1.5, 0.3, 8})},
            {1001, box({0.5, 0.5, 0.5}), material_of({0.1, 0.8, 0.3}), moved_by({1.5, -0.3, 8})}};
        const int in_row = static_cast<int>(std::ceil(std::sqrt(count)));
        for (int i = 0; i < static_cast<int>(count); ++i) {
            const int column = i % in_row, row = i / in_row;
            const double x = column + 0.5 - in_row / 2.0, y = row + 0.5 - in_row / 2.0;
            parts.push_back(
                {i + 1, quad(1.4 / in_row), mirror_material(),
                 moved_by({x * 3 / in_row, y * 3 / in_row, -1}) * turned_by(3.0 * i / count, {0, 1, 0})});
        }
        const plan::View view = looking(scene_of(parts), {0, 0, 6}, {0, 0, -1});
        study.method.points.push_back({count, percent_off(drawn(laboratory, view), truth_of(view))});
        if (count <= 16) {
            plan::View plain = view;
            for (Part& part : parts) part.material.reflectivity = 0;
            plain.scene = scene_of(parts);
            study.cost = "With 16 mirrors a picture takes " +
                         times_the_time(time_of(laboratory, view), time_of(laboratory, plain)) +
                         " that it takes without: each shows the scene once more.";
        }
    }
    return study;
}

Study edge_on_mirrors(const Laboratory& laboratory) {
    Study study{"edge-on", "The eye crosses a mirror's plane", "1 / height of the eye above, then below",
                "pixels off by more than 8 of 255, in percent"};
    study.bound = 0.5;
    study.method.title = "reflection in double, depth of its own";
    study.explanation = "At the plane itself the mirror is a line, and nothing is seen in it.";
    study.cost = "None.";
    for (const double inverse : laboratory.chosen({0.5, 1, 3, 10, 100, 1e3, 1e4, 1e6, 1e9, 1e12})) {
        const auto scene =
            scene_of({{1, quad(3), mirror_material(), turned_by(-90, {1, 0, 0})},
                      {2, sphere(0.5, 12), material_of({0.9, 0.2, 0.1}), moved_by({-0.6, 0.7, -1})},
                      {3, box({0.3, 0.3, 0.3}), material_of({0.1, 0.8, 0.3}), moved_by({0.7, 0.4, 0})}});
        double worst = 0;
        for (const double height : {1 / inverse, 0.0, -1 / inverse}) {
            const plan::View view = looking(scene, {0.2, height, 4}, {0.1, 0.2 * height, 0});
            worst = std::max(worst, percent_off(drawn(laboratory, view), truth_of(view)));
        }
        study.method.points.push_back({inverse, worst});
    }
    return study;
}

Study bent_mirrors(const Laboratory& laboratory) {
    Study study{"bent-mirrors", "Mirrors that are not quite flat",
                "height of the bulge / radius of the mirror", "error of the reflection at the rim, degrees"};
    study.bound = 0.2;
    study.method.title = "flat to 1e-4 of the radius, else none";
    study.explanation =
        "What is not flat to 1e-4 of its radius reflects the panorama, where there is one, or is drawn as a "
        "plain surface, and a notice says so.";
    study.cost = "A bent mirror does not show the scene.";
    constexpr double kFlat = 1e-5;  // of the radius: what a file's rounding may bend
    for (const double bulge : laboratory.chosen({1e-7, 1e-6, 1e-5, 1e-4, 3e-4, 1e-3, 1e-2, 0.1, 0.5})) {
        const scene::Geometry cap = surface(16, 16, [&](double u, double v) {
            const glm::dvec2 place = glm::dvec2(u, v) * 2.0 - 1.0;
            return glm::dvec3(place, -bulge * glm::dot(place, place));
        });
        // The normal at the rim leans by the slope there, the reflection by twice that.
        const double error = glm::degrees(2 * std::atan(2 * bulge));
        const bool is_flat = scene::fitted_plane(cap).has_value();
        const bool is_lost = !is_flat && bulge <= kFlat;
        study.method.points.push_back({bulge, is_lost ? kNothing : is_flat ? error : 0});
    }
    return study;
}

Study mirrors_in_mirrors(const Laboratory& laboratory) {
    Study study{"mirrors-in-mirrors", "Two mirrors that face each other", "reflectivity, in percent",
                "pixels off from endless reflection, in percent"};
    study.bound = 0.1;
    study.limit = 25;
    study.method.title = "one bounce, then plain surfaces";
    study.explanation =
        "That a mirror is seen in a mirror as a plain surface in its own colour is a rule of the "
        "picture. It is seen where mirrors are good ones and face each other, as in a lift; a car's hardly "
        "do.";
    study.cost =
        "A second bounce would show the scene once more for each pair of mirrors, up to 240 times in a "
        "picture with 16.";
    const auto shining = [](const glm::dvec3& color) {
        scene::Material material = material_of({0, 0, 0});
        material.emission = {color, 1};
        material.two_sided = true;
        return material;
    };
    // Mirrors at z = -2 and 2, the eye between them, and things that light does not change.
    const std::vector<Part> things{
        {1, sphere(0.4, 12), shining({0.9, 0.2, 0.1}), moved_by({-0.9, 0.2, -0.6})},
        {2, box({0.3, 0.5, 0.3}), shining({0.2, 0.9, 0.9}), moved_by({0.9, -0.3, -0.2})}};
    for (const double percent : laboratory.chosen({1, 2, 5, 10, 15, 25, 35, 50, 65, 80})) {
        scene::Material mirror = shining({0.1, 0.1, 0.1});
        mirror.reflectivity = percent / 100;
        std::vector<Part> parts = things;
        parts.push_back({8, quad(100), mirror, moved_by({0, 0, -2})});
        parts.push_back({9, quad(100), mirror, moved_by({0, 0, 2})});
        plan::View view = looking(scene_of(parts), {0.3, 0.4, 1.5}, {0, 0, -2});
        const scene::Image seen = drawn(laboratory, view);
        // What mirrors show lies behind them as behind panes of their own colour, until less than a step of a
        // byte comes through.
        scene::Material pane = shining({0.1, 0.1, 0.1});
        pane.diffuse.a = 1 - mirror.reflectivity;
        std::vector<Part> unfolded = things;
        const int bounces = static_cast<int>(std::ceil(std::log(0.003) / std::log(mirror.reflectivity)));
        for (int i = 0; i < bounces; ++i) {
            unfolded.push_back({10 + i, quad(1000), pane, moved_by({0, 0, -2.0 - 4 * i})});
            const glm::dmat4 there =
                moved_by({0, 0, -4.0 * (i + 1)}) * scaled_by({1, 1, i % 2 == 0 ? -1 : 1});
            for (const Part& thing : things)
                unfolded.push_back(
                    {1000 * thing.id + i, thing.geometry, thing.material, there * thing.matrix});
        }
        view.scene = scene_of(unfolded);
        study.method.points.push_back({percent, percent_off(seen, truth_of(view))});
    }
    return study;
}

}  // namespace vrut::stability
