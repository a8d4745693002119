// From input to frame over loopback: what the server adds to drawing, reading back and encoding the same
// frame.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "scenes/library.hpp"
#include "test_client.hpp"

using namespace vrut;
using namespace vrut::server::scenes;
using namespace vrut::server::engine;
using namespace vrut::test;

namespace {

struct Series {
    const char* name = "";
    std::vector<double> ms;

    double percentile(double part) {
        std::sort(ms.begin(), ms.end());
        return ms[static_cast<std::size_t>(std::lround(part * static_cast<double>(ms.size() - 1)))];
    }
};

}  // namespace

TEST_CASE("latency of isolated inputs") {
    constexpr int kInputs = 100;
    auto scene = load_scene(VRUT_CARS "/car.vrut", "car.vrut");
    REQUIRE(scene.has_value());
    TestServer server(*std::move(scene), gl_renderer({}));
    TestClient client(server.port());
    client.join();
    client.send({{"type", "resize"}, {"id", 1}, {"width", 1280}, {"height", 720}, {"pixelRatio", 1}});
    client.send(pointer_event("pointerdown", 100, 100));

    Series total{"input to frame", {}}, render{"  render", {}}, readback{"  read-back", {}},
        encode{"  encode", {}}, server_part{"  input to socket", {}},
        added{"added by the server and the way", {}};
    for (int i = 0; i < kInputs; ++i) {
        client.wait_for_still();
        client.grant();
        std::this_thread::sleep_for(20ms);  // the grant is there before the input
        const auto start = std::chrono::steady_clock::now();
        client.send(pointer_event("pointermove", 105 + 5 * i, 100));
        const Json header = client.wait_for("frame");
        const double ms =
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        REQUIRE(header["quality"]["level"] == "moving");
        const Json& timing = header["timing"];
        const auto part = [&](const char* name) { return timing[name].get<double>(); };
        total.ms.push_back(ms);
        render.ms.push_back(part("renderMs"));
        readback.ms.push_back(part("readbackMs"));
        encode.ms.push_back(part("encodeMs"));
        server_part.ms.push_back(part("sinceInputMs"));
        added.ms.push_back(ms - part("renderMs") - part("readbackMs") - part("encodeMs"));
    }
    std::printf("%s\n%d isolated inputs, 1280x720, the car; ms\n%-34s %8s %8s %8s\n",
                server.description().c_str(), kInputs, "", "p50", "p95", "p99");
    for (Series* series : {&total, &render, &readback, &encode, &server_part, &added})
        std::printf("%-34s %8.3f %8.3f %8.3f\n", series->name, series->percentile(0.5),
                    series->percentile(0.95), series->percentile(0.99));
}
