// Studies of picking.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "mesh/picking.hpp"
#include "pictures.hpp"
#include "scene/camera.hpp"
#include "shapes.hpp"

namespace vrut::stability {

namespace {

/// The distance by Möller and Trumbore's test in single precision; none where the triangle is missed.
std::optional<float> met_in_float(const glm::vec3& direction, const glm::vec3& a, const glm::vec3& b,
                                  const glm::vec3& c) {
    const glm::vec3 p = glm::cross(direction, c - a);
    const float determinant = glm::dot(b - a, p);
    if (std::abs(determinant) < 1e-7F) return {};  // as it is usually written
    const glm::vec3 q = glm::cross(-a, b - a);
    const float u = glm::dot(-a, p) / determinant, v = glm::dot(direction, q) / determinant;
    if (!(u >= 0 && v >= 0 && u + v <= 1)) return {};
    return glm::dot(c - a, q) / determinant;
}

/// The distance to the nearest of a geometry's triangles along a ray from the origin, by Möller and
/// Trumbore's test in long double; 0 where no front is met.
long double nearest_of_all(const scene::Geometry& geometry, const glm::dvec3& place,
                           const glm::dvec3& direction) {
    using Vector = glm::vec<3, long double>;
    constexpr long double kEdge = 1e-9L;  // an edge belongs to its triangle
    long double nearest = 0;
    for (const glm::uvec3& triangle : geometry.triangles) {
        std::array<Vector, 3> corner{};
        for (int k = 0; k < 3; ++k)
            corner[static_cast<std::size_t>(k)] = Vector(geometry.positions[triangle[k]]) + Vector(place);
        const Vector side = corner[1] - corner[0], other = corner[2] - corner[0];
        const Vector p = glm::cross(Vector(direction), other), q = glm::cross(-corner[0], side);
        const long double determinant = glm::dot(side, p);
        if (!(determinant > 0)) continue;  // a back
        const long double u = -glm::dot(corner[0], p) / determinant;
        const long double v = glm::dot(Vector(direction), q) / determinant;
        if (std::min({u, v, 1 - u - v}) < -kEdge) continue;
        const long double distance = glm::dot(other, q) / determinant;
        if (distance > 0 && (nearest == 0 || distance < nearest)) nearest = distance;
    }
    return nearest;
}

/// A ball between panes of glass, in no order, before a wall.
std::vector<Part> ball_among_panes(int surfaces) {
    std::vector<Part> parts{{7, sphere(1, 8), material_of({1, 0, 0})},
                            {9, quad(5), material_of({0, 1, 0}), moved_by({0, 0, -3})}};
    scene::Material glass = material_of({0, 0, 1});
    glass.diffuse.a = 0.5;
    glass.two_sided = true;
    for (int i = 1; i < surfaces; ++i)
        parts.push_back({10 + i * 7 % 1009, quad(3), glass,
                         moved_by({0, 0, (i % 3 == 0 ? -1 : 1) * (1.2 + 1.0 * i / surfaces)}) *
                             turned_by(17.0 * i, {0, 0, 1})});
    return parts;
}

/// By brute force, of parts whose positions are the world's; -1 for none.
scene::Id nearest_part(const std::vector<Part>& parts, const mesh::Ray& ray, bool through) {
    scene::Id best = -1;
    long double least = std::numeric_limits<long double>::infinity();
    for (const Part& part : parts) {
        if (through && part.material.diffuse.a < 1) continue;
        const long double distance = nearest_of_all(part.geometry, -ray.origin, ray.direction);
        if (distance == 0 || !(distance < least)) continue;
        least = distance;
        best = part.id;
    }
    return best;
}

}  // namespace

Study slivers(const Laboratory& laboratory) {
    Study study{"slivers", "Picking slivers", "length of a sliver / its width",
                "picks along its middle that miss it, in percent"};
    study.bound = 0;
    study.baseline.title = "ray and triangle in single precision";
    study.method.title = "Woop's test in double";
    study.explanation =
        "One ray in double, with an edge test that leaves no gaps; triangles are brought to the ray, so that "
        "no inverse is needed.";
    study.cost = "0.07 ms a pick on the car; a picture of ids takes hundreds of times longer.";
    for (const double ratio : laboratory.chosen({1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e9, 1e12})) {
        const glm::dvec3 a(0.1, 0.2, -5), b(2.1, 0.9, -6);
        const glm::dvec3 across = glm::normalize(glm::cross(b - a, glm::dvec3(0, 0, 1)));
        const glm::dvec3 c = b + across * (glm::distance(a, b) / ratio);
        scene::Geometry sliver;
        sliver.positions = {a, b, c};
        sliver.triangles = {{0, 1, 2}};
        for (const glm::dvec3& corner : sliver.positions) sliver.bounds.add(corner);
        scene::Material material;
        material.two_sided = true;
        const auto scene = scene_of({{1, sliver, material}});
        constexpr int kPicks = 200;
        int missed = 0, missed_in_float = 0;
        for (int i = 0; i < kPicks; ++i) {
            const double along = (i + 0.5) / kPicks;
            const glm::dvec3 point = a + along * ((b + c) / 2.0 - a);
            const glm::dvec3 direction = glm::normalize(point);
            missed += !mesh::pick(*scene, {glm::dvec3(0), direction}).has_value();
            missed_in_float += !met_in_float(direction, a, b, c).has_value();
        }
        study.baseline.points.push_back({ratio, 100.0 * missed_in_float / kPicks});
        study.method.points.push_back({ratio, 100.0 * missed / kPicks});
    }
    return study;
}

Study shared_edges(const Laboratory& laboratory) {
    Study study{"shared-edges", "Picking where two triangles meet", "distance of the eye / size of the part",
                "picks that miss it by a hundredth of the part, in percent"};
    study.bound = 0;
    study.baseline.title = "ray and triangle in single precision";
    study.method.title = "Woop's test in double";
    study.explanation =
        "Two triangles get their common edge from the same numbers, and only its sign decides: a ray on the "
        "edge meets one of the two.";
    study.cost = "None: it is the test of all triangles.";
    const scene::Geometry ball = welded(sphere(1, 12));
    for (const double distance : laboratory.chosen({2, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8})) {
        const glm::dvec3 place = distance * glm::normalize(glm::dvec3(0.3, -0.2, -1));
        const auto scene = scene_of({{1, mapped(ball, 1, place), material_of({1, 1, 1})}});
        int picks = 0, wrong = 0, wrong_in_float = 0;
        for (std::size_t i = 0; i < ball.triangles.size(); ++i) {
            const glm::uvec3& triangle = ball.triangles[i];
            const glm::dvec3 a = ball.positions[triangle.x] + place, b = ball.positions[triangle.y] + place;
            // Where both triangles of the edge face the eye.
            if (glm::dot(a, a - place) > -0.3 * distance || glm::dot(b, b - place) > -0.3 * distance)
                continue;
            for (const double along : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}) {
                const glm::dvec3 direction = glm::normalize(glm::mix(a, b, along));
                ++picks;
                const double right = static_cast<double>(nearest_of_all(ball, place, direction));
                const auto hit = mesh::pick(*scene, {glm::dvec3(0), direction});
                wrong += !hit || std::abs(hit->distance - right) > 0.01;
                double nearest = std::numeric_limits<double>::infinity();
                for (const glm::uvec3& t : ball.triangles)
                    nearest = std::min<double>(
                        nearest, met_in_float(direction, ball.positions[t.x] + place,
                                              ball.positions[t.y] + place, ball.positions[t.z] + place)
                                     .value_or(std::numeric_limits<float>::infinity()));
                wrong_in_float += !(std::abs(nearest - right) <= 0.01);
            }
        }
        study.baseline.points.push_back({distance, 100.0 * wrong_in_float / picks});
        study.method.points.push_back({distance, 100.0 * wrong / picks});
    }
    return study;
}

