#include <doctest/doctest.h>

#include "plan/render_job.hpp"
#include "test_client.hpp"

using namespace vrut;
using namespace vrut::server::engine;
using namespace vrut::test;

namespace {

constexpr int kLarge = 4096, kOther = 4095, kSmall = 80, kNext = 48;  // pixels of width

struct Turns {
    std::atomic<int> begun{0};  ///< large ones, before the small one is drawn: 1 kLarge, 2 kOther, 3 both
    std::atomic<bool> small_is_drawn{false};
};

/// Draws on the large ones until the small one is drawn: one after the other, they would never end.
FrameRendererFactory renderer_of_turns(Turns& turns) {
    return [&] {
        FrameRenderer renderer = FakeRenderer{}.factory()();
        renderer.step = [&, step = renderer.step](plan::RenderJob& rendering) {
            const int width = rendering.view.width;
            if (width >= kOther && !turns.small_is_drawn) {
                turns.begun |= width == kLarge ? 1 : 2;
                return false;
            }
            const bool whole = step(rendering);
            if (width == kSmall && whole) turns.small_is_drawn = true;
            return whole;
        };
        return renderer;
    };
}

void ask(TestClient& client, int id, int width, int height = 32) {
    client.send({{"type", "snapshot"}, {"id", id}, {"width", width}, {"height", height}});
}

}  // namespace

TEST_CASE("snapshots of several clients are drawn in turns, those of one in their order") {
    for (const bool another_waits : {false, true}) {
        CAPTURE(another_waits);
        Turns turns;
        TestServer server(scene_of("vrut-text 1"), renderer_of_turns(turns));
        TestClient first(server.port()), second(server.port());
        first.join();
        second.join("view");
        ask(first, 1, kLarge);
        if (another_waits) ask(first, 2, kNext);
        REQUIRE(eventually([&] { return turns.begun == 1; }));
        ask(second, 1, kSmall);
        const Json small = second.wait_for("frame");
        CHECK(small["width"] == kSmall);
        for (int id = 1; id <= (another_waits ? 2 : 1); ++id) {
            const Json own = first.wait_for("frame");
            CHECK(own["snapshot"] == id);
        }
    }
}

TEST_CASE("a large snapshot waits for another client's large one, and a small one for neither") {
    Turns turns;
    TestServer server(scene_of("vrut-text 1"), renderer_of_turns(turns));
    TestClient first(server.port()), second(server.port()), third(server.port());
    for (TestClient* client : {&first, &second, &third}) client->join("view");
    ask(first, 1, kLarge, 2048);
    REQUIRE(eventually([&] { return turns.begun == 1; }));
    ask(second, 1, kOther, 2048);
    second.send({{"type", "tree"}, {"id", 2}});
    second.wait_for("tree");
    ask(third, 1, kSmall);
    CHECK(third.wait_for("frame")["width"] == kSmall);
    CHECK(turns.begun == 1);
    CHECK(first.wait_for("frame")["width"] == kLarge);
    CHECK(second.wait_for("frame")["width"] == kOther);
}
