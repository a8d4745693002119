#include "measurement/welded_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "measurement/vectors.hpp"

namespace vrut::measurement {

namespace {

/// A triangle lower than this, in lengths of its longest edge, has no normal of its own.
constexpr double kLeastHeight = 1e-10;
/// Triangles without area that lie side by side are given a normal in so many steps.
constexpr int kNormalRounds = 8;

/// 0 if the triangle has no area.
glm::dvec3 normal_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double longest = std::max({largest(b - a), largest(c - b), largest(a - c)});
    if (!(longest > 0) || !std::isfinite(longest)) return glm::dvec3(0);
    const glm::dvec3 area = glm::cross((b - a) / longest, (c - a) / longest);
    const double length = glm::length(area);
    return length > kLeastHeight ? area / length : glm::dvec3(0);
}

}  // namespace

WeldedMesh::WeldedMesh(const scene::Geometry& geometry) : table_(geometry.positions.size()) {
    weld(geometry);
    sort_half_edges();
    twins_.assign(triangles_.size() * 3, kNone);
    is_first_.assign(triangles_.size() * 3, false);
    for (unsigned vertex = 0; vertex < positions().size(); ++vertex) {
        const std::span<Entry> entries = entries_of(vertex);
        std::sort(entries.begin(), entries.end());
        for (std::size_t i = 0, end = 0; i < entries.size(); i = end) {
            while (end < entries.size() && entries[end].far_end == entries[i].far_end) ++end;
            pair_half_edges(entries.subspan(i, end - i));
        }
    }
    find_normals();
}

void WeldedMesh::weld(const scene::Geometry& geometry) {
    std::vector<unsigned> numbers(geometry.positions.size(), kNone);
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (is_finite(geometry.positions[i])) numbers[i] = table_.add(geometry.positions[i]);
    triangles_.reserve(geometry.triangles.size());
    for (const glm::uvec3& t : geometry.triangles) {
        const glm::uvec3 u(numbers[t.x], numbers[t.y], numbers[t.z]);
        if (u.x != u.y && u.y != u.z && u.z != u.x && std::max({u.x, u.y, u.z}) != kNone)
            triangles_.push_back(u);
    }
}

void WeldedMesh::sort_half_edges() {
    const auto count = static_cast<unsigned>(triangles_.size() * 3);
    const auto low = [&](unsigned half_edge) { return std::min(start_of(half_edge), end_of(half_edge)); };
    first_.assign(positions().size() + 2, 0);
    for (unsigned half_edge = 0; half_edge < count; ++half_edge) ++first_[low(half_edge) + 2];
    for (std::size_t i = 2; i < first_.size(); ++i) first_[i] += first_[i - 1];
    entries_.resize(count);
    for (unsigned half_edge = 0; half_edge < count; ++half_edge)
        entries_[first_[low(half_edge) + 1]++] = {std::max(start_of(half_edge), end_of(half_edge)),
                                                  half_edge};
}

void WeldedMesh::pair_half_edges(std::span<const Entry> edge) {
    is_first_[edge[0].half_edge] = true;
    if (edge.size() != 2) return;
    twins_[edge[0].half_edge] = edge[1].half_edge;
    twins_[edge[1].half_edge] = edge[0].half_edge;
}

void WeldedMesh::find_normals() {
    std::vector<unsigned> without;
    normals_.reserve(triangles_.size());
    for (const glm::uvec3& t : triangles_) {
        normals_.push_back(normal_of(positions()[t.x], positions()[t.y], positions()[t.z]));
        if (normals_.back() == glm::dvec3(0)) without.push_back(static_cast<unsigned>(normals_.size() - 1));
    }
    const auto length = [&](unsigned half_edge) {
        return glm::distance(positions()[start_of(half_edge)], positions()[end_of(half_edge)]);
    };
    for (int round = 0; round < kNormalRounds && !without.empty(); ++round) {
        std::erase_if(without, [&](unsigned triangle) {
            unsigned longest = 3 * triangle;
            for (const unsigned half_edge : {longest + 1, longest + 2})
                if (length(half_edge) > length(longest)) longest = half_edge;
            if (twins_[longest] == kNone) return true;
            const glm::dvec3& across = normals_[twins_[longest] / 3];
            normals_[triangle] = agrees_with_twin(longest) ? across : -across;
            return across != glm::dvec3(0);
        });
    }
}

std::optional<unsigned> WeldedMesh::find_half_edge(const glm::dvec3& start, const glm::dvec3& end) const {
    const auto from = table_.find(start), to = table_.find(end);
    if (!from || !to) return {};
    const unsigned low = std::min(*from, *to), high = std::max(*from, *to);
    const auto begin = entries_.begin() + first_[low], stop = entries_.begin() + first_[low + 1];
    for (auto entry = std::lower_bound(begin, stop, Entry{high, 0}); entry != stop && entry->far_end == high;
         ++entry)
        if (start_of(entry->half_edge) == *from) return entry->half_edge;
    return {};
}

}  // namespace vrut::measurement
