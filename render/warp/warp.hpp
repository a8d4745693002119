#pragma once

#include <glm/glm.hpp>

#include "scene/camera.hpp"
#include "scene/image.hpp"
#include "warp/depth_map.hpp"

namespace vrut::warp {

/// From an image's normalized device coordinates x, y and reciprocal distance d along the view, as
/// (x, y, 1, d), to the same of another camera: of the product m, (m.x, m.y, m.w) / m.z.
glm::dmat4 warp_matrix(const scene::Camera& from, const scene::Camera& to, double aspect);

/// Of what is infinitely far: it turns with the camera, or stays where it is in the image, as a colour or a
/// texture behind the scene does.
enum class Background { turns, stays };

/// What `to` sees of an image that `from` has taken, in the image's size: a grid of the blocks' centres, of
/// which no triangle spans a step of depth (Mark, McMillan and Bishop, "Post-Rendering 3D Warping", 1997).
/// What a surface hid and now does not is taken to look like what is seen beside it, and what is beside the
/// image like its side.
scene::Image warped(const scene::Image& image, const DepthMap& depth, const scene::Camera& from,
                    const scene::Camera& to, Background background);

/// The blocks as the two layers of the grid have them: where an edge goes through a block or beside it, the
/// one has what is nearer, and the other what is farther. There a part of a block belongs to the first layer
/// if its bit in `mask` is set; elsewhere both layers are the same, and blocks belong to both.
struct Layers {
    std::vector<std::uint8_t> near, far;
    std::vector<std::uint16_t> mask;
    /// By how much the layer rises from a block to the next beside and below it, together: on the side where
    /// that is less.
    std::vector<std::uint8_t> near_slope, far_slope;
    /// Of those up to two blocks beside it, or itself, the one that shows what is farthest.
    std::vector<std::uint32_t> farthest;
};
Layers layers_of(const DepthMap& map);

/// A triangle of the grid that spans more steps, beside twice its slope, is no surface, and neither is one
/// that reaches infinity.
inline constexpr int kGap = 16;

}  // namespace vrut::warp
