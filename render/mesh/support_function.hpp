#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/picking_trees.hpp"
#include "scene/clip_plane.hpp"
#include "scene/scene.hpp"

namespace vrut::mesh {

/// How far what is shown at and below a node reaches in a direction: h(d) = max of d · p over its points p in
/// world space (the support function of its convex hull; Boyd, Vandenberghe, "Convex Optimization", 2.5.2).
/// Shown is what may show from anywhere, as for scene::subtree_bounds(); presentation counts only where there
/// is nothing else. Less of it is shown where clip planes cut. Exact: a box around the node would hold more.
/// The scene and `trees`, of the same scene, must outlive it; the trees change the time that it takes, and no
/// bit of the result.
class SupportFunction {
public:
    SupportFunction(const scene::PlacedScene& placed, scene::Index node, const PickingTrees* trees,
                    std::span<const scene::ClipPlane> clip_planes = {});

    /// Around the boxes of the parts; empty where nothing is shown, as where all is cut away.
    const math::Bounds& bounds() const { return bounds_; }
    /// Minus infinity where nothing is shown.
    double operator()(const glm::dvec3& direction) const;

private:
    struct Part {
        const scene::Geometry* geometry = nullptr;
        const Bvh<float>* tree = nullptr;  ///< null: its triangles are asked one by one
        glm::dmat4 world{1};
    };
    std::vector<Part> parts_;             // that no plane crosses
    std::vector<glm::dvec3> cut_points_;  // of the others: corners in world space
    math::Bounds bounds_;
};

}  // namespace vrut::mesh
