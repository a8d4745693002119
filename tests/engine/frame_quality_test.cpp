#include "engine/frame_quality.hpp"

#include <doctest/doctest.h>

using namespace vrut;
using namespace vrut::server::engine;

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
    protocol::Quality level = kRefined;
    level.error = 0.001;
    const PictureLimits limits{1000, 16384};
    CHECK(quality_of(level, {25, 40, 1}, limits, false).error == 0.001);
    CHECK_FALSE(quality_of(level, {25, 41, 1}, limits, false).error.has_value());
    level.scale = 0.5;
    CHECK(quality_of(level, {25, 41, 1}, limits, false).error == 0.001);
}

TEST_CASE("sizes: up to the level's scale, the limit's pixels and the device's sides") {
    const PictureLimits limits;
    CHECK(quality_of(kRefined, {1180, 820, 2}, limits, false).scale == 1);
    for (const protocol::Resize& view :
         {protocol::Resize{1180, 820, 2}, {8192, 8192, 4}, {8192, 1, 4}, {1, 8192, 4}, {1, 1, 0.25}}) {
        for (const double scale : {0.25, 0.71, 1.0}) {
            protocol::Quality level = kRefined;
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
