#include <doctest/doctest.h>
#include <sys/resource.h>

#include "engine/frame_quality.hpp"
#include "plan/render_job.hpp"
#include "test_client.hpp"

using namespace vrut;
using namespace vrut::server::observe;
using namespace vrut::server::scenes;
using namespace vrut::server::engine;
using namespace vrut::server::net;
using namespace vrut::test;

namespace {

double cpu_milliseconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto ms = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_usec) / 1e3;
    };
    return ms(usage.ru_utime) + ms(usage.ru_stime);
}

Json eye(int id, double x) {
    return {{"type", "patch"}, {"id", id}, {"patch", {{"camera", {{"eye", {x, 0.5, 9}}}}}}};
}

}  // namespace

TEST_CASE("after a change come moving frames, then still ones of rising samples, then none") {
    TestServer server;
    TestClient client(server.port());
    client.join();
    client.send({{"type", "frame"}});
    Json first = client.wait_for("frame");  // at rest since long: still at once
    CHECK(first["frame"] == 1);
    CHECK(first["quality"]["level"] == "still");
    CHECK(first["quality"]["samples"] == 1);
    CHECK(first["quality"]["scale"] == 1.0);
    CHECK(client.wait_for_still()["frame"] == 3);
    client.send(eye(1, 1));
    client.send({{"type", "frame"}});
    const Json moving = client.wait_for("frame");
    CHECK(moving["quality"]["level"] == "moving");
    CHECK(moving["camera"]["eye"][0] == 1.0);
    const auto start = std::chrono::steady_clock::now();
    client.send({{"type", "frame"}});
    const Json coarse = client.wait_for("frame");
    CHECK(std::chrono::steady_clock::now() - start > 100ms);
    CHECK(coarse["quality"]["level"] == "still");
    CHECK(coarse["quality"]["samples"] == 1);
    CHECK(coarse["quality"]["scale"] == 1.0);
    const Json still = client.wait_for_still();
    CHECK(still["quality"]["samples"] == 16);
    CHECK(still["quality"]["scale"] == 1.0);
    CHECK(still["quality"]["subsampling"] == "4:4:4");
    client.send({{"type", "frame"}});
    CHECK_FALSE(client.receive(400ms).has_value());
    CHECK(server.metrics().frames_rendered() == 7);
}

TEST_CASE("the header tells the highest id of this client that the picture shows") {
    TestServer server;
    TestClient a(server.port()), b(server.port());
    a.join();
    b.join("view");
    CHECK(a.wait_for_still()["handled"] == 0);
    a.send(eye(41, 1));
    a.send({{"type", "frame"}, {"id", 42}});
    const Json header = a.wait_for("frame");
    CHECK(header["handled"] == 42);
    CHECK(header["timing"]["sinceInputMs"] >= 0);
    CHECK(b.wait_for_still()["handled"] == 0);
}

TEST_CASE("nothing is drawn that nobody asked for") {
    TestServer server;
    TestClient client(server.port());
    client.join();
    for (int i = 1; i <= 20; ++i) {
        client.send(eye(i, i));
        client.wait_for("ok");
    }
    std::this_thread::sleep_for(300ms);
    CHECK(server.metrics().frames_rendered() == 0);
    CHECK(server.metrics().frames_encoded == 0);
    client.send({{"type", "frame"}});
    CHECK(client.wait_for("frame")["camera"]["eye"][0] == 20.0);
    CHECK(server.metrics().frames_rendered() == 1);
}

