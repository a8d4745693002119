// What sections cost, and where there are many planes: whether they are right is judged in
// agreement_test.cpp.
#include <algorithm>

#include "reference/reference.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

plan::View small_view(const glm::dvec3& eye) {
    plan::View view = view_from(eye);
    view.width = 160;
    view.height = 120;
    return view;
}

std::shared_ptr<const scene::PlacedScene> ball_and_sheet() {
    scene::Material glass = material_of({0.3, 0.5, 0.7});
    glass.diffuse.a = 0.5;
    return scene_of({{1, welded(sphere(1, 24)), material_of({0.8, 0.4, 0.2})},
                     {2, quad(1.5), material_of({0.3, 0.6, 0.3}), turned_by(70, {0, 1, 0})},
                     {3, quad(0.6), glass, moved_by({0, 0, 1.2})}});
}

/// Six planes around the ball, and a box.
std::vector<scene::ClipPlane> twelve_planes() {
    std::vector<scene::ClipPlane> planes;
    for (const glm::dvec3& normal :
         {glm::dvec3(1, 1, 1), {-1, 1, 1}, {1, -1, 1}, {1, 1, -1}, {-1, -1, 1}, {-1, 1, -1}})
        planes.push_back({glm::normalize(normal), 0.7});
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            glm::dvec3 normal(0);
            normal[axis] = sign;
            planes.push_back({normal, 0.8});
        }
    return planes;
}

}  // namespace

TEST_CASE("planes that cut nothing cost nothing, and change no byte") {
    RendererFixture studio;
    const auto scene = ball_and_sheet();
    plan::View view = small_view({1, 2, 5});
    studio.draw(scene, view);
    const scene::Image without = studio.draw(scene, view);
    const plan::FrameStats stats = studio.stats;
    view.clip_planes = {{{0, 0, 1}, 3}, {{0, -1, 0}, 3}};
    CHECK(studio.draw(scene, view).rgba == without.rgba);
    CHECK(studio.stats.passes == stats.passes);
    CHECK(studio.stats.draws == stats.draws);
    CHECK(studio.stats.triangles == stats.triangles);
    CHECK(studio.stats.programs == 0);
    CHECK(studio.stats.uploads == 0);
}

TEST_CASE("a section that is taken away leaves nothing behind") {
    RendererFixture studio;
    const auto scene = ball_and_sheet();
    plan::View view = small_view({1, 2, 5});
    const scene::Image without = studio.draw(scene, view);
    for (const auto& planes : {std::vector<scene::ClipPlane>{{{0, 0, 1}, 0.2}}, twelve_planes()}) {
        view.clip_planes = planes;
        CHECK(studio.draw(scene, view).rgba != without.rgba);
        view.clip_planes.clear();
        CHECK(studio.draw(scene, view).rgba == without.rgba);
    }
}

TEST_CASE("twelve planes cut one part, more than a driver clips by") {
    RendererFixture studio;
    const auto scene = ball_and_sheet();
    for (const glm::dvec3& eye : {glm::dvec3(1, 2, 5), {4, -3, 1}, {-4, 3, -2}}) {
        plan::View view = small_view(eye);
        view.clip_planes = twelve_planes();
        const scene::Image drawn = studio.draw(scene, view);
        view.scene = scene;
        const scene::Image expected = reference::image_of(reference::trace(view));
        std::size_t off = 0;
        for (std::size_t i = 0; i < drawn.rgba.size(); i += 4) {
            const glm::ivec3 a(drawn.rgba[i], drawn.rgba[i + 1], drawn.rgba[i + 2]);
            const glm::ivec3 b(expected.rgba[i], expected.rgba[i + 1], expected.rgba[i + 2]);
            if (a == glm::ivec3(26)) continue;  // a line of a cut
            const glm::ivec3 apart = glm::abs(a - b);
            off += std::max({apart.x, apart.y, apart.z}) > 1;
        }
        CHECK(off < 60);  // beside lines and at outlines
    }
}

TEST_CASE("ids are those of the caps") {
    RendererFixture studio;
    plan::View view = small_view({0, 0, 5});
    view.scene = scene_of({{1, box({1, 1, 1}), material_of({0.8, 0.4, 0.2})},
                           {2, box({0.5, 0.5, 0.1}), material_of({0.2, 0.4, 0.8}), moved_by({0, 0, 0.8})}});
    view.clip_planes = {{{0, 0, 1}, 0.85}};
    const std::vector<scene::Index> nodes = studio.renderer().node_ids(view);
    const auto at = [&](int x, int y) {
        return nodes[static_cast<std::size_t>(y) * 160 + static_cast<std::size_t>(x)];
    };
    CHECK(at(80, 60) == 2);
    CHECK(at(80, 60 - 30) == 1);
}

TEST_CASE("a part that moves takes its cap along") {
    RendererFixture studio;
    plan::View view = small_view({0, 0, 5});
    view.clip_planes = {{{0, 0, 1}, 0}};
    const auto drawn = [&](const glm::dmat4& matrix) {
        return studio.draw(scene_of({{1, box({0.5, 0.5, 0.5}), material_of({0.8, 0.4, 0.2}), matrix}}), view)
            .rgba;
    };
    const auto still = drawn(moved_by({0, 0, 0.1}));
    CHECK(drawn(moved_by({0.5, 0, 0.1})) != still);
    CHECK(drawn(moved_by({0, 0, 0.2})) == still);  // seen along the plane's normal
}
