#include "car_geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

namespace vrut {

namespace {

const scene::Node& at(const scene::Scene& scene, scene::Index index) {
    return scene.nodes()[static_cast<std::size_t>(index)];
}

std::array<std::array<unsigned, 2>, 3> edges_of(const glm::uvec3& t) {
    return {{{t.x, t.y}, {t.y, t.z}, {t.z, t.x}}};
}

}  // namespace

std::string path_of(const scene::Scene& scene, scene::Index node) {
    std::string path;
    for (; at(scene, node).parent != scene::kNone; node = at(scene, node).parent)
        path = at(scene, node).name + (path.empty() ? "" : "/") + path;
    return path;
}

scene::Index node_at(const scene::Scene& scene, const std::string& path) {
    for (std::size_t i = 1; i < scene.nodes().size(); ++i)
        if (path_of(scene, static_cast<scene::Index>(i)) == path) return static_cast<scene::Index>(i);
    return scene::kNone;
}

Surface welded(const std::vector<const scene::Geometry*>& geometries) {
    Surface surface;
    std::map<std::tuple<double, double, double>, unsigned> known;
    const auto corner = [&](const glm::dvec3& p) {
        const auto number = static_cast<unsigned>(surface.points.size());
        const auto [found, is_new] = known.emplace(std::tuple(p.x, p.y, p.z), number);
        if (is_new) surface.points.push_back(p);
        return found->second;
    };
    for (const scene::Geometry* geometry : geometries)
        for (const glm::uvec3& t : geometry->triangles)
            surface.triangles.emplace_back(corner(geometry->positions[t.x]), corner(geometry->positions[t.y]),
                                           corner(geometry->positions[t.z]));
    return surface;
}

OpenEdges open_edges(const Surface& surface) {
    std::map<std::array<unsigned, 2>, int> uses;
    for (const glm::uvec3& t : surface.triangles)
        for (const auto& edge : edges_of(t)) ++uses[edge];
    OpenEdges result;
    for (const auto& [edge, count] : uses) {
        const bool open = uses.count({edge[1], edge[0]}) == 0;
        if (open || count > 1) result.at = surface.points[edge[0]];
        result.open += open;
        result.crowded += count > 1;
    }
    return result;
}

std::vector<Body> bodies_of(const Surface& surface) {
    std::vector<unsigned> leader(surface.points.size());
    std::iota(leader.begin(), leader.end(), 0U);
    const auto find = [&](unsigned point) {
        while (leader[point] != point) point = leader[point] = leader[leader[point]];
        return point;
    };
    for (const glm::uvec3& t : surface.triangles) {
        leader[find(t.y)] = find(t.x);
        leader[find(t.z)] = find(t.x);
    }
    std::map<unsigned, Body> bodies;
    for (const glm::uvec3& t : surface.triangles) {
        Body& body = bodies[find(t.x)];
        if (body.triangles++ == 0) body.at = surface.points[t.x];
        // Near the body, so that little is lost in differences.
        const glm::dvec3 a = surface.points[t.x] - body.at, b = surface.points[t.y] - body.at,
                         c = surface.points[t.z] - body.at;
        body.volume += glm::dot(a, glm::cross(b, c)) / 6;
    }
    std::vector<Body> result;
    result.reserve(bodies.size());
    for (const auto& [first, body] : bodies) result.push_back(body);
    return result;
}

double unevenness(const Surface& surface) {
    glm::dvec3 normal(0);
    for (const glm::uvec3& t : surface.triangles)
        normal +=
            glm::cross(surface.points[t.y] - surface.points[t.x], surface.points[t.z] - surface.points[t.x]);
    const double length = glm::length(normal);
    if (!(length > 0)) return std::numeric_limits<double>::infinity();
    double least = 0, most = 0;
    for (const glm::dvec3& p : surface.points) {
        const double d = glm::dot(p - surface.points[0], normal) / length;
        least = std::min(least, d);
        most = std::max(most, d);
    }
    return most - least;
}

}  // namespace vrut
