#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "mesh/simplification.hpp"

namespace vrut::mesh {

/// What is worked out about a scene's geometries on a thread of low priority, those with the most triangles
/// first: an order of triangles that suits the vertex cache, coarser levels of detail, and whether they are
/// watertight (is_watertight). That comes before the levels where a material of the scene is two-sided, for
/// backface culling; else after them. If a computation fails, what was found by then remains.
class DetailLevels {
public:
    /// Receives why no more can be found out, most likely for want of memory. Called at most once, on the
    /// thread that makes the levels; after wait() where it is an examination that fails.
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
    /// Whether the geometry is watertight; none until it is examined, false where that failed. Callable from
    /// any thread.
    std::optional<bool> watertight(scene::Index geometry) const;
    void wait() const;  ///< until all levels are made, or their making has failed
    bool done() const;
    void wait_until_examined() const;  ///< until watertight() is known of all geometries; implies wait()
    bool examined() const;

private:
    struct LevelGenerator;
    std::shared_ptr<LevelGenerator> generator_;  // shared with the thread
};

}  // namespace vrut::mesh
