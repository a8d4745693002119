// Studies of what is drawn, beside what the double-precision reference traces.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "pictures.hpp"
#include "reference/reference.hpp"
#include "shapes.hpp"

namespace vrut::stability {

namespace {

scene::Geometry in_single_precision(scene::Geometry geometry) {
    for (glm::dvec3& position : geometry.positions) position = glm::dvec3(glm::vec3(position));
    return geometry;
}

}  // namespace

Study far_positions(const Laboratory& laboratory) {
    Study study{"positions", "Positions far from the origin",
                "distance from the origin, in sizes of the part",
                "pixels off by more than 8 of 255, in percent"};
    study.bound = 0.1;
    study.baseline.title = "world positions in single precision";
    study.method.title = "relative to the eye, from double precision";
    study.explanation =
        "Positions and matrices are kept in double; each part is moved to the eye in double, and only what "
        "is left, which is small where it is seen large, goes to the GPU in single precision.";
    study.cost = "A product of two matrices in double for each part and picture; no more bytes on the GPU.";
    const scene::Material material = material_of({0.6, 0.4, 0.2}, {0.3, 0.3, 0.3}, 30);
    for (const double distance : laboratory.chosen({1, 10, 100, 1e3, 1e4, 3e4, 1e5, 1e6, 1e7, 1e8})) {
        const glm::dvec3 there(distance, -distance, distance);
        const scene::Geometry body = mapped(sphere(1, 12), 1, there);
        const auto scene = scene_of({{1, body, material}});
        const plan::View view = looking(scene, there + glm::dvec3(1, 1.5, 3), there);
        const scene::Image right = truth_of(view);
        plan::View rounded = view;
        rounded.scene = scene_of({{1, in_single_precision(body), material}});
        study.baseline.points.push_back({distance, percent_off(drawn(laboratory, rounded), right)});
        study.method.points.push_back({distance, percent_off(drawn(laboratory, view), right)});
    }
    return study;
}

namespace {

/// Whether a wall at `distance` hides one that stands `gap` of that behind it, with a speck at `near`.
bool tells_apart(const Laboratory& laboratory, double near, double distance, double gap) {
    const scene::Material front = material_of({1, 0, 0}), back = material_of({0, 1, 0});
    const auto scene = scene_of({{1, quad(near / 100), back, moved_by({near * 0.2, 0, -near})},
                                 {2, quad(distance), front, moved_by({0, 0, -distance})},
                                 {3, quad(distance), back, moved_by({0, 0, -distance * (1 + gap)})}});
    const scene::Image image = drawn(laboratory, looking(scene, {0, 0, 0}, {0, 0, -1}));
    std::size_t of_front = 0, others = 0;  // pixels in the middle
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        const std::size_t x = i / 4 % static_cast<std::size_t>(image.width);
        if (std::abs(static_cast<double>(x) - image.width / 2.0) >= image.width / 8.0) continue;
        ++(image.rgba[i] > image.rgba[i + 1] + 50 ? of_front : others);
    }
    return of_front > 0 && others == 0;
}

/// The depth that 24 bits keep of something at `distance`, of a usual projection (OpenGL 4.6, 13.8.1).
std::uint32_t depth_24(double near, double far, double distance) {
    const double depth = far * (distance - near) / (distance * (far - near));
    return static_cast<std::uint32_t>(std::lround(depth * 0xFFFFFF));
}

}  // namespace

Study deep_views(const Laboratory& laboratory) {
    Study study{"depth", "Views from very near to very far", "far / near",
                "least gap told apart at the far end / its distance"};
    study.bound = 1e-5;
    study.baseline.title = "24 bits, the usual way (computed)";
    study.method.title = "reversed depth in 32-bit float";
    study.explanation =
        "Depth is near / distance in 32-bit float: 1 at the near plane, 0 at infinity, with the same "
        "relative precision everywhere.";
    study.cost = "Nothing: the same 32 bits a pixel, and one clip plane less.";
    for (const double ratio : laboratory.chosen({10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8})) {
        const double near = 1000 / ratio;
        double gap = 1;
        while (gap > 1e-9 && depth_24(near, 2000, 1000) < depth_24(near, 2000, 1000 * (1 + gap / 2)))
            gap /= 2;
        study.baseline.points.push_back({ratio, gap});
        if (!tells_apart(laboratory, near, 1000, 1)) {
            study.method.points.push_back({ratio, kNothing});
            continue;
        }
        double least = 1;
        while (least > 1e-9 && tells_apart(laboratory, near, 1000, least / 2)) least /= 2;
        study.method.points.push_back({ratio, least});
    }
    return study;
}

Study large_triangles(const Laboratory& laboratory) {
    Study study{"light", "Light on large triangles", "side of the triangles / their distance to the light",
                "largest error of a channel, of 255"};
    study.bound = 8;
    study.baseline.title = "light at the vertices";
    study.method.title = "light at each pixel";
    study.explanation = "Position and normal are interpolated, everything else is computed at each pixel.";
    for (const double ratio :
         laboratory.chosen({0.03, 0.05, 0.1, 0.14, 0.2, 0.3, 0.5, 0.7, 1, 1.4, 2, 2.8, 4})) {
        // Triangles of side `ratio`, as many as cover the wall, and a light 1 before it.
        const auto cells = static_cast<unsigned>(std::max(1.0, std::round(4 / ratio)));
        const double half = ratio * cells / 2;
        scene::Geometry wall = surface(
            cells, cells, [&](double u, double v) { return half * glm::dvec3(2 * u - 1, 2 * v - 1, 0); });
        wall.normals.assign(wall.positions.size(), {0, 0, 1});
        plan::View view = looking(scene_of({{1, wall, material_of({0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, 20)}}),
                                  {0.3, 0.2, 2.5});
        view.light.headlight = false;
        view.light.position = {0.13, 0.07, 1};
        const scene::Image right = truth_of(view);
        study.method.points.push_back({ratio, largest_error(drawn(laboratory, view), right)});
        const double pixel_ms = time_of(laboratory, view);
        view.methods.light = plan::Methods::Lighting::vertex;
        study.cost = "Here " + times_the_time(pixel_ms, time_of(laboratory, view)) +
                     ", where one wall is all of the picture; within what times vary on the car.";
        study.baseline.points.push_back({ratio, largest_error(drawn(laboratory, view), right)});
    }
    return study;
}

}  // namespace vrut::stability
