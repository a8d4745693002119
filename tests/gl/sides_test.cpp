#include <cmath>

#include "compare/difference.hpp"
#include "reference/reference.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

scene::Material two_sided(scene::Material material) {
    material.two_sided = true;
    return material;
}

const scene::Material kPlain = material_of({0.7, 0.5, 0.3}, {0.2, 0.3, 0.4}, 12);

/// How many pixels show something else than the background.
int covered(const scene::Image& image) {
    int count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            count += pixel_of(image, x, y) != bytes_of(plan::kDefaultBackground);
    return count;
}

}  // namespace

TEST_CASE("back faces are not drawn") {
    RendererFixture studio;
    CHECK(covered(studio.draw(scene_of({{1, quad(1), kPlain, glm::dmat4(1)}}), view_from({0, 0, 5}))) > 300);
    CHECK(covered(studio.draw(scene_of({{1, quad(1), kPlain, glm::dmat4(1)}}), view_from({0, 0, -5}))) == 0);
    // Inside out, the far side of a ball is seen from within.
    const auto inside_out = scene_of({{1, turned_inside_out(sphere(1.5, 8)), kPlain, glm::dmat4(1)}});
    CHECK(studio.check(inside_out, view_from({0, 0, 5})).surfaces > 400);
    // From within a plain ball nothing is seen, the eye being inside the scene's bounds.
    CHECK(covered(studio.draw(scene_of({{1, sphere(3, 8), kPlain, glm::dmat4(1)}}),
                              view_from({0, 0, 0.5}))) == 0);
}

TEST_CASE("a mirroring matrix does not turn a part inside out") {
    RendererFixture studio;
    for (const glm::dvec3& factors : {glm::dvec3(-1, 1, 1), glm::dvec3(1, -1, 1), glm::dvec3(1, 1, -1),
                                      glm::dvec3(-2, -1, -0.5), glm::dvec3(-1, -1, 1)}) {
        CAPTURE(factors.x);
        CAPTURE(factors.y);
        CHECK(studio.check(scene_of({{1, sphere(1, 8), kPlain, scaled_by(factors)}}), view_from({1, 2, 5}))
                  .surfaces > 200);
        CHECK(studio.check(scene_of({{1, box({1, 1, 1}), kPlain, scaled_by(factors)}}), view_from({1, 2, 5}))
                  .surfaces > 200);
        const bool from_front = factors.z > 0;
        const auto plate = scene_of({{1, quad(1), kPlain, scaled_by(factors)}});
        CHECK((covered(studio.draw(plate, view_from({0, 0, 5}))) > 0) == from_front);
        CHECK((covered(studio.draw(plate, view_from({0, 0, -5}))) > 0) != from_front);
    }
}

TEST_CASE("two-sided parts are lit from both sides") {
    RendererFixture studio;
    for (const bool normals : {true, false}) {
        const auto plate = scene_of({{1, quad(1, normals), two_sided(kPlain), glm::dmat4(1)}});
        CHECK(studio.check(plate, view_from({1, 0, 4})).surfaces > 300);
        CHECK(studio.check(plate, view_from({1, 0, -4})).surfaces > 300);
        const auto mirrored = scene_of({{1, quad(1, normals), two_sided(kPlain), scaled_by({1, -1, 1})}});
        CHECK(studio.check(mirrored, view_from({1, 0, 4})).surfaces > 300);
        CHECK(studio.check(mirrored, view_from({1, 0, -4})).surfaces > 300);
    }
    plan::View within = view_from({0, 0, 0.5}, {1, 0, 0});
    CHECK(studio.check(scene_of({{1, sphere(2, 8), two_sided(kPlain), glm::dmat4(1)}}), within).surfaces ==
          96 * 64);
}

TEST_CASE("of two-sided parts the normal faces the viewer, whatever the triangle does") {
    RendererFixture studio;
    // The triangles face the viewer, their normals do not: a file from a modeller that turned one of the two.
    scene::Geometry away = quad(1);
    away.normals.assign(4, glm::vec3(0.3f, 0, -1));
    CHECK(
        studio.check(scene_of({{1, away, two_sided(kPlain), glm::dmat4(1)}}), view_from({1, 0, 4})).surfaces >
        300);
    CHECK(studio.check(scene_of({{1, away, two_sided(kPlain), glm::dmat4(1)}}), view_from({1, 0, -4}))
              .surfaces > 300);
    // Normals that turn away from the viewer within a triangle.
    scene::Geometry wide = quad(1.5);
    wide.normals = {{-1, 0, 0.2f}, {1, 0, 0.2f}, {1, 0, -0.5f}, {-1, 0, 0.2f}};
    CHECK(
        studio.check(scene_of({{1, wide, two_sided(kPlain), glm::dmat4(1)}}), view_from({2, 0, 4})).surfaces >
        300);
    // One-sided ones keep theirs: dark.
    CHECK(studio.check(scene_of({{1, away, kPlain, glm::dmat4(1)}}), view_from({1, 0, 4})).surfaces > 300);
}

