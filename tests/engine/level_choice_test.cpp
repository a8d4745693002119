#include "engine/level_choice.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <limits>
#include <set>

#include "scenes/level_store.hpp"

using namespace vrut;
using namespace vrut::server::base;
using namespace vrut::server::scenes;
using namespace vrut::server::engine;
using namespace std::chrono_literals;
using protocol::Quality;

namespace {

constexpr double kPixels = 1000 * 500;

/// Scales 0.25, 0.5, 0.7, 1; the table says 2 ms and 40 ms for a whole picture, and a byte for five pixels.
protocol::LevelTable table() {
    protocol::LevelTable made{"", "", 1000, 500, {}};
    for (const double scale : {0.25, 0.5, 0.7, 1.0})
        made.levels.push_back(
            {{Quality::Level::moving, scale}, 2 + 40 * scale * scale, kPixels * scale * scale / 5, ""});
    made.levels.push_back({kRefined, 900, 3e5, ""});
    return made;
}

/// A server and a link that take what a test says, and the choice between them.
struct Loop {
    LevelChoice choice{table()};
    Clock::time_point now{1h};
    LevelDemand demand{{1000, 500, 1}, {}, 50};
    double server_factor = 1;  ///< to what the table says
    double ms_a_byte = 0;
    double noise = 0;  ///< part of the time, either way
    unsigned random = 1;
    std::size_t level = 0;
    int changes = 0;
    std::function<double(std::size_t)> server_ms = [this](std::size_t at) {
        return choice.levels()[at].ms * server_factor;
    };

    void picture() {
        if (ms_a_byte > 0) demand.link = Link{1000 / ms_a_byte, {}};
        const std::size_t next = choice.choose(demand, now);
        changes += next != level;
        level = next;
        random = random * 1664525 + 1013904223;
        const double factor = 1 + noise * (2 * (random >> 16) / 65535.0 - 1);
        const PictureCost cost{server_ms(level) * factor, choice.levels()[level].bytes * factor};
        now += std::chrono::duration_cast<Clock::duration>(
            std::chrono::duration<double, std::milli>(std::max(cost.ms_over(demand.link), 1.0)));
        const double scale = choice.levels()[level].quality.scale;
        choice.took(level, cost, kPixels * scale * scale, now);
    }
    void pictures(int count) {
        for (int i = 0; i < count; ++i) picture();
    }
    /// The level after as many pictures as it takes to settle.
    std::size_t settled() {
        pictures(300);
        return level;
    }
};

}  // namespace

TEST_CASE("of a table those levels are taken that are for moving pictures") {
    CHECK(LevelChoice(table()).levels().size() == 4);
    CHECK(LevelChoice(built_in_levels()).levels().size() >= 3);
}

TEST_CASE("before anything is measured the table tells") {
    Loop loop;
    CHECK(loop.choice.expected(3, kPixels, loop.now).ms == doctest::Approx(42));
    CHECK(loop.choice.expected(1, kPixels, loop.now).ms == doctest::Approx(48));  // of another view
    CHECK(loop.choice.choose(loop.demand, loop.now) == 3);
    loop.demand.target_ms = 15;
    CHECK(loop.choice.choose(loop.demand, loop.now) == 1);
    loop.demand.target_ms = 1;
    CHECK(loop.choice.choose(loop.demand, loop.now) == 0);
}

TEST_CASE("what was not measured of late is expected in proportion to the table, each part to its own") {
    Loop loop;
    const double quarter = kPixels / 4;
    loop.choice.took(1, {24, 100}, quarter, loop.now);  // twice as slow as the table says
    const PictureCost full = loop.choice.expected(3, kPixels, loop.now);
    CHECK(full.ms == doctest::Approx(84));
    CHECK(full.bytes == doctest::Approx(400));
    // A view of twice the pixels.
    CHECK(loop.choice.expected(1, 2 * quarter, loop.now).ms_over(Link{1000, {}}) == doctest::Approx(248));
    // A level's mean begins at what was expected of it, and is its own for a while.
    loop.choice.took(3, {34, 300}, kPixels, loop.now);
    CHECK(loop.choice.expected(3, kPixels, loop.now).ms == doctest::Approx(74));
    CHECK(loop.choice.expected(3, kPixels, loop.now).bytes == doctest::Approx(380));
    CHECK(loop.choice.expected(1, quarter, loop.now + 1s).ms_over(Link{1000, {}}) == 124.0);
    CHECK(loop.choice.expected(1, quarter, loop.now + 3s).ms == doctest::Approx(74.0 / 42 * 12));
}

TEST_CASE("under a steady load the most accurate level that holds the target is found, and kept") {
    const std::vector<std::pair<double, std::size_t>> loads{{0.1, 3}, {1, 3},  {1.6, 2},
                                                            {3, 1},   {10, 0}, {99, 0}};
    for (const auto& load : loads) {
        const double factor = load.first;
        CAPTURE(factor);
        Loop loop;
        loop.server_factor = factor;
        loop.noise = 0.1;
        CHECK(loop.settled() == load.second);
        loop.changes = 0;
        loop.pictures(2000);
        CHECK(loop.level == load.second);
        CHECK(loop.changes == 0);
    }
}

