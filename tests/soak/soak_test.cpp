// A room for a minute: a presenter who drags and resizes, watchers, clients that come and go. Nothing may
// grow.
#include <doctest/doctest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "scene_library.hpp"
#include "test_client.hpp"

using namespace vrut;
using namespace vrut::test;

namespace {

double resident_megabytes() {
    std::ifstream status("/proc/self/statm");
    double size = 0, resident = 0;
    status >> size >> resident;
    return resident * 4096 / 1e6;
}

std::ptrdiff_t open_descriptors() {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                         std::filesystem::directory_iterator());
}

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
    TestServer server(*std::move(scene), gl_painter({}));
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
    const double memory = resident_megabytes();
    const auto descriptors = open_descriptors();
    work_for(45s);
    std::printf("%d rounds, %.1f MB at first, %.1f MB at the end\n", round, memory, resident_megabytes());
    CHECK(resident_megabytes() - memory < 8);
    CHECK(open_descriptors() == descriptors);
    CHECK(server.metrics().pictures_held <= 2);
}