TEST_CASE("a thousand grants count as two") {
    TestServer server;
    TestClient client(server.port()), watcher(server.port());
    client.join();
    watcher.join("view");
    client.wait_for_still();
    for (int i = 0; i < 1000; ++i) client.send({{"type", "frame"}});
    const auto& sent = server.metrics().frames_sent;
    const std::uint64_t before = sent;
    std::uint64_t of_watcher = 0;
    for (int i = 1; i <= 5; ++i) {
        client.send(eye(i, i));
        client.wait_for("ok");
        // Draws what the client would get, too.
        for (double x = -1; x != i; ++of_watcher) {
            watcher.send({{"type", "frame"}});
            x = watcher.wait_for("frame")["camera"]["eye"][0];
        }
    }
    client.send(eye(6, 6));
    client.wait_for("ok");
    CHECK(sent == before + 2 + of_watcher);
}

TEST_CASE("one rendering and one encoding serve everybody") {
    TestServer server;
    TestClient a(server.port()), b(server.port()), c(server.port());
    a.join();
    b.join("view");
    c.join("view");
    Json frames[3];
    for (TestClient* client : {&a, &b, &c}) client->send({{"type", "frame"}});
    frames[0] = a.wait_for("frame");
    frames[1] = b.wait_for("frame");
    frames[2] = c.wait_for("frame");
    CHECK(frames[0]["frame"] == frames[1]["frame"]);
    CHECK(frames[0]["frame"] == frames[2]["frame"]);
    CHECK(server.metrics().frames_rendered() == 1);
    CHECK(server.metrics().frames_encoded == 1);
    CHECK(server.metrics().frames_sent == 3);
    // Who comes later gets the same one without any work.
    const Json refined = a.wait_for_still();
    TestClient d(server.port());
    d.join("view");
    CHECK(d.wait_for_still()["frame"] == refined["frame"]);
    CHECK(server.metrics().frames_rendered() == 3);
}

TEST_CASE("five seconds without change cost nothing") {
    TestServer server;
    TestClient a(server.port()), b(server.port());
    a.join();
    b.join("view");
    a.send(eye(1, 3));
    a.wait_for_still();
    b.wait_for_still();
    for (TestClient* client : {&a, &b})
        for (int i = 0; i < 2; ++i) client->send({{"type", "frame"}});
    std::this_thread::sleep_for(200ms);
    const auto rendered = server.metrics().frames_rendered();
    const auto encoded = server.metrics().frames_encoded.load();
    const auto sent = server.metrics().frames_sent.load();
    const double cpu = cpu_milliseconds();
    std::this_thread::sleep_for(5s);
    const double used = cpu_milliseconds() - cpu;
    CHECK(server.metrics().frames_rendered() == rendered);
    CHECK(server.metrics().frames_encoded == encoded);
    CHECK(server.metrics().frames_sent == sent);
    MESSAGE("processor time in 5 s at rest: " << used << " ms");
    CHECK(used < 50);
}

TEST_CASE("a client that never reads delays nobody, and one frame waits for it at most") {
    TestServer server({.noise = true});
    TestClient worker(server.port()), stalled(server.port(), {.receive_buffer = 4096});
    worker.join();
    stalled.join("view");
    constexpr int kFrames = 60;
    for (int i = 1; i <= kFrames; ++i) {
        stalled.send({{"type", "frame"}});
        worker.send({{"type", "frame"}});
        worker.send(eye(i, i * 0.1));
        const Json header = worker.wait_for("frame");
        CHECK(header["handled"].get<int>() >= i - 1);
    }
    const Metrics& metrics = server.metrics();
    // The worker's frames, and of the stalled one's what went into its socket's buffers.
    CHECK(metrics.frames_sent >= kFrames);
    CHECK(metrics.frames_sent <= kFrames + 3);
    CHECK(metrics.frames_replaced >= kFrames - 5);
    // The stalled client's in its socket, the newest (which is what waits for it), one on its way to the
    // worker, one fresh from the encoder.
    CHECK(metrics.pictures_held_most <= 4);
    CHECK(metrics.frames_encoded <= metrics.frames_granted);
}

