#include "mesh/picking_trees.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <numeric>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

#include "base/thread_priority.hpp"

namespace vrut::mesh {

namespace {

constexpr std::size_t kNoTreeBelow = 64;  ///< as quickly asked one by one

bool is_finite_position(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The nearest float on either side, so that the box holds what was rounded.
Bvh<float>::Box rounded_outwards(const glm::dvec3& low, const glm::dvec3& high) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Bvh<float>::Box box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = std::nextafter(static_cast<float>(low[axis]), -kInfinity);
        box.max[axis] = std::nextafter(static_cast<float>(high[axis]), kInfinity);
    }
    return box;
}

std::optional<Bvh<float>> tree_of(const scene::Geometry& geometry) {
    const double scale = tree_scale(geometry);
    if (geometry.triangles.size() <= kNoTreeBelow || !(scale > 0) || !std::isfinite(1 / scale)) return {};
    const glm::dvec3 center = geometry.bounds.center();
    std::vector<Bvh<float>::Box> boxes;
    boxes.reserve(geometry.triangles.size());
    for (const glm::uvec3& t : geometry.triangles) {
        const auto corner = [&](int k) { return (geometry.positions[t[k]] - center) / scale; };
        const glm::dvec3 a = corner(0), b = corner(1), c = corner(2);
        // No box holds such a triangle.
        if (!is_finite_position(a) || !is_finite_position(b) || !is_finite_position(c)) return {};
        boxes.push_back(rounded_outwards(glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))));
    }
    return Bvh<float>(boxes);
}

}  // namespace

double tree_scale(const scene::Geometry& geometry) {
    const glm::dvec3 half = geometry.bounds.half_extent();
    return std::max({half.x, half.y, half.z});
}

struct PickingTrees::Builder {
    struct Tree {
        std::optional<Bvh<float>> tree;
        std::atomic<bool> built{false};  ///< from then on `tree` does not change
    };

    explicit Builder(std::shared_ptr<const scene::Scene> of)
        : scene(std::move(of)), trees(scene->geometries().size()) {}
    void build_all();
    void run();

    const std::shared_ptr<const scene::Scene> scene;
    std::vector<Tree> trees;  // one for each geometry
    std::atomic<bool> stop{false}, done{false};
};

void PickingTrees::Builder::build_all() {
    const std::vector<scene::Geometry>& geometries = scene->geometries();
    std::vector<std::size_t> order(geometries.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return geometries[a].triangles.size() > geometries[b].triangles.size();
    });
    for (const std::size_t at : order) {
        if (stop) return;
        trees[at].tree = tree_of(geometries[at]);
        trees[at].built.store(true, std::memory_order_release);
    }
}

void PickingTrees::Builder::run() {
    base::lower_thread_priority();
    try {
        build_all();
    } catch (const std::exception&) {
        // Most likely there is no memory; pick() asks the triangles of the other geometries one by one.
    }
    done = true;
    done.notify_all();
}

PickingTrees::PickingTrees(std::shared_ptr<const scene::Scene> scene)
    : builder_(std::make_shared<Builder>(std::move(scene))) {
    try {
        std::thread([builder = builder_] { builder->run(); }).detach();
    } catch (const std::system_error&) {
        builder_->done = true;
    }
}

PickingTrees::~PickingTrees() { builder_->stop = true; }

const Bvh<float>* PickingTrees::of(scene::Index geometry) const {
    const Builder::Tree& tree = builder_->trees[static_cast<std::size_t>(geometry)];
    return tree.built.load(std::memory_order_acquire) && tree.tree ? &*tree.tree : nullptr;
}

void PickingTrees::wait() const { builder_->done.wait(false); }

std::size_t PickingTrees::size_bytes() const {
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < builder_->trees.size(); ++i)
        if (const Bvh<float>* tree = of(static_cast<scene::Index>(i))) bytes += tree->size_bytes();
    return bytes;
}

}  // namespace vrut::mesh
