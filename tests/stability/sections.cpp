// Studies of sections.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/cut.hpp"
#include "mesh/watertight.hpp"
#include "pictures.hpp"
#include "shapes.hpp"

namespace vrut::stability {

namespace {

const scene::Material kRed = material_of({0.9, 0.3, 0.2}), kBlue = material_of({0.2, 0.4, 0.9});

/// Pixels off in percent, but for lines of cuts, which the reference leaves out.
double percent_off_beside_lines(const Laboratory& laboratory, const plan::View& view) {
    scene::Image image = drawn(laboratory, view);
    const scene::Image right = truth_of(view);
    if (image.rgba.size() != right.rgba.size()) return kNothing;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4)
        if (image.rgba[i] == 26 && image.rgba[i + 1] == 26 && image.rgba[i + 2] == 26)
            std::copy_n(right.rgba.begin() + static_cast<std::ptrdiff_t>(i), 4,
                        image.rgba.begin() + static_cast<std::ptrdiff_t>(i));
    return percent_off(image, right);
}

/// Flat boxes one behind the other, as one geometry.
scene::Geometry plates(int count) {
    scene::Geometry all;
    for (int i = 0; i < count; ++i) {
        const double step = 2.0 / count;
        const scene::Geometry plate = mapped(box({0.8, 0.6, 0.3 * step}), 1, {0, 0, -1 + (i + 0.5) * step});
        const auto first = static_cast<unsigned>(all.positions.size());
        all.positions.insert(all.positions.end(), plate.positions.begin(), plate.positions.end());
        for (const glm::uvec3& triangle : plate.triangles) all.triangles.push_back(triangle + first);
    }
    for (const glm::dvec3& position : all.positions) all.bounds.add(position);
    return all;
}

}  // namespace

Study sections_along_the_view(const Laboratory& laboratory) {
    Study study{"section-edge-on", "The eye crosses a section's plane",
                "1 / height of the eye above, then below", "pixels off by more than 8 of 255, in percent"};
    study.bound = 0.5;
    study.method.title = "the cap's depth from the plane";
    study.explanation =
        "In the plane itself the cap is a line, and nothing is seen of it; from below there is none.";
    study.cost = "None.";
    const auto scene =
        scene_of({{1, box({1, 1, 1}), kRed}, {2, welded(sphere(0.7, 16)), kBlue, moved_by({1.5, 0, 0})}});
    for (const double inverse : laboratory.chosen({0.5, 1, 3, 10, 100, 1e3, 1e4, 1e6, 1e9, 1e12})) {
        double worst = 0;
        for (const double height : {1 / inverse, 0.0, -1 / inverse}) {
            plan::View view = looking(scene, {0.4, 0.2 + height, 5}, {0.5, 0.2, 0});
            view.clip_planes = {{{0, 1, 0}, 0.2}};
            worst = std::max(worst, percent_off_beside_lines(laboratory, view));
        }
        study.method.points.push_back({inverse, worst});
    }
    return study;
}

Study sections_at_a_face(const Laboratory& laboratory) {
    Study study{"section-at-a-face", "A section comes near to a face that lies along it",
                "size of the part / distance of the two", "pixels off by more than 8 of 255, in percent"};
    study.bound = 0.1;
    study.limit = 1e16;
    study.method.title = "exact cut, cap at the plane's depth";
    study.explanation =
        "The face beyond the plane is cut away and the cap stands in its place; within rounding either is "
        "seen. "
        "Both have the part's colour, but the face may have a texture.";
    study.cost = "None.";
    const auto scene = scene_of({{1, box({1, 1, 1}), kRed}});
    for (const double inverse : laboratory.chosen({2, 10, 1e3, 1e5, 1e6, 1e7, 1e9, 1e12, 1e16})) {
        double worst = 0;
        for (const double side : {-1.0, 1.0}) {
            plan::View view = looking(scene, {2, 3, 4});
            view.clip_planes = {{{0, 1, 0}, 1 + side / inverse}};
            worst = std::max(worst, percent_off_beside_lines(laboratory, view));
        }
        study.method.points.push_back({inverse, worst});
    }
    return study;
}

