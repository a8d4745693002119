#include <doctest/doctest.h>

#include "rendering.hpp"
#include "test_client.hpp"

using namespace vrut;
using namespace vrut::server::engine;
using namespace vrut::test;

namespace {

constexpr int kLarge = 640, kSmall = 80, kNext = 48;  // pixels of width

/// Draws on the large one until the small one is drawn: one after the other, they would never end.
FrameRendererFactory renderer_of_turns(std::atomic<bool>& large_is_begun, std::atomic<bool>& small_is_drawn) {
    return [&] {
        FrameRenderer renderer = FakeRenderer{}.factory()();
        renderer.step = [&, step = renderer.step](Rendering& rendering) {
            if (rendering.view.width == kLarge) {
                large_is_begun = true;
                if (!small_is_drawn) return false;
            }
            const bool whole = step(rendering);
            if (rendering.view.width == kSmall && whole) small_is_drawn = true;
            return whole;
        };
        return renderer;
    };
}

void ask(TestClient& client, int id, int width) {
    client.send({{"type", "snapshot"}, {"id", id}, {"width", width}, {"height", 32}});
}

}  // namespace

TEST_CASE("snapshots of several clients are drawn in turns, those of one in their order") {
    for (const bool another_waits : {false, true}) {
        CAPTURE(another_waits);
        std::atomic<bool> large_is_begun{false}, small_is_drawn{false};
        TestServer server(scene_of("vrut-text 1"), renderer_of_turns(large_is_begun, small_is_drawn));
        TestClient first(server.port()), second(server.port());
        first.join();
        second.join("view");
        ask(first, 1, kLarge);
        if (another_waits) ask(first, 2, kNext);
        REQUIRE(eventually([&] { return large_is_begun.load(); }));
        ask(second, 1, kSmall);
        const Json small = second.wait_for("frame");
        CHECK(small["width"] == kSmall);
        for (int id = 1; id <= (another_waits ? 2 : 1); ++id) {
            const Json own = first.wait_for("frame");
            CHECK(own["snapshot"] == id);
        }
    }
}