TEST_CASE("a flattened part is drawn from both sides, lit along the axis that is gone") {
    RendererFixture studio;
    for (const double degrees : {0.0, 20.0, 50.0}) {
        CAPTURE(degrees);
        const glm::dmat4 turn = turned_by(degrees, glm::normalize(glm::dvec3(1, 2, 3)));
        const auto flattened = [&](const scene::Geometry& geometry) {
            return scene_of({{1, geometry, kPlain, turn * scaled_by({1, 1, 0})}});
        };
        for (const double side : {1.0, -1.0}) {
            CAPTURE(side);
            plan::View view = view_from({0.5, 0.3, 5 * side}), shortened = view;
            // A plate has the same faces.
            view.scene = scene_of({{1, quad(1), two_sided(kPlain), turn}});
            for (const scene::Geometry& geometry : {box({1, 1, 1}), quad(1), quad(1, false)}) {
                const PictureMismatch result = mismatch(view, studio.draw(flattened(geometry), view));
                CHECK_MESSAGE(result.worst <= 1, result.where);
                CHECK(result.surfaces > 200);
            }
            // Flattened along none of its own axes, it has columns that are all there, and a determinant of
            // noise.
            const glm::dmat4 tilt = turned_by(30, {1, 0, 0});
            shortened.scene = scene_of(
                {{1, quad(1), two_sided(kPlain), turn * scaled_by({1, std::cos(glm::radians(30.0)), 1})}});
            for (const bool normals : {true, false}) {
                const auto plate =
                    scene_of({{1, quad(1, normals), kPlain, turn * scaled_by({1, 1, 0}) * tilt}});
                const PictureMismatch result = mismatch(shortened, studio.draw(plate, view));
                CHECK_MESSAGE(result.worst <= 1, result.where);
                CHECK(result.surfaces > 200);
            }
            // A ball becomes a disc, in the middle as bright as the plate.
            std::vector<bool> middle(static_cast<std::size_t>(view.width * view.height));
            for (int y = 28; y < 36; ++y)
                for (int x = 44; x < 52; ++x) middle[static_cast<std::size_t>(y * view.width + x)] = true;
            CHECK(compare::difference(reference::image_of(reference::trace(view)),
                                      studio.draw(flattened(sphere(1, 8)), view), middle)
                      .maximum() <= 1);
        }
    }
}

TEST_CASE("a part that is only thin is not flat") {
    RendererFixture studio;
    // A determinant of 1e-12 of the product of the axes' lengths is the limit.
    for (const double determinant : {0.99e-12, 1.01e-12}) {
        glm::dmat4 skewed(1);
        skewed[2] = {1, 0, determinant, 0};
        const auto scene = scene_of({{1, quad(1), kPlain, skewed}});
        CHECK(covered(studio.draw(scene, view_from({0, 0, 4}))) > 300);
        CHECK((covered(studio.draw(scene, view_from({0, 0, -4}))) > 300) == (determinant < 1e-12));
    }
    for (const double thickness : {1e-3, 1e-9}) {
        const auto thin =
            scene_of({{1, sphere(1, 8), kPlain, turned_by(30, {0, 1, 0}) * scaled_by({1, 1, thickness})}});
        CHECK(studio.check(thin, view_from({0.5, 0.3, 4})).surfaces > 200);
        CHECK(covered(studio.draw(scene_of({{1, quad(1), kPlain, scaled_by({1, 1, thickness})}}),
                                  view_from({0, 0, -4}))) == 0);
    }
}

TEST_CASE("normals that a flattening matrix wipes out take the face's") {
    RendererFixture studio;
    scene::Geometry sideways = quad(1);
    sideways.normals.assign(4, glm::vec3(1, 0, 0));
    plan::View view = view_from({0.5, 0.3, 5});
    view.scene = scene_of({{1, quad(1), kPlain, glm::dmat4(1)}});
    const PictureMismatch result =
        mismatch(view, studio.draw(scene_of({{1, sideways, kPlain, scaled_by({1, 1, 0})}}), view));
    CHECK_MESSAGE(result.worst <= 1, result.where);
    CHECK(result.surfaces > 300);
}

TEST_CASE("parts flattened to a line or a point leave no trace") {
    RendererFixture studio;
    for (const glm::dvec3& factors : {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 0)}) {
        const auto scene = scene_of(
            {{1, sphere(1, 6), kPlain, scaled_by(factors)}, {2, quad(1), kPlain, scaled_by(factors)}});
        CHECK(covered(studio.draw(scene, view_from({1, 1, 5}))) == 0);
    }
    scene::Geometry degenerate = quad(1, false);
    degenerate.triangles = {{0, 0, 1}, {0, 1, 1}, {2, 2, 2}, {0, 1, 2}};
    // No pixel's centre lies on the diagonal.
    CHECK(
        studio.check(scene_of({{1, degenerate, kPlain, glm::dmat4(1)}}), view_from({0.1, 0.2, 5})).surfaces >
        100);
}
