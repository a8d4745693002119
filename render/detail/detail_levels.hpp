#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <thread>
#include <vector>

#include "simplify.hpp"

namespace vrut {

/// What makes a scene faster to draw, made one geometry after the other on a thread of low priority, those
/// with the most triangles first: which of them are closed; and then a better order of their triangles, where
/// the file's is a bad one, and coarser surfaces.
class DetailLevels {
public:
    explicit DetailLevels(std::shared_ptr<const Scene> scene);
    /// Gives up what is not made yet; waits for the level that is being made.
    ~DetailLevels();
    DetailLevels(const DetailLevels&) = delete;
    DetailLevels& operator=(const DetailLevels&) = delete;

    const std::shared_ptr<const Scene>& scene() const { return scene_; }
    /// Of a geometry, from fine to coarse: their errors rise. Empty until all of its levels are made. From
    /// any thread; they stay where they are.
    std::span<const DetailLevel> of(Index geometry) const;
    /// Whether a geometry is known to be closed (is_closed); asked only where a material is two-sided.
    bool closed(Index geometry) const;
    void wait() const;  ///< until all are made
    bool done() const { return done_; }

private:
    struct Chain {
        std::vector<DetailLevel> levels;
        std::atomic<bool> made{false};  ///< from then on `levels` do not change
        std::atomic<bool> closed{false};
    };
    void find_closed(const std::vector<std::size_t>& order);
    void make_all();

    std::shared_ptr<const Scene> scene_;
    std::vector<Chain> chains_;  // one for each geometry
    std::atomic<bool> stop_{false}, done_{false};
    std::thread thread_;  // last: it uses all of the above
};

}  // namespace vrut
