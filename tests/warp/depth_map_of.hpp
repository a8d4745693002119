#pragma once

#include <span>

#include "warp/depth_map.hpp"

namespace vrut::warp {

/// Of an image whose depth comes at once.
inline DepthMap depth_map_of(std::span<const float> depth, int width, int height, double near_distance,
                             const DepthMapSize& size, std::span<const float> added = {}) {
    DepthSamples samples(width, height, size);
    samples.add(depth);
    return samples.map(near_distance, added);
}

}  // namespace vrut::warp
