#pragma once

#include <array>
#include <functional>
#include <string>

#include "plan/view.hpp"
#include "scene/image.hpp"
#include "scene/scene.hpp"

namespace vrut {

/// What a texture shows, in double: bilinear, and trilinear between levels that are box filtered.
class ExpectedTexture {
public:
    explicit ExpectedTexture(const scene::Image& image);

    /// RGB, 0 to 1. The pixel reaches from `place` by `across` and by `up`; (0, 0) is the bottom left, (1, 1)
    /// the top right.
    glm::dvec3 at(const glm::dvec2& uv, const glm::dvec2& across, const glm::dvec2& up,
                  bool repeat = true) const;
    int levels() const { return static_cast<int>(levels_.size()); }
    /// A texel of a level; rows from the bottom.
    const glm::dvec3& texel(int level, int x, int y) const;
    glm::ivec2 size(int level) const { return levels_[static_cast<std::size_t>(level)].size; }

private:
    struct ExpectedMipLevel {
        glm::ivec2 size{0};
        std::vector<glm::dvec3> texels;
    };
    glm::dvec3 bilinear(int level, const glm::dvec2& uv, bool repeat) const;
    std::vector<ExpectedMipLevel> levels_;
};

/// A panorama of six pictures px nx py ny pz nz, each seen by a camera with 90° at the origin.
class ExpectedEnvironment {
public:
    explicit ExpectedEnvironment(const std::array<scene::Image, 6>& images);

    /// RGB, 0 to 1, in a direction of any length, which changes by `across` and `up` over the pixel.
    glm::dvec3 at(const glm::dvec3& direction, const glm::dvec3& across, const glm::dvec3& up) const;

    /// How the pictures were taken.
    struct ExpectedFace {
        glm::dvec3 view, up;
        glm::dvec3 right() const { return glm::cross(view, up); }
    };
    static const std::array<ExpectedFace, 6> kFaces;

private:
    glm::dvec3 bilinear(std::size_t face, int level, const glm::dvec2& uv) const;
    glm::dvec3 texel(std::size_t face, int level, const glm::ivec2& at) const;
    std::vector<ExpectedTexture> faces_;
};

/// log2 of the longer side of a pixel, in texels; 0 where it is shorter than one.
double expected_level(const glm::dvec2& across, const glm::dvec2& up);

/// Every texel different and unlike its neighbours.
scene::Image noise(int width, int height, unsigned seed = 1);
/// As if many such were laid over each other, from coarse to fine: what a photograph is like.
scene::Image cloudy(int width, int height, unsigned seed = 1);

/// Of 255: the largest difference of a channel, and the root of the mean square.
struct TextureMismatch {
    double worst = 0, rms = 0;
    std::string where;
    int pixels = 0;
};
/// Compares each pixel for which something is expected; x and y from the top left, centres at halves.
TextureMismatch deviation(const scene::Image& image,
                          const std::function<std::optional<glm::dvec3>(double x, double y)>& expected);

/// World space direction, not unit, from the eye through a place of the picture in pixels from its top left.
glm::dvec3 ray_through(const plan::View& view, double x, double y);

}  // namespace vrut
