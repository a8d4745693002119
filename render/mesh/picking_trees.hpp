#pragma once

#include <memory>

#include "mesh/bvh.hpp"
#include "scene/scene.hpp"

namespace vrut::mesh {

/// Hierarchies of the triangles of a scene's geometries, for pick(). They are built one after the other on a
/// thread of low priority, those of the most triangles first. Where memory is short, those that are built by
/// then are all; where no thread can be had, none is.
class PickingTrees {
public:
    explicit PickingTrees(std::shared_ptr<const scene::Scene> scene);
    /// Does not wait for the thread, which ends after the tree that it is building and holds the scene until
    /// then.
    ~PickingTrees();
    PickingTrees(const PickingTrees&) = delete;
    PickingTrees& operator=(const PickingTrees&) = delete;

    /// Of a geometry, in the space of tree_scale(). Null until it is built, of few triangles, and where a
    /// position is not finite. From any thread.
    const Bvh<float>* of(scene::Index geometry) const;
    void wait() const;               ///< until no more are built
    std::size_t size_bytes() const;  ///< memory of those that are built

private:
    struct Builder;
    std::shared_ptr<Builder> builder_;  // the thread's, too
};

/// A tree's space is centred at the geometry's box and its unit is this many of the geometry's: coordinates
/// are -1 to 1, where float has room for any geometry.
double tree_scale(const scene::Geometry& geometry);

}  // namespace vrut::mesh