TEST_CASE("where the table promises too much, what is tried in vain is tried less and less often") {
    Loop loop;
    loop.server_ms = [](std::size_t level) { return level < 2 ? 10.0 : 200.0; };
    std::vector<Clock::time_point> tries;
    const Clock::time_point end = loop.now + 10min;
    while (loop.now < end) {
        const std::size_t before = loop.level;
        loop.picture();
        if (before < 2 && loop.level >= 2) tries.push_back(loop.now);
    }
    CHECK(loop.level == 1);
    CHECK(tries.size() >= 3);   // it may have got better
    CHECK(tries.size() <= 24);  // two levels, after 2, 4, 8, ... 64 s
    CHECK(tries.back() - tries[tries.size() - 2] > 25s);
}

TEST_CASE("a level at the verge of the target is tried seldom, and more and more seldom") {
    for (const double target : {50.0, 500.0, 1000.0})
        for (const double verge : {0.99, 1.0, 1.03}) {
            CAPTURE(target);
            CAPTURE(verge);
            Loop loop;
            loop.noise = 0.1;
            loop.demand.target_ms = target;
            const double promised = 0.6 * target / 42;  // by which the level below is judged
            loop.server_ms = [&](std::size_t level) {
                return level == 3 ? verge * target : loop.choice.levels()[level].ms * promised;
            };
            std::vector<Clock::time_point> drops;
            const Clock::time_point end = loop.now + 5min;
            while (loop.now < end) {
                const std::size_t before = loop.level;
                loop.picture();
                if (loop.level < before) drops.push_back(loop.now);
            }
            CHECK(drops.size() <= 9);  // after 2, 4, 8, ... 64 s
            if (drops.size() >= 7) CHECK(drops.back() - drops[drops.size() - 2] >= 60s);
        }
}

TEST_CASE("a load that comes is felt within a few pictures, and forgotten soon when it has gone") {
    Loop loop;
    CHECK(loop.settled() == 3);
    loop.server_factor = 3;
    loop.pictures(6);
    CHECK(loop.level <= 1);
    CHECK(loop.settled() == 1);
    loop.server_factor = 1;
    const Clock::time_point gone = loop.now;
    while (loop.level < 3 && loop.now < gone + 10s) loop.picture();
    CHECK(loop.level == 3);
    CHECK(loop.now - gone < 5s);
}

TEST_CASE("a slow link takes levels of fewer bytes, though the server is fast") {
    Loop loop;
    loop.server_factor = 0.1;
    CHECK(loop.settled() == 3);
    loop.ms_a_byte = 8.0 / 8000;  // 8 Mbit/s: 25 ms for half the size
    CHECK(loop.settled() == 1);
    loop.ms_a_byte = 8.0 / 250;
    CHECK(loop.settled() == 0);
}

TEST_CASE("the target is multiplied by the odds of the preference") {
    CHECK(preferred_target(50, 0) == 0);
    CHECK(preferred_target(50, 0.2) == doctest::Approx(12.5));
    CHECK(preferred_target(50, 0.5) == 50);
    CHECK(preferred_target(50, 0.8) == doctest::Approx(200));
    CHECK(preferred_target(50, 1) == std::numeric_limits<double>::infinity());
}

TEST_CASE("a higher preference never gives a less accurate level; the ends are the table's ends") {
    for (const double factor : {0.01, 0.3, 1.0, 2.0, 7.0, 100.0}) {
        CAPTURE(factor);
        std::size_t last = 0;
        for (int step = 0; step <= 20; ++step) {
            Loop loop;
            loop.server_factor = factor;
            loop.noise = 0.05;
            loop.demand.target_ms = preferred_target(50, step / 20.0);
            const std::size_t level = loop.settled();
            CHECK(level >= last);
            last = level;
            if (step == 0) CHECK(level == 0);
            if (step == 20) CHECK(level == 3);
        }
    }
}

TEST_CASE("the slider is obeyed at once, whatever was too slow before") {
    Loop loop;
    loop.server_factor = 3;
    CHECK(loop.settled() == 1);
    std::set<std::size_t> shown;
    for (int step = 10; step <= 20; ++step) {
        loop.demand.target_ms = preferred_target(50, step / 20.0);
        const std::size_t before = loop.level;
        loop.pictures(5);
        CHECK(loop.level >= before);
        shown.insert(loop.level);
    }
    CHECK(shown == std::set<std::size_t>{1, 2, 3});
    loop.demand.target_ms = 0;
    loop.picture();
    CHECK(loop.level == 0);
}

TEST_CASE("where no link is known, the server's part counts alone") {
    CHECK(PictureCost{12, 80}.ms_over({}) == 12);
    CHECK(PictureCost{12, 80}.ms_over(Link{1000, {}}) == 92);
    CHECK(PictureCost{12, 80}.ms_over(Link{std::numeric_limits<double>::infinity(), {}}) == 12);
}

TEST_CASE("who warps frames waits for them no longer than the link takes anyway") {
    using std::chrono::milliseconds;
    CHECK(warped_target(50, {}, 0) == 50);
    CHECK(warped_target(50, Link{1e6, milliseconds(20)}, 0) == 50);
    CHECK(warped_target(50, Link{1e6, milliseconds(200)}, 0) == 200);
    CHECK(warped_target(50, Link{1e6, milliseconds(200)}, 3) == 200);
    CHECK(warped_target(50, Link{1e6, milliseconds(200)}, 0.2) == 400);
    CHECK(warped_target(50, {}, 0.2) == 100);
}
