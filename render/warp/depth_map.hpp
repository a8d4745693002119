#pragma once

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
inline constexpr int kMostBlocks = 160;

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

/// `depth` of `width` · `height` pixels, rows from the bottom up, is near_distance / distance along the view,
/// and 0 at infinity (math::reversed_clip_from_view). Its pixels may be larger or smaller than blocks are.
/// `added`: the same of what it has not, in kAddedSide samples a side for each block; the nearer counts.
/// Empty: none.
DepthMap depth_map_of(std::span<const float> depth, int width, int height, double near_distance,
                      const DepthMapSize& size, std::span<const float> added = {});
inline constexpr int kAddedSide = 2;

/// In the format of zlib (RFC 1950): for each block the difference of its `far` from what its neighbours make
/// expect; a bit for each block, set if an edge goes through it; and of those blocks the difference of `near`
/// from that of the neighbours, then two bytes of `mask`.
std::string encode(const DepthMap& map);
/// None where the bytes are not those of a map of this size.
std::optional<DepthMap> decode(std::string_view bytes, int columns, int rows, double scale);

}  // namespace vrut::warp
