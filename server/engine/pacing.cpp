#include "engine/pacing.hpp"

#include <algorithm>
#include <cmath>

namespace vrut::server::engine {

namespace {

/// The largest that the limits allow, at most 1.
double largest_scale(const protocol::Resize& view, const PictureLimits& limits) {
    const double width = view.width * view.pixel_ratio, height = view.height * view.pixel_ratio;
    return std::min({1.0, std::sqrt(static_cast<double>(limits.max_pixels) / (width * height)),
                     limits.max_side / std::max(width, height)});
}

}  // namespace

protocol::Quality quality_of(const protocol::Quality& level, const protocol::Resize& view,
                             const PictureLimits& limits, bool thin_lines) {
    protocol::Quality quality = level;
    quality.scale = std::min(level.scale, largest_scale(view, limits));
    if (thin_lines) quality.subsampling = protocol::Quality::Subsampling::yuv444;
    if (thin_lines || quality.scale < level.scale) quality.error.reset();  // of such none was measured
    return quality;
}

PictureSize picture_size(const protocol::Resize& view, double scale) {
    const auto pixels = [&](double css) {
        return std::max(1, static_cast<int>(std::lround(css * view.pixel_ratio * scale)));
    };
    return {pixels(view.width), pixels(view.height)};
}

PacingDecision decide(const PacingInput& input) {
    using Action = PacingDecision::Action;
    const bool final_one = input.newest_samples == kStillSamples.back();
    if (!input.somebody_waits || (!input.changed && final_one)) return {};
    if (!input.encoder_free) return {};  // taking its next picture, the encoder wakes us
    const base::Clock::time_point quiet_at = input.last_change + kQuiet;
    if (input.now >= quiet_at) {
        const int drawn = input.changed ? 0 : input.newest_samples;
        const auto step = std::find_if(kStillSamples.begin(), kStillSamples.end(),
                                       [&](int samples) { return samples > drawn; });
        return {Action::draw, *step};
    }
    if (input.changed) return {Action::draw};
    return {Action::wait, 0, quiet_at};
}

}  // namespace vrut::server::engine
