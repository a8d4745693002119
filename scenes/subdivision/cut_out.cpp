#include <algorithm>
#include <cmath>
#include <map>

#include "sheet.hpp"

namespace vrut {

namespace {

constexpr double kSnap = 0.2;         // of a vertex's shortest edge: how far it may move onto the cut
constexpr double kSmallPiece = 2e-5;  // square metres; what is smaller is dropped
constexpr double kBehind = 0.3;       // of that edge: how much farther in another vertex has to be
constexpr std::uint32_t kNobody = ~0U;

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

glm::dvec3 unit_or(const glm::dvec3& v, const glm::dvec3& other) {
    const double length = glm::length(v);
    return length > 1e-12 ? v / length : other;
}

class Cutter {
public:
    Cutter(const AdaptiveMesh& mesh, const CuttingTable& table, const Field& field)
        : mesh_(mesh), field_(field), table_(table) {}

    Sheet run() {
        classify();
        find_crossings();
        snap();
        for (const int t : table_.order) add(mesh_.triangles()[static_cast<std::size_t>(t)]);
        return std::move(sheet_);
    }

private:
    /// Where an edge meets the cut.
    struct Crossing {
        LimitSurface::Point point;
        double share = 0;   ///< of the way from the lower vertex to the higher
        bool hard = false;  ///< the edge is hard or a border
        std::uint32_t number = kNobody;
    };
    using Triangle = AdaptiveMesh::Triangle;

    std::uint32_t vertex(const Triangle& triangle, std::size_t k) const {
        return mesh_.corners()[triangle.corners[k % 3]].vertex;
    }
    const glm::dvec3& place(std::uint32_t v) const { return mesh_.vertices()[v].position; }

    void classify() {
        values_.resize(mesh_.vertices().size());
        sides_.resize(mesh_.vertices().size());
        for (std::uint32_t v = 0; v < values_.size(); ++v) {
            values_[v] = field_(place(v), table_.normals[v]);
            sides_[v] = values_[v] < 0 ? -1 : 1;
        }
        points_.assign(values_.size(), kNobody);
    }

    void find_crossings() {
        const auto& triangles = mesh_.triangles();
        for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
            const Triangle& triangle = triangles[static_cast<std::size_t>(t)];
            for (std::size_t k = 0; k < 3; ++k) {
                if (triangle.neighbours[k] > t) continue;  // it is the neighbour's turn
                const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
                if (sides_[vertex(triangle, a)] == sides_[vertex(triangle, b)]) continue;
                const bool rising = vertex(triangle, a) < vertex(triangle, b);
                Crossing crossing = find_crossing(triangle, rising ? a : b, rising ? b : a);
                crossing.hard = mesh_.is_feature(triangle, k);
                crossings_.emplace(edge_key(vertex(triangle, a), vertex(triangle, b)), crossing);
            }
        }
    }

    /// Where the field is 0 between two corners, on the limit surface: by false position, then halving.
    Crossing find_crossing(const Triangle& triangle, std::size_t from, std::size_t to) const {
        double low = 0, high = 1, at_low = values_[vertex(triangle, from)],
               at_high = values_[vertex(triangle, to)];
        Crossing crossing;
        for (int step = 0; step < 12; ++step) {
            const double guess = low + (high - low) * std::clamp(at_low / (at_low - at_high), 0.02, 0.98);
            crossing.share = step % 3 == 2 ? (low + high) / 2 : guess;
            crossing.point = mesh_.between(triangle, from, to, crossing.share);
            const double value = field_(crossing.point.position, crossing.point.normal);
            if (std::abs(value) < 1e-7) break;
            const bool beyond = (value < 0) != (at_low < 0);
            (beyond ? high : low) = crossing.share;
            (beyond ? at_high : at_low) = value;
        }
        return crossing;
    }

