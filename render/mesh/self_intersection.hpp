#pragma once

#include <atomic>
#include <glm/glm.hpp>
#include <span>

namespace vrut::mesh {

/// Returns true if two triangles of one component cross, overlap in a plane, or lie folded on each other;
/// those that come closer than 10⁻¹⁰ of the radius count as touching. True as well for a surface whose
/// triangles take too long to compare, and where `stop` is set. Triangles name each position by one number,
/// so that neighbours share theirs; `components` has one number for each triangle.
bool may_self_intersect(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles,
                        std::span<const unsigned> components, const std::atomic<bool>& stop);

}  // namespace vrut::mesh
