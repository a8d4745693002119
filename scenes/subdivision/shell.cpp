#include "shell.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>
#include <numbers>

namespace vrut {

namespace {

using BorderEdge = std::array<std::uint32_t, 2>;

/// At each point of the border the way out of the sheet, in its surface; mitred, so that both edges move by
/// as much.
std::vector<glm::dvec3> ways_out(const Sheet& sheet) {
    std::vector<std::array<glm::dvec3, 2>> sides(sheet.points.size());
    for (const auto& [from, to] : sheet.border) {
        const glm::dvec3 along = sheet.points[to].position - sheet.points[from].position;
        for (const bool start : {true, false}) {
            const std::uint32_t p = start ? from : to;
            const glm::dvec3 out = glm::cross(along, sheet.points[p].normal);
            const double length = glm::length(out);
            if (length > 0) sides[p][start ? 0 : 1] = out / length;
        }
    }
    std::vector<glm::dvec3> ways(sheet.points.size(), glm::dvec3(0));
    for (const auto& [from, to] : sheet.border) {
        const auto& [next, before] = sides[from];
        const glm::dvec3 sum = next + before;
        const double length = glm::length(sum);
        if (length < 1e-9) continue;
        // |sum| is twice the cosine of half the bend; beyond 120 degrees the mitre ends.
        ways[from] = sum / length / std::max(length / 2, 0.5);
    }
    return ways;
}

class Shell {
public:
    Shell(const Sheet& sheet, const Panel& panel, const glm::dmat4& from_car, bool textured)
        : sheet_(sheet),
          panel_(panel),
          from_car_(from_car),
          normals_from_car_(glm::inverseTranspose(glm::dmat3(from_car))),
          mirrored_(glm::determinant(glm::dmat3(from_car)) < 0),
          ways_(ways_out(sheet)),
          builder_(textured) {}

    scene::Geometry build(double tolerance) {
        for (const auto& triangle : sheet_.triangles) {
            std::array<GeometryBuilder::Vertex, 3> front, back;
            for (std::size_t k = 0; k < 3; ++k) {
                front[k] = vertex(triangle.points[k], 0, 0, 0, triangle.normals[k]);
                back[2 - k] = vertex(triangle.points[k], last_ring(), panel_.edge, panel_.thickness,
                                     -triangle.normals[k]);
            }
            if (has_front()) add(front);
            if (panel_.layer != Panel::Layer::outside) add(back);
        }
        const double arc = std::numbers::pi / 2;
        arcs_ = panel_.edge > 0
                    ? std::clamp(static_cast<int>(
                                     std::ceil(arc / std::sqrt(8 * std::max(tolerance, 1e-9) / panel_.edge))),
                                 1, 4)
                    : 0;
        for (const BorderEdge& edge : sheet_.border) {
            if (has_front())
                for (int ring = 0; ring < arcs_; ++ring) add_strip(edge, ring);
            if (panel_.layer == Panel::Layer::whole || panel_.layer == Panel::Layer::inside) add_rim(edge);
        }
        return builder_.take();
    }

private:
    bool has_front() const {
        return panel_.layer == Panel::Layer::whole || panel_.layer == Panel::Layer::outside;
    }
    static constexpr std::uint32_t last_ring() { return 7; }

    /// A point of the sheet, moved: `ring` tells its places apart.
    GeometryBuilder::Vertex vertex(std::uint32_t p, std::uint32_t ring, double out, double down,
                                   const glm::dvec3& normal) const {
        const Sheet::Point& point = sheet_.points[p];
        const glm::dvec3 place = point.position + (panel_.lift - down) * point.normal + out * ways_[p];
        const glm::dvec3 turned = normals_from_car_ * normal;
        const double length = glm::length(turned);
        return {8 * p + ring, glm::dvec3(from_car_ * glm::dvec4(place, 1)),
                length > 0 ? turned / length : glm::dvec3(0), point.texcoord};
    }

    GeometryBuilder::Vertex on_arc(std::uint32_t p, int ring) const {
        const double angle = std::numbers::pi / 2 * ring / arcs_;
        return vertex(p, static_cast<std::uint32_t>(ring), panel_.edge * std::sin(angle),
                      panel_.edge * (1 - std::cos(angle)),
                      std::cos(angle) * sheet_.points[p].normal + std::sin(angle) * way(p));
    }

    glm::dvec3 way(std::uint32_t p) const {
        const double length = glm::length(ways_[p]);
        return length > 0 ? ways_[p] / length : sheet_.points[p].normal;
    }

    void add_strip(const BorderEdge& edge, int ring) {
        add_quad(on_arc(edge[0], ring), on_arc(edge[1], ring), on_arc(edge[0], ring + 1),
                 on_arc(edge[1], ring + 1));
    }

    void add_rim(const BorderEdge& edge) {
        const auto upper = [&](std::uint32_t p) {
            return vertex(p, static_cast<std::uint32_t>(arcs_), panel_.edge, panel_.edge, way(p));
        };
        const auto lower = [&](std::uint32_t p) {
            return vertex(p, last_ring(), panel_.edge, panel_.thickness, way(p));
        };
        add_quad(upper(edge[0]), upper(edge[1]), lower(edge[0]), lower(edge[1]));
    }

    /// Between two rings; the upper one runs along the border.
    void add_quad(const GeometryBuilder::Vertex& a, const GeometryBuilder::Vertex& b,
                  const GeometryBuilder::Vertex& below_a, const GeometryBuilder::Vertex& below_b) {
        add({b, a, below_a});
        add({b, below_a, below_b});
    }

    void add(std::array<GeometryBuilder::Vertex, 3> corners) {
        if (mirrored_) std::swap(corners[1], corners[2]);
        builder_.add(corners);
    }

    const Sheet& sheet_;
    const Panel& panel_;
    glm::dmat4 from_car_;
    glm::dmat3 normals_from_car_;
    bool mirrored_;
    std::vector<glm::dvec3> ways_;
    GeometryBuilder builder_;
    int arcs_ = 0;
};

}  // namespace

scene::Geometry shell_of(const Sheet& sheet, const Panel& panel, double tolerance, const glm::dmat4& from_car,
                         bool textured) {
    return Shell(sheet, panel, from_car, textured).build(tolerance);
}

}  // namespace vrut
