#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "plan/triangle_order.hpp"

namespace vrut::plan {

/// An oriented box: the points center + Σ t_k · axes[k] with t_k from -1 to 1.
struct OrientedBox {
    glm::dvec3 center{0};
    std::array<glm::dvec3, 3> axes{};
};

/// Returns an oriented bounding box in node space. One axis is the area-weighted mean normal, so that the box
/// is thin around a flat sheet of any orientation.
OrientedBox oriented_box(const scene::Geometry& geometry);

/// Returns the box transformed by an affine `matrix`.
OrientedBox transformed(const glm::dmat4& matrix, const OrientedBox& box);

/// Caches, per geometry, the oriented box and the triangle orders that sorting transparent items needs.
class TransparencyCache {
public:
    /// The scene must outlive it.
    explicit TransparencyCache(const scene::Scene& scene)
        : scene_(scene), entries_(scene.geometries().size()) {}
    /// Computes the cached values for an item. Returns the cost in units of DrawBudget.
    std::int64_t find(const DrawItem& item);
    const OrientedBox& box(scene::Index geometry);
    const TriangleOrder& order(scene::Index geometry, CullMode cull_mode);

private:
    struct CacheEntry {
        std::optional<OrientedBox> box;
        std::array<std::optional<TriangleOrder>, 2> orders;  // with front faces, with both
    };
    const scene::Geometry& geometry(scene::Index index) const {
        return scene_.geometries()[static_cast<std::size_t>(index)];
    }

    const scene::Scene& scene_;
    std::vector<CacheEntry> entries_;
};

}  // namespace vrut::plan
