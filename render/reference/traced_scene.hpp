#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "mesh/bvh.hpp"
#include "plan/view.hpp"

namespace vrut::reference {

/// A half-line relative to the eye, along the world's axes, and how it changes from a pixel to the next, to
/// the right and upwards.
struct RayDifferential {
    glm::dvec3 origin{0}, direction{0, 0, -1};  ///< the direction is unit
    std::array<glm::dvec3, 2> dorigin_dxy{}, ddirection_dxy{};
};

/// A geometry node as the eye sees it: all is relative to the eye, along the world's axes.
struct TracedInstance {
    scene::Index node = scene::kNone;
    const scene::Geometry* geometry = nullptr;
    const scene::Material* material = nullptr;
    std::vector<glm::dvec3> positions;
    glm::dmat3 normal_matrix{
        1};  ///< cofactors of the node's matrix, by the sign of its determinant, to scale
    /// Which triangles are drawn, by how they turn in a ray's space.
    bool clockwise = false, counter_clockwise = false;
    bool flattened = false;
    bool clipped = true;     ///< by the view's planes
    bool two_sided = false;  ///< normals turn to the viewer
    bool transparent = false;
    bool colored = false;  ///< by the colours of its vertices
    std::optional<math::Plane> mirror;
    std::optional<scene::Material> cap_material;  ///< where a plane with caps cuts it, and it is watertight
    std::uint32_t coincident_group = 0;  ///< the first part of the same geometry under the same matrix
};

/// Where a ray goes through a triangle. One exactly through an edge or a corner meets one of the triangles
/// around it that turn the same way, so that a ray meets a pane of glass once and a closed surface has no
/// gaps. Or where it meets the part's cap, which has no triangle.
struct TriangleHit {
    struct Cap {
        std::size_t plane = 0;  ///< of the view's
        glm::dvec3 normal{0};   ///< the plane's: towards the ray's origin
    };
    std::uint32_t part = 0, triangle = 0;
    double distance = 0;         ///< along the ray, above 0, in the scene's unit
    glm::dvec3 barycentrics{0};  ///< of the triangle's corners; their sum is 1
    std::optional<Cap> cap = {};

    /// Equal distance: the higher id is in front; of one geometry the cap, then the later triangle.
    bool is_in_front_of(const TriangleHit& other) const;
};

/// Of what is hit: the part's own, or its cap's.
const scene::Material& material_at(const TracedInstance& part, const TriangleHit& hit);

/// What a view shows of a scene, to be met by rays. What lies beyond a clip plane is passed.
class TracedScene {
public:
    explicit TracedScene(const plan::View& view);
    const std::vector<TracedInstance>& parts() const { return parts_; }  ///< by rising id

    static constexpr std::uint32_t kNoInstance = 0xffffffff;
    /// The first opaque surface along the ray; the part `without` and what coincides with it are passed.
    std::optional<TriangleHit> closest_opaque_hit(const RayDifferential& ray,
                                                  std::uint32_t excluded = kNoInstance) const;
    /// All transparent surfaces before `end` (all along the ray, where it is none), nearest first; `without`
    /// and what coincides with it are passed.
    std::vector<TriangleHit> transparent_hits_before(const RayDifferential& ray,
                                                     const std::optional<TriangleHit>& end,
                                                     std::uint32_t excluded = kNoInstance) const;

private:
    bool is_coincident(std::uint32_t part, std::uint32_t of) const {
        return of != kNoInstance && parts_[part].coincident_group == parts_[of].coincident_group;
    }
    struct TriangleRef {
        std::uint32_t part, index;
    };
    /// Triangles of some parts, in a tree.
    struct TriangleSet {
        TriangleSet(const std::vector<TracedInstance>& parts, bool (*contains)(const TracedInstance&));
        std::vector<TriangleRef> triangles;
        mesh::Bvh<double> tree;
    };
    /// Its last is before its first where nothing is kept of the ray.
    scene::KeptInterval kept_of(const RayDifferential& ray) const;
    /// The cap of the part of the highest id that is solid where the ray comes through a clip plane.
    std::optional<TriangleHit> cap_hit(const RayDifferential& ray, const scene::KeptInterval& kept) const;

    std::vector<scene::ClipPlane> clip_planes_;  // relative to the eye
    std::vector<TracedInstance> parts_;
    TriangleSet opaque_, transparent_, capped_;
};

}  // namespace vrut::reference
