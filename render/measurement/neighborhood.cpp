#include "measurement/neighborhood.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "measurement/vectors.hpp"

namespace vrut::measurement {

namespace {

// In radii of the cone at the hit:
constexpr double kReach = 4;
constexpr double kWidth = 2;          // the hit may be at the cone's edge
constexpr double kOccluderReach = 8;  // what is in the way is looked for from there on
constexpr double kOnSurface = 1e-3;   // what is nearer than this behind a surface lies on it
constexpr std::size_t kMostTriangles = 20'000;
/// Rounding of the hit point, in its distance from the ray's origin.
constexpr double kHitRounding = 1e-7;

double distance_to_segment(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 edge = b - a;
    const double square = glm::dot(edge, edge);
    const double along = square > 0 ? std::clamp(-glm::dot(a, edge) / square, 0.0, 1.0) : 0;
    return safe_length(a + edge * along);
}

/// From the origin.
double distance_to_triangle(const std::array<glm::dvec3, 3>& t) {
    const glm::dvec3 normal = unit(glm::cross(t[1] - t[0], t[2] - t[0]));
    double least = std::numeric_limits<double>::infinity();
    bool is_inside = normal != glm::dvec3(0);
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 &a = t[k], &b = t[(k + 1) % 3];
        is_inside &= glm::dot(glm::cross(b - a, -a), normal) >= 0;
        least = std::min(least, distance_to_segment(a, b));
    }
    return is_inside ? std::abs(glm::dot(normal, t[0])) : least;
}

/// How far along the unit direction the triangle is met, edges included; infinite if it is missed.
double distance_along(const std::array<glm::dvec3, 3>& t, const glm::dvec3& from,
                      const glm::dvec3& direction) {
    constexpr double kMissed = std::numeric_limits<double>::infinity(), kEdge = 1e-9, kEdgeOn = 1e-9;
    const glm::dvec3 ab = t[1] - t[0], ac = t[2] - t[0], p = glm::cross(direction, ac);
    const double determinant = glm::dot(ab, p);
    if (std::abs(determinant) <= kEdgeOn * glm::length(ab) * glm::length(ac)) return kMissed;
    const glm::dvec3 offset = from - t[0], q = glm::cross(offset, ab);
    const double u = glm::dot(offset, p) / determinant, v = glm::dot(direction, q) / determinant;
    if (!(std::min({u, v, 1 - u - v}) >= -kEdge)) return kMissed;
    return glm::dot(ac, q) / determinant;
}

}  // namespace

std::optional<Neighborhood> Neighborhood::around(const scene::PlacedScene& placed, const mesh::Hit& hit,
                                                 const mesh::Ray& ray, const SnapOptions& options,
                                                 MeshEdgesMemo& memo) {
    if (hit.node == scene::kNone) return {};
    const auto node = static_cast<std::size_t>(hit.node);
    const auto* data = std::get_if<scene::GeometryData>(&placed.scene->nodes()[node].data);
    const glm::dmat4& world = placed.world[node];
    if (!data || data->geometry == scene::kNone || !scene::is_finite(world)) return {};
    Neighborhood result;
    result.linear_ = glm::dmat3(world);
    result.inverse_ = glm::inverse(result.linear_);
    result.hit_ = result.inverse_ * (hit.point - glm::dvec3(world[3]));
    result.world_hit_ = hit.point;
    result.eye_ = ray.origin - hit.point;
    result.direction_ = ray.direction;
    result.tangent_ = options.radius;
    result.radius_ = options.radius * result.depth(glm::dvec3(0));
    result.clip_planes_ = options.clip_planes;
    result.is_mirrored_ = glm::determinant(result.linear_) < 0;
    if (!is_finite(result.hit_) || !is_finite(result.eye_) || !(result.radius_ >= 0)) return {};
    if (!(std::abs(scene::relative_determinant(result.linear_)) > kHitRounding)) return {};
    result.edges_ = &memo.of(placed.scene, data->geometry);
    result.hit_triangle_ = result.nearest_triangle();
    result.find_triangles();
    return result;
}

double Neighborhood::rounding() const {
    return kHitRounding * (depth(glm::dvec3(0)) + largest(world_hit_) * 1e-6);
}

