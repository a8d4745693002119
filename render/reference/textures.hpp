#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "scene/scene.hpp"

namespace vrut::reference {

/// An image and its halves, each made from the one before by a box filter weighted by area: floor(n / 2)
/// texels a side, 1 at least.
class MipMap {
public:
    explicit MipMap(const scene::Image& image);
    /// Of given levels, the largest first.
    explicit MipMap(const std::vector<const scene::Image*>& levels);

    int levels() const { return static_cast<int>(levels_.size()); }
    int width(int level) const { return levels_[static_cast<std::size_t>(level)].width; }
    int height(int level) const { return levels_[static_cast<std::size_t>(level)].height; }
    const glm::dvec4& texel(int level, int x, int y) const;

    /// Returns RGBA, 0 to 1, at `uv` ((0, 0) is the bottom left). `change` holds the derivatives of uv
    /// with respect to the pixel's x (right) and y (up). If the longer side of the pixel's footprint exceeds
    /// one texel, filtering is trilinear between the two nearest levels, else bilinear in level 0. If the
    /// sampler magnifies by the nearest texel, level 0 shows the texel in which `uv` lies instead.
    glm::dvec4 sample(const glm::dvec2& uv, const std::array<glm::dvec2, 2>& change,
                      const scene::Sampler& sampler) const;

private:
    struct MipLevel {
        int width = 0, height = 0;
        std::vector<glm::dvec4> texels;  // rows from the bottom up
    };
    static MipLevel level_of(const scene::Image& image);
    static MipLevel half_of(const MipLevel& level);

    std::vector<MipLevel> levels_;
};

/// Six square images of one size, each what a camera at the world's origin with 90° sees that looks along
/// +x, -x, +y, -y, +z, -z; its top is +y, but +z for +y and -z for -y.
class CubeMap {
public:
    explicit CubeMap(const std::array<const scene::Image*, 6>& images);
    /// Of given levels, the largest first.
    explicit CubeMap(const std::vector<std::array<scene::Image, 6>>& levels);

    /// RGB in a direction of the world (of any length) that changes so from a pixel to the next; as
    /// MipMap::sample, on the face that the direction meets, and filtered across its edges.
    glm::dvec3 sample(const glm::dvec3& direction, const std::array<glm::dvec3, 2>& change) const;

    /// RGB at a level, between two of them.
    glm::dvec3 sample(const glm::dvec3& direction, double level) const;

private:
    glm::dvec4 texel(std::size_t face, int level, int x, int y) const;
    glm::dvec4 bilinear(std::size_t face, int level, const glm::dvec2& uv) const;

    std::array<MipMap, 6> faces_;
};

}  // namespace vrut::reference