TEST_CASE("input interrupts the picture at rest") {
    TestServer server({.takes = 50ms});
    TestClient client(server.port());
    client.join();
    client.send({{"type", "frame"}});
    CHECK(client.wait_for("frame")["quality"]["level"] == "still");
    client.grant();
    std::this_thread::sleep_for(30ms);  // the second picture, of several samples, is being drawn
    client.send(eye(1, 2));
    const Json header = client.wait_for("frame");
    CHECK(header["quality"]["level"] == "moving");
    CHECK(header["camera"]["eye"][0] == 2.0);
    CHECK(server.metrics().frames_interrupted >= 1);
}

TEST_CASE("messages that change nothing to be seen do not keep the picture at rest away") {
    TestServer server({.takes = 160ms});
    TestClient watcher(server.port()), noisy(server.port());
    watcher.join("view");
    noisy.join("view");
    watcher.send({{"type", "frame"}});
    int sent = 0;
    const auto end = std::chrono::steady_clock::now() + 3s;
    while (server.metrics().frames_rendered_still == 0 && std::chrono::steady_clock::now() < end) {
        noisy.send({{"type", "keyup"}, {"key", "f"}, {"code", "KeyF"}});
        std::this_thread::sleep_for(10ms);
        ++sent;
    }
    CHECK(sent > 5);
    CHECK(server.metrics().frames_rendered_still == 1);
    CHECK(server.metrics().frames_interrupted == 0);
}

TEST_CASE("a slow client gets no frame twice") {
    TestServer server({.noise = true});
    TestClient worker(server.port()), slow(server.port(), {.receive_buffer = 4096});
    worker.join();
    slow.join("view");
    std::int64_t last = 0;
    for (int i = 1; i <= 20; ++i) {
        slow.send({{"type", "frame"}});
        worker.send({{"type", "frame"}});
        worker.send(eye(i, i * 0.1));
        worker.wait_for("frame");
    }
    for (int i = 0; i < 4; ++i) {
        slow.send({{"type", "frame"}});
        while (const auto message = slow.receive(300ms)) {
            if (!message->binary) continue;
            CHECK(message->json()["frame"] > last);
            last = message->json()["frame"];
        }
    }
    CHECK(last > 0);
}

TEST_CASE("the whole scene stays in view while nobody has moved the camera, and then the camera stays") {
    TestServer server;
    TestClient client(server.port());
    const Json home = client.join()["camera"];
    client.send({{"type", "patch"}, {"patch", Json::object()}});  // takes control
    client.send({{"type", "resize"}, {"id", 1}, {"width", 400}, {"height", 900}, {"pixelRatio", 1}});
    client.wait_for("ok");
    const Json upright = client.state["camera"];
    CHECK(upright["eye"] != home["eye"]);
    CHECK(upright["center"] == home["center"]);
    client.send(eye(2, 1));
    client.wait_for("ok");
    const Json own = client.state["camera"];
    client.send({{"type", "resize"}, {"id", 3}, {"width", 900}, {"height", 400}, {"pixelRatio", 1}});
    client.wait_for("ok");
    CHECK(client.state["camera"] == own);
}

TEST_CASE("a picture that cannot be drawn is told, and ends nothing") {
    std::atomic<bool> broken{false};
    const FrameRendererFactory factory = [&] {
        FrameRenderer renderer = FakeRenderer{}.factory()();
        renderer.step = [&, step = renderer.step](plan::RenderJob& rendering) {
            if (broken) throw std::runtime_error("the table of colours is gone");
            return step(rendering);
        };
        return renderer;
    };
    TestServer server(scene_of("vrut-text 1"), factory);
    TestClient client(server.port());
    client.join();
    broken = true;
    client.send({{"type", "frame"}});
    client.wait_for_notice("This view cannot be drawn: the table of colours is gone");
    client.send({{"type", "snapshot"}, {"id", 1}, {"width", 64}, {"height", 48}});
    const Json error = client.wait_for("error");
    CHECK(error["code"] == "failed");
    CHECK(error["message"] == "the image cannot be drawn: the table of colours is gone");
    broken = false;
    client.send({{"type", "navigate"}, {"id", 2}, {"rotate", {5, 0}}});
    client.wait_for("frame");
}

