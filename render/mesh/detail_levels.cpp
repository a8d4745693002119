#include "mesh/detail_levels.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <numeric>
#include <thread>
#include <vector>

#include "base/thread_priority.hpp"
#include "mesh/vertex_cache_order.hpp"
#include "mesh/watertight.hpp"

namespace vrut::mesh {

namespace {

std::vector<DetailLevel> levels_of(const scene::Geometry& geometry, const std::atomic<bool>& stop) {
    std::vector<DetailLevel> levels = simplify(geometry, stop);
    if (stop) return levels;
    if (auto ordered = optimize_vertex_cache(geometry)) levels.insert(levels.begin(), *std::move(ordered));
    return levels;
}

}  // namespace

struct DetailLevels::LevelGenerator {
    struct LevelChain {
        std::vector<DetailLevel> levels;
        std::atomic<bool> made{false};  ///< from then on `levels` do not change
        std::atomic<bool> watertight{false};
    };

    LevelGenerator(std::shared_ptr<const scene::Scene> of, OnFailure call_on_failure)
        : scene(std::move(of)), chains(scene->geometries().size()), on_failure(std::move(call_on_failure)) {}
    void find_watertight(const std::vector<std::size_t>& order);
    void make_all();
    void report(const std::exception& error) const;
    void run();

    const std::shared_ptr<const scene::Scene> scene;
    std::vector<LevelChain> chains;  // one for each geometry
    const OnFailure on_failure;
    std::atomic<bool> stop{false}, done{false};
};

void DetailLevels::LevelGenerator::find_watertight(const std::vector<std::size_t>& order) {
    const std::vector<scene::Material>& materials = scene->materials();
    if (std::none_of(materials.begin(), materials.end(),
                     [](const scene::Material& m) { return m.two_sided; }))
        return;
    for (const std::size_t at : order)
        chains[at].watertight.store(is_watertight(scene->geometries()[at], stop), std::memory_order_relaxed);
}

void DetailLevels::LevelGenerator::make_all() {
    const std::vector<scene::Geometry>& geometries = scene->geometries();
    std::vector<std::size_t> order(geometries.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return geometries[a].triangles.size() > geometries[b].triangles.size();
    });
    find_watertight(order);
    for (const std::size_t at : order) {
        if (stop) break;
        chains[at].levels = levels_of(geometries[at], stop);
        chains[at].made.store(true, std::memory_order_release);
    }
}

/// Without memory the report may fail, too; the levels are missing all the same.
void DetailLevels::LevelGenerator::report(const std::exception& error) const {
    try {
        if (on_failure) on_failure(error.what());
    } catch (const std::exception&) {
    }
}

void DetailLevels::LevelGenerator::run() {
    base::lower_thread_priority();
    try {
        make_all();
    } catch (const std::exception& error) {
        report(error);
    }
    done = true;
    done.notify_all();
}

DetailLevels::DetailLevels(std::shared_ptr<const scene::Scene> scene, OnFailure on_failure)
    : generator_(std::make_shared<LevelGenerator>(std::move(scene), std::move(on_failure))) {
    std::thread([generator = generator_] { generator->run(); }).detach();
}

DetailLevels::~DetailLevels() { generator_->stop = true; }

const std::shared_ptr<const scene::Scene>& DetailLevels::scene() const { return generator_->scene; }

std::span<const DetailLevel> DetailLevels::of(scene::Index geometry) const {
    const LevelGenerator::LevelChain& chain = generator_->chains[static_cast<std::size_t>(geometry)];
    if (!chain.made.load(std::memory_order_acquire)) return {};
    return chain.levels;
}

bool DetailLevels::known_watertight(scene::Index geometry) const {
    return generator_->chains[static_cast<std::size_t>(geometry)].watertight.load(std::memory_order_relaxed);
}

void DetailLevels::wait() const { generator_->done.wait(false); }

bool DetailLevels::done() const { return generator_->done; }

}  // namespace vrut::mesh
