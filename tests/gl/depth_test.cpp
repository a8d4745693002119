// The depth that comes with an image: what is in front, glass too unless it is clear, and no other byte of
// the image changes.
#include <algorithm>

#include "renderer_fixture.hpp"
#include "warp/depth_map.hpp"

using namespace vrut;

namespace {

constexpr int kSide = 64;

struct Drawn {
    scene::Image image;
    warp::DepthMap depth;
};

Drawn drawn(RendererFixture& studio, const plan::View& view, bool with_depth) {
    plan::RenderJob job(view);
    if (with_depth) job.depth_size = warp::depth_map_size(view.width, view.height, 4);
    while (!studio.renderer().step(job)) {
    }
    return {std::move(job.image), std::move(job.depth)};
}

}  // namespace

TEST_CASE("depth of walls, of glass and of the background") {
    RendererFixture studio;
    plan::View view = pixel_view(kSide, kSide);
    scene::Material glass = material_of({0.2, 0.4, 0.6});
    glass.diffuse.a = 0.6;
    // Left a wall, in the middle glass before it, right nothing.
    const scene::Geometry left = rectangle(0, 0, 40, kSide, view), middle = rectangle(8, 0, 16, kSide, view);
    const double near = kSide / 4.0, far = kSide / 2.0;  // distances from the eye
    view.scene = scene_of(
        {{1, left, material_of({0.8, 0.2, 0.2})}, {2, mapped(middle, 0.5, {0, 0, far - near}), glass}});
    for (const int samples : {1, 4}) {
        view.samples = samples;
        const Drawn with = drawn(studio, view, true), without = drawn(studio, view, false);
        CHECK(with.image.rgba == without.image.rgba);
        CHECK(without.depth.columns == 0);
        REQUIRE(with.depth.columns == kSide / 4);
        REQUIRE(with.depth.rows == kSide / 4);
        CHECK(with.depth.scale == doctest::Approx(1 / near).epsilon(1e-5));
        const auto at = [&](int column) { return with.depth.near[static_cast<std::size_t>(column)]; };
        CHECK(at(0) == warp::DepthMap::kSteps / 2 + 1);
        CHECK(at(2) == warp::DepthMap::kSteps);
        CHECK(at(3) == warp::DepthMap::kSteps);
        CHECK(at(8) == warp::DepthMap::kSteps / 2 + 1);
        CHECK(at(12) == 0);
        CHECK(with.depth.near == with.depth.far);
    }
}

TEST_CASE("clear glass leaves the depth of what is seen through it") {
    RendererFixture studio;
    plan::View view = pixel_view(kSide, kSide);
    scene::Material glass = material_of({0.2, 0.4, 0.6});
    glass.diffuse.a = 0.3;
    const scene::Geometry wall = rectangle(0, 0, kSide, kSide, view),
                          middle = rectangle(8, 0, 16, kSide, view);
    view.scene = scene_of(
        {{1, wall, material_of({0.8, 0.2, 0.2})}, {2, mapped(middle, 0.5, {0, 0, kSide / 4.0}), glass}});
    const Drawn seen = drawn(studio, view, true);
    CHECK(std::ranges::min(seen.depth.near) == warp::DepthMap::kSteps);
}

TEST_CASE("a view without a scene has the background's depth") {
    RendererFixture studio;
    plan::View view = pixel_view(kSide, kSide);
    const Drawn empty = drawn(studio, view, true);
    CHECK(empty.depth.scale == 0);
    CHECK(std::ranges::max(empty.depth.near) == 0);
}
