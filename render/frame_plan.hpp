#pragma once

#include <string>
#include <vector>

#include "camera.hpp"
#include "scene.hpp"

namespace vrut {

enum class Sides { front, both };

/// One geometry node to be drawn.
struct DrawItem {
    Index node = kNone, geometry = kNone, material = kNone;
    glm::dmat4 view_from_node{1};
    Sides sides = Sides::front;
    bool mirrored = false;  ///< the matrix turns counter-clockwise triangles clockwise
};

/// What a frame needs, and no more: a pass without items does not run.
struct FramePlan {
    std::vector<DrawItem> opaque;
};

FramePlan plan_frame(const PlacedScene& placed, const Camera& camera);

/// A sentence for each thing that the scene holds and the renderer does not draw.
std::vector<std::string> undrawn_features(const Scene& scene);

}  // namespace vrut
