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
    input.newest_is_still = true;
    CHECK(decide(input).action == Action::wait);
    CHECK_FALSE(decide(input).until.has_value());
}

TEST_CASE("a change is drawn at once, at rest again in full") {
    PacingInput input = at(0ms);
    input.changed = true;
    CHECK(decide(input).action == Action::draw_moving);

    input.changed = false;  // the moving picture is drawn
    CHECK(decide(input).action == Action::wait);
    CHECK(decide(input).until == kStart + 150ms);
    input.now = kStart + 149ms;
    CHECK(decide(input).action == Action::wait);
    input.now = kStart + 150ms;
    CHECK(decide(input).action == Action::draw_still);
}

TEST_CASE("a change that nobody waited for is drawn in full when somebody comes later") {
    PacingInput input = at(151ms);
    input.changed = true;
    CHECK(decide(input).action == Action::draw_still);
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

TEST_CASE("levels: at rest all pixels up to the limits, while moving a million") {
    const PictureLimits limits;
    CHECK(still_quality({1180, 820, 2}, limits).scale == 1);
    CHECK(moving_quality({1280, 720, 1}, limits).scale == 1);
    for (const protocol::Resize& view :
         {protocol::Resize{1180, 820, 2}, {8192, 8192, 4}, {8192, 1, 4}, {1, 8192, 4}, {1, 1, 0.25}}) {
        for (const bool still : {false, true}) {
            const protocol::Quality quality =
                still ? still_quality(view, limits) : moving_quality(view, limits);
            const PictureSize size = picture_size(view, quality.scale);
            const double pixels = static_cast<double>(size.width) * size.height;
            CHECK(quality.scale > 0);
            CHECK(quality.scale <= 1);
            CHECK(size.width >= 1);
            CHECK(size.height >= 1);
            CHECK(std::max(size.width, size.height) <= limits.max_side);
            const auto most = static_cast<double>(still ? limits.max_pixels : limits.max_moving_pixels);
            CHECK(pixels <= most * 1.01);
        }
    }
}