math::Bounds Neighborhood::box_around(const glm::dvec3& relative_point, double reach) const {
    glm::dvec3 half(0);
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 row(inverse_[0][k], inverse_[1][k], inverse_[2][k]);
        half[k] = reach * safe_length(row);
    }
    const glm::dvec3 center = hit_ + inverse_ * relative_point;
    return {center - half, center + half};
}

math::Bounds Neighborhood::box_along_ray(double before, double behind) const {
    const double reach = kWidth * radius_ + rounding();
    math::Bounds box = box_around(direction_ * (-before * radius_), reach);
    box.add(box_around(direction_ * (behind * radius_), reach));
    return box;
}

Neighborhood::Corners Neighborhood::corners_of(unsigned triangle) const {
    const glm::uvec3& t = edges_->mesh().triangles()[triangle];
    return {relative(t.x), relative(t.y), relative(t.z)};
}

void Neighborhood::find_triangles() {
    const auto before = edges_->triangles_near(box_along_ray(kOccluderReach, kReach), kMostTriangles);
    is_dense_ = !before;
    if (is_dense_) return;
    triangles_ = edges_->triangles_near(box_along_ray(kReach, kReach)).value();
    const bool hit_front = hit_triangle_ && faces_ray(*hit_triangle_);
    for (const unsigned near : *before)
        if (!hit_front || faces_ray(near)) occluders_.push_back(corners_of(near));
}

double Neighborhood::offset(const glm::dvec3& relative_point) const {
    const double along = depth(relative_point);
    if (!(along > 0)) return std::numeric_limits<double>::infinity();
    return safe_length(relative_point - eye_ - direction_ * along) / along;
}

bool Neighborhood::is_near(const glm::dvec3& relative_point) const {
    return offset(relative_point) <= tangent_ && safe_length(relative_point) <= kReach * radius_;
}

double Neighborhood::closest_to_ray(const glm::dvec3& a, const glm::dvec3& b) const {
    const auto across = [&](const glm::dvec3& v) { return v - direction_ * glm::dot(direction_, v); };
    const glm::dvec3 from = across(a - eye_), edge = across(b - a);
    const double square = glm::dot(edge, edge);
    return square > 0 ? std::clamp(-glm::dot(from, edge) / square, 0.0, 1.0) : 0;
}

std::vector<std::size_t> Neighborhood::chains() const {
    return edges_->chains_near(box_along_ray(kReach, kReach));
}

std::optional<unsigned> Neighborhood::nearest_triangle() const {
    std::optional<unsigned> best;
    double least = rounding();
    const auto touched = edges_->triangles_near(box_around(glm::dvec3(0), least));
    for (const bool faces : {true, false})
        for (const unsigned triangle : touched.value()) {
            if (faces_ray(triangle) != faces) continue;
            const double distance = distance_to_triangle(corners_of(triangle));
            if (!(distance < least)) continue;
            least = distance;
            best = triangle;
        }
    return best;
}

bool Neighborhood::faces_ray(unsigned triangle) const {
    const Corners t = corners_of(triangle);
    const double facing = glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), eye_ - t[0]);
    return is_mirrored_ ? facing < 0 : facing > 0;
}

bool Neighborhood::is_clipped(const glm::dvec3& relative_point) const {
    for (const scene::ClipPlane& plane : clip_planes_) {
        const double beyond = glm::dot(plane.normal, world_hit_) - plane.distance;
        if (beyond + glm::dot(plane.normal, relative_point) > kOnSurface * radius_) return true;
    }
    return false;
}

bool Neighborhood::is_visible(const glm::dvec3& relative_point) const {
    if (is_clipped(relative_point)) return false;
    const double to_eye = safe_length(eye_ - relative_point);
    const glm::dvec3 direction = unit(eye_ - relative_point);
    return std::none_of(occluders_.begin(), occluders_.end(), [&](const Corners& triangle) {
        const double along = distance_along(triangle, relative_point, direction);
        return along > kOnSurface * radius_ && along < to_eye &&
               !is_clipped(relative_point + direction * along);
    });
}

}  // namespace vrut::measurement
