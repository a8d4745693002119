#include "pacing.hpp"

#include <algorithm>
#include <cmath>

namespace vrut {

namespace {

double scale_for(const protocol::Resize& view, std::int64_t max_pixels, int max_side) {
    const double width = view.width * view.pixel_ratio, height = view.height * view.pixel_ratio;
    return std::min({1.0, std::sqrt(static_cast<double>(max_pixels) / (width * height)),
                     max_side / std::max(width, height)});
}

}  // namespace

protocol::Quality moving_quality(const protocol::Resize& view, const PictureLimits& limits) {
    const double scale =
        scale_for(view, std::min(limits.max_pixels, limits.max_moving_pixels), limits.max_side);
    return {.moving = true, .scale = scale, .samples = 1, .jpeg_quality = 75, .subsampled = true};
}

protocol::Quality still_quality(const protocol::Resize& view, const PictureLimits& limits) {
    const double scale = scale_for(view, limits.max_pixels, limits.max_side);
    return {.moving = false, .scale = scale, .samples = 4, .jpeg_quality = 90, .subsampled = false};
}

PictureSize picture_size(const protocol::Resize& view, double scale) {
    const auto pixels = [&](double css) {
        return std::max(1, static_cast<int>(std::lround(css * view.pixel_ratio * scale)));
    };
    return {pixels(view.width), pixels(view.height)};
}

PacingDecision decide(const PacingInput& input) {
    using Action = PacingDecision::Action;
    if (!input.somebody_waits || (!input.changed && input.newest_is_still)) return {Action::wait, {}};
    if (!input.encoder_free) return {Action::wait, {}};  // taking its next picture, the encoder wakes us
    const Clock::time_point quiet_at = input.last_change + kQuiet;
    if (input.now >= quiet_at) return {Action::draw_still, {}};
    if (input.changed) return {Action::draw_moving, {}};
    return {Action::wait, quiet_at};
}

}  // namespace vrut
