#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "measurement/position_table.hpp"
#include "scene/scene.hpp"

namespace vrut::measurement {

/// The triangles of a geometry, whose corners of equal position are one, and how they hang together.
/// Triangles that use a corner twice, or one that is not finite, are left out. Half-edge 3 t + k leads from
/// corner k of triangle t to the next.
class WeldedMesh {
public:
    static constexpr unsigned kNone = ~0U;

    explicit WeldedMesh(const scene::Geometry& geometry);

    /// In the geometry's space: exactly the geometry's.
    const std::vector<glm::dvec3>& positions() const { return table_.positions(); }
    const std::vector<glm::uvec3>& triangles() const { return triangles_; }
    /// Unit; of a triangle without area that of the one across its longest edge. 0 if there is none either.
    const glm::dvec3& normal(unsigned triangle) const { return normals_[triangle]; }

    std::size_t half_edge_count() const { return twins_.size(); }
    unsigned start_of(unsigned half_edge) const {
        return triangles_[half_edge / 3][static_cast<int>(half_edge % 3)];
    }
    unsigned end_of(unsigned half_edge) const {
        return triangles_[half_edge / 3][static_cast<int>((half_edge + 1) % 3)];
    }
    /// The same edge in the one other triangle that has it. kNone if there is no other, or more than one.
    unsigned twin(unsigned half_edge) const { return twins_[half_edge]; }
    /// True for one of an edge's half-edges.
    bool is_first_of_edge(unsigned half_edge) const { return is_first_[half_edge]; }
    /// True if both triangles of the edge agree on the outside.
    bool agrees_with_twin(unsigned half_edge) const {
        return start_of(half_edge) == end_of(twins_[half_edge]);
    }
    /// The half-edge between these positions. None if there is none.
    std::optional<unsigned> find_half_edge(const glm::dvec3& start, const glm::dvec3& end) const;

private:
    struct Entry {
        unsigned far_end, half_edge;
        bool operator<(const Entry& other) const {
            return std::tie(far_end, half_edge) < std::tie(other.far_end, other.half_edge);
        }
    };

    void weld(const scene::Geometry& geometry);
    void sort_half_edges();
    void pair_half_edges(std::span<const Entry> edge);
    void find_normals();
    std::span<Entry> entries_of(unsigned vertex) {
        return std::span(entries_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
    }

    PositionTable table_;
    std::vector<glm::uvec3> triangles_;
    std::vector<glm::dvec3> normals_;
    std::vector<unsigned> first_;  // in entries_, by the edge's lower vertex
    std::vector<Entry> entries_;
    std::vector<unsigned> twins_;
    std::vector<bool> is_first_;
};

}  // namespace vrut::measurement
