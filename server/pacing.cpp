#include "pacing.hpp"

#include <algorithm>
#include <cmath>

namespace vrut {

namespace {

constexpr double kWellWithin = 0.7;                 // of the target, before a higher level is tried
constexpr double kNewWeight = 0.2;                  // of a new time in the running mean
constexpr auto kLately = std::chrono::seconds(10);  // a mean is trusted so long

double scale_for(const protocol::Resize& view, std::int64_t max_pixels, int max_side) {
    const double width = view.width * view.pixel_ratio, height = view.height * view.pixel_ratio;
    return std::min({1.0, std::sqrt(static_cast<double>(max_pixels) / (width * height)),
                     max_side / std::max(width, height)});
}

int moving_level(const PacingInput& input) {
    const double target = input.target_ms * std::pow(4, 2 * input.preference - 1);
    const auto expected = [&](int level) { return input.expected_ms[static_cast<std::size_t>(level)]; };
    int level = std::clamp(input.level, 0, kStillLevel - 1);
    if (expected(level) > target) {
        while (level > 0 && expected(level) > target) --level;
    } else if (level + 1 < kStillLevel && expected(level + 1) &&
               *expected(level + 1) < kWellWithin * target) {
        ++level;
    }
    return level;
}

}  // namespace

protocol::Quality quality_of(int level, const protocol::Resize& view, const PictureLimits& limits,
                             bool thin_lines) {
    const Level& row = kLevels[static_cast<std::size_t>(level)];
    protocol::Quality quality;
    quality.level = level == kStillLevel ? protocol::Quality::Level::still : protocol::Quality::Level::moving;
    quality.scale = scale_for(view, std::min(limits.max_pixels, row.max_pixels), limits.max_side);
    quality.samples = row.samples;
    quality.jpeg_quality = row.jpeg_quality;
    quality.subsampling = thin_lines ? protocol::Quality::Subsampling::yuv444 : row.subsampling;
    return quality;
}

PictureSize picture_size(const protocol::Resize& view, double scale) {
    const auto pixels = [&](double css) {
        return std::max(1, static_cast<int>(std::lround(css * view.pixel_ratio * scale)));
    };
    return {pixels(view.width), pixels(view.height)};
}

void MeasuredTimes::add(int level, double ms, double pixels, Clock::time_point now) {
    Mean& mean = means_[static_cast<std::size_t>(level)];
    const bool goes_on = mean.last && now - *mean.last < kLately && mean.pixels == pixels;
    mean = {goes_on ? mean.ms + kNewWeight * (ms - mean.ms) : ms, pixels, now};
}

std::optional<double> MeasuredTimes::expected(int level, double pixels, int current,
                                              Clock::time_point now) const {
    const Mean& own = means_[static_cast<std::size_t>(level)];
    if (own.last && own.pixels == pixels && (level == current || now - *own.last < kLately)) return own.ms;
    const Mean& other = means_[static_cast<std::size_t>(current)];
    if (!other.last) return std::nullopt;
    return other.ms * pixels / other.pixels;
}

PacingDecision decide(const PacingInput& input) {
    using Action = PacingDecision::Action;
    const bool final_one = input.newest_samples == kStillSamples.back();
    if (!input.somebody_waits || (!input.changed && final_one)) return {};
    if (!input.encoder_free) return {};  // taking its next picture, the encoder wakes us
    const Clock::time_point quiet_at = input.last_change + kQuiet;
    if (input.now >= quiet_at) {
        const int drawn = input.changed ? 0 : input.newest_samples;
        const auto step = std::find_if(kStillSamples.begin(), kStillSamples.end(),
                                       [&](int samples) { return samples > drawn; });
        return {Action::draw, kStillLevel, *step};
    }
    if (input.changed) return {Action::draw, moving_level(input), 1};
    return {Action::wait, input.level, 1, quiet_at};
}

}  // namespace vrut
