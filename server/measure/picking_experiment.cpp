// How long a pick takes, and how often it is wrong, for three ways to pick.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "measure/experiments.hpp"
#include "mesh/picking.hpp"

namespace vrut::server::measure {

namespace {

constexpr int kPickingViews = 4, kPicksInView = 60, kPictures = 5;

double ms_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// Points of a view, -1 to 1, spread evenly by the golden ratio's two-dimensional kin (R2 sequence).
glm::dvec2 point_of(int i) {
    const glm::dvec2 part = glm::fract(glm::dvec2(0.7548776662466927, 0.5698402909980532) * (i + 0.5));
    return 2.0 * part - 1.0;
}

mesh::Ray ray_through(const plan::View& view, const glm::dvec2& point) {
    const double aspect = static_cast<double>(view.width) / view.height;
    return {view.camera.eye, scene::direction_through(view.camera, aspect, point)};
}

/// Möller and Trumbore's test, in world space.
struct Crossing {
    double distance = 0;
    bool front = false;
};
std::optional<Crossing> cross(const mesh::Ray& ray, const std::array<glm::dvec3, 3>& corner) {
    const glm::dvec3 a = corner[1] - corner[0], b = corner[2] - corner[0];
    const glm::dvec3 p = glm::cross(ray.direction, b);
    const double determinant = glm::dot(a, p);
    if (determinant == 0) return {};
    const glm::dvec3 s = ray.origin - corner[0];
    const double u = glm::dot(s, p) / determinant;
    const glm::dvec3 q = glm::cross(s, a);
    const double v = glm::dot(ray.direction, q) / determinant;
    if (u < 0 || v < 0 || u + v > 1) return {};
    const double distance = glm::dot(b, q) / determinant;
    if (!(distance > 0)) return {};
    return Crossing{distance, determinant > 0};
}

template <class Number>
scene::Id id_of(const scene::PlacedScene& placed, Number node) {
    return placed.scene->nodes()[static_cast<std::size_t>(node)].id;
}

/// The node in front, by asking every triangle that is drawn: the judge, with nothing to go wrong in.
scene::Index ask_all(const scene::PlacedScene& placed, const mesh::Ray& ray) {
    const std::vector<bool> shown = scene::shown_nodes(placed, ray.origin);
    scene::Index nearest = scene::kNone;
    double distance = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const auto* data = std::get_if<scene::GeometryData>(&placed.scene->nodes()[i].data);
        if (!shown[i] || !data || data->geometry == scene::kNone) continue;
        const scene::Geometry& geometry =
            placed.scene->geometries()[static_cast<std::size_t>(data->geometry)];
        const glm::dmat4& world = placed.world[i];
        const double turned = scene::relative_determinant(glm::dmat3(world));
        const bool both =
            placed.scene->material(placed.nodes[i].material).two_sided || !(std::abs(turned) > 1e-12);
        for (const glm::uvec3& triangle : geometry.triangles) {
            std::array<glm::dvec3, 3> corners{};
            for (int k = 0; k < 3; ++k)
                corners[static_cast<std::size_t>(k)] =
                    glm::dvec3(world * glm::dvec4(geometry.positions[triangle[k]], 1));
            const auto crossing = cross(ray, corners);
            if (!crossing || crossing->distance > distance) continue;
            if (!both && crossing->front != (turned > 0)) continue;
            if (crossing->distance == distance && nearest != scene::kNone &&
                id_of(placed, i) < id_of(placed, nearest))
                continue;  // of equally near ones that of the higher id is in front
            distance = crossing->distance;
            nearest = static_cast<scene::Index>(i);
        }
    }
    return nearest;
}

struct Answers {
    std::vector<double> ms;
    int wrong = 0;

    template <class Ask>
    auto ask(const Ask& question) {
        const auto start = std::chrono::steady_clock::now();
        auto answer = question();
        ms.push_back(ms_since(start));
        return answer;
    }
    /// Every move of the view needs another picture of ids.
    std::vector<scene::Index> draw(renderer::Renderer& renderer, const plan::View& view) {
        return ask([&] { return renderer.node_ids(view); });
    }
};

/// What the picture of ids has at a point.
scene::Index at_point(const std::vector<scene::Index>& ids, const plan::View& view, const glm::dvec2& point) {
    const auto pixel = [](double part, int count) {
        return std::clamp(static_cast<int>(part * count), 0, count - 1);
    };
    const int x = pixel((point.x + 1) / 2, view.width), y = pixel((1 - point.y) / 2, view.height);
    return ids[static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width) +
               static_cast<std::size_t>(x)];
}

}  // namespace

Row Laboratory::picking_row(const Subject& subject, const std::string& method) const {
    const int picks = kPickingViews * kPicksInView;
    return row_of({"picking", method, subject, kModes[0], {}, Experiment::Judge::none, picks}, {});
}

std::vector<Row> Laboratory::picking_rows(const Subject& subject) const {
    std::vector<Row> rows;
    rows.reserve(kPickings.size());
    for (const char* method : kPickings) rows.push_back(picking_row(subject, method));
    return rows;
}

void Laboratory::run_picking(const Subject& subject, const PartDone& done) {
    const std::vector<Row> wanted = picking_rows(subject);
    if (std::all_of(wanted.begin(), wanted.end(), [&](const Row& row) { return rows_.has(row); })) return;
    std::array<Answers, kPickings.size()> answers;
    auto& [ray, ids, small_ids, all] = answers;
    renderer_.node_ids(subject.home);  // everything comes to the GPU
    for (int v = 0; v < kPickingViews; ++v) {
        const plan::View view = on_orbit(subject.home, v, kPickingViews);
        const plan::View small = view_with(view, {.scale = 0.5});
        std::vector<scene::Index> pictures[2];
        for (int i = 0; i < kPictures; ++i) {
            pictures[0] = ids.draw(renderer_, view);
            pictures[1] = small_ids.draw(renderer_, small);
        }
        for (int i = 0; i < kPicksInView; ++i) {
            const glm::dvec2 point = point_of(v * kPicksInView + i);
            const scene::Index truth =
                all.ask([&] { return ask_all(*view.scene, ray_through(view, point)); });
            const scene::Index met = ray.ask([&] {
                const auto hit = mesh::pick(*view.scene, ray_through(view, point));
                return hit ? hit->node : scene::kNone;
            });
            ray.wrong += met != truth;
            ids.wrong += at_point(pictures[0], view, point) != truth;
            small_ids.wrong += at_point(pictures[1], small, point) != truth;
            if (done) done((v + static_cast<double>(i + 1) / kPicksInView) / kPickingViews);
        }
    }
    for (std::size_t k = 0; k < answers.size(); ++k) {
        Row row = wanted[k];
        row.cost.ms = spread_of(answers[k].ms);
        row.wrong = answers[k].wrong / static_cast<double>(kPickingViews * kPicksInView);
        if (!rows_.has(row)) rows_.add(row);
    }
}

}  // namespace vrut::server::measure
