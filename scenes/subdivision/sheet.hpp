#pragma once

#include <functional>

#include "refinement.hpp"

namespace vrut {

/// For each corner of a mesh the one of its vertex that shares its normal, to about two degrees, and the mean
/// normal of those that do.
struct SharedCorners {
    explicit SharedCorners(const AdaptiveMesh& mesh);
    std::vector<std::uint32_t> first;
    std::vector<glm::dvec3> normals;  ///< unit or zero; of those that `first` names
};

/// Triangles as a scene holds them: vertices are split where edges are hard, none is unused, and no triangle
/// is without area.
scene::Geometry geometry_of(const AdaptiveMesh& mesh, bool textured);

/// Gathers triangles into a geometry. Vertices with the same number and normal become one.
class GeometryBuilder {
public:
    struct Vertex {
        std::uint32_t number = 0;  ///< one place has one number
        glm::dvec3 position{0}, normal{0};
        glm::vec2 texcoord{0};
    };
    explicit GeometryBuilder(bool textured) : textured_(textured) {}
    /// Leaves out what has no area; normals that lean away from their triangle become its own. Positions
    /// become multiples of a micrometre.
    void add(const std::array<Vertex, 3>& corners);
    scene::Geometry take() { return std::move(geometry_); }

private:
    struct Key {
        std::uint32_t number;
        std::array<int, 3> normal;
        bool operator==(const Key&) const = default;
    };
    struct Hash {
        std::size_t operator()(const Key& key) const;
    };
    unsigned number_of(const Vertex& vertex);

    bool textured_;
    scene::Geometry geometry_;
    std::unordered_map<Key, unsigned, Hash> numbers_;
};

/// An open piece of a surface.
struct Sheet {
    struct Point {
        glm::dvec3 position{0}, normal{0};  ///< one normal for each place, also on hard edges
        glm::vec2 texcoord{0};
    };
    struct Triangle {
        std::array<std::uint32_t, 3> points{};
        std::array<glm::dvec3, 3> normals{};  ///< as shaded
    };
    std::vector<Point> points;
    std::vector<Triangle> triangles;
    std::vector<std::array<std::uint32_t, 2>> border;  ///< its edges, with the sheet on their left
};

/// What cutting a mesh takes again and again.
struct CuttingTable {
    explicit CuttingTable(const AdaptiveMesh& mesh);
    SharedCorners shared;
    std::vector<int> order;
    std::vector<glm::dvec3> normals;  ///< one for each vertex, also on hard edges
    std::vector<double> shortest;     ///< edge at each vertex
    std::vector<bool> feature;        ///< the vertex is on a border or a hard edge
};

using Field = std::function<double(const glm::dvec3& position, const glm::dvec3& normal)>;

/// The part of a mesh where `field` is below 0, cut along its zero; vertices close to it move onto it. Every
/// point of the result has one border at most, and pieces too small to see are left out.
Sheet cut_out(const AdaptiveMesh& mesh, const CuttingTable& table, const Field& field);

}  // namespace vrut
