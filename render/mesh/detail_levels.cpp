#include "mesh/detail_levels.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <numeric>
#include <thread>
#include <vector>

#include "mesh/vertex_cache_order.hpp"
#include "mesh/watertight.hpp"

namespace vrut {

namespace {

/// On Linux a thread has a niceness of its own.
void give_way() { static_cast<void>(setpriority(PRIO_PROCESS, 0, 10)); }

std::vector<DetailLevel> levels_of(const Geometry& geometry, const std::atomic<bool>& stop) {
    std::vector<DetailLevel> levels = simplify(geometry, stop);
    if (stop) return levels;
    if (auto ordered = cache_ordered(geometry)) levels.insert(levels.begin(), *std::move(ordered));
    return levels;
}

}  // namespace

struct DetailLevels::Making {
    struct Chain {
        std::vector<DetailLevel> levels;
        std::atomic<bool> made{false};  ///< from then on `levels` do not change
        std::atomic<bool> closed{false};
    };

    explicit Making(std::shared_ptr<const Scene> of)
        : scene(std::move(of)), chains(scene->geometries().size()) {}
    void find_closed(const std::vector<std::size_t>& order);
    void make_all();
    void run();

    const std::shared_ptr<const Scene> scene;
    std::vector<Chain> chains;  // one for each geometry
    std::atomic<bool> stop{false}, done{false};
};

void DetailLevels::Making::find_closed(const std::vector<std::size_t>& order) {
    const std::vector<Material>& materials = scene->materials();
    if (std::none_of(materials.begin(), materials.end(), [](const Material& m) { return m.two_sided; }))
        return;
    for (const std::size_t at : order)
        chains[at].closed.store(is_closed(scene->geometries()[at], stop), std::memory_order_relaxed);
}

void DetailLevels::Making::make_all() {
    const std::vector<Geometry>& geometries = scene->geometries();
    std::vector<std::size_t> order(geometries.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return geometries[a].triangles.size() > geometries[b].triangles.size();
    });
    find_closed(order);
    for (const std::size_t at : order) {
        if (stop) break;
        chains[at].levels = levels_of(geometries[at], stop);
        chains[at].made.store(true, std::memory_order_release);
    }
}

void DetailLevels::Making::run() {
    give_way();
    try {
        make_all();
    } catch (const std::exception&) {
        // Most likely there is no memory; the scene is drawn without what is missing.
    }
    done = true;
    done.notify_all();
}

DetailLevels::DetailLevels(std::shared_ptr<const Scene> scene)
    : making_(std::make_shared<Making>(std::move(scene))) {
    std::thread([making = making_] { making->run(); }).detach();
}

DetailLevels::~DetailLevels() { making_->stop = true; }

const std::shared_ptr<const Scene>& DetailLevels::scene() const { return making_->scene; }

std::span<const DetailLevel> DetailLevels::of(Index geometry) const {
    const Making::Chain& chain = making_->chains[static_cast<std::size_t>(geometry)];
    if (!chain.made.load(std::memory_order_acquire)) return {};
    return chain.levels;
}

bool DetailLevels::closed(Index geometry) const {
    return making_->chains[static_cast<std::size_t>(geometry)].closed.load(std::memory_order_relaxed);
}

void DetailLevels::wait() const { making_->done.wait(false); }

bool DetailLevels::done() const { return making_->done; }

}  // namespace vrut
