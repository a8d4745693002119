#include "pacing.hpp"

#include <doctest/doctest.h>

using namespace vrut;
using namespace std::chrono_literals;
using Action = PacingDecision::Action;

namespace {

const Clock::time_point kStart = Clock::time_point(1h);

PacingInput at(std::chrono::milliseconds since_change) {
    PacingInput input;
    input.somebody_waits = true;
    input.last_change = kStart;
    input.now = kStart + since_change;
    return input;
}

}  // namespace

TEST_CASE("nothing is drawn that nobody waits for, or that has been drawn") {
    PacingInput input = at(1000ms);
    input.changed = true;
    input.somebody_waits = false;
    CHECK(decide(input).action == Action::wait);
    CHECK_FALSE(decide(input).until.has_value());

    input = at(1000ms);
    input.newest_samples = 16;
    CHECK(decide(input).action == Action::wait);
    CHECK_FALSE(decide(input).until.has_value());
}

TEST_CASE("a change is drawn at once, at rest again in full, in steps") {
    PacingInput input = at(0ms);
    input.changed = true;
    CHECK(decide(input).action == Action::draw);
    CHECK(decide(input).level < kStillLevel);
    CHECK(decide(input).samples == 1);

    input.changed = false;  // the moving picture is drawn
    CHECK(decide(input).action == Action::wait);
    CHECK(decide(input).until == kStart + 150ms);
    input.now = kStart + 149ms;
    CHECK(decide(input).action == Action::wait);
    input.now = kStart + 150ms;
    CHECK(decide(input).action == Action::draw);
    CHECK(decide(input).level == kStillLevel);
    CHECK(decide(input).samples == 4);
    input.newest_samples = 4;
    CHECK(decide(input).samples == 16);
    input.newest_samples = 16;
    CHECK(decide(input).action == Action::wait);

    // What was still is no more.
    input.changed = true;
    input.last_change = input.now;
    CHECK(decide(input).level < kStillLevel);
}

TEST_CASE("a change that nobody waited for is drawn in full when somebody comes later") {
    PacingInput input = at(151ms);
    input.changed = true;
    input.newest_samples = 16;
    CHECK(decide(input).level == kStillLevel);
    CHECK(decide(input).samples == 4);
}

namespace {

/// The level of the next moving picture, where those of each level are expected to take so long.
int next_level(int level, std::array<std::optional<double>, kStillLevel> expected_ms,
               double preference = 0.5) {
    PacingInput input = at(0ms);
    input.changed = true;
    input.level = level;
    input.expected_ms = expected_ms;
    input.target_ms = 50;
    input.preference = preference;
    return decide(input).level;
}

}  // namespace

TEST_CASE(
    "a level that is too slow is left for a lower one, a higher one is tried when that is well within") {
    CHECK(next_level(1, {{{}, {}, {}}}) == 1);  // nothing measured
    CHECK(next_level(1, {10, 50, 200}) == 1);
    CHECK(next_level(1, {10, 51, 200}) == 0);
    CHECK(next_level(2, {10, 50, 200}) == 1);
    CHECK(next_level(2, {10, 60, 200}) == 0);
    CHECK(next_level(0, {80, 320, 1280}) == 0);  // there is none below
    // Between 35 and 50 ms the level stays as it is: neither up nor down.
    CHECK(next_level(1, {5, 20, 34.9}) == 2);
    CHECK(next_level(1, {5, 20, 35}) == 1);
    CHECK(next_level(2, {5, 20, 49.9}) == 2);
    CHECK(next_level(0, {1, 2, 3}) == 1);  // a step at a time
}

TEST_CASE("preference moves the target by four either way") {
    CHECK(next_level(1, {3, 12.5, 100}, 0) == 1);
    CHECK(next_level(1, {3, 12.6, 100}, 0) == 0);
    CHECK(next_level(1, {30, 200, 800}, 1) == 1);
    CHECK(next_level(1, {30, 100, 139}, 1) == 2);
}

