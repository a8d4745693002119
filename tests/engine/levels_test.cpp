#include <doctest/doctest.h>
#include <pthread.h>

#include <array>
#include <atomic>
#include <random>
#include <set>
#include <tuple>

#include "engine/frame_quality.hpp"
#include "engine/scheduler.hpp"
#include "environment_variable.hpp"
#include "plan/render_job.hpp"
#include "scenes/level_store.hpp"
#include "temporary_folder.hpp"
#include "test_client.hpp"

using namespace vrut;
using namespace vrut::server::observe;
using namespace vrut::server::scenes;
using namespace vrut::server::engine;
using namespace vrut::test;
using protocol::Quality;

namespace {

constexpr int kSide = 100;  // of the view in pixels
constexpr const char *kScene = "ab12", *kRenderer = "a renderer that waits";

/// Draws noise, and takes `whole_ms` for a picture of the whole size, and less in proportion to its pixels.
FrameRendererFactory renderer_that_waits(const std::atomic<double>& whole_ms) {
    return [&whole_ms] {
        FrameRenderer renderer{kRenderer, false, 16384, {}};
        renderer.step = [&whole_ms](plan::RenderJob& rendering) {
            const plan::View& view = rendering.view;
            if (rendering.samples == 0 || rendering.samples < view.samples) {
                rendering.stats.render_ms = whole_ms * view.width * view.height / (kSide * kSide);
                std::this_thread::sleep_for(
                    std::chrono::duration<double, std::milli>(rendering.stats.render_ms / view.samples));
                ++rendering.stats.samples;
                if (++rendering.samples < view.samples) return false;
            }
            rendering.stats.readbacks = 1;
            rendering.image.resize(view.width, view.height);
            std::minstd_rand random;
            for (std::uint8_t& byte : rendering.image.rgba) byte = static_cast<std::uint8_t>(random());
            return true;
        };
        return renderer;
    };
}

protocol::LevelTable table() {
    protocol::LevelTable made{kScene, kRenderer, kSide, kSide, {}};
    for (const double scale : {0.25, 0.35, 0.5, 0.71, 1.0})
        made.levels.push_back(
            {{Quality::Level::moving, scale, 1, 0, 75, Quality::Subsampling::yuv420, 0.1 * (1.25 - scale)},
             200 * scale * scale,
             20'000 * scale * scale,
             ""});
    made.levels.push_back({kRefined, 3000, 30'000, ""});
    made.levels.back().quality.error = 0.001;
    return made;
}

/// The quickest level and the most accurate.
protocol::LevelTable ends_of_table() {
    protocol::LevelTable ends = table();
    ends.levels = {ends.levels[0], ends.levels[4]};
    return ends;
}

LoadedScene measured_scene() {
    LoadedScene scene = scene_of("vrut-text 1");
    scene.sha256 = kScene;
    return scene;
}

/// A server that finds the table above, and a client that moves the camera.
struct Drag {
    struct Kept {
        TemporaryFolder folder;
        EnvironmentVariable state{"XDG_STATE_HOME", folder.path().c_str()};
        explicit Kept(const protocol::LevelTable& levels) { store_levels(levels); }
    } kept;
    std::atomic<double> whole_ms{1};
    TestServer server{measured_scene(), renderer_that_waits(whole_ms)};
    TestClient client;
    int id = 0;

    explicit Drag(const protocol::LevelTable& levels = table(), const ConnectOptions& link = {})
        : kept(levels), client(server.port(), link) {
        client.join();
        client.send({{"type", "resize"}, {"width", kSide}, {"height", kSide}, {"pixelRatio", 1}});
    }
    void change(const Json& patch) {
        client.send({{"type", "patch"}, {"id", ++id}, {"patch", patch}});
        client.wait_for("ok");
    }
    void move(int grants) {
        client.send({{"type", "patch"}, {"id", ++id}, {"patch", {{"camera", {{"eye", {id, 1, 9}}}}}}});
        for (int i = 0; i < grants; ++i) client.grant();
    }
    /// The quality of the last of so many pictures, each asked for when the one before has come.
    Json moves(int pictures) {
        Json header;
        for (int i = 0; i < pictures; ++i) {
            move(1);
            header = client.wait_for("frame");
        }
        return header["quality"];
    }
    /// The scale of the first picture between two, however many a loaded machine needs, within limits.
    double moves_until(double least, double most = 1) {
        double scale = -1;
        for (int i = 0; i < 100 && !(scale >= least && scale <= most); ++i) scale = moves(1)["scale"];
        return scale;
    }
    /// The quality of a picture asked for once, while the camera moves on and on.
    Json moves_on() {
        client.grant();
        const auto end = std::chrono::steady_clock::now() + 5s;
        while (std::chrono::steady_clock::now() < end) {
            move(0);
            while (const auto message = client.receive(2ms))
                if (message->binary) return message->json()["quality"];
        }
        return {};
    }
};

}  // namespace

TEST_CASE("while things move the most accurate level is drawn that holds the target") {
    Drag drag;
    drag.change({{"quality", {{"latencyTargetMs", 100}}}});
    drag.whole_ms = 10;
    CHECK(drag.moves_until(1.0) == 1.0);
    drag.whole_ms = 1000;  // 63 ms at a quarter of the size, and more than 100 at the next
    CHECK(drag.moves_until(0, 0.25) == 0.25);
}

TEST_CASE("pictures of several samples come while the camera moves, and are judged by what they took") {
    protocol::LevelTable sampled = ends_of_table();
    sampled.levels[1].quality.samples = 4;
    Drag drag{sampled};
    drag.change({{"quality", {{"latencyTargetMs", 300}}}});
    drag.whole_ms = 20;
    CHECK(drag.moves_on()["scale"] == 0.25);  // nobody knows yet how slow the link is
    Json quality;
    for (int i = 0; i < 40 && quality["samples"] != 4; ++i) quality = drag.moves_on();
    CHECK(quality["samples"] == 4);
    drag.whole_ms = 400;  // and 25 at a quarter of the size
    for (int i = 0; i < 40 && quality["samples"] != 1; ++i) quality = drag.moves_on();
    CHECK(quality["samples"] == 1);
    CHECK(drag.server.metrics().frames_interrupted == 0);
}

TEST_CASE("with two pictures on their way each is measured until it has arrived") {
    Drag drag{ends_of_table()};
    drag.change({{"quality", {{"latencyTargetMs", 300}}}});
    drag.whole_ms = 30;
    drag.move(2);
    CHECK(eventually([&] { return drag.server.metrics().frames_sent == 1; }));
    drag.move(0);
    Json quality;
    for (int i = 0; i < 12 && quality["scale"] != 0.25; ++i) {
        quality = drag.client.wait_for("frame")["quality"];
        std::this_thread::sleep_for(200ms);  // it shows one while the next waits
        drag.move(1);
    }
    CHECK(quality["scale"] == 0.25);
}

TEST_CASE("frames that wait unread tell of a slow link, whatever the kernel has acknowledged") {
    Drag drag{ends_of_table()};
    drag.change({{"quality", {{"latencyTargetMs", 200}}}});
    for (int i = 1; i <= 5; ++i) {
        drag.move(1);
        std::this_thread::sleep_for(400ms);
        CHECK(drag.client.wait_for("frame")["quality"]["scale"] == 0.25);
    }
}

TEST_CASE("who takes long to ask gets the picture at rest soon: it need not be the link") {
    Drag drag{ends_of_table()};
    drag.moves(1);
    std::this_thread::sleep_for(1500ms);
    drag.move(1);  // it took 1.5 s to the grant; a whole picture has 16 times the bytes
    const auto rest = std::chrono::steady_clock::now();
    while (drag.client.wait_for("frame", 10s)["quality"]["samples"] != 16) {
        REQUIRE(std::chrono::steady_clock::now() - rest < 12s);
        drag.client.grant();
    }
    CHECK(std::chrono::steady_clock::now() - rest < 10s);
}

TEST_CASE("who steers over a slow link sees where it ended at once, though others have seen it before") {
    Drag drag{ends_of_table()};
    TestClient watcher(drag.server.port());
    watcher.join("view");
    drag.moves(1);
    std::this_thread::sleep_for(1500ms);
    drag.moves(1);
    drag.move(0);
    for (Json quality; quality["samples"] != 16; quality = watcher.wait_for("frame")["quality"])
        watcher.send({{"type", "frame"}});
    const auto asked = std::chrono::steady_clock::now();
    drag.client.send({{"type", "frame"}});
    drag.client.wait_for("frame");
    CHECK(std::chrono::steady_clock::now() - asked < 1s);
}

TEST_CASE("a whole picture that is held back on a slow link makes way for the view that moves again") {
    Drag drag{ends_of_table()};
    drag.move(1);
    // Two are small, and tell of the link; the third has the whole size, and one sample.
    for (const auto& [level, scale, takes] :
         {std::tuple("moving", 0.25, 200ms), {"still", 0.25, 200ms}, {"still", 1.0, 3000ms}}) {
        std::this_thread::sleep_for(takes);
        const Json quality = drag.client.wait_for("frame")["quality"];
        CHECK(quality["level"] == level);
        CHECK(quality["scale"] == scale);
        if (scale == 1) CHECK(quality["samples"] == 1);
        drag.client.grant();
    }
    const Metrics& metrics = drag.server.metrics();
    CHECK(eventually([&] { return metrics.frames_encoded == 4; }, 60s));
    CHECK(metrics.frames_sent == 3);  // the fourth takes longer than was thought
    drag.move(0);
    CHECK(drag.client.wait_for("frame", 60s)["quality"]["level"] == "moving");
}

TEST_CASE("on a very slow link the first picture of a view that rests waits no longer than a moving one") {
    Drag drag{ends_of_table()};
    drag.move(1);
    std::this_thread::sleep_for(2500ms);
    drag.client.wait_for("frame");
    drag.move(0);
    while (drag.client.receive(2 * kQuiet)) {
    }
    drag.client.grant();
    const Metrics& metrics = drag.server.metrics();
    CHECK(eventually([&] { return metrics.frames_encoded == 2; }));
    drag.move(0);
    CHECK(drag.client.wait_for("frame")["quality"]["level"] == "still");
}

TEST_CASE("where who steers takes no pictures, the others' are not small for that") {
    Drag drag;
    TestClient watcher(drag.server.port());
    watcher.join("view");
    drag.moves(1);
    double scale = 0;
    for (int i = 0; i < 100 && scale < 1; ++i) {
        watcher.send({{"type", "frame"}});
        drag.move(0);
        scale = watcher.wait_for("frame")["quality"]["scale"];
    }
    CHECK(scale == 1);
}

TEST_CASE("what is told to all reaches a slow client, though pictures come all the time") {
    Drag drag{ends_of_table()};
    drag.client.send({{"type", "resize"}, {"width", 4 * kSide}, {"height", 4 * kSide}, {"pixelRatio", 1}});
    drag.change({{"quality", {{"preference", 1}}}});
    TestClient slow(drag.server.port(), {.receive_buffer = 4096});
    slow.takes_stats = true;
    slow.join("view");
    for (int i = 0; i < 2; ++i) slow.send({{"type", "frame"}});
    const auto begin = std::chrono::steady_clock::now();
    int pictures = 0, stats = 0;
    while (stats == 0 && std::chrono::steady_clock::now() - begin < 20s) {
        drag.move(0);
        const auto message = slow.receive(10ms);
        if (!message) continue;
        if (message->binary) {
            ++pictures;
            slow.send({{"type", "frame"}});
            std::this_thread::sleep_for(50ms);
        } else if (message->json()["type"] == "stats" && pictures > 5) {
            ++stats;
        }
    }
    MESSAGE("after " << pictures << " pictures");
    CHECK(stats == 1);
}

TEST_CASE("preference moves along the levels, from the quickest to the most accurate") {
    Drag drag;
    drag.whole_ms = 200;
    drag.change({{"quality", {{"latencyTargetMs", 100}}}});
    std::set<double> scales;
    double last = 0;
    for (const double preference : {0.0, 0.35, 0.5, 0.65, 0.8, 1.0}) {
        CAPTURE(preference);
        drag.change({{"quality", {{"preference", preference}}}});
        drag.moves(6);
        const double scale = drag.moves_until(last);
        CHECK(scale >= last);
        scales.insert(last = scale);
    }
    CHECK(scales.size() >= 4);
    CHECK(scales.contains(0.25));
    CHECK(scales.contains(1));
}

TEST_CASE("where no thread can be had for coarser surfaces, pictures come without them") {
    protocol::LevelTable coarse = ends_of_table();
    coarse.levels[0].quality.detail = 2;
    Drag drag{coarse};
    pthread_attr_t usual, huge;
    REQUIRE(pthread_getattr_default_np(&usual) == 0);
    REQUIRE(pthread_getattr_default_np(&huge) == 0);
    REQUIRE(pthread_attr_setstacksize(&huge, std::size_t{1} << 50) ==
            0);  // of a new thread: more than there is
    REQUIRE(pthread_setattr_default_np(&huge) == 0);
    const bool came = !drag.moves(3).empty();
    pthread_setattr_default_np(&usual);
    CHECK(came);
}

TEST_CASE("the error that was measured is told with each picture") {
    Drag drag;
    drag.change({{"quality", {{"preference", 1}}}});
    const Json most = drag.moves(2);
    CHECK(most["level"] == "moving");
    CHECK(most["error"].get<double>() == doctest::Approx(0.025));
    drag.change({{"quality", {{"preference", 0}}}});
    CHECK(drag.moves(2)["error"].get<double>() == doctest::Approx(0.1));
    CHECK(drag.client.wait_for_still()["quality"]["error"] == 0.001);
    drag.change({{"renderer", {{"mode", "stylized"}}}});  // of which nothing was measured
    CHECK_FALSE(drag.moves(2).contains("error"));
    CHECK_FALSE(drag.client.wait_for_still()["quality"].contains("error"));
}

TEST_CASE("an interactive frame at full accuracy is the first sample of the refined ones") {
    Drag drag;
    drag.change({{"quality", {{"preference", 1}}}});
    CHECK(drag.moves(2)["scale"] == 1.0);
    const std::uint64_t drawn = drag.server.metrics().samples_drawn;
    CHECK(drag.client.wait_for_still()["quality"]["samples"] == 16);
    CHECK(drag.server.metrics().samples_drawn == drawn + 15);
}

TEST_CASE("points that wait for their turn do not put off the picture at rest") {
    Drag drag;
    drag.moves(2);
    TestClient other(drag.server.port());
    other.join("view");
    drag.move(1);
    Json level;
    const auto end = std::chrono::steady_clock::now() + 3s;
    while (level != "still" && std::chrono::steady_clock::now() < end) {
        other.send({{"type", "point"}, {"x", 10}, {"y", 10}});
        const auto message = drag.client.receive(5ms);
        if (!message || !message->binary) continue;
        level = message->json()["quality"]["level"];
        drag.client.grant();
    }
    CHECK(level == "still");
}

TEST_CASE("walls that follow put off no picture at rest, and cause none") {
    Drag drag;
    TestClient host(drag.server.port());
    host.join("host");
    drag.change({{"unit", {{"metres", 1}}}, {"camera", {{"eye", {0, 1, 9}}, {"focus", {0, 1, 0}}}}});
    drag.moves(1);
    drag.change(
        {{"comfort", {{"metresPerSecond", 1}}}, {"camera", {{"eye", {3, 1, 9}}, {"focus", {3, 1, 0}}}}});
    drag.client.wait_for_still();
    CHECK(drag.client.state.contains("walls"));
    const std::uint64_t drawn = drag.server.metrics().samples_drawn;
    for (int i = 0; i < 2; ++i) drag.client.grant();
    while (!host.state.contains("walls")) REQUIRE(host.receive(1s));
    int updates = 0;
    for (; host.state.contains("walls"); ++updates) REQUIRE(host.receive(1s));
    CHECK(updates > 20);
    CHECK(drag.server.metrics().samples_drawn == drawn);
}

TEST_CASE("at rest nothing is drawn, read back or encoded, with and without grants") {
    Drag drag;
    const auto counted = [&] {
        const Metrics& metrics = drag.server.metrics();
        return std::array<std::uint64_t, 7>{metrics.frames_rendered(),  metrics.frames_interrupted,
                                            metrics.snapshots_rendered, metrics.samples_drawn,
                                            metrics.readbacks,          metrics.frames_encoded,
                                            metrics.bytes_encoded};
    };
    drag.moves(2);
    // Nobody waits: not even the picture at rest is drawn.
    drag.change({{"camera", {{"eye", {5.5, 1, 9}}}}});
    const auto before = counted();
    std::this_thread::sleep_for(500ms);
    CHECK(counted() == before);
    // What was asked for is counted...
    const Json still = drag.client.wait_for_still();
    CHECK(still["quality"]["samples"] == 16);
    const auto drawn = counted();
    CHECK(drawn[0] == before[0] + 3);
    CHECK(drawn[3] == before[3] + 16);  // each goes on from the one before
    CHECK(drawn[4] == before[4] + 3);
    CHECK(drawn[5] == before[5] + 3);
    CHECK(drawn[6] > before[6]);
    // ...and then nothing more is, whoever waits.
    for (int i = 0; i < 2; ++i) drag.client.send({{"type", "frame"}});
    std::this_thread::sleep_for(500ms);
    CHECK(counted() == drawn);
    // Pointing causes no picture, either.
    for (int i = 0; i < 20; ++i) {
        drag.client.send({{"type", "point"}, {"x", 10 + i}, {"y", 10}});
        std::this_thread::sleep_for(20ms);
    }
    drag.client.send({{"type", "tree"}, {"id", drag.client.next_id()}});
    drag.client.wait_for("tree");
    std::this_thread::sleep_for(100ms);
    CHECK(counted() == drawn);
}
