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
    std::vector<math::Bounds> boxes;
    boxes.reserve(mesh_.triangles().size());
    for (unsigned triangle = 0; triangle < mesh_.triangles().size(); ++triangle)
        boxes.push_back(triangle_bounds(triangle));
    triangle_blocks_ = BlockBounds(boxes);
    boxes.clear();
    boxes.reserve(chain_vertices_.size());
    for (std::size_t at = 0; at < chain_vertices_.size(); ++at) boxes.push_back(chain_edge_bounds(at));
    chain_blocks_ = BlockBounds(boxes);
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

math::Bounds MeshEdges::triangle_bounds(unsigned triangle) const {
    math::Bounds bounds;
    for (int k = 0; k < 3; ++k) bounds.add(mesh_.positions()[mesh_.triangles()[triangle][k]]);
    return bounds;
}

math::Bounds MeshEdges::chain_edge_bounds(std::size_t at) const {
    math::Bounds bounds;
    for (const std::size_t end : {at, std::min(at + 1, chain_vertices_.size() - 1)})
        bounds.add(mesh_.positions()[chain_vertices_[end]]);
    return bounds;
}

std::size_t MeshEdges::chain_of(std::size_t at) const {
    const auto next = std::upper_bound(first_of_chain_.begin(), first_of_chain_.end(), at);
    return static_cast<std::size_t>(next - first_of_chain_.begin()) - 1;
}

std::optional<std::vector<unsigned>> MeshEdges::triangles_near(const math::Bounds& box,
                                                               std::size_t most) const {
    std::vector<unsigned> near;
    triangle_blocks_.visit(box, [&](unsigned triangle) {
        if (near.size() <= most && overlap(triangle_bounds(triangle), box)) near.push_back(triangle);
    });
    if (near.size() > most) return {};
    std::sort(near.begin(), near.end());
    return near;
}

std::vector<std::size_t> MeshEdges::chains_near(const math::Bounds& box) const {
    std::vector<std::size_t> near;
    chain_blocks_.visit(box, [&](unsigned at) {
        if (!overlap(chain_edge_bounds(at), box)) return;
        const std::size_t chain = chain_of(at);
        if (at + 1 < first_of_chain_[chain + 1]) near.push_back(chain);
    });
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
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
