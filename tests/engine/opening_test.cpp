// A scene is opened while the one before is steered.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <atomic>
#include <mutex>

#include "base/drawing_errors.hpp"
#include "plan/render_job.hpp"
#include "scenes/import_process.hpp"
#include "temporary_folder.hpp"
#include "test_client.hpp"

using namespace vrut;
using namespace vrut::server::engine;
using namespace vrut::server::net;
using namespace vrut::server::scenes;
using namespace vrut::test;

/// What reads a file is this program, started anew.
int main(int argc, char** argv) {
    if (is_import_process(argc, argv)) run_import_process(argv);
    return doctest::Context(argc, argv).run();
}

namespace {

constexpr const char* kOld =
    "vrut-text 1\n"
    "geometry 1 vertices 3 -1 -1 0  1 -1 0  0 1 1 triangles 1 0 1 2 end\n"
    "node 1 \"Triangle\" geometry geometry 1 end\n";
constexpr const char* kNew =
    "vrut-text 1\n"
    "geometry 1 vertices 4 -1 -1 0  1 -1 0  1 1 0  -1 1 0 triangles 2 0 1 2  0 2 3 end\n"
    "node 1 \"Square\" geometry geometry 1 end\n";

/// Uploads in as many steps as a test likes; a frame takes three. It logs its steps.
struct SlowUpload {
    enum class Step { upload, part, frame };
    std::atomic<bool> ends{false}, fails{false}, resets{false};
    std::atomic<int> uploads{0};
    std::mutex mutex;
    std::vector<Step> steps;  // since the first of the upload

    void add(Step step) {
        const std::lock_guard lock(mutex);
        if (uploads > 0) steps.push_back(step);
    }
    FrameRendererFactory factory() {
        return [this] {
            FrameRenderer renderer = FakeRenderer{}.factory()();
            renderer.upload_step = [this, is_first = uploads == 0](const plan::View& view) {
                if (is_first && view.scene->scene->triangle_count() == 1) return true;
                ++uploads;
                add(Step::upload);
                if (fails) throw vrut::base::OutOfMemory("there is no room");
                if (resets.exchange(false)) throw vrut::base::ContextLost("the driver has reset itself");
                return ends.load();
            };
            renderer.step = [this, step = renderer.step, part = 0](plan::RenderJob& job) mutable {
                const bool whole = ++part % 3 == 0 && step(job);
                add(whole ? Step::frame : Step::part);
                return whole;
            };
            return renderer;
        };
    }
};

struct Opening {
    Opening() {
        folder.write("new.vrut", kNew);
        ServerOptions options;
        options.library = SceneLibrary(folder.path());
        server.emplace(scene_of(kOld, "old.vrut"), driver.factory(), options);
        client.emplace(server->port());
        client->join();
        client->send({{"type", "control"}, {"id", 1}, {"action", "take"}});
        client->wait_for_still();
        client->send({{"type", "open"}, {"id", client->next_id()}, {"scene", "new.vrut"}});
        REQUIRE(eventually([&] { return driver.uploads > 0; }, 20s));
    }
    Json move_and_look() {
        client->send({{"type", "navigate"}, {"id", client->next_id()}, {"rotate", {7, 0}}});
        client->send({{"type", "frame"}});
        return client->wait_for("frame");
    }
    Json end_of_loading() {
        for (;;) {
            const Json loading = client->wait_for("loading", 20s);
            if (loading.contains("done") || loading.contains("refused")) return loading;
        }
    }

    TemporaryFolder folder;
    SlowUpload driver;
    std::optional<TestServer> server;
    std::optional<TestClient> client;
};

}  // namespace

TEST_CASE("while a scene is uploaded, each move of the old one is shown; then the new one is") {
    Opening opening;
    const Json old_scene = opening.client->state["scene"];
    for (int i = 0; i < 10; ++i) {
        const std::int64_t id = opening.client->next_id();
        const Json header = opening.move_and_look();
        CHECK(header["handled"] == id);
        CHECK(opening.client->state["scene"] == old_scene);
    }
    {
        const std::lock_guard lock(opening.driver.mutex);
        using Step = SlowUpload::Step;
        int frames = 0, in_a_row = 0;
        bool under_way = false;
        for (const Step step : opening.driver.steps) {
            if (step == Step::upload) {
                ++in_a_row;
                // Between two steps of a frame there is at most one of the upload.
                if (under_way) CHECK(in_a_row <= 1);
                continue;
            }
            in_a_row = 0;
            frames += step == Step::frame;
            under_way = step == Step::part;
        }
        CHECK(frames >= 10);
    }
    const int uploads = opening.driver.uploads;
    CHECK(eventually([&] { return opening.driver.uploads > uploads + 10; }));  // nobody moves: it goes on
    opening.driver.ends = true;
    CHECK(opening.end_of_loading()["done"] == true);
    CHECK(opening.client->wait_for_still()["quality"]["level"] == "still");
    CHECK(opening.client->state["scene"]["triangles"] == 2);
    const std::int64_t id = opening.client->next_id();
    CHECK(opening.move_and_look()["handled"] == id);
}

TEST_CASE("an upload that fails midway leaves the old scene, with all that was done to it") {
    Opening opening;
    const Json eye = opening.move_and_look()["camera"]["eye"];
    opening.driver.fails = true;
    CHECK(opening.end_of_loading()["refused"] == "new.vrut: there is no room");
    CHECK(opening.client->state["scene"]["triangles"] == 1);
    CHECK(opening.client->wait_for_still()["camera"]["eye"] == eye);
}

TEST_CASE("an upload goes on in a new renderer where the driver resets itself") {
    Opening opening;
    opening.move_and_look();
    opening.driver.resets = true;
    CHECK(eventually([&] { return !opening.driver.resets; }));
    opening.move_and_look();
    opening.driver.ends = true;
    CHECK(opening.end_of_loading()["done"] == true);
    opening.client->wait_for_still();
    CHECK(opening.client->state["scene"]["triangles"] == 2);
}

TEST_CASE("the server ends while a scene is uploaded") {
    Opening opening;
    CHECK(opening.server->stop() < 3s);
}
