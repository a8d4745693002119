#include "observe/live_stats.hpp"

#include <doctest/doctest.h>

using namespace vrut;
using namespace vrut::server::base;
using namespace vrut::server::observe;
using namespace std::chrono_literals;
using protocol::Role;

namespace {

const Clock::time_point kStart{1h};

}  // namespace

TEST_CASE("stats come at most twice a second, and only after something happened") {
    const Metrics metrics;
    LiveStats stats(metrics);
    CHECK_FALSE(stats.due());
    CHECK_FALSE(stats.take(kStart + 1h));

    stats.joined("c1", Role::control, "", kStart);
    CHECK(stats.due() == kStart);
    CHECK(stats.take(kStart));
    CHECK_FALSE(stats.due());
    CHECK_FALSE(stats.take(kStart + 1h));

    stats.drawn({}, 5, kStart + 100ms);
    stats.drawn({}, 5, kStart + 499ms);
    CHECK(stats.due() == kStart + 500ms);
    CHECK_FALSE(stats.take(kStart + 499ms));
    CHECK(stats.take(kStart + 500ms));
    CHECK_FALSE(stats.take(kStart + 1h));

    stats.left("c1", kStart + 2h);  // long after: at once
    CHECK(stats.due() == kStart + 2h);
    CHECK(stats.take(kStart + 2h));
}

TEST_CASE("a revision that is made is nothing to tell") {
    const Metrics metrics;
    LiveStats stats(metrics);
    stats.made(4, kStart);
    CHECK_FALSE(stats.due());
}

TEST_CASE("mean, median and 95th percentile are those of the last 100 pictures") {
    const Metrics metrics;
    LiveStats stats(metrics);
    stats.joined("c1", Role::view, "", kStart);
    CHECK_FALSE(stats.take(kStart)->renderer);  // before the first picture
    Clock::time_point now = kStart;
    const auto told = [&](const std::vector<double>& times) {
        for (const double ms : times) stats.drawn({}, ms, now += 1s);
        return *stats.take(now)->renderer;
    };
    auto renderer = told({30, 10, 100, 20, 40});
    CHECK(renderer.mean_render_ms == 40);
    CHECK(renderer.median_render_ms == 30);
    CHECK(renderer.p95_render_ms == 100);

    renderer = told({12, 14, 16, 18, 22, 24, 26, 28, 32, 34, 36, 38, 42, 44, 46, 48});  // 21 in all
    CHECK(renderer.median_render_ms == 30);
    CHECK(renderer.p95_render_ms == 48);  // one of them took longer

    std::vector<double> hundred;
    for (int i = 1; i <= 100; ++i) hundred.push_back(i);
    renderer = told(hundred);  // those before are forgotten
    CHECK(renderer.mean_render_ms == 50.5);
    CHECK(renderer.p95_render_ms == 95);
    renderer = told({101});
    CHECK(renderer.mean_render_ms == 51.5);
}

TEST_CASE("one picture is its own mean, median and percentile") {
    const Metrics metrics;
    LiveStats stats(metrics);
    protocol::Quality quality;
    quality.samples = 16;
    stats.drawn(quality, 7.5, kStart);
    const auto told = stats.take(kStart);
    CHECK(told->quality == quality);
    CHECK(told->renderer->mean_render_ms == 7.5);
    CHECK(told->renderer->median_render_ms == 7.5);
    CHECK(told->renderer->p95_render_ms == 7.5);
}

TEST_CASE("a host's lag goes from a revision's making to its report") {
    const Metrics metrics;
    LiveStats stats(metrics);
    stats.joined("c1", Role::host, "Cave", kStart);
    stats.joined("c2", Role::host, "Wall", kStart);
    stats.made(7, kStart + 1000ms);
    stats.made(8, kStart + 1010ms);
    stats.made(9, kStart + 1020ms);
    CHECK(stats.take(kStart)->hosts.empty());  // none has told yet

    stats.shown("c1", 8, kStart + 1042ms);
    auto hosts = stats.take(kStart + 2s)->hosts;
    REQUIRE(hosts.size() == 1);
    CHECK(hosts["c1"].name == "Cave");
    CHECK(hosts["c1"].revision == 8);
    CHECK(hosts["c1"].lag_ms == 32);

    stats.shown("c1", 6, kStart + 2100ms);  // of before: when that was made is not known
    stats.shown("c2", 9, kStart + 1010ms);  // no lag is below none
    stats.shown("c3", 9, kStart + 2100ms);  // nobody
    hosts = stats.take(kStart + 3s)->hosts;
    REQUIRE(hosts.size() == 2);
    CHECK(hosts["c1"].revision == 6);
    CHECK_FALSE(hosts["c1"].lag_ms);
    CHECK(hosts["c2"].lag_ms == 0);

    stats.left("c1", kStart + 4s);
    CHECK(stats.take(kStart + 4s)->hosts.size() == 1);
}

TEST_CASE("who is there is counted, and who of them only watches") {
    const Metrics metrics;
    LiveStats stats(metrics);
    stats.joined("c1", Role::control, "", kStart);
    stats.joined("c2", Role::view, "", kStart);
    stats.joined("c3", Role::view, "", kStart);
    stats.joined("c4", Role::host, "", kStart);
    auto told = stats.take(kStart);
    CHECK(told->clients == 4);
    CHECK(told->watchers == 2);
    stats.left("c2", kStart + 1s);
    told = stats.take(kStart + 1s);
    CHECK(told->clients == 3);
    CHECK(told->watchers == 1);
}

TEST_CASE("rates are those since it was told last") {
    Metrics metrics;
    LiveStats stats(metrics);
    stats.joined("c1", Role::view, "", kStart);
    stats.take(kStart);
    metrics.frames_sent = 10;
    metrics.bytes_sent = 5000;
    stats.drawn({}, 1, kStart + 100ms);
    auto told = stats.take(kStart + 500ms);
    CHECK(told->frames_per_second == 20);
    CHECK(told->bytes_per_second == 10'000);
    metrics.frames_sent = 11;
    stats.drawn({}, 1, kStart + 600ms);
    told = stats.take(kStart + 1500ms);
    CHECK(told->frames_per_second == 1);
    CHECK(told->bytes_per_second == 0);
}
