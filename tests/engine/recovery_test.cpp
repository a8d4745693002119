// The graphics driver fails while clients are there.
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <future>

#include "base/detached_thread.hpp"
#include "base/drawing_errors.hpp"
#include "engine/engine.hpp"
#include "event_log_file.hpp"
#include "full_disk.hpp"
#include "plan/render_job.hpp"
#include "room/replay.hpp"
#include "temporary_folder.hpp"
#include "test_client.hpp"

using namespace vrut;
using namespace vrut::server::room;
using namespace vrut::server::engine;
using namespace vrut::server::net;
using namespace vrut::test;

namespace {

/// What draws here fails when a test says so.
class FailingDriver {
public:
    /// The next picture is lost, at its second sample where it has one.
    std::atomic<bool> resets{false};
    /// So are all of this height.
    std::atomic<int> resets_at_height{0};
    /// So many renderers cannot be made.
    std::atomic<int> refuses{0};
    std::atomic<int> made{0};

    FrameRendererFactory factory() {
        return [this] {
            if (refuses > 0) {
                --refuses;
                throw std::runtime_error("nothing here draws");
            }
            ++made;
            FrameRenderer renderer = FakeRenderer{.takes = 2ms}.factory()();
            renderer.step = [this, step = renderer.step](plan::RenderJob& rendering) {
                const bool whole = step(rendering);
                const bool second = whole || rendering.samples > 1;
                if (rendering.view.height == resets_at_height || (second && resets.exchange(false))) {
                    rendering.image.rgba.assign(rendering.image.rgba.size(), 0xEE);
                    throw vrut::base::ContextLost("the driver has reset itself");
                }
                return whole;
            };
            return renderer;
        };
    }
};

/// With a folder for recordings.
struct Running {
    explicit Running(ServerOptions options = {}) {
        options.record_folder = folder.path();
        server.emplace(scene_of("vrut-text 1\n"
                                "geometry 1 vertices 3 -1 -1 0  1 -1 0  0 1 1 triangles 1 0 1 2 end\n"
                                "node 1 \"Triangle\" geometry geometry 1 end\n"),
                       driver.factory(), std::move(options));
    }
    TemporaryFolder folder;
    FailingDriver driver;
    std::optional<TestServer> server;
};

std::size_t notices_about(const Json& state, const std::string& what) {
    const auto& notices = state["notices"];
    return static_cast<std::size_t>(std::count_if(notices.begin(), notices.end(), [&](const auto& entry) {
        const auto notice = entry["message"].template get<std::string>();
        return notice.find(what) != std::string::npos;
    }));
}

}  // namespace

TEST_CASE("a driver that resets itself in the midst of a drag costs a picture, and nobody anything else") {
    Running running;
    TestClient holder(running.server->port()), watcher(running.server->port());
    holder.join();
    watcher.join("view");
    holder.send({{"type", "record"}, {"id", 1}, {"action", "start"}, {"name", "drag"}});
    holder.wait_for("ok");
    holder.send(pointer_event("pointerdown", 300, 300));
    std::int64_t frame = 0;
    double eye = 0;
    for (int i = 1; i <= 30; ++i) {
        if (i == 15) {
            running.driver.refuses = 2;
            running.driver.resets = true;
        }
        holder.send(pointer_event("pointermove", 300 + 10 * i, 300));
        const auto asked = std::chrono::steady_clock::now();
        for (TestClient* client : {&holder, &watcher}) {
            client->send({{"type", "frame"}});
            const Json header = client->wait_for("frame");
            CHECK(std::chrono::steady_clock::now() - asked < 5s);
            if (client != &holder) continue;
            CHECK(header["frame"] > frame);
            CHECK(header["camera"]["eye"][0] != eye);
            frame = header["frame"];
            eye = header["camera"]["eye"][0];
        }
    }
    CHECK(running.driver.made == 2);
    CHECK(running.driver.refuses == 0);
    holder.send(pointer_event("pointerup", 600, 300, "touch", 0, 0));
    holder.send({{"type", "record"}, {"id", 2}, {"action", "stop"}});
    CHECK(holder.wait_for("ok")["name"] == "drag");
    CHECK(holder.state["control"]["holder"] == watcher.state["control"]["holder"]);
    for (const TestClient* client : {&holder, &watcher}) CHECK(notices_about(client->state, "driver") == 1);
    watcher.wait_for_still();
}

