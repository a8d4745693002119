#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "limit_surface.hpp"

namespace vrut {

/// Triangles on the limit surface of a cage, refined edge by edge: to halve an edge splits the triangles on
/// both its sides, so that they stay conforming. Edges inside a quad are swapped where the other diagonal
/// lies closer to the surface: triangles become long where it is straight. Every quad starts as two.
class AdaptiveMesh {
public:
    struct Vertex {
        glm::dvec3 position{0};
        glm::vec2 texcoord{0};
    };
    /// A vertex as one quad has it; at a hard edge two quads differ in the normal.
    struct Corner {
        std::uint32_t vertex = 0;
        std::uint16_t u = 0, v = 0;  ///< in the quad, of kUnit
        glm::vec3 normal{0};
    };
    static constexpr int kUnit = 1 << 15;

    struct Triangle {
        std::array<std::uint32_t, 3> corners{};     ///< counter-clockwise
        std::array<int, 3> neighbours{-1, -1, -1};  ///< across the edge opposite each corner; -1 for none
        int quad = 0;
        std::array<float, 3> errors{};  ///< of those edges, in metres; 0 where one cannot be halved any more
        float own_error = 0;            ///< of the triangle itself: halving its longest edge mends it
    };
    /// The edge of a triangle opposite one of its corners.
    struct Edge {
        int triangle = 0;
        std::size_t opposite = 0;
    };

    /// What else than curvature makes errors, in metres. Either may be empty.
    struct ErrorRule {
        /// Of an edge's ends, and the error that its curvature makes.
        std::function<double(const glm::dvec3&, const glm::dvec3&, double)> edge;
        std::function<double(const std::array<glm::dvec3, 3>&)> triangle;
    };

    explicit AdaptiveMesh(const Cage& cage, ErrorRule rule = {});

    const std::vector<Vertex>& vertices() const { return vertices_; }
    const std::vector<Corner>& corners() const { return corners_; }
    const std::vector<Triangle>& triangles() const { return triangles_; }
    const glm::dvec3& position(std::uint32_t corner) const {
        return vertices_[corners_[corner].vertex].position;
    }
    /// The surface at a place between two of a triangle's corners.
    LimitSurface::Point between(const Triangle& triangle, std::size_t a, std::size_t b, double share) const;
    /// Whether the edge opposite a corner is a border, or one at which the normals of two quads differ: such
    /// an edge is seen as a line.
    bool is_feature(const Triangle& triangle, std::size_t edge) const;

    /// What halving an edge would mend, in metres.
    float error(const Edge& edge) const;

    /// Halves an edge and swaps those around it; `changed` then holds the triangles that are new or
    /// different.
    void halve(const Edge& edge, std::vector<int>& changed);

    /// Triangles in an order in which neighbours stand close together.
    std::vector<int> order() const;

private:
    /// How well an edge fits the surface, and the triangles beside it their purpose.
    struct Fit {
        double error = 0;
        double shape = 0;  ///< the sine of the smallest angle; below 0 where a triangle is turned over
    };

    void add_quads(const Cage& cage);
    void link_neighbours();
    Triangle& at(int triangle) { return triangles_[static_cast<std::size_t>(triangle)]; }
    const Triangle& at(int triangle) const { return triangles_[static_cast<std::size_t>(triangle)]; }
    std::size_t edge_of(int triangle, int neighbour, std::uint32_t first_corner) const;
    std::uint32_t add_corner(std::uint32_t vertex, int quad, int u, int v);
    LimitSurface::Point surface_at(int quad, int u, int v) const;

    bool can_be_halved(int triangle, std::size_t edge) const;
    std::array<std::uint32_t, 2> add_middle(int triangle, std::size_t edge);
    int split(int triangle, std::size_t edge, std::uint32_t middle);
    void split_both(int triangle, std::size_t edge, std::vector<int>& changed);

    double chord_error(std::uint32_t a, std::uint32_t b, int quad, bool is_line) const;
    double edge_error(int triangle, std::size_t edge) const;
    double with_rule(std::uint32_t a, std::uint32_t b, double curvature) const;
    void measure_edge(int triangle, std::size_t edge);
    void measure_own(Triangle& triangle) const;
    std::size_t longest_edge(const Triangle& triangle) const;

    Edge shorter_instead(Edge edge) const;
    double shape(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
    double area_in_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
    bool is_better(const Fit& fit, const Fit& than, double level) const;
    bool swap_if_better(int triangle, std::size_t edge, double level);
    void swap(int triangle, std::size_t edge, double error);

    LimitSurface surface_;
    ErrorRule rule_;
    std::vector<Vertex> vertices_;
    std::vector<Corner> corners_;
    std::vector<Triangle> triangles_;
};

/// A mesh to be refined: `weight` is how many triangles of the picture one of its own makes.
struct RefinedPart {
    AdaptiveMesh* mesh = nullptr;
    double tolerance = 1;
    double weight = 1;
};

/// Halves the edge with the largest error again and again.
class Refinement {
public:
    explicit Refinement(std::span<RefinedPart> parts);

    /// Until all parts together have `count` triangles, or no edge that can be halved.
    void refine_to(double count);
    double count() const;
    /// The error down to which edges have been halved, in metres.
    double reached() const { return reached_ > 0 || heap_.empty() ? reached_ : heap_.front().error; }

private:
    struct Entry {
        float error = 0;
        std::uint32_t part = 0;
        std::uint32_t number = 0;  ///< four times the triangle's, and the edge's
        AdaptiveMesh::Edge edge() const { return {static_cast<int>(number / 4), number % 4}; }
        bool operator<(const Entry& other) const {
            if (error != other.error) return error < other.error;
            return part != other.part ? part > other.part : number > other.number;
        }
        bool operator==(const Entry&) const = default;
    };
    float error_of(std::uint32_t part, const AdaptiveMesh::Edge& edge) const;
    void push(const Entry& entry);
    void push(std::uint32_t part, const std::vector<int>& triangles);
    void drop_outdated();

    std::span<RefinedPart> parts_;
    std::vector<Entry> heap_;
    std::size_t room_ = 1 << 16;  // entries, before those that are out of date are dropped
    double reached_ = 0;
};

}  // namespace vrut
