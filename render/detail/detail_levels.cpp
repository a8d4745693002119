#include "detail_levels.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <numeric>

#include "cache_order.hpp"
#include "closed.hpp"

namespace vrut {

namespace {

/// On Linux a thread has a niceness of its own.
void give_way() { static_cast<void>(setpriority(PRIO_PROCESS, 0, 10)); }

std::vector<DetailLevel> levels_of(const Geometry& geometry, const std::atomic<bool>& stop) {
    std::vector<DetailLevel> levels = simplify(geometry, stop);
    if (auto ordered = cache_ordered(geometry)) levels.insert(levels.begin(), *std::move(ordered));
    return levels;
}

}  // namespace

DetailLevels::DetailLevels(std::shared_ptr<const Scene> scene)
    : scene_(std::move(scene)), chains_(scene_->geometries().size()), thread_([this] { make_all(); }) {}

DetailLevels::~DetailLevels() {
    stop_ = true;
    thread_.join();
}

std::span<const DetailLevel> DetailLevels::of(Index geometry) const {
    const Chain& chain = chains_[static_cast<std::size_t>(geometry)];
    if (!chain.made.load(std::memory_order_acquire)) return {};
    return chain.levels;
}

bool DetailLevels::closed(Index geometry) const {
    return chains_[static_cast<std::size_t>(geometry)].closed.load(std::memory_order_relaxed);
}

void DetailLevels::wait() const { done_.wait(false); }

void DetailLevels::find_closed(const std::vector<std::size_t>& order) {
    const std::vector<Material>& materials = scene_->materials();
    if (std::none_of(materials.begin(), materials.end(), [](const Material& m) { return m.two_sided; }))
        return;
    for (const std::size_t at : order)
        chains_[at].closed.store(is_closed(scene_->geometries()[at], stop_), std::memory_order_relaxed);
}

void DetailLevels::make_all() {
    give_way();
    const std::vector<Geometry>& geometries = scene_->geometries();
    std::vector<std::size_t> order(geometries.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return geometries[a].triangles.size() > geometries[b].triangles.size();
    });
    find_closed(order);
    for (const std::size_t at : order) {
        if (stop_) break;
        chains_[at].levels = levels_of(geometries[at], stop_);
        chains_[at].made.store(true, std::memory_order_release);
    }
    done_ = true;
    done_.notify_all();
}

}  // namespace vrut
