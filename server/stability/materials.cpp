// Studies of mirrors, textures and normals.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>

#include "pictures.hpp"
#include "plane.hpp"
#include "reference.hpp"
#include "shapes.hpp"

namespace vrut::stability {

namespace {

Material mirror_material() {
    Material material = material_of({0.1, 0.1, 0.1});
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
    study.takes_over = "The others are drawn as plain surfaces, which a small one may pass for.";
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
        const View view = looking(scene_of(parts), {0, 0, 6}, {0, 0, -1});
        study.method.points.push_back({count, percent_off(drawn(laboratory, view), image_of(trace(view)))});
        if (count <= 16) {
            View plain = view;
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
    Study study{"edge-on", "The eye comes to a mirror's plane", "1 / height of the eye above the plane",
                "pixels off by more than 8 of 255, in percent"};
    study.bound = 0.5;
    study.method.title = "reflection in double, depth of its own";
    study.takes_over =
        "Nothing needs to: at the plane itself the mirror is a line, and nothing is seen in it.";
    study.cost = "None.";
    for (const double inverse : laboratory.chosen({0.5, 1, 3, 10, 100, 1e3, 1e4, 1e6, 1e9, 1e12})) {
        const auto scene =
            scene_of({{1, quad(3), mirror_material(), turned_by(-90, {1, 0, 0})},
                      {2, sphere(0.5, 12), material_of({0.9, 0.2, 0.1}), moved_by({-0.6, 0.7, -1})},
                      {3, box({0.3, 0.3, 0.3}), material_of({0.1, 0.8, 0.3}), moved_by({0.7, 0.3, 0})}});
        const View view = looking(scene, {0.2, 1 / inverse, 4}, {0.1, 0.2 / inverse, 0});
        study.method.points.push_back({inverse, percent_off(drawn(laboratory, view), image_of(trace(view)))});
    }
    return study;
}

Study bent_mirrors(const Laboratory& laboratory) {
    Study study{"bent-mirrors", "Mirrors that are not quite flat",
                "height of the bulge / radius of the mirror", "error of the reflection at the rim, degrees"};
    study.bound = 0.2;
    study.limit = 1e-3;
    study.method.title = "taken for flat, whatever they are";
    study.successor = {"flat to 1e-4 of the radius, else none"};
    study.takes_over =
        "What is not flat to 1e-4 of its radius reflects the panorama, where there is one, or is drawn as a "
        "plain surface, and a notice says so.";
    study.cost = "A bent mirror does not show the scene.";
    for (const double bulge : laboratory.chosen({1e-7, 1e-6, 1e-5, 1e-4, 3e-4, 1e-3, 1e-2, 0.1, 0.5})) {
        constexpr unsigned kCells = 16;
        Geometry cap;
        for (unsigned y = 0; y <= kCells; ++y)
            for (unsigned x = 0; x <= kCells; ++x) {
                const glm::dvec2 place = glm::dvec2(x, y) * (2.0 / kCells) - 1.0;
                cap.positions.emplace_back(place, -bulge * glm::dot(place, place));
                cap.bounds.add(cap.positions.back());
                if (x == kCells || y == kCells) continue;
                const unsigned at = y * (kCells + 1) + x, above = at + kCells + 1;
                cap.triangles.emplace_back(at, at + 1, above + 1);
                cap.triangles.emplace_back(at, above + 1, above);
            }
        // The normal at the rim leans by the slope there, the reflection by twice that.
        const double error = glm::degrees(2 * std::atan(2 * bulge));
        study.method.points.push_back({bulge, error});
        study.successor->points.push_back({bulge, plane_of(cap) ? error : 0});
    }
    return study;
}

Study minified_textures(const Laboratory& laboratory) {
    Study study{"minified", "Textures seen small", "texels to a pixel", "largest error of a channel, of 255"};
    study.bound = 40;
    study.limit = 2;
    study.method.title = "the texel at the pixel's centre (computed)";
    study.successor = {"levels of means, trilinear"};
    study.takes_over =
        "Each level is the mean of the texels that it covers, for pictures of any size; between two levels "
        "the "
        "picture is mixed.";
    study.cost = "A third more memory for a texture.";
    constexpr int kSide = 192, kTexels = 256;
    Texture checkers;
    checkers.image.resize(kTexels, kTexels);
    const auto white = [](std::int64_t x, std::int64_t y) { return ((x + y) & 1) == 0; };
    for (std::size_t at = 0; at < checkers.image.rgba.size(); ++at) {
        const auto texel = static_cast<std::int64_t>(at / 4);
        checkers.image.rgba[at] = white(texel % kTexels, texel / kTexels) || at % 4 == 3 ? 255 : 0;
    }
    for (const int texels : {1, 2, 3, 4, 6, 8, 16, 32, 64}) {
        Geometry wall = quad(kSide / 2.0);
        const float last = static_cast<float>(kSide * texels) / kTexels;
        wall.texcoords = {{0, 0}, {last, 0}, {last, last}, {0, last}};
        Material material = material_of({1, 1, 1});
        material.ambient = {0, 0, 0, 1};
        material.texture = 0;
        View view = looking(scene_of({{1, wall, material}}, {checkers}), {0, 0, kSide / 2.0});
        view.camera.fov = 90;
        view.width = view.height = kSide;
        view.light.headlight = false;
        view.light.type = LightData::Type::directional;
        view.light.direction = {0, 0, -1};
        const Image image = drawn(laboratory, view);
        double worst = 0, worst_of_nearest = 0;
        for (std::int64_t y = 8; y < kSide - 8; ++y)
            for (std::int64_t x = 8; x < kSide - 8; ++x) {
                // Of an odd square of checkers one more is of its corner's colour.
                const double more = texels % 2 == 0 ? 0 : 1.0 / (texels * texels);
                const double mean = 127.5 * (1 + (white(x * texels, y * texels) ? more : -more));
                const double nearest = white(x * texels + texels / 2, y * texels + texels / 2) ? 255 : 0;
                worst_of_nearest = std::max(worst_of_nearest, std::abs(nearest - mean));
                const double shown = image.rgba[static_cast<std::size_t>(4 * (y * kSide + x))];
                worst = std::max(worst, std::abs(shown - mean));
            }
        study.method.points.push_back({1.0 * texels, worst_of_nearest});
        study.successor->points.push_back({1.0 * texels, worst});
    }
    return study;
}

Study small_matrices(const Laboratory& laboratory) {
    Study study{"normals", "Normals under matrices that shrink", "1 / scale",
                "pixels off by more than 8 of 255, in percent"};
    study.bound = 0.5;
    study.limit = 1e13;
    study.method.title = "inverse transpose in single precision";
    study.successor = {"cofactor matrix in double"};
    study.takes_over =
        "Normals go by the cofactor matrix, times the sign of the determinant, brought to scale: it needs no "
        "inverse, which flattened parts have not; a normal of zero takes its face's.";
    study.cost = "None: it is computed once a part.";
    const Material material = material_of({0.6, 0.4, 0.2}, {0.3, 0.3, 0.3}, 30);
    for (const double inverse : laboratory.chosen({1, 10, 1e3, 1e6, 1e9, 1e12, 1e13, 1e15})) {
        const Geometry ball = sphere(1, 12);
        const glm::dmat4 matrix = scaled_by(glm::dvec3(1, 0.5, 1) / inverse) * turned_by(30, {0, 0, 1});
        Geometry baked = ball;
        const glm::mat3 naive = glm::transpose(glm::inverse(glm::mat3(matrix)));
        baked.bounds = {};
        for (std::size_t i = 0; i < baked.positions.size(); ++i) {
            baked.positions[i] = glm::dvec3(matrix * glm::dvec4(baked.positions[i], 1));
            baked.bounds.add(baked.positions[i]);
            const glm::vec3 normal = glm::normalize(naive * baked.normals[i]);
            baked.normals[i] = std::isfinite(glm::dot(normal, normal)) ? normal : glm::vec3(0);
        }
        const View view = looking(scene_of({{1, ball, material, matrix}}), glm::dvec3(1, 1.5, 3) / inverse);
        const Image right = image_of(trace(view));
        View inverted = view;
        inverted.scene = scene_of({{1, baked, material}});
        study.method.points.push_back({inverse, percent_off(drawn(laboratory, inverted), right)});
        study.successor->points.push_back({inverse, percent_off(drawn(laboratory, view), right)});
    }
    return study;
}

}  // namespace vrut::stability
