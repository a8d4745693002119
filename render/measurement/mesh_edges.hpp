#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "measurement/block_bounds.hpp"
#include "measurement/welded_mesh.hpp"
#include "scene/scene.hpp"

namespace vrut::measurement {

/// The edges of a geometry that a viewer sees as such, in the geometry's space. A feature edge belongs to one
/// triangle, to more than two, or to two whose normals differ by more than 20 degrees. A corner is a vertex
/// in which other than two feature edges meet, or two that turn by more than 40 degrees. A million triangles
/// take a third of a second, or twice that where each has corners of its own and the file is in no order.
class MeshEdges {
public:
    explicit MeshEdges(const scene::Geometry& geometry);

    const WeldedMesh& mesh() const { return mesh_; }
    bool is_feature(unsigned half_edge) const { return is_feature_[half_edge]; }
    bool is_corner(unsigned vertex) const { return is_corner_[vertex]; }
    /// Feature edges from corner to corner, or all around.
    std::size_t chain_count() const { return first_of_chain_.size() - 1; }
    /// Its vertices in order. The last one of a closed chain is the first one again, where it turns most.
    std::span<const unsigned> chain(std::size_t index) const {
        return std::span(chain_vertices_)
            .subspan(first_of_chain_[index], first_of_chain_[index + 1] - first_of_chain_[index]);
    }
    /// Triangles whose boxes overlap with this one, by rising number. None if there are more than `most`.
    std::optional<std::vector<unsigned>> triangles_near(
        const math::Bounds& box, std::size_t most = std::numeric_limits<std::size_t>::max()) const;
    /// Chains that have an edge whose box overlaps with this one, by rising number.
    std::vector<std::size_t> chains_near(const math::Bounds& box) const;

private:
    void find_feature_edges();
    math::Bounds triangle_bounds(unsigned triangle) const;
    /// Of the edge from there on in chain_vertices_, to the next chain where one ends.
    math::Bounds chain_edge_bounds(std::size_t at) const;
    std::size_t chain_of(std::size_t at) const;

    WeldedMesh mesh_;
    std::vector<bool> is_feature_;  // by half-edge
    std::vector<bool> is_corner_;   // by vertex
    std::vector<unsigned> chain_vertices_;
    std::vector<std::size_t> first_of_chain_;  // in chain_vertices_, and their end
    BlockBounds triangle_blocks_, chain_blocks_;
};

/// The edges of a scene's geometries, found when they are first asked for.
class MeshEdgesMemo {
public:
    /// Holds until a geometry of another scene is asked for.
    const MeshEdges& of(const std::shared_ptr<const scene::Scene>& scene, scene::Index geometry);

private:
    std::weak_ptr<const scene::Scene> scene_;              // of what is known; not kept alive by it
    std::vector<std::unique_ptr<const MeshEdges>> known_;  // by geometry
};

}  // namespace vrut::measurement