    /// Vertices close to the cut move onto it, so that no slivers come about; but not the only ones inside a
    /// narrow strip.
    void snap() {
        std::unordered_map<std::uint32_t, double>
            farthest;  // of the field's values beside a vertex, on its side
        for (const auto& [key, crossing] : crossings_)
            for (const auto v : {static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key)})
                farthest.emplace(v, 0);
        for (const Triangle& triangle : mesh_.triangles())
            for (std::size_t k = 0; k < 3; ++k) {
                const auto found = farthest.find(vertex(triangle, k));
                if (found == farthest.end()) continue;
                for (std::size_t l = k + 1; l < k + 3; ++l)
                    found->second =
                        std::max(found->second, sides_[found->first] * values_[vertex(triangle, l)]);
            }
        std::map<std::uint32_t, std::pair<double, std::uint64_t>> nearest;
        for (const auto& [key, crossing] : crossings_)
            for (const auto v : {static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key)}) {
                const double distance = glm::distance(place(v), crossing.point.position);
                if (distance > kSnap * table_.shortest[v] || (table_.feature[v] && !crossing.hard)) continue;
                if (farthest.at(v) < least_behind(v)) continue;
                const auto [found, is_new] = nearest.emplace(v, std::pair{distance, key});
                if (!is_new) found->second = std::min(found->second, std::pair{distance, key});
            }
        // Nor where an edge leads through more of its side to another cut: that would be lost.
        for (const auto& [key, crossing] : crossings_)
            for (const auto v : {static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key)})
                if (nearest.contains(v) && lies_between(v, crossing)) nearest.erase(v);
        for (const auto& [v, choice] : nearest) {
            sides_[v] = 0;
            moved_[v] = choice.second;
        }
    }

    double least_behind(std::uint32_t v) const { return std::abs(values_[v]) + kBehind * table_.shortest[v]; }

    bool lies_between(std::uint32_t v, const Crossing& crossing) const {
        const glm::dvec3& end = crossing.point.position;
        return sides_[v] * field_((place(v) + end) / 2.0, table_.normals[v]) > 1.5 * std::abs(values_[v]);
    }

    void add(const Triangle& triangle) {
        struct Item {
            std::uint32_t point;
            glm::dvec3 normal;
        };
        std::array<int, 3> sides{};
        for (std::size_t k = 0; k < 3; ++k) sides[k] = sides_[vertex(triangle, k)];
        const auto [least, most] = std::minmax_element(sides.begin(), sides.end());
        if (*least == 1 || (*least == 0 && (*most == 1 || !holds_centre(triangle)))) return;
        std::vector<Item> items;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t l = (k + 1) % 3;
            if (sides[k] <= 0) items.push_back({point_of(vertex(triangle, k)), normal_of(triangle, k)});
            if (sides[k] * sides[l] == -1) {
                Crossing& crossing = crossings_.at(edge_key(vertex(triangle, k), vertex(triangle, l)));
                items.push_back({point_of(crossing), normal_of(triangle, k, l, crossing)});
            }
        }
        const auto add_triangle = [&](std::size_t a, std::size_t b, std::size_t c) {
            sheet_.triangles.push_back({{items[a].point, items[b].point, items[c].point},
                                        {items[a].normal, items[b].normal, items[c].normal}});
        };
        const auto apart = [&](std::size_t a, std::size_t b) {
            return glm::distance(sheet_.points[items[a].point].position,
                                 sheet_.points[items[b].point].position);
        };
        if (items.size() == 3) {
            add_triangle(0, 1, 2);
        } else if (apart(0, 2) <= apart(1, 3)) {
            add_triangle(0, 1, 2);
            add_triangle(0, 2, 3);
        } else {
            add_triangle(0, 1, 3);
            add_triangle(1, 2, 3);
        }
    }

    bool holds_centre(const Triangle& triangle) const {
        glm::dvec3 centre(0), normal(0);
        for (std::size_t k = 0; k < 3; ++k) {
            centre += place(vertex(triangle, k)) / 3.0;
            normal += table_.normals[vertex(triangle, k)];
        }
        return field_(centre, unit_or(normal, {0, 1, 0})) < 0;
    }

    std::uint32_t add_point(const glm::dvec3& position, const glm::dvec3& normal, const glm::vec2& texcoord) {
        sheet_.points.push_back({position, normal, texcoord});
        return static_cast<std::uint32_t>(sheet_.points.size() - 1);
    }

    std::uint32_t point_of(std::uint32_t v) {
        if (points_[v] != kNobody) return points_[v];
        if (const auto moved = moved_.find(v); moved != moved_.end()) {
            const LimitSurface::Point& point = crossings_.at(moved->second).point;
            points_[v] = add_point(point.position, table_.feature[v] ? table_.normals[v] : point.normal,
                                   glm::vec2(point.texcoord));
        } else {
            points_[v] = add_point(place(v), table_.normals[v], mesh_.vertices()[v].texcoord);
        }
        return points_[v];
    }

    std::uint32_t point_of(Crossing& crossing) {
        if (crossing.number == kNobody)
            crossing.number =
                add_point(crossing.point.position, crossing.point.normal, glm::vec2(crossing.point.texcoord));
        return crossing.number;
    }

    const glm::dvec3& own_normal(const Triangle& triangle, std::size_t k) const {
        return table_.shared.normals[table_.shared.first[triangle.corners[k]]];
    }

    glm::dvec3 normal_of(const Triangle& triangle, std::size_t k) const {
        const std::uint32_t v = vertex(triangle, k);
        if (sides_[v] != 0 || table_.feature[v]) return own_normal(triangle, k);
        return crossings_.at(moved_.at(v)).point.normal;
    }

    glm::dvec3 normal_of(const Triangle& triangle, std::size_t k, std::size_t l,
                         const Crossing& crossing) const {
        if (!crossing.hard) return crossing.point.normal;
        if (vertex(triangle, k) > vertex(triangle, l)) std::swap(k, l);
        return unit_or(glm::mix(own_normal(triangle, k), own_normal(triangle, l), crossing.share),
                       crossing.point.normal);
    }

    const AdaptiveMesh& mesh_;
    const Field& field_;
    const CuttingTable& table_;
    std::vector<double> values_;
    std::vector<int> sides_;  // -1 inside, 0 on the cut, 1 outside
    std::vector<std::uint32_t> points_;
    std::unordered_map<std::uint64_t, Crossing> crossings_;
    std::unordered_map<std::uint32_t, std::uint64_t> moved_;
    Sheet sheet_;
};

