#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "scene.hpp"

namespace vrut {

/// A box of any orientation: the points center + Σ t_k · axes[k] with t_k from -1 to 1.
struct OrientedBox {
    glm::dvec3 center{0};
    std::array<glm::dvec3, 3> axes{};
};

/// Around a geometry, in its own space, with one axis along the normal of its largest triangle's side: thin
/// around a sheet of glass, however that lies in its space.
OrientedBox oriented_box(const Geometry& geometry);

/// The box seen through an affine `matrix`.
OrientedBox transformed(const glm::dmat4& matrix, const OrientedBox& box);

/// What of a geometry decides in which order glass of that shape is drawn.
struct GlassShape {
    OrientedBox box;
};

/// The shapes of a scene's geometries, each found when it is first asked for.
class GlassShapes {
public:
    explicit GlassShapes(const Scene& scene) : shapes_(scene.geometries().size()) {}
    const GlassShape& of(const Scene& scene, Index geometry);

private:
    std::vector<std::unique_ptr<GlassShape>> shapes_;
};

}  // namespace vrut
