#include "measurement/mesh_edges.hpp"

#include <algorithm>
#include <utility>

#include "measurement/feature_graph.hpp"

namespace vrut::measurement {

namespace {

/// Of 20 degrees, less a little: what bends by just that much is smooth.
constexpr double kFeatureCosine = 0.9396926207859084 - 1e-6;

bool is_fold(const WeldedMesh& mesh, unsigned half_edge) {
    const glm::dvec3& here = mesh.normal(half_edge / 3);
    const glm::dvec3& there = mesh.normal(mesh.twin(half_edge) / 3);
    if (here == glm::dvec3(0) || there == glm::dvec3(0)) return false;
    const double cosine = glm::dot(here, there);
    return (mesh.agrees_with_twin(half_edge) ? cosine : -cosine) < kFeatureCosine;
}

}  // namespace

MeshEdges::MeshEdges(const scene::Geometry& geometry) : mesh_(geometry) {
    find_feature_edges();
    const std::vector<glm::dvec3>& positions = mesh_.positions();
    triangle_blocks_.build(mesh_.triangles().size(), [&](std::size_t triangle, math::Bounds& box) {
        for (int k = 0; k < 3; ++k) box.add(positions[mesh_.triangles()[triangle][k]]);
    });
    const std::size_t count = chain_vertices_.size();
    chain_blocks_.build(count, [&](std::size_t at, math::Bounds& box) {
        box.add(positions[chain_vertices_[at]]);
        if (at + 1 < count) box.add(positions[chain_vertices_[at + 1]]);
    });
}

void MeshEdges::find_feature_edges() {
    is_feature_.resize(mesh_.half_edge_count());
    std::vector<std::pair<unsigned, unsigned>> edges;
    for (unsigned half_edge = 0; half_edge < is_feature_.size(); ++half_edge) {
        const bool is_feature = mesh_.twin(half_edge) == WeldedMesh::kNone || is_fold(mesh_, half_edge);
        is_feature_[half_edge] = is_feature;
        if (is_feature && mesh_.is_first_of_edge(half_edge))
            edges.emplace_back(mesh_.start_of(half_edge), mesh_.end_of(half_edge));
    }
    const FeatureGraph graph(mesh_.positions(), edges);
    is_corner_ = graph.corners();
    FeatureGraph::Chains chains = graph.chains(is_corner_);
    chain_vertices_ = std::move(chains.vertices);
    first_of_chain_ = std::move(chains.first);
}

std::vector<unsigned> MeshEdges::triangles_near(const math::Bounds& box) const {
    std::vector<unsigned> near;
    triangle_blocks_.visit(box, [&](std::size_t triangle) {
        math::Bounds bounds;
        for (int k = 0; k < 3; ++k) bounds.add(mesh_.positions()[mesh_.triangles()[triangle][k]]);
        if (overlap(bounds, box)) near.push_back(static_cast<unsigned>(triangle));
    });
    return near;
}

std::vector<std::size_t> MeshEdges::chains_near(const math::Bounds& box) const {
    std::vector<std::size_t> near;
    chain_blocks_.visit(box, [&](std::size_t at) {
        const auto end = std::upper_bound(first_of_chain_.begin(), first_of_chain_.end(), at);
        const auto chain = static_cast<std::size_t>(end - first_of_chain_.begin()) - 1;
        if (at + 1 == *end || (!near.empty() && near.back() == chain)) return;
        math::Bounds bounds;
        bounds.add(mesh_.positions()[chain_vertices_[at]]);
        bounds.add(mesh_.positions()[chain_vertices_[at + 1]]);
        if (overlap(bounds, box)) near.push_back(chain);
    });
    return near;
}

const MeshEdges& MeshEdgesMemo::of(const std::shared_ptr<const scene::Scene>& scene, scene::Index geometry) {
    if (scene_.lock() != scene) {
        scene_ = scene;
        known_.clear();
        known_.resize(scene->geometries().size());
    }
    const auto at = static_cast<std::size_t>(geometry);
    if (!known_[at]) known_[at] = std::make_unique<const MeshEdges>(scene->geometries()[at]);
    return *known_[at];
}

}  // namespace vrut::measurement
