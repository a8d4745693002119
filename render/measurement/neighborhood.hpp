#pragma once

#include <array>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "measurement/mesh_edges.hpp"
#include "measurement/snapping.hpp"

namespace vrut::measurement {

/// What lies around a hit. Relative points are in directions of the world, from the hit point: as exact far
/// from the world's origin as near it.
class Neighborhood {
public:
    /// None if the hit is on no geometry, or on a flattened part, or a number is not finite.
    static std::optional<Neighborhood> around(const scene::PlacedScene& placed, const mesh::Hit& hit,
                                              const mesh::Ray& ray, const SnapOptions& options,
                                              MeshEdgesMemo& memo);

    const MeshEdges& edges() const { return *edges_; }
    const glm::dmat3& world_from_node() const { return linear_; }
    /// The hit, in the node's space.
    const glm::dvec3& hit() const { return hit_; }
    /// The cone's radius at the hit.
    double radius() const { return radius_; }
    glm::dvec3 relative(const glm::dvec3& point) const { return linear_ * (point - hit_); }
    glm::dvec3 relative(unsigned vertex) const { return relative(edges_->mesh().positions()[vertex]); }

    /// Distance from the ray, in the distance along it; infinite behind the ray's origin.
    double offset(const glm::dvec3& relative_point) const;
    double depth(const glm::dvec3& relative_point) const {
        return glm::dot(relative_point - eye_, direction_);
    }
    /// True within the cone, and within 4 radii from the hit.
    bool is_near(const glm::dvec3& relative_point) const;
    /// Where between two points, 0 to 1, a line is closest to the ray.
    double closest_to_ray(const glm::dvec3& a, const glm::dvec3& b) const;

    /// True if more triangles are near than a finger can distinguish: triangles() has none then, and
    /// whatever is asked is visible.
    bool is_dense() const { return is_dense_; }
    /// Triangles in two cones' widths, and chains, that may come within 4 radii.
    const std::vector<unsigned>& triangles() const { return triangles_; }
    std::vector<std::size_t> chains() const;
    /// The triangle that was hit. None if it is a cap's.
    const std::optional<unsigned>& hit_triangle() const { return hit_triangle_; }
    bool faces_ray(unsigned triangle) const;
    /// True if no front of the part is in the way.
    bool is_visible(const glm::dvec3& relative_point) const;

private:
    Neighborhood() = default;
    using Corners = std::array<glm::dvec3, 3>;
    Corners corners_of(unsigned triangle) const;
    math::Bounds box_around(const glm::dvec3& relative_point, double reach) const;
    /// Around the hit and the ray, from `before` radii nearer to `behind` radii farther than the hit.
    math::Bounds box_along_ray(double before, double behind) const;
    /// How far the hit may be from its triangle.
    double rounding() const;
    std::optional<unsigned> nearest_triangle() const;
    bool is_clipped(const glm::dvec3& relative_point) const;
    void find_triangles();

    const MeshEdges* edges_ = nullptr;
    std::span<const scene::ClipPlane> clip_planes_;
    glm::dmat3 linear_{1}, inverse_{1};
    glm::dvec3 hit_{0}, world_hit_{0};
    glm::dvec3 eye_{0}, direction_{0};
    double tangent_ = 0, radius_ = 0;
    bool is_mirrored_ = false, is_dense_ = false;
    std::vector<unsigned> triangles_;
    std::optional<unsigned> hit_triangle_;
    std::vector<Corners> occluders_;
};

}  // namespace vrut::measurement
