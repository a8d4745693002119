#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <utility>

namespace vrut::math {

/// Sheared coordinates in which the ray is the z axis and z is the distance along it. Input is relative to
/// the ray's origin. A triangle that is counter-clockwise seen from the ray's origin is clockwise in x and y.
/// (Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.)
class RaySpace {
public:
    /// `direction` is unit.
    explicit RaySpace(const glm::dvec3& direction) {
        const glm::dvec3 size = glm::abs(direction);
        z_ = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        x_ = (z_ + 1) % 3;
        y_ = (z_ + 2) % 3;
        if (direction[z_] < 0) std::swap(x_, y_);
        shear_ = {direction[x_] / direction[z_], direction[y_] / direction[z_]};
        length_ = direction[z_];
    }

    glm::dvec3 to_ray_space(const glm::dvec3& v) const {
        return {v[x_] - shear_.x * v[z_], v[y_] - shear_.y * v[z_], v[z_] / length_};
    }

private:
    int x_ = 0, y_ = 1, z_ = 2;
    glm::dvec2 shear_{0};
    double length_ = 1;
};

/// Edge function of a and b: rounded, but with the sign of the exact value. Swapping a and b only flips the
/// sign, so two triangles agree on which side of their common edge the ray passes.
inline double edge_function(const glm::dvec3& a, const glm::dvec3& b) {
    const double p = a.x * b.y, q = a.y * b.x;
    if (p != q) return p - q;
    return std::fma(a.x, b.y, -p) - std::fma(a.y, b.x, -q);
}

/// The sign of edge_function(a, b), which is `value`. Where the ray goes exactly through the edge it is taken
/// to pass a hair to its right, and less than a hair above: the same side for both triangles of the edge.
inline double edge_side(double value, const glm::dvec3& a, const glm::dvec3& b) {
    if (value != 0) return value;
    return a.y != b.y ? a.y - b.y : b.x - a.x;
}

}  // namespace vrut::math
