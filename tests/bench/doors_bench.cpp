// What watchers get who come by doors that others have opened: several/watchers.mjs of tests/web opens them.
#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "audience.hpp"

using namespace vrut::test;
using Clock = std::chrono::steady_clock;

TEST_CASE("watchers get each change") {
    const char* const doors_given = std::getenv("VRUT_DOORS");  // PORT/PATH,PORT/PATH
    const char* const watchers_given = std::getenv("VRUT_WATCHERS");
    REQUIRE(doors_given);
    REQUIRE(watchers_given);
    std::vector<Door> doors;
    std::istringstream list(doors_given);
    for (std::string door; std::getline(list, door, ',');) {
        const std::size_t path = door.find('/');
        doors.push_back({static_cast<std::uint16_t>(std::stoi(door.substr(0, path))), door.substr(path)});
    }
    constexpr auto kLasts = 8s;
    Audience audience(doors, 1 + static_cast<std::size_t>(std::atoi(watchers_given)));
    audience.work_until(Clock::now() + 2s);
    audience.forget();
    const std::size_t before = audience.changes();
    std::puts("begun");
    std::fflush(stdout);
    audience.work_until(Clock::now() + kLasts);
    const double seconds = std::chrono::duration<double>(kLasts).count();
    std::printf("{\"changes\":%.1f,\"delivered\":%.1f,\"p50\":%.1f,\"p99\":%.1f}\n",
                static_cast<double>(audience.changes() - before) / seconds,
                static_cast<double>(audience.seen()) / seconds, audience.percentile(0.5),
                audience.percentile(0.99));
}
