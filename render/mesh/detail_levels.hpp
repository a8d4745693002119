#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "mesh/simplification.hpp"

namespace vrut::mesh {

/// What makes a scene faster to draw, computed on a thread of low priority, geometries with the most
/// triangles first: which of them are watertight (is_watertight), then an order of triangles that suits the
/// vertex cache, and coarser levels of detail. If a computation fails, the levels that were made by then
/// remain.
class DetailLevels {
public:
    /// Receives why no more levels can be made, most likely for want of memory. Called at most once, on the
    /// thread that makes them.
    using OnFailure = std::function<void(const std::string& reason)>;
    /// Throws std::system_error if no thread can be started.
    explicit DetailLevels(std::shared_ptr<const scene::Scene> scene, OnFailure on_failure = {});
    /// Does not wait for the thread, whose step for millions of triangles takes seconds. The thread ends
    /// after that step, and owns the scene until then.
    ~DetailLevels();
    DetailLevels(const DetailLevels&) = delete;
    DetailLevels& operator=(const DetailLevels&) = delete;

    const std::shared_ptr<const scene::Scene>& scene() const;
    /// The levels of a geometry, from fine to coarse: their errors rise. Empty until all of its levels are
    /// made. Callable from any thread; the span stays valid as long as this object.
    std::span<const DetailLevel> of(scene::Index geometry) const;
    /// True if the geometry was found to be watertight. Only scenes with a two-sided material are examined.
    bool known_watertight(scene::Index geometry) const;
    void wait() const;  ///< until all levels are made, or their making has failed
    bool done() const;

private:
    struct LevelGenerator;
    std::shared_ptr<LevelGenerator> generator_;  // shared with the thread
};

}  // namespace vrut::mesh