Study picks_through_glass(const Laboratory& laboratory) {
    Study study{"picks-through-glass", "Picking a part through glass", "surfaces that the ray meets",
                "picks that name another part, in percent"};
    study.bound = 0;
    study.baseline.title = "from a picture of ids";
    study.method.title = "a ray that passes what is transparent";
    study.explanation =
        "What is transparent is left out before its triangles are asked; without 'through' the nearest pane "
        "is picked as any other part.";
    study.cost = "None: less is asked than by a pick of what is nearest.";
    for (const double count : laboratory.chosen({1, 2, 3, 10, 100, 1000})) {
        std::vector<Part> parts = ball_among_panes(static_cast<int>(count));
        const plan::View view = looking(scene_of(parts), {0.2, 0.3, 6});
        for (Part& part : parts)
            for (glm::dvec3& position : part.geometry.positions)
                position = glm::dvec3(part.matrix * glm::dvec4(position, 1));
        const auto id_of = [&](scene::Index node) {
            return node == scene::kNone ? -1 : view.scene->scene->nodes()[static_cast<std::size_t>(node)].id;
        };
        const auto picked = [&](const mesh::Ray& ray, bool through) {
            const auto hit = mesh::pick(*view.scene, ray, {.through_transparent = through});
            return id_of(hit ? hit->node : scene::kNone);
        };
        const std::vector<scene::Index> ids = laboratory.renderer.node_ids(view);  // rows from the bottom up
        int picks = 0, wrong = 0, wrong_in_picture = 0;
        for (int y = 4; y < view.height; y += 8)
            for (int x = 4; x < view.width; x += 8) {
                const glm::dvec2 place((2 * x + 1.0) / view.width - 1, 1 - (2 * y + 1.0) / view.height);
                const double aspect = 1.0 * view.width / view.height;
                const mesh::Ray ray{view.camera.eye, scene::direction_through(view.camera, aspect, place)};
                const scene::Id right = nearest_part(parts, ray, true);
                ++picks;
                wrong += picked(ray, true) != right || picked(ray, false) != nearest_part(parts, ray, false);
                wrong_in_picture +=
                    id_of(ids[static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width) +
                              static_cast<std::size_t>(x)]) != right;
            }
        study.baseline.points.push_back({count, 100.0 * wrong_in_picture / picks});
        study.method.points.push_back({count, 100.0 * wrong / picks});
    }
    return study;
}

}  // namespace vrut::stability
