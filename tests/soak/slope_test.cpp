// A day in the room: somebody turns the car, ten inputs a second, and somebody watches. Memory may not grow.
#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <vector>

#include "program.hpp"
#include "swarm.hpp"

using namespace vrut::test;
using Clock = std::chrono::steady_clock;

namespace {

struct Sample {
    double hours = 0, megabytes = 0;
};

/// Megabytes an hour, by least squares.
double slope_of(const std::vector<Sample>& samples) {
    double hours = 0, megabytes = 0, above = 0, below = 0;
    for (const Sample& sample : samples) {
        hours += sample.hours / static_cast<double>(samples.size());
        megabytes += sample.megabytes / static_cast<double>(samples.size());
    }
    for (const Sample& sample : samples) {
        above += (sample.hours - hours) * (sample.megabytes - megabytes);
        below += (sample.hours - hours) * (sample.hours - hours);
    }
    return above / below;
}

/// Drags to and fro; between two drags the picture comes to rest, and now and then the wheel turns.
Json input(int number) {
    constexpr int kDrag = 40;
    const int step = number % kDrag;
    const double x = 200 + 10 * (number / kDrag % 2 == 0 ? step : kDrag - step), y = 200 + number % 7;
    if (step == 0) return pointer_event("pointerdown", x, y);
    if (step < 34) return pointer_event("pointermove", x, y);
    if (step == 34) return pointer_event("pointerup", x, y, "touch", 0, 0);
    const double delta = number / kDrag % 2 == 0 ? 100 : -100;
    if (step == 38)
        return {{"type", "wheel"}, {"x", x}, {"y", y}, {"deltaX", 0}, {"deltaY", delta}, {"deltaMode", 0}};
    return {{"type", "pick"}, {"x", x}, {"y", y}, {"id", number + 1}};
}

}  // namespace

TEST_CASE("a day of work takes no more memory than its first minute") {
    const char* given = std::getenv("VRUT_SOAK_SECONDS");
    const std::chrono::seconds lasts(given ? std::atoi(given) : 240);
    const auto warm_up = lasts / 3;
    Program program({"serve", VRUT_CARS "/car.vrut", "--listen", "127.0.0.1:0", "--log-level", "warning"});
    Swarm clients(program.port());
    clients.join("control");
    clients.join("view");

    std::vector<Sample> samples;
    std::int64_t frames = 0;
    const auto start = Clock::now();
    for (int i = 0; Clock::now() - start < lasts; ++i) {
        clients.send(0, input(i));
        clients.read_until(start + (i + 1) * 100ms, [&](const Swarm::Frame&) { ++frames; });
        const auto passed = Clock::now() - start;
        if (i % 10 != 0 || passed < warm_up) continue;
        samples.push_back(
            {std::chrono::duration<double>(passed).count() / 3600, use_of(program.process()).resident_mb});
        if (i % 600 == 0)
            std::printf("%.0f min: %.2f MB\n", samples.back().hours * 60, samples.back().megabytes),
                std::fflush(stdout);
    }
    const double slope = slope_of(samples), hours = samples.back().hours - samples.front().hours;
    const auto [least, most] = std::minmax_element(
        samples.begin(), samples.end(), [](auto& a, auto& b) { return a.megabytes < b.megabytes; });
    std::printf("%lld frames in %.0f min; memory %.2f to %.2f MB, slope %.2f MB an hour over %zu samples\n",
                static_cast<long long>(frames), hours * 60, least->megabytes, most->megabytes, slope,
                samples.size());
    CHECK(static_cast<double>(frames) > 3600 * hours);
    // In a short run what is made once, in the first quarter of an hour, weighs more than an hour's slope.
    CHECK(slope * hours < (hours > 0.5 ? 1.0 * hours : 8.0));
}