Study sections_through_many_walls(const Laboratory& laboratory) {
    Study study{"section-walls", "A ray meets many walls of one part behind a section", "walls",
                "pixels off by more than 8 of 255, in percent"};
    study.bound = 0.5;
    study.method.title = "triangles of the exact cut";
    study.baseline.title = "one count of 8 bits a pixel (stencil)";
    study.explanation =
        "Caps are found from the contours, so that it does not matter how many surfaces lie behind them. A "
        "stencil "
        "buffer counts to 255.";
    for (const double count : laboratory.chosen({1, 4, 16, 64, 128, 256, 512, 1000})) {
        plan::View view = looking(scene_of({{1, plates(static_cast<int>(count)), kRed}}), {0.4, 3, 1.5});
        view.clip_planes = {{glm::normalize(glm::dvec3(0, 1, 0.02)), 0.1}};
        study.method.points.push_back({2 * count, percent_off_beside_lines(laboratory, view)});
        study.baseline.points.push_back({2 * count, 2 * count > 255 ? 100.0 : 0});
        plan::View whole = view;
        whole.clip_planes.clear();
        study.cost = "With a section a picture of the last takes " +
                     times_the_time(time_of(laboratory, view), time_of(laboratory, whole)) +
                     " that it takes without.";
    }
    return study;
}

Study sections_of_slivers(const Laboratory& laboratory) {
    Study study{"section-slivers", "A section along a part that is ever thinner", "length / thickness",
                "error of the cap's area, of itself"};
    study.bound = 1e-6;
    study.limit = 1e12;
    study.method.title = "contours in double, exact ears";
    study.explanation = "Beyond that the corners of the part itself are rounded together.";
    study.cost = "None.";
    for (const double ratio : laboratory.chosen({1, 10, 1e3, 1e5, 1e7, 1e9, 1e10, 1e12})) {
        const double half = 0.5 / ratio;
        scene::Geometry part = mapped(box({0.5, half, 0.5}), 1, {0.3, 0.2, 0.1});
        const glm::dvec3 normal = glm::normalize(glm::dvec3(0.2, 0, 1));
        const mesh::Cut cut =
            mesh::cut_of(part, glm::dvec4(-normal, glm::dot(normal, glm::dvec3(0.3, 0.2, 0.1))), true);
        double area = 0;
        for (const glm::uvec3& t : cut.triangles)
            area += glm::length(
                        glm::cross(cut.points[t.y] - cut.points[t.x], cut.points[t.z] - cut.points[t.x])) /
                    2;
        // The plane leans: it crosses the part's whole length, at the slope of its normal.
        const double expected = 2 * half / normal.z;
        study.method.points.push_back(
            {ratio, cut.triangles.empty() ? kNothing : std::abs(area - expected) / expected});
    }
    return study;
}

Study sections_of_gaps(const Laboratory& laboratory) {
    Study study{"section-gaps", "A section cuts a part that is nearly watertight",
                "width of its gap / its size", "pixels off from the closed part, in percent"};
    study.bound = 0.5;
    study.limit = 1e-15;
    study.method.title = "caps where each edge has two triangles";
    study.explanation =
        "A part with any gap is not closed: nobody can tell what is within. It shows both sides, and lines "
        "where it "
        "is cut.";
    study.cost = "An open part looks hollow.";
    const scene::Geometry closed = welded(sphere(1, 16));
    for (const double gap : laboratory.chosen({1e-18, 1e-16, 1e-15, 1e-12, 1e-6, 1e-3, 0.1})) {
        scene::Geometry part = closed;
        // A corner of one triangle alone.
        part.positions.push_back(part.positions[part.triangles[40].x] * (1 + gap));
        part.triangles[40].x = static_cast<unsigned>(part.positions.size() - 1);
        part.normals.push_back(glm::vec3(glm::normalize(part.positions.back())));
        plan::View view = looking(scene_of({{1, part, kRed}}), {1, 3, 3});
        view.clip_planes = {{{0, 1, 0}, 0.1}};
        plan::View right = view;
        right.scene = scene_of({{1, closed, kRed}});
        study.method.points.push_back({gap, percent_off(drawn(laboratory, view), drawn(laboratory, right))});
    }
    return study;
}

}  // namespace vrut::stability
