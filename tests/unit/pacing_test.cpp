#include "engine/pacing.hpp"

#include <doctest/doctest.h>

using namespace vrut;
using namespace vrut::server::base;
using namespace vrut::server::engine;
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
    CHECK(decide(input).still_samples == 0);

    input.changed = false;  // the moving picture is drawn
    CHECK(decide(input).action == Action::wait);
    CHECK(decide(input).until == kStart + 150ms);
    input.now = kStart + 149ms;
    CHECK(decide(input).action == Action::wait);
    input.now = kStart + 150ms;
    CHECK(decide(input).action == Action::draw);
    CHECK(decide(input).still_samples == 4);
    input.newest_samples = 4;
    CHECK(decide(input).still_samples == 16);
    input.newest_samples = 16;
    CHECK(decide(input).action == Action::wait);

    // What was still is no more.
    input.changed = true;
    input.last_change = input.now;
    CHECK(decide(input).still_samples == 0);
}

TEST_CASE("a change that nobody waited for is drawn in full when somebody comes later") {
    PacingInput input = at(151ms);
    input.changed = true;
    input.newest_samples = 16;
    CHECK(decide(input).still_samples == 4);
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

TEST_CASE("a picture of a level: thin lines are never subsampled, and their error is not known") {
    const protocol::Quality level{protocol::Quality::Level::moving,       0.5, 1, 2, 75,
                                  protocol::Quality::Subsampling::yuv420, 0.03};
    CHECK(quality_of(level, {}, {}, false) == level);
    const protocol::Quality lines = quality_of(level, {}, {}, true);
    CHECK(lines.subsampling == protocol::Quality::Subsampling::yuv444);
    CHECK_FALSE(lines.error.has_value());
    CHECK(lines.scale == 0.5);
}

TEST_CASE("a picture smaller than its level, which the limits ask for, has no error that is known") {
    protocol::Quality level = kStill;
    level.error = 0.001;
    const PictureLimits limits{1000, 16384};
    CHECK(quality_of(level, {25, 40, 1}, limits, false).error == 0.001);
    CHECK_FALSE(quality_of(level, {25, 41, 1}, limits, false).error.has_value());
    level.scale = 0.5;
    CHECK(quality_of(level, {25, 41, 1}, limits, false).error == 0.001);
}

TEST_CASE("sizes: up to the level's scale, the limit's pixels and the device's sides") {
    const PictureLimits limits;
    CHECK(quality_of(kStill, {1180, 820, 2}, limits, false).scale == 1);
    for (const protocol::Resize& view :
         {protocol::Resize{1180, 820, 2}, {8192, 8192, 4}, {8192, 1, 4}, {1, 8192, 4}, {1, 1, 0.25}}) {
        for (const double scale : {0.25, 0.71, 1.0}) {
            protocol::Quality level = kStill;
            level.scale = scale;
            const protocol::Quality quality = quality_of(level, view, limits, false);
            const PictureSize size = picture_size(view, quality.scale);
            const double pixels = static_cast<double>(size.width) * size.height;
            CHECK(quality.scale > 0);
            CHECK(quality.scale <= scale);
            CHECK(size.width >= 1);
            CHECK(size.height >= 1);
            CHECK(std::max(size.width, size.height) <= limits.max_side);
            CHECK(pixels <= static_cast<double>(limits.max_pixels) * 1.01);
        }
    }
}
