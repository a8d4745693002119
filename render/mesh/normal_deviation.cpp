#include "mesh/normal_deviation.hpp"

#include <algorithm>
#include <cmath>

namespace vrut::mesh {

namespace {

/// Of a surface so many triangles are looked at, spread evenly.
constexpr std::size_t kSamples = 600;
/// Half its size for a shade that is right at a triangle's corners and off between them. Where triangles are
/// flat, each is off as a whole, and the steps between them are seen.
constexpr float kSmooth = 0.5F, kFlat = 2;
/// The part of the area that may be worse: creases, and points where normals are bunched.
constexpr float kMeasured = 0.95F;

glm::vec3 unit(const glm::vec3& v) {
    const float length = glm::length(v);
    return length > 0 ? v / length : glm::vec3(0);
}

glm::vec3 across(std::span<const glm::vec3> positions, const glm::uvec3& t) {
    return glm::cross(positions[t.y] - positions[t.x], positions[t.z] - positions[t.x]);
}

/// How much each corner has in the point of a triangle's plane below another point.
glm::vec3 barycentrics(const glm::vec3& point, std::span<const glm::vec3> p, const glm::uvec3& t) {
    const glm::vec3 normal = across(p, t);
    const float area = glm::dot(normal, normal);
    if (!(area > 0)) return glm::vec3(1.0F / 3);
    glm::vec3 result;
    for (int k = 0; k < 3; ++k) {
        const glm::vec3 &from = p[t[(k + 1) % 3]], &to = p[t[(k + 2) % 3]];
        result[k] = std::max(glm::dot(glm::cross(to - from, point - from), normal) / area, 0.0F);
    }
    return result / (result.x + result.y + result.z);
}

}  // namespace

NormalDeviation::NormalDeviation(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                                 const std::vector<glm::vec3>& corners)
    : positions_(positions) {
    const std::size_t count = std::min(kSamples, triangles.size());
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t number = i * triangles.size() / count;
        const glm::uvec3& t = triangles[number];
        const glm::vec3 face = across(positions, t);
        glm::vec3 normal = face;
        if (!corners.empty())
            normal =
                unit(corners[3 * number]) + unit(corners[3 * number + 1]) + unit(corners[3 * number + 2]);
        if (glm::length(normal) > 0)
            samples_.push_back({(positions[t.x] + positions[t.y] + positions[t.z]) / 3.0F, unit(normal), t,
                                glm::length(face)});
    }
}

float NormalDeviation::measure(const SurfaceDeviation& deviation, std::span<const glm::uvec3> after,
                               const std::vector<glm::vec3>& corners) const {
    struct SampleError {
        float error, area;
    };
    const float size = corners.empty() ? kFlat : kSmooth;
    std::vector<SampleError> found;
    float area = 0;
    for (const NormalSample& sample : samples_) {
        const unsigned number = deviation.closest_triangle(sample.point, sample.triangle);
        const glm::uvec3& t = after[number];
        glm::vec3 normal = across(positions_, t);
        if (!corners.empty()) {
            const glm::vec3 weights = barycentrics(sample.point, positions_, t);
            normal = glm::vec3(0);
            for (int k = 0; k < 3; ++k)
                normal += weights[k] * unit(corners[3 * number + static_cast<unsigned>(k)]);
        }
        float longest = 0;
        for (int k = 0; k < 3; ++k)
            longest = std::max(longest, glm::distance(positions_[t[k]], positions_[t[(k + 1) % 3]]));
        found.push_back({glm::distance(unit(normal), sample.normal) * longest * size, sample.area});
        area += sample.area;
    }
    std::ranges::sort(found, {}, &SampleError::error);
    float below = 0;
    for (const auto& [error, here] : found) {
        below += here;
        if (below >= kMeasured * area) return error;
    }
    return 0;
}

}  // namespace vrut::mesh
