// A room for a minute: a presenter who drags and resizes, watchers, clients that come and go. Nothing may
// grow.
#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdio>

#include "dying_clients.hpp"
#include "gl/handles.hpp"
#include "process.hpp"
#include "scenes/library.hpp"

using namespace vrut;
using namespace vrut::server::scenes;
using namespace vrut::server::engine;
using namespace vrut::server::net;
using namespace vrut::test;

namespace {

void one_round(TestServer& server, TestClient& presenter, int round) {
    const double width = 400 + 40 * (round % 7), height = 300 + 30 * (round % 5);
    presenter.send(
        {{"type", "resize"}, {"id", round + 1}, {"width", width}, {"height", height}, {"pixelRatio", 1}});
    presenter.wait_for("ok");
    TestClient watcher(server.port());
    watcher.join("view");
    presenter.send(pointer_event("pointerdown", 10, 10));
    for (int i = 0; i < 20; ++i) {
        for (TestClient* client : {&presenter, &watcher}) client->send({{"type", "frame"}});
        presenter.send(pointer_event("pointermove", 10 + i * 9, 10 + i));
        presenter.wait_for("frame");
    }
    presenter.send(pointer_event("pointerup", 200, 30, "touch", 0, 0));
    watcher.wait_for_still();
}

}  // namespace

TEST_CASE("a minute of work leaves no more behind than a few seconds") {
    auto scene = load_scene(VRUT_CARS "/car-20k.vrut", "car-20k.vrut");
    REQUIRE(scene.has_value());
    TestServer server(*std::move(scene), gl_renderer({}));
    TestClient presenter(server.port());
    presenter.join();
    int round = 0;
    const auto work_for = [&](std::chrono::seconds time) {
        const auto end = std::chrono::steady_clock::now() + time;
        while (std::chrono::steady_clock::now() < end) one_round(server, presenter, round++);
        CHECK(
            eventually([&] { return server.metrics().clients_joined - server.metrics().clients_left == 1; }));
    };
    work_for(15s);
    const double memory = use_of(getpid()).resident_mb;
    const auto descriptors = use_of(getpid()).descriptors;
    work_for(45s);
    std::printf("%d rounds, %.1f MB at first, %.1f MB at the end\n", round, memory,
                use_of(getpid()).resident_mb);
    if (kMemoryTells) CHECK(use_of(getpid()).resident_mb - memory < 8);
    CHECK(use_of(getpid()).descriptors == descriptors);
    CHECK(server.metrics().pictures_held <= 2);
}

TEST_CASE("four thousand clients that die in the midst of something leave nothing behind") {
    auto scene = load_scene(VRUT_CARS "/car-20k.vrut", "car-20k.vrut");
    REQUIRE(scene.has_value());
    ServerOptions options;
    options.max_clients = 300;
    TestServer server(*std::move(scene), gl_renderer({}), options);
    TestClient watcher(server.port());
    watcher.join("view");
    let_die(server, 8, 200);  // coarser surfaces are drawn for the first time meanwhile
    watcher.wait_for_still(60s);
    const long objects = gl::live_gl_objects();
    const double grown_mb = let_die(server, 12, 200);
    watcher.wait_for_still(60s);
    std::printf("GL objects: %ld after 8 rounds, %ld after 20\n", objects, gl::live_gl_objects());
    CHECK(gl::live_gl_objects() <= objects + 10);  // a level that few pictures had
    CHECK(server.metrics().pictures_held <= 2);
    if (kMemoryTells) CHECK(grown_mb < 8);
}
