#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vrut::warp {

/// How far away the surfaces of an image are, in blocks of its pixels, rows from the top down. Distances are
/// kept as their reciprocals, which are linear in the image where a surface is a plane.
struct DepthMap {
    static constexpr int kSteps = 255;  ///< the nearest surface of the image; 0: infinitely far
    static constexpr int kBits = 4;     ///< of a block's mask, in each direction

    int columns = 0, rows = 0;
    double scale = 0;  ///< reciprocal distance of the nearest surface along the view, in 1/scene unit
    /// Of each block, the reciprocal distances of what is nearer and of what is farther; equal where no edge
    /// goes through it.
    std::vector<std::uint8_t> near, far;
    /// Bit kBits · row + column, from the block's top left, is set where that part of it shows what is
    /// nearer.
    std::vector<std::uint16_t> mask;

    bool operator==(const DepthMap&) const = default;
};

struct DepthMapSize {
    int columns = 0, rows = 0;
};
/// With blocks of so many pixels a side, or of more where there would be over kMostBlocks a side.
DepthMapSize depth_map_size(int width, int height, double pixels);
inline constexpr int kMostBlocks = 128;

/// Chooses the size of blocks, by what maps before took, so that a map takes up to kMostOfFrame of the bytes
/// of its frame, or kEnough bytes, below which a warp is worse than none.
class BlockChoice {
public:
    static constexpr double kMostOfFrame = 0.15, kEnough = 1500, kFinest = 4, kCoarsest = 32;
    double pixels() const { return pixels_; }
    void took(std::size_t map_bytes, std::size_t frame_bytes);

private:
    double pixels_ = 8;
};

inline constexpr int kAddedSide = 2;

/// The depth of an image of `width` · `height` pixels at the middle of each part of its blocks. Depth is
/// near_distance / distance along the view, and 0 at infinity (math::reversed_clip_from_view). Pixels may be
/// larger or smaller than parts.
class DepthSamples {
public:
    DepthSamples(int width, int height, const DepthMapSize& size);
    /// The next rows, from the bottom up: an image may come in strips, which stay in the processor's cache.
    void add(std::span<const float> depth);
    /// Once all rows have come. `added`: the depth of what the image's has not, in kAddedSide samples a
    /// side for each block, rows from the bottom up; the nearer counts. Empty: none.
    DepthMap map(double near_distance, std::span<const float> added = {}) const;

private:
    DepthMapSize size_;
    std::size_t width_;
    std::vector<std::uint32_t> columns_, rows_;  // pixels with samples, padded; rows from the bottom up
    std::vector<float> values_;                  // of rows_ that have come
    float nearest_ = 0;
    std::size_t row_ = 0;  // the next one
};

/// In the format of zlib (RFC 1950): for each block the difference of its `far` from what its neighbours make
/// expect; a bit for each block, set if an edge goes through it; and of those blocks the difference of `near`
/// from that of the neighbours, then two bytes of `mask`.
std::string encode(const DepthMap& map);
/// None where the bytes are not those of a map of this size.
std::optional<DepthMap> decode(std::string_view bytes, int columns, int rows, double scale);

}  // namespace vrut::warp
