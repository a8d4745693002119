#include "base/rate_limit.hpp"

#include <doctest/doctest.h>

using namespace vrut::server::base;
using namespace std::chrono_literals;

TEST_CASE("a rate lets a second's messages come at once, then as many a second") {
    RateLimit rate(1000);
    Clock::time_point now = Clock::now();
    for (int i = 0; i < 1000; ++i) {
        CHECK(rate.wait(now) <= 0s);
        rate.spend(now);
    }
    rate.spend(now);
    CHECK(rate.wait(now) == 1ms);
    now += 500ms;
    for (int i = 0; i < 499; ++i) rate.spend(now);
    CHECK(rate.wait(now) == 0s);
    now += 1h;
    for (int i = 0; i < 1001; ++i) rate.spend(now);
    CHECK(rate.wait(now) == 1ms);
}
