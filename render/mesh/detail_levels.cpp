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
    enum class Watertight { unknown, no, yes };
    struct LevelChain {
        std::vector<DetailLevel> levels;
        std::atomic<bool> made{false};  ///< from then on `levels` do not change
        std::atomic<Watertight> watertight{Watertight::unknown};
    };

    LevelGenerator(std::shared_ptr<const scene::Scene> of, OnFailure call_on_failure)
        : scene(std::move(of)), chains(scene->geometries().size()), on_failure(std::move(call_on_failure)) {}
    void examine(const std::vector<std::size_t>& order);
    void make_levels(const std::vector<std::size_t>& order);
    void work();
    void report(const std::exception& error) const;
    void run();

    const std::shared_ptr<const scene::Scene> scene;
    std::vector<LevelChain> chains;  // one for each geometry
    const OnFailure on_failure;
    std::atomic<bool> stop{false}, done{false}, examined{false};
};

namespace {

void set(std::atomic<bool>& flag) {
    flag = true;
    flag.notify_all();
}

std::vector<std::size_t> by_falling_size(const std::vector<scene::Geometry>& geometries) {
    std::vector<std::size_t> order(geometries.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return geometries[a].triangles.size() > geometries[b].triangles.size();
    });
    return order;
}

}  // namespace

void DetailLevels::LevelGenerator::examine(const std::vector<std::size_t>& order) {
    for (const std::size_t at : order)
        chains[at].watertight.store(
            is_watertight(scene->geometries()[at], stop) ? Watertight::yes : Watertight::no,
            std::memory_order_relaxed);
}

void DetailLevels::LevelGenerator::make_levels(const std::vector<std::size_t>& order) {
    for (const std::size_t at : order) {
        if (stop) break;
        chains[at].levels = levels_of(scene->geometries()[at], stop);
        chains[at].made.store(true, std::memory_order_release);
    }
    set(done);
}

void DetailLevels::LevelGenerator::work() {
    const std::vector<std::size_t> order = by_falling_size(scene->geometries());
    const bool culls = std::ranges::any_of(scene->materials(), &scene::Material::two_sided);
    if (culls) examine(order);
    make_levels(order);
    if (!culls) examine(order);
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
        work();
    } catch (const std::exception& error) {
        report(error);
    }
    set(done);
    set(examined);
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

std::optional<bool> DetailLevels::watertight(scene::Index geometry) const {
    using Watertight = LevelGenerator::Watertight;
    const bool examined = generator_->examined;
    const Watertight known =
        generator_->chains[static_cast<std::size_t>(geometry)].watertight.load(std::memory_order_relaxed);
    if (known == Watertight::unknown && !examined) return {};
    return known == Watertight::yes;
}

void DetailLevels::wait() const { generator_->done.wait(false); }

bool DetailLevels::done() const { return generator_->done; }

void DetailLevels::wait_until_examined() const { generator_->examined.wait(false); }

bool DetailLevels::examined() const { return generator_->examined; }

}  // namespace vrut::mesh