TEST_CASE("a picture that cannot be encoded is told, and ends nothing") {
    std::atomic<bool> broken{false};
    const FrameRendererFactory factory = [&] {
        FrameRenderer renderer = FakeRenderer{}.factory()();
        renderer.step = [&, step = renderer.step](plan::RenderJob& rendering) {
            const bool whole = step(rendering);
            if (whole && broken) rendering.image.resize(0, 0);  // no encoder takes that
            return whole;
        };
        return renderer;
    };
    TestServer server(scene_of("vrut-text 1"), factory);
    TestClient client(server.port());
    client.join();
    broken = true;
    client.send({{"type", "frame"}});
    client.wait_for_notice("This view cannot be encoded: ");
    client.send({{"type", "snapshot"}, {"id", 1}, {"width", 64}, {"height", 48}, {"format", "png"}});
    CHECK(client.wait_for("error")["code"] == "failed");
    CHECK(http(server.port(), "GET", "/frame.jpg").status == 503);
    broken = false;
    client.send({{"type", "navigate"}, {"id", 2}, {"rotate", {5, 0}}});
    client.wait_for("frame");
}

TEST_CASE("if the last refinement cannot be encoded, who comes later sees the one before it") {
    const FrameRendererFactory factory = [&] {
        FrameRenderer renderer = FakeRenderer{}.factory()();
        renderer.step = [&, step = renderer.step](plan::RenderJob& rendering) {
            const bool whole = step(rendering);
            if (whole && rendering.view.samples == server::engine::kRefined.samples)
                rendering.image.resize(0, 0);
            return whole;
        };
        return renderer;
    };
    TestServer server(scene_of("vrut-text 1"), factory);
    TestClient client(server.port());
    client.join();
    Json frame;
    for (int i = 0; i < 2; ++i) {
        client.grant();
        frame = client.wait_for("frame");
    }
    client.grant();
    client.wait_for_notice("This view cannot be encoded: ");
    TestClient late(server.port());
    late.join();
    late.grant();
    CHECK(late.wait_for("frame")["frame"] >= frame["frame"]);
}

TEST_CASE("what cannot draw, and a port that is taken, are told at once") {
    const FrameRendererFactory none = []() -> FrameRenderer {
        throw std::runtime_error("nothing here draws");
    };
    ServerOptions options;
    options.listen = {"127.0.0.1", 0};
    const LoadedScene scene = scene_of("vrut-text 1");
    CHECK_THROWS_WITH(Server(options, scene, none), "nothing here draws");
    TestServer other;
    options.listen.port = other.port();
    CHECK_THROWS_WITH(Server(options, scene, FakeRenderer{}.factory()),
                      doctest::Contains("cannot listen at 127.0.0.1:"));
}

TEST_CASE("what a snapshot says was handled does not fall behind the frames before it") {
    TestServer server({.takes = 5ms});
    TestClient client(server.port());
    client.join();
    client.send({{"type", "frame"}});
    client.wait_for("frame");
    client.send({{"type", "snapshot"}, {"id", 1}, {"width", 64}, {"height", 48}, {"format", "png"}});
    client.send({{"type", "navigate"}, {"id", 2}, {"rotate", {5, 0}}});
    client.send({{"type", "frame"}});
    client.send({{"type", "frame"}});
    std::int64_t handled = 0;
    for (bool snapshot = false; !snapshot || handled < 2;) {
        const auto message = client.receive();
        REQUIRE(message.has_value());
        if (!message->binary || message->data[0] == '\x89') {
            snapshot = snapshot || message->binary;
            continue;
        }
        const Json header = message->json();
        CHECK(header["handled"] >= handled);
        handled = header["handled"];
    }
}