/// Sets of numbers that grow together.
class Sets {
public:
    explicit Sets(std::size_t count) {
        parents_.reserve(count);
        for (std::size_t i = 0; i < count; ++i) parents_.push_back(i);
    }
    std::size_t find(std::size_t i) {
        while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
        return i;
    }
    void join(std::size_t a, std::size_t b) {
        parents_[std::max(find(a), find(b))] = std::min(find(a), find(b));
    }

private:
    std::vector<std::size_t> parents_;
};

std::size_t corner(std::size_t triangle, std::size_t k) { return 3 * triangle + k % 3; }

/// Which corners of a sheet's triangles are one fan around a point, and which triangles hang together by
/// edges.
struct Connections {
    explicit Connections(const Sheet& sheet)
        : fans(3 * sheet.triangles.size()), pieces(sheet.triangles.size()) {
        std::vector<std::pair<std::uint64_t, std::size_t>> edges(3 * sheet.triangles.size());
        for (std::size_t t = 0; t < sheet.triangles.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto& points = sheet.triangles[t].points;
                edges[corner(t, k)] = {edge_key(points[k], points[(k + 1) % 3]), corner(t, k)};
            }
        std::sort(edges.begin(), edges.end());
        for (std::size_t i = 0; i < edges.size(); ++i) {
            const std::size_t c = edges[i].second;
            if (i + 1 == edges.size() || edges[i + 1].first != edges[i].first) {
                border.push_back(c);
                continue;
            }
            const std::size_t other = edges[++i].second;
            fans.join(c, corner(other / 3, other % 3 + 1));
            fans.join(corner(c / 3, c % 3 + 1), other);
            pieces.join(c / 3, other / 3);
        }
        std::sort(border.begin(), border.end());
    }

    Sets fans, pieces;
    std::vector<std::size_t> border;  ///< corners from which a border's edge goes to the next
};

double area_of(const Sheet& sheet, const Sheet::Triangle& triangle) {
    const auto place = [&](std::size_t k) { return sheet.points[triangle.points[k]].position; };
    return glm::length(glm::cross(place(1) - place(0), place(2) - place(0))) / 2;
}

/// Gives each fan of triangles around a point a point of its own, leaves out pieces too small to see, and
/// notes the border.
Sheet tidied(const Sheet& sheet) {
    Connections connections(sheet);
    const std::size_t count = sheet.triangles.size();
    std::vector<double> areas(count);
    for (std::size_t t = 0; t < count; ++t)
        areas[connections.pieces.find(t)] += area_of(sheet, sheet.triangles[t]);
    const auto stays = [&](std::size_t t) { return areas[connections.pieces.find(t)] >= kSmallPiece; };

    Sheet result;
    std::vector<std::uint32_t> numbers(3 * count, kNobody);
    const auto number_of = [&](std::size_t t, std::size_t k) -> std::uint32_t& {
        return numbers[connections.fans.find(corner(t, k))];
    };
    for (std::size_t t = 0; t < count; ++t) {
        if (!stays(t)) continue;
        Sheet::Triangle triangle = sheet.triangles[t];
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t& number = number_of(t, k);
            if (number == kNobody) {
                number = static_cast<std::uint32_t>(result.points.size());
                result.points.push_back(sheet.points[triangle.points[k]]);
            }
            triangle.points[k] = number;
        }
        result.triangles.push_back(triangle);
    }
    for (const std::size_t c : connections.border)
        if (stays(c / 3)) result.border.push_back({number_of(c / 3, c % 3), number_of(c / 3, c % 3 + 1)});
    return result;
}

}  // namespace

CuttingTable::CuttingTable(const AdaptiveMesh& mesh)
    : shared(mesh),
      order(mesh.order()),
      normals(mesh.vertices().size(), glm::dvec3(0)),
      shortest(mesh.vertices().size(), 1e300),
      feature(mesh.vertices().size(), false) {
    for (const auto& corner : mesh.corners()) normals[corner.vertex] += glm::dvec3(corner.normal);
    for (glm::dvec3& normal : normals) normal = unit_or(normal, {0, 1, 0});
    for (const auto& triangle : mesh.triangles())
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.corners()[triangle.corners[(k + 1) % 3]].vertex,
                                b = mesh.corners()[triangle.corners[(k + 2) % 3]].vertex;
            const double length = glm::distance(mesh.vertices()[a].position, mesh.vertices()[b].position);
            shortest[a] = std::min(shortest[a], length);
            shortest[b] = std::min(shortest[b], length);
            if (mesh.is_feature(triangle, k)) feature[a] = feature[b] = true;
        }
}

Sheet cut_out(const AdaptiveMesh& mesh, const CuttingTable& table, const Field& field) {
    return tidied(Cutter(mesh, table, field).run());
}

}  // namespace vrut
