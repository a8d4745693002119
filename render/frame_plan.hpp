#pragma once

#include <string>
#include <vector>

#include "scene.hpp"
#include "view.hpp"

namespace vrut {

enum class Sides { front, both };

/// One geometry node to be drawn.
struct DrawItem {
    Index node = kNone, geometry = kNone, material = kNone;
    glm::dmat4 view_from_node{1};
    Sides sides = Sides::front;
    bool mirrored = false;     ///< the matrix turns counter-clockwise triangles clockwise
    Index texture = kNone;     ///< whose colour stands in the place of the material's diffuse one
    bool environment = false;  ///< mixed with the panorama that it reflects
};

/// Faces that are drawn from one sight, in this order.
struct Layers {
    std::vector<DrawItem> opaque;  ///< by rising id
};

/// What a frame needs, and no more: a pass without items does not run. Each by rising id.
struct FramePlan {
    Layers scene;
    std::vector<DrawItem> edges;     ///< with edges
    std::vector<DrawItem> selected;  ///< to be marked
};

/// Whether a geometry in that material is a planar mirror; other reflective ones reflect the panorama.
bool is_mirror(const Scene& scene, Index geometry, Index material);

/// Empty where the view has no scene.
FramePlan plan_frame(const View& view);

/// Geometry nodes of a scene by what their material is.
struct ClassCounts {
    std::uint64_t solid = 0;
    std::uint64_t transparent = 0;  ///< as Scene::is_transparent()
    std::uint64_t reflective = 0;   ///< opaque, with reflectivity above 0

    bool operator==(const ClassCounts&) const = default;
};
ClassCounts count_classes(const PlacedScene& placed);

/// A sentence for each thing that the scene holds and the renderer does not draw.
std::vector<std::string> undrawn_features(const Scene& scene);

}  // namespace vrut
