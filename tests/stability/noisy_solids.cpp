#include "noisy_solids.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solids.hpp"

namespace vrut::stability {

namespace {

constexpr unsigned kPlateEdges = 32, kCylinderEdges = 128, kCylinderRows = 10;

Points closed_circle(unsigned count) {
    Points points;
    points.reserve(count + 1);
    for (unsigned i = 0; i <= count; ++i) points.emplace_back(on_circle(1, i, count), 0);
    return points;
}

double chord(unsigned count) { return 2 * std::sin(std::numbers::pi / count); }

/// The vertices with these coordinates on two axes, in order along the third one.
Points edge_of(const scene::Geometry& geometry, int axis, double u, double v) {
    std::map<double, glm::dvec3> edge;
    for (const glm::dvec3& p : geometry.positions)
        if (p[(axis + 1) % 3] == u && p[(axis + 2) % 3] == v) edge.emplace(p[axis], p);
    Points points;
    points.reserve(edge.size());
    for (const auto& [place, p] : edge) points.push_back(p);
    return points;
}

/// The corners and straight edges of a square solid.
void find_square(Solid& solid, double half) {
    for (const double x : {-half, half})
        for (const double y : {-half, half}) {
            solid.corners.emplace_back(x, y, 0);
            solid.other_edges.push_back(edge_of(solid.geometry, 2, x, y));
        }
    for (const double z : {0.0, -solid.depth})
        for (const double side : {-half, half}) {
            std::vector<Points>& edges = z == 0 ? solid.edges : solid.other_edges;
            edges.push_back(edge_of(solid.geometry, 0, side, z));
            edges.push_back(edge_of(solid.geometry, 1, z, side));
        }
}

void find_top(Solid& solid) {
    for (const glm::uvec3& t : solid.geometry.triangles) {
        const std::array corners{solid.geometry.positions[t.x], solid.geometry.positions[t.y],
                                 solid.geometry.positions[t.z]};
        if (std::all_of(corners.begin(), corners.end(), [](const glm::dvec3& p) { return p.z == 0; }))
            solid.top.push_back(corners);
    }
}

}  // namespace

Solid coarse_box() {
    Solid solid{mapped(box({1, 1, 1}), 1, {0, 0, -1}), 2, 2, {}, {}, {}, {}, {}, {}};
    find_square(solid, 1);
    find_top(solid);
    return solid;
}

Solid plate_with_hole() {
    Solid solid{
        plate(2, 1, kPlateEdges), chord(kPlateEdges), 0.25, {}, {}, {}, closed_circle(kPlateEdges), {}, {}};
    find_square(solid, 2);
    find_top(solid);
    return solid;
}

Solid fine_cylinder() {
    const double step = chord(kCylinderEdges);
    Solid solid{{}, step, step * kCylinderRows, {}, {}, {}, closed_circle(kCylinderEdges), {}, {}};
    scene::Geometry& geometry = solid.geometry;
    geometry.positions = {{0, 0, 0}, {0, 0, -solid.depth}};
    for (unsigned row = 0; row <= kCylinderRows; ++row)
        for (unsigned i = 0; i < kCylinderEdges; ++i)
            geometry.positions.emplace_back(on_circle(1, i, kCylinderEdges), -step * row);
    const auto vertex = [](unsigned row, unsigned i) {
        return 2 + row * kCylinderEdges + i % kCylinderEdges;
    };
    const auto add_side = [&](unsigned a, unsigned b, unsigned c) {
        geometry.triangles.emplace_back(a, b, c);
        solid.side.push_back({geometry.positions[a], geometry.positions[b], geometry.positions[c]});
    };
    for (unsigned i = 0; i < kCylinderEdges; ++i) {
        geometry.triangles.emplace_back(0, vertex(0, i), vertex(0, i + 1));
        geometry.triangles.emplace_back(1, vertex(kCylinderRows, i + 1), vertex(kCylinderRows, i));
        for (unsigned row = 0; row < kCylinderRows; ++row) {
            add_side(vertex(row + 1, i), vertex(row + 1, i + 1), vertex(row, i + 1));
            add_side(vertex(row + 1, i), vertex(row, i + 1), vertex(row, i));
        }
    }
    geometry = with_bounds(std::move(geometry));
    find_top(solid);
    return solid;
}

double gaussian(Noise& noise) {
    double sum = 0;
    for (int i = 0; i < 12; ++i) sum += noise.next() / 2;
    return sum;
}

NoisySolid::NoisySolid(const Solid& solid, double sigma, Noise& noise) {
    scene::Geometry geometry = solid.geometry;
    for (glm::dvec3& position : geometry.positions) {
        const auto [place, is_new] = moved_.emplace(key(position), position);
        if (is_new)
            for (int k = 0; k < 3; ++k) place->second[k] += sigma * gaussian(noise);
        position = place->second;
    }
    placed_ = scene_of({{1, with_bounds(std::move(geometry)), material_of({0.5, 0.5, 0.5})}});
}

Points NoisySolid::moved(const Points& positions) const {
    Points points;
    points.reserve(positions.size());
    for (const glm::dvec3& position : positions) points.push_back(moved(position));
    return points;
}

std::optional<measurement::Snapped> NoisySolid::snapped(const glm::dvec3& at, const glm::dvec3& eye) {
    return clicked(*placed_, at, eye, memo_);
}

std::optional<measurement::Snapped> clicked(const scene::PlacedScene& placed, const glm::dvec3& at,
                                            const glm::dvec3& eye, measurement::MeshEdgesMemo& memo) {
    const auto find_hit = [&](const mesh::Ray& ray) { return mesh::pick(placed, ray); };
    return measurement::snap_around(placed, {eye, glm::normalize(at - eye)}, find_hit, {.radius = kCone},
                                    memo);
}

}  // namespace vrut::stability
