// Studies of surfaces with fewer triangles.
#include <algorithm>
#include <cmath>
#include <limits>

#include "measure/settings.hpp"
#include "mesh/detail_levels.hpp"
#include "pictures.hpp"
#include "plan/detail_plan.hpp"
#include "shapes.hpp"

namespace vrut::stability {

namespace {

/// A ball with bumps, closed; its normals are none of its own.
scene::Geometry bumpy_ball(int rings) {
    scene::Geometry geometry = welded(sphere(1, rings, false));
    for (glm::dvec3& p : geometry.positions)
        p *= 1 + 0.1 * std::sin(5 * p.x + 1) * std::sin(7 * p.y) * std::sin(6 * p.z + 2);
    return mapped(geometry, 1, glm::dvec3(0));
}

const scene::Material kBlack = material_of({0, 0, 0});

/// Of a black part, the pixels that do not lie among others of it.
std::vector<glm::ivec2> outline_of(const scene::Image& image) {
    const auto shown = [&](int x, int y) {
        return image.rgba[4 * static_cast<std::size_t>(y * image.width + x)] == 0;
    };
    std::vector<glm::ivec2> outline;
    for (int y = 1; y + 1 < image.height; ++y)
        for (int x = 1; x + 1 < image.width; ++x)
            if (shown(x, y) && !(shown(x - 1, y) && shown(x + 1, y) && shown(x, y - 1) && shown(x, y + 1)))
                outline.emplace_back(x, y);
    return outline;
}

/// The furthest that a pixel of one outline lies from the other.
double furthest(const std::vector<glm::ivec2>& from, const std::vector<glm::ivec2>& to) {
    int furthest = 0;
    for (const glm::ivec2& a : from) {
        int nearest = std::numeric_limits<int>::max();
        for (const glm::ivec2& b : to) {
            const glm::ivec2 way = a - b;
            nearest = std::min(nearest, way.x * way.x + way.y * way.y);
            if (nearest <= furthest) break;
        }
        furthest = std::max(furthest, nearest);
    }
    return std::sqrt(furthest);
}

}  // namespace

Study outlines_of_levels(const Laboratory& laboratory) {
    Study study{"outlines", "Outlines of parts with fewer triangles",
                "triangles of the part / triangles left", "how far the outline moves / error told"};
    study.bound = 1;
    study.method.title = "the error told with each level";
    study.explanation =
        "How far the collapses have moved the surface is measured at vertices, edges and "
        "triangles, from either surface to the other, and told with a quarter more.";
    study.cost = "Part of the time that levels take to make, on a thread that gives way.";
    scene::Geometry whole = bumpy_ball(24);
    whole.normals.assign(whole.positions.size(), {0, 0, 1});  // so that only places count
    const auto scene = scene_of({{1, whole, kBlack}});
    const auto levels = server::measure::detail_levels_of(scene);
    std::vector<double> places;
    for (std::size_t i = 0; i < levels->of(0).size(); ++i)
        if (levels->of(0)[i].number > 0) places.push_back(static_cast<double>(i));
    for (const double place : laboratory.chosen(places)) {
        const mesh::DetailLevel& level = levels->of(0)[static_cast<std::size_t>(place)];
        const auto fewer = scene_of({{1, mesh::geometry_of(whole, level), kBlack}});
        double most = 0;
        for (const glm::dvec3& eye : {glm::dvec3(0, 0, 4), glm::dvec3(3, 2, 1.5), glm::dvec3(-2, 3, -1.5),
                                      glm::dvec3(-3, -1, 2), glm::dvec3(1, -3, -2), glm::dvec3(4, 0, 0)}) {
            plan::View view = looking(scene, eye);
            view.width = view.height = 1024;
            const double told = level.error * plan::max_screen_space_scale(
                                                  scene::view_from_world(view.camera), whole.bounds, view);
            const auto before = outline_of(drawn(laboratory, view));
            view.scene = fewer;
            const auto after = outline_of(drawn(laboratory, view));
            if (before.empty() || after.empty()) most = kNothing;
            most = std::max({most, furthest(before, after) / told, furthest(after, before) / told});
        }
        const double reduction =
            static_cast<double>(whole.triangles.size()) / static_cast<double>(level.triangles.size());
        study.method.points.push_back({reduction, most});
    }
    return study;
}

Study popping_levels(const Laboratory& laboratory) {
    Study study{"popping", "The picture when a level of detail changes", "error allowed, in pixels",
                "pixels that jump by more than 8 of 255, in percent"};
    study.bound = 1;
    study.limit = 4;
    study.method.title = "from each level to the next, at once";
    study.explanation =
        "While things move, the built-in levels of accuracy allow two pixels at most; at rest every triangle "
        "is drawn.";
    study.cost = "Where fewer pixels are allowed, more triangles are drawn.";
    scene::Geometry whole = bumpy_ball(48);
    whole.normals.assign(whole.positions.size(), glm::vec3(0));
    for (const glm::uvec3& t : whole.triangles) {
        const auto& p = whole.positions;
        const glm::vec3 across(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]));
        for (int k = 0; k < 3; ++k) whole.normals[t[k]] += across;
    }
    const auto scene = scene_of({{1, whole, material_of({0.6, 0.4, 0.2}, {0.3, 0.3, 0.3}, 30)}});
    const auto levels = server::measure::detail_levels_of(scene);
    for (const double pixels : laboratory.chosen({0.125, 0.25, 0.5, 1, 2, 4, 8, 16})) {
        std::vector<double> jumps;
        for (const mesh::DetailLevel& level : levels->of(0)) {
            if (level.number == 0) continue;
            // From where the level is just drawn.
            plan::View view;
            for (double distance = 1.3; distance < 1e4; distance *= 1.01) {
                view = looking(scene, glm::normalize(glm::dvec3(1, 1, 2)) * distance);
                view.width = view.height = 512;
                view.levels = levels;
                view.detail =
                    plan::max_screen_space_scale(scene::view_from_world(view.camera), whole.bounds, view) *
                    level.error;
                if (view.detail <= pixels) break;
            }
            plan::FrameStats fewer, more;
            view.detail *= 1.0001;
            const scene::Image after = drawn(laboratory, view, &fewer);
            view.detail *= 0.999;
            const scene::Image before = drawn(laboratory, view, &more);
            // Of coarse levels so far away that the ball is less than a pixel nothing is to be seen.
            if (fewer.triangles < more.triangles && !is_plain(after))
                jumps.push_back(percent_off(before, after));
        }
        const auto most = std::max_element(jumps.begin(), jumps.end());
        study.method.points.push_back({pixels, most == jumps.end() ? kNothing : *most});
    }
    return study;
}

}  // namespace vrut::stability
