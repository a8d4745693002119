#include "engine/frame_quality.hpp"

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

}  // namespace vrut::server::engine
