#pragma once

#include <memory>
#include <span>

#include "mesh/simplification.hpp"

namespace vrut::mesh {

/// What makes a scene faster to draw, made one geometry after the other on a thread of low priority, those
/// with the most triangles first: which of them are closed; and then a better order of their triangles, where
/// the file's is a bad one, and coarser surfaces. Where memory is short, those that are made by then are all.
class DetailLevels {
public:
    explicit DetailLevels(std::shared_ptr<const scene::Scene> scene);
    /// Gives up what is not made yet, and waits for nothing: one call for millions of triangles takes
    /// seconds. The thread ends by itself soon after, and holds the scene until then.
    ~DetailLevels();
    DetailLevels(const DetailLevels&) = delete;
    DetailLevels& operator=(const DetailLevels&) = delete;

    const std::shared_ptr<const scene::Scene>& scene() const;
    /// Of a geometry, from fine to coarse: their errors rise. Empty until all of its levels are made. From
    /// any thread; they stay where they are.
    std::span<const DetailLevel> of(scene::Index geometry) const;
    /// Whether a geometry is known to be closed (is_watertight); asked only where a material is two-sided.
    bool known_watertight(scene::Index geometry) const;
    void wait() const;  ///< until no more are made
    bool done() const;

private:
    struct LevelGenerator;
    std::shared_ptr<LevelGenerator> generator_;  // the thread's, too
};

}  // namespace vrut::mesh
