#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "plan/view.hpp"
#include "reference/box_tree.hpp"

namespace vrut::reference {

/// A half-line relative to the eye, along the world's axes, and how it changes from a pixel to the next, to
/// the right and upwards.
struct Sight {
    glm::dvec3 origin{0}, direction{0, 0, -1};  ///< the direction is unit
    std::array<glm::dvec3, 2> origin_change{}, direction_change{};
};

/// A geometry node as the eye sees it: all is relative to the eye, along the world's axes.
struct Part {
    Index node = kNone;
    const Geometry* geometry = nullptr;
    const Material* material = nullptr;
    std::vector<glm::dvec3> positions;
    glm::dmat3 normal_matrix{
        1};  ///< cofactors of the node's matrix, by the sign of its determinant, to scale
    /// Which triangles are drawn, by how they turn in a ray's space.
    bool clockwise = false, counter_clockwise = false;
    bool both_sides = false;  ///< normals turn to the viewer
    bool transparent = false;
    std::optional<Plane> mirror;
    std::uint32_t twins = 0;  ///< the first part of the same geometry under the same matrix
};

/// Where a ray goes through a triangle. One exactly through an edge or a corner meets one of the triangles
/// around it that turn the same way, so that a pane of glass is met once and a closed surface has no gaps.
struct Meeting {
    std::uint32_t part = 0, triangle = 0;
    double distance = 0;    ///< along the ray, above 0, in the scene's unit
    glm::dvec3 weights{0};  ///< of the triangle's corners; their sum is 1

    /// Equal distance: the higher id is in front; of one geometry the later triangle.
    bool before(const Meeting& other) const;
};

/// What a view shows of a scene, to be met by rays.
class Surfaces {
public:
    explicit Surfaces(const View& view);
    const std::vector<Part>& parts() const { return parts_; }  ///< by rising id

    static constexpr std::uint32_t kNoPart = 0xffffffff;
    /// The first opaque surface along the ray; the part `without` and its twins are passed.
    std::optional<Meeting> first_opaque(const Sight& ray, std::uint32_t without = kNoPart) const;
    /// All transparent surfaces before `end` (all along the ray, where it is none), nearest first; `without`
    /// and its twins are passed.
    std::vector<Meeting> transparent_before(const Sight& ray, const std::optional<Meeting>& end,
                                            std::uint32_t without = kNoPart) const;

private:
    bool is_twin(std::uint32_t part, std::uint32_t of) const {
        return of != kNoPart && parts_[part].twins == parts_[of].twins;
    }
    struct Triangle {
        std::uint32_t part, index;
    };
    /// Triangles in a tree.
    struct Group {
        Group(const std::vector<Part>& parts, bool transparent);
        std::vector<Triangle> triangles;
        BoxTree tree;
    };

    std::vector<Part> parts_;
    Group opaque_, transparent_;
};

}  // namespace vrut::reference
