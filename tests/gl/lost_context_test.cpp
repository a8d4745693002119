// The driver resets itself: what was drawn is lost, and what draws is made anew.
#include "gl_faults.hpp"
#include "studio.hpp"

using namespace vrut;

namespace {

struct Healed {
    ~Healed() { gl_faults::heal(); }
};

std::shared_ptr<const PlacedScene> two_parts() {
    const Material paint = material_of({0.7, 0.5, 0.3});
    return scene_of(
        {{1, sphere(1, 8), paint, moved_by({-1, 0, 0})}, {2, box({1, 1, 1}), paint, moved_by({1, 0, 0})}});
}

View view_of(const std::shared_ptr<const PlacedScene>& scene) {
    View view = view_from({0, 1, 5});
    view.scene = scene;
    view.samples = 4;
    return view;
}

}  // namespace

TEST_CASE("a picture in whose midst the driver resets itself is not had, and a new renderer draws it") {
    const Healed healed;
    const View view = view_of(two_parts());
    Image expected, image;
    FrameStats stats;
    {
        Renderer renderer;
        REQUIRE(renderer.render(view, expected, stats));
        const int draws = stats.draws;
        REQUIRE(draws >= 8);
        for (const int before : {0, 1, draws / 2, draws - 1}) {
            CAPTURE(before);
            gl_faults::heal();
            Renderer other;
            REQUIRE(other.render(view, image, stats));
            gl_faults::reset_after(before);
            CHECK_THROWS_AS(other.render(view, image, stats), ContextLost);
        }
    }
    CHECK(live_gl_objects() == 0);
    gl_faults::heal();
    Renderer renderer;
    REQUIRE(renderer.render(view, image, stats));
    CHECK(image.rgba == expected.rgba);
}

TEST_CASE("a picture that is given up tells of a reset, too") {
    const Healed healed;
    const View view = view_of(two_parts());
    Image image;
    FrameStats stats;
    Renderer renderer;
    REQUIRE(renderer.render(view, image, stats));
    gl_faults::reset_after(0);
    CHECK_THROWS_AS(renderer.render(view, image, stats, [] { return true; }), ContextLost);
}

TEST_CASE("shaders that a lost context does not compile are no fault of ours") {
    const Healed healed;
    View view = view_of(two_parts());
    Image image;
    FrameStats stats;
    Renderer renderer;
    REQUIRE(renderer.render(view, image, stats));
    gl_faults::reset_after(0);
    const auto fails = [&]() -> bool { throw std::logic_error("a shader does not compile"); };
    CHECK_THROWS_AS(renderer.render(view, image, stats, fails), ContextLost);
}

TEST_CASE("the numbers of nodes that a lost context has drawn are not had") {
    const Healed healed;
    const View view = view_of(two_parts());
    Renderer renderer;
    REQUIRE_FALSE(renderer.node_ids(view).empty());
    gl_faults::reset_after(1);
    CHECK_THROWS_AS(renderer.node_ids(view), ContextLost);
}
