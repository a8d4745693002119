// Studies of picking.
#include <cmath>

#include "camera.hpp"
#include "picking.hpp"
#include "shapes.hpp"
#include "study.hpp"

namespace vrut::stability {

namespace {

/// Möller and Trumbore's test in single precision.
bool met_in_float(const glm::vec3& direction, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::vec3 p = glm::cross(direction, c - a);
    const float determinant = glm::dot(b - a, p);
    if (std::abs(determinant) < 1e-7F) return false;  // as it is usually written
    const glm::vec3 q = glm::cross(-a, b - a);
    const float u = glm::dot(-a, p) / determinant, v = glm::dot(direction, q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1;
}

}  // namespace

Study slivers(const Laboratory& laboratory) {
    Study study{"slivers", "Picking slivers", "length of a sliver / its width",
                "picks along its middle that miss it, in percent"};
    study.bound = 0;
    study.limit = 1e6;
    study.method.title = "ray and triangle in single precision";
    study.successor = {"Woop's test in double"};
    study.takes_over =
        "One ray in double, with an edge test that leaves no gaps; triangles are brought to the ray, so that "
        "no "
        "inverse is needed.";
    study.cost = "0.07 ms a pick on the car; a picture of ids takes hundreds of times longer.";
    for (const double ratio : laboratory.chosen({1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e9, 1e12})) {
        const glm::dvec3 a(0.1, 0.2, -5), b(2.1, 0.9, -6);
        const glm::dvec3 across = glm::normalize(glm::cross(b - a, glm::dvec3(0, 0, 1)));
        const glm::dvec3 c = b + across * (glm::distance(a, b) / ratio);
        Geometry sliver;
        sliver.positions = {a, b, c};
        sliver.triangles = {{0, 1, 2}};
        for (const glm::dvec3& corner : sliver.positions) sliver.bounds.add(corner);
        Material material;
        material.two_sided = true;
        const auto scene = scene_of({{1, sliver, material}});
        constexpr int kPicks = 200;
        int missed = 0, missed_in_float = 0;
        for (int i = 0; i < kPicks; ++i) {
            const double along = (i + 0.5) / kPicks;
            const glm::dvec3 point = a + along * ((b + c) / 2.0 - a);
            const glm::dvec3 direction = glm::normalize(point);
            missed += !pick(*scene, {glm::dvec3(0), direction}, false).has_value();
            missed_in_float += !met_in_float(direction, a, b, c);
        }
        study.method.points.push_back({ratio, 100.0 * missed_in_float / kPicks});
        study.successor->points.push_back({ratio, 100.0 * missed / kPicks});
    }
    return study;
}

}  // namespace vrut::stability
