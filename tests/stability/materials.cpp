// Studies of textures and normals.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/gtc/matrix_inverse.hpp>

#include "compare/difference.hpp"
#include "pictures.hpp"
#include "reference/reference.hpp"
#include "shapes.hpp"

namespace vrut::stability {

namespace {

constexpr int kSide = 192;  // of pictures of walls, in pixels

/// A wall that fills the picture, with so many texels to a pixel, from its bottom left corner on.
plan::View wall_with(const scene::Texture& texture, double texels) {
    scene::Geometry wall = quad(kSide / 2.0);
    const glm::vec2 last =
        glm::vec2(static_cast<float>(kSide * texels)) / glm::vec2(texture.image.width, texture.image.height);
    wall.texcoords = {{0, 0}, {last.x, 0}, last, {0, last.y}};
    scene::Material material = material_of({1, 1, 1});
    material.texture = 0;
    plan::View view = looking(scene_of({{1, wall, material}}, {texture}), {0, 0, kSide / 2.0});
    view.camera.fov = 90;
    view.width = view.height = kSide;
    view.light.headlight = false;
    view.light.type = scene::LightData::Type::directional;
    view.light.direction = {0, 0, -1};
    return view;
}

/// Grey, between a quarter and three quarters.
scene::Texture grey_noise(int width, int height) {
    scene::Texture texture;
    texture.image.resize(width, height);
    Noise noise;
    for (std::size_t at = 0; at < texture.image.rgba.size(); at += 4) {
        std::fill_n(&texture.image.rgba[at], 3, static_cast<std::uint8_t>(128 + 64 * noise.next()));
        texture.image.rgba[at + 3] = 255;
    }
    return texture;
}

/// Adds to both curves how far a part is from the reference: moved by its matrix in advance, with such a
/// matrix for normals and sides turned or not, and as it is drawn.
void compare_normals(const Laboratory& laboratory, Study& study, double inverse, const Part& part,
                     const glm::mat3& naive, bool turned, const glm::dvec3& eye) {
    Part baked{part.id, part.geometry, part.material};
    baked.geometry.bounds = {};
    for (std::size_t i = 0; i < part.geometry.positions.size(); ++i) {
        glm::dvec3& position = baked.geometry.positions[i];
        position = glm::dvec3(part.matrix * glm::dvec4(position, 1));
        baked.geometry.bounds.add(position);
        const glm::vec3 normal = glm::normalize(naive * part.geometry.normals[i]);
        baked.geometry.normals[i] = std::isfinite(glm::dot(normal, normal)) ? normal : glm::vec3(0);
    }
    if (turned) baked.geometry = turned_inside_out(baked.geometry);
    const plan::View view = looking(scene_of({part}), eye);
    const scene::Image right = truth_of(view);
    plan::View inverted = view;
    inverted.scene = scene_of({baked});
    study.baseline.points.push_back({inverse, percent_off(drawn(laboratory, inverted), right)});
    study.method.points.push_back({inverse, percent_off(drawn(laboratory, view), right)});
}

}  // namespace

Study minified_textures(const Laboratory& laboratory) {
    Study study{"minified", "Textures seen small", "texels to a pixel", "largest error of a channel, of 255"};
    study.bound = 40;
    study.baseline.title = "the texel at the pixel's centre (computed)";
    study.method.title = "levels of means, trilinear";
    study.explanation =
        "Each level is the mean of the texels that it covers, for pictures of any size; between two levels "
        "the picture is mixed.";
    study.cost = "A third more memory for a texture.";
    constexpr int kTexels = 256;
    scene::Texture checkers;
    checkers.image.resize(kTexels, kTexels);
    const auto white = [](std::int64_t x, std::int64_t y) { return ((x + y) & 1) == 0; };
    for (std::size_t at = 0; at < checkers.image.rgba.size(); ++at) {
        const auto texel = static_cast<std::int64_t>(at / 4);
        checkers.image.rgba[at] = white(texel % kTexels, texel / kTexels) || at % 4 == 3 ? 255 : 0;
    }
    for (const int texels : {1, 2, 3, 4, 6, 8, 16, 32, 64}) {
        const scene::Image image = drawn(laboratory, wall_with(checkers, texels));
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
        study.baseline.points.push_back({1.0 * texels, worst_of_nearest});
        study.method.points.push_back({1.0 * texels, worst});
    }
    return study;
}

namespace {

/// Adds to the study how far walls are from the reference with textures of several sizes, so many texels to a
/// pixel.
void compare_sizes(const Laboratory& laboratory, Study& study, double texels) {
    const int most = laboratory.renderer.max_size();
    const std::vector<glm::ivec2> sizes{{1, 1},     {3, 5},         {7, 1},       {1000, 3},
                                        {most, 16}, {most + 1, 16}, {2 * most, 5}};
    for (const double place : laboratory.chosen({0, 1, 2, 3, 4, 5, 6})) {
        const glm::ivec2 size = sizes[static_cast<std::size_t>(place)];
        double worst = 0;
        for (const scene::Texture& texture : {grey_noise(size.x, size.y), grey_noise(size.y, size.x)}) {
            const plan::View view = wall_with(texture, texels);
            worst = std::max(worst, largest_error(drawn(laboratory, view), truth_of(view)));
        }
        study.method.points.push_back({1.0 * std::max(size.x, size.y) / most, worst});
    }
}

}  // namespace

Study odd_textures(const Laboratory& laboratory) {
    Study study{"odd-textures", "Textures of odd and of great sizes, seen near",
                "longer side / the longest that the driver takes", "largest error of a channel, of 255"};
    study.bound = 4;
    study.limit = 1.00001;  // one texel more
    study.method.title = "two pixels to a texel";
    study.explanation =
        "Sizes need not be powers of two, nor even. Of a texture larger than the driver takes the next level "
        "is "
        "the finest that is drawn, half as sharp.";
    study.cost = "None: files with more than 16,384 texels along a side are refused when they are read.";
    compare_sizes(laboratory, study, 0.5);
    return study;
}

Study small_odd_textures(const Laboratory& laboratory) {
    Study study{"small-odd-textures", "Textures of odd and of great sizes, seen small",
                "longer side / the longest that the driver takes", "largest error of a channel, of 255"};
    study.bound = 4;
    study.method.title = "2.5 texels to a pixel";
    study.explanation =
        "Where two texels or more fall on a pixel, nothing is lost of textures larger than the driver takes.";
    study.cost = "None.";
    compare_sizes(laboratory, study, 2.5);
    return study;
}

Study small_matrices(const Laboratory& laboratory) {
    Study study{"normals", "Normals under matrices that shrink", "1 / scale",
                "pixels off by more than 8 of 255, in percent"};
    study.bound = 0.5;
    study.baseline.title = "inverse transpose in single precision";
    study.method.title = "cofactor matrix in double";
    study.explanation =
        "Normals go by the cofactor matrix, times the sign of the determinant, brought to scale: it needs no "
        "inverse, which flattened parts have not; a normal of zero takes its face's.";
    study.cost = "None: it is computed once a part.";
    const scene::Material material = material_of({0.6, 0.4, 0.2}, {0.3, 0.3, 0.3}, 30);
    for (const double inverse : laboratory.chosen({1, 10, 1e3, 1e6, 1e9, 1e12, 1e13, 1e15})) {
        const glm::dmat4 matrix = scaled_by(glm::dvec3(1, 0.5, 1) / inverse) * turned_by(30, {0, 0, 1});
        compare_normals(laboratory, study, inverse, {1, sphere(1, 12), material, matrix},
                        glm::transpose(glm::inverse(glm::mat3(matrix))), false,
                        glm::dvec3(1, 1.5, 3) / inverse);
    }
    return study;
}

Study mirroring_matrices(const Laboratory& laboratory) {
    Study study{"mirrored-normals", "Normals under matrices that mirror and flatten", "1 / thickness",
                "pixels off by more than 8 of 255, in percent"};
    study.bound = 0.5;
    study.baseline.title = "the determinant's sign in single precision";
    study.method.title = "in double, and no sign where no volume is";
    study.explanation =
        "Where a matrix mirrors, the sign of its determinant turns sides and normals; a part thinner than "
        "1e-12 of its size is drawn from both sides. A normal of zero takes its face's.";
    study.cost = "None: it is computed once a part.";
    const scene::Material material = material_of({0.6, 0.4, 0.2}, {0.3, 0.3, 0.3}, 30);
    // A sheet with waves, its front towards x; in the middle its normals are left at zero.
    scene::Geometry sheet = surface(16, 16, [](double u, double v) {
        return glm::dvec3(0.2 * std::sin(5 * u) * std::sin(4 * v), 2 * u - 1, 2 * v - 1);
    });
    for (const glm::dvec3& p : sheet.positions) {
        const glm::dvec2 at = (glm::dvec2(p.y, p.z) + 1.0) / 2.0;
        const glm::dvec2 slope = 0.1 * glm::dvec2(5 * std::cos(5 * at.x) * std::sin(4 * at.y),
                                                  4 * std::sin(5 * at.x) * std::cos(4 * at.y));
        sheet.normals.push_back(glm::length(glm::dvec2(p.y, p.z)) < 0.4 ? glm::vec3(0)
                                                                        : glm::vec3(1, -slope));
    }
    for (const double inverse : laboratory.chosen({1, 10, 1e3, 1e5, 1e7, 1e8, 1e9, 1e11, 1e13, 1e15})) {
        const glm::dmat4 turn = turned_by(40, glm::normalize(glm::dvec3(1, 2, 3)));
        const glm::dmat4 matrix = turn * scaled_by({-1 / inverse, 1, 1}) * turned_by(10, {0, 0, 1});
        const glm::mat3 single(matrix);
        const bool mirrors = glm::determinant(single) < 0;
        const glm::mat3 cofactors(glm::cross(single[1], single[2]), glm::cross(single[2], single[0]),
                                  glm::cross(single[0], single[1]));
        compare_normals(laboratory, study, inverse, {1, sheet, material, matrix},
                        mirrors ? -cofactors : cofactors, mirrors, glm::dmat3(turn) * glm::dvec3(-3, 0.7, 1));
    }
    return study;
}

Study flipped_normals(const Laboratory& laboratory) {
    Study study{"flipped-normals", "Normals that point inwards", "triangles with such, in percent",
                "pixels off by more than 8 of 255, in percent"};
    study.bound = 0.5;
    study.baseline.title = "as they are";
    study.method.title = "two-sided: turned to the viewer";
    study.explanation =
        "With a material that is `two-sided` a normal that points away from the viewer is negated. Without, "
        "normals are taken as they are, and such triangles stay dark.";
    const scene::Geometry ball = sphere(1, 24);
    const auto view_of = [&](bool two_sided, double percent) {
        scene::Geometry flipped;
        flipped.bounds = ball.bounds;
        for (std::size_t i = 0; i < ball.triangles.size(); ++i) {
            const glm::uvec3& triangle = ball.triangles[i];
            // The golden ratio's multiples spread evenly.
            const bool flips = 100 * std::fmod(0.618034 * static_cast<double>(i + 1), 1.0) < percent;
            const auto first = static_cast<unsigned>(flipped.positions.size());
            for (int k = 0; k < 3; ++k) {
                flipped.positions.push_back(ball.positions[triangle[k]]);
                flipped.normals.push_back((flips ? -1.0f : 1.0f) * ball.normals[triangle[k]]);
            }
            flipped.triangles.emplace_back(first, first + 1, first + 2);
        }
        scene::Material material = material_of({0.6, 0.4, 0.2}, {0.3, 0.3, 0.3}, 30);
        material.two_sided = two_sided;
        return looking(scene_of({{1, flipped, material}}), {0.5, 0.7, 2.5});
    };
    const scene::Image right = truth_of(view_of(true, 0));
    for (const double percent : laboratory.chosen({0.1, 0.3, 1, 3, 10, 30, 100}))
        for (const bool two_sided : {false, true})
            (two_sided ? study.method : study.baseline)
                .points.push_back(
                    {percent, percent_off(drawn(laboratory, view_of(two_sided, percent)), right)});
    study.cost =
        "The back sides are drawn, too: " +
        times_the_time(time_of(laboratory, view_of(true, 0)), time_of(laboratory, view_of(false, 0))) + ".";
    return study;
}

}  // namespace vrut::stability