TEST_CASE("times are running means; what was not measured lately is expected in proportion to the pixels") {
    MeasuredTimes times;
    const auto now = kStart;
    CHECK_FALSE(times.expected(1, 1e6, 1, now).has_value());
    times.add(1, 10, 1e6, now);
    CHECK(times.expected(1, 1e6, 1, now) == 10.0);
    CHECK(times.expected(2, 4e6, 1, now) == 40.0);
    CHECK(times.expected(0, 0.25e6, 1, now) == 2.5);
    times.add(1, 20, 1e6, now + 1s);
    CHECK(times.expected(1, 1e6, 1, now + 1s) == doctest::Approx(12));
    // Measured at its own level, a while long.
    times.add(2, 100, 4e6, now + 1s);
    CHECK(times.expected(2, 4e6, 1, now + 10s) == 100.0);
    CHECK(times.expected(2, 4e6, 1, now + 12s) == doctest::Approx(48));
    // Another size of the view: the mean begins anew.
    times.add(1, 5, 0.5e6, now + 2s);
    CHECK(times.expected(1, 0.5e6, 1, now + 2s) == 5.0);
    CHECK(times.expected(1, 1e6, 1, now + 2s) == 10.0);
}

TEST_CASE("under a steady load the level settles") {
    // Each picture takes 2 ms and 20 ms a million pixels, with some noise.
    MeasuredTimes times;
    int level = kFirstLevel, changes = 0;
    unsigned noise = 1;
    for (int i = 0; i < 2000; ++i) {
        const auto now = kStart + i * 33ms;
        PacingInput input = at(0ms);
        input.changed = true;
        input.level = level;
        const std::array pixels{0.26e6, 0.92e6, 3.7e6};
        for (int l = 0; l < kStillLevel; ++l)
            input.expected_ms[static_cast<std::size_t>(l)] =
                times.expected(l, pixels[static_cast<std::size_t>(l)], level, now);
        const int next = decide(input).level;
        if (i > 100) changes += next != level;
        level = next;
        noise = noise * 1664525 + 1013904223;
        const double mega = pixels[static_cast<std::size_t>(level)] / 1e6;
        times.add(level, (2 + 20 * mega) * (0.9 + 0.2 * (noise >> 16) / 65535.0), mega * 1e6, now);
    }
    CHECK(level == 1);
    CHECK(changes == 0);
}

TEST_CASE("while a picture waits for the encoder none is drawn behind it") {
    PacingInput input = at(0ms);
    input.changed = true;
    input.encoder_free = false;
    CHECK(decide(input).action == Action::wait);
    CHECK_FALSE(decide(input).until.has_value());
}

TEST_CASE("the size of a picture") {
    CHECK(picture_size({1180, 820, 2}, 1) == PictureSize{2360, 1640});
    CHECK(picture_size({819.5, 1180, 2}, 0.5) == PictureSize{820, 1180});
    CHECK(picture_size({1, 8192, 0.25}, 0.1) == PictureSize{1, 205});
}

TEST_CASE("at most four levels, by rising accuracy; thin lines are never subsampled") {
    CHECK(kLevels.size() <= 4);
    for (std::size_t i = 1; i < kLevels.size(); ++i) {
        CHECK(kLevels[i].max_pixels >= kLevels[i - 1].max_pixels);
        CHECK(kLevels[i].samples >= kLevels[i - 1].samples);
        CHECK(kLevels[i].jpeg_quality >= kLevels[i - 1].jpeg_quality);
    }
    CHECK(quality_of(0, {}, {}, false).subsampling == protocol::Quality::Subsampling::yuv420);
    CHECK(quality_of(0, {}, {}, true).subsampling == protocol::Quality::Subsampling::yuv444);
    CHECK(quality_of(kStillLevel, {}, {}, false).level == protocol::Quality::Level::still);
    CHECK(quality_of(2, {}, {}, false).level == protocol::Quality::Level::moving);
}

TEST_CASE("sizes: up to the level's pixels and the device's sides") {
    const PictureLimits limits;
    CHECK(quality_of(kStillLevel, {1180, 820, 2}, limits, false).scale == 1);
    CHECK(quality_of(1, {1280, 720, 1}, limits, false).scale == 1);
    for (const protocol::Resize& view :
         {protocol::Resize{1180, 820, 2}, {8192, 8192, 4}, {8192, 1, 4}, {1, 8192, 4}, {1, 1, 0.25}}) {
        for (int level = 0; level <= kStillLevel; ++level) {
            const protocol::Quality quality = quality_of(level, view, limits, false);
            const PictureSize size = picture_size(view, quality.scale);
            const double pixels = static_cast<double>(size.width) * size.height;
            CHECK(quality.scale > 0);
            CHECK(quality.scale <= 1);
            CHECK(size.width >= 1);
            CHECK(size.height >= 1);
            CHECK(std::max(size.width, size.height) <= limits.max_side);
            CHECK(pixels <= static_cast<double>(kLevels[static_cast<std::size_t>(level)].max_pixels) * 1.01);
        }
    }
}