TEST_CASE("at rest, too: snapshots that wait come, and another client finds all as it was") {
    Running running;
    TestClient client(running.server->port());
    client.join();
    const Json before = client.wait_for_still();
    running.driver.refuses = 1;
    running.driver.resets = true;
    for (const int id : {1, 2})
        client.send({{"type", "snapshot"}, {"id", id}, {"width", 40 * id}, {"height", 30 * id}});
    std::vector<int> snapshots;
    while (snapshots.size() < 2) {
        const Json header = client.wait_for("frame");
        if (header.contains("snapshot")) snapshots.push_back(header["snapshot"]);
        CHECK(header["camera"]["eye"] == before["camera"]["eye"]);
    }
    CHECK(snapshots == std::vector<int>{1, 2});
    CHECK(running.driver.made == 2);
    TestClient other(running.server->port());
    CHECK(other.join("view")["camera"]["eye"] == before["camera"]["eye"]);
    CHECK(other.wait_for_still()["frame"] == before["frame"]);  // nothing has changed
}

TEST_CASE("a picture that resets the driver each time it is drawn is refused, and the others go on") {
    Running running;
    TestClient client(running.server->port());
    client.join();
    running.driver.resets_at_height = 31;
    client.send({{"type", "snapshot"}, {"id", 1}, {"width", 40}, {"height", 31}});
    const Json error = client.wait_for("error");
    CHECK(error["id"] == 1);
    CHECK(error["code"] == "failed");
    CHECK(http(running.server->port(), "GET", "/frame.jpg?width=40&height=31").status == 503);
    CHECK(http(running.server->port(), "GET", "/frame.jpg?width=40&height=30").status == 200);
    client.send({{"type", "snapshot"}, {"id", 2}, {"width", 40}, {"height", 30}});
    CHECK(client.wait_for("frame")["snapshot"] == 2);
    client.wait_for_still();
}

TEST_CASE("a driver that never comes back ends the server with what it says") {
    FailingDriver driver;
    ServerOptions options;
    options.listen = {"127.0.0.1", 0};
    Server server(options, scene_of("vrut-text 1"), driver.factory());
    std::string sentence;
    std::thread thread([&] {
        try {
            server.run();
        } catch (const std::exception& error) {
            sentence = error.what();
        }
    });
    TestClient client(server.port());
    client.join();
    driver.refuses = 1000;
    driver.resets = true;
    client.send({{"type", "frame"}});
    CHECK(client.wait_for_close(15s) == 1001);
    thread.join();
    CHECK(sentence == "drawing has failed: nothing here draws");
}

TEST_CASE("an engine that cannot begin leaves nothing that would tell it later of work on files") {
    std::promise<void> let_go;
    const auto waits = let_go.get_future().share();
    EngineOptions options;
    options.scene = scene_of("vrut-text 1\nnode 1 \"Root\" assembly end\n");
    options.scene.changes = "none";
    options.scene.changes_fault = "a newer program has written it";
    options.keep_changes = {[](const std::string&, const std::string&) {},
                            [waits](const std::string&, const std::string&, const std::string&) {
                                waits.wait();
                                return std::string("aside");
                            }};
    const auto too_large = [] {
        FrameRenderer renderer = FakeRenderer{}.factory()();
        renderer.upload_step = [](const plan::View&) -> bool {
            throw vrut::base::OutOfMemory("the scene is too large");
        };
        return renderer;
    };
    vrut::server::observe::Metrics metrics;
    CHECK_THROWS_WITH(std::make_unique<Engine>(std::move(options), too_large, metrics, EngineCallbacks{}),
                      doctest::Contains("the scene is too large"));
    let_go.set_value();
    CHECK(eventually([] { return vrut::server::base::detached_threads() == 0; }));
}

TEST_CASE("a recording that finds no room ends, with a notice for everybody and nothing else") {
    Running running;
    TestClient a(running.server->port()), b(running.server->port());
    a.join();
    b.join("view");
    a.send({{"type", "record"}, {"id", 1}, {"action", "start"}, {"name", "log"}});
    a.wait_for("ok");
    a.wait_for_still();
    b.wait_for_still();
    CHECK(b.state["recording"]["name"] == "log");
    const std::filesystem::path log = running.folder.path() / "log.jsonl";
    const auto size = std::filesystem::file_size(log);
    const FullDisk full(size + 100);
    for (int i = 2; i < 20; ++i) {
        a.send({{"type", "navigate"}, {"id", i}, {"rotate", {5, 0}}});
        CHECK(a.wait_for("ok")["id"] == i);
        a.send({{"type", "frame"}});
        CHECK(a.wait_for("frame")["handled"] == i);
    }
    b.wait_for_still();
    for (const TestClient* client : {&a, &b}) {
        CHECK_FALSE(client->state.contains("recording"));
        CHECK(notices_about(client->state, "The recording 'log' has ended: File too large") == 1);
    }
    CHECK(running.server->metrics().clients_left == 0);
    CHECK(std::filesystem::file_size(log) <= size + 100);
    CHECK(log_in(log).has_value());
}
