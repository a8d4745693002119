#include "study.hpp"

#include <algorithm>
#include <cmath>

namespace vrut::stability {

namespace {

std::string at(const Curve& curve, const Curve::Point& point) {
    return "'" + curve.title + "' is " + std::to_string(point.y) + " at " + std::to_string(point.x);
}

}  // namespace

std::optional<std::string> contradiction(const Study& study) {
    for (const Curve* curve : {&study.method, study.successor ? &*study.successor : &study.method}) {
        if (curve->points.empty()) return "'" + curve->title + "' was not measured";
        for (const Curve::Point& point : curve->points)
            if (!(std::isfinite(point.x) && std::isfinite(point.y) && point.x >= 0 && point.y >= 0))
                return at(*curve, point);
    }
    for (const Curve::Point& point : study.method.points)
        if (point.y > study.bound && !(study.limit && point.x >= *study.limit))
            return at(study.method, point) + ", before its limit";
    if (study.limit) {
        const auto first = std::find_if(study.method.points.begin(), study.method.points.end(),
                                        [&](const Curve::Point& point) { return point.x >= *study.limit; });
        if (first == study.method.points.end()) return "'" + study.method.title + "' was not pushed so far";
        if (!(first->y > study.bound)) return at(study.method, *first) + ", and has not failed";
    }
    if (!study.successor) return std::nullopt;
    for (const Curve::Point& point : study.successor->points)
        if (point.y > study.bound) return at(*study.successor, point) + ", and fails, too";
    return std::nullopt;
}

std::vector<double> Laboratory::chosen(std::vector<double> points) const {
    constexpr std::size_t kBrief = 4;
    if (form == Form::whole || points.size() <= kBrief) return points;
    std::vector<double> few;
    for (std::size_t i = 0; i < kBrief; ++i) few.push_back(points[i * (points.size() - 1) / (kBrief - 1)]);
    return few;
}

const std::vector<Topic>& topics() {
    static const std::vector<Topic> all{
        {"positions far from the origin", far_positions},
        {"depth of the view", deep_views},
        {"large triangles in light", large_triangles},
        {"panes that cross", crossing_panes},
        {"rings of panes", rings_of_panes},
        {"many panes", many_panes},
        {"panes in one place", panes_in_one_place},
        {"nearly opaque panes", nearly_opaque_panes},
        {"matrices that shrink", small_matrices},
        {"matrices that mirror", mirroring_matrices},
        {"normals that point inwards", flipped_normals},
        {"textures seen small", minified_textures},
        {"textures of odd sizes", odd_textures},
        {"many mirrors", many_mirrors},
        {"mirrors edge-on", edge_on_mirrors},
        {"bent mirrors", bent_mirrors},
        {"mirrors in mirrors", mirrors_in_mirrors},
        {"outlines of fewer triangles", outlines_of_levels},
        {"levels that pop", popping_levels},
        {"picking slivers", slivers},
        {"picking where triangles meet", shared_edges},
        {"picking through glass", picks_through_glass},
        {"thin lines in JPEG", thin_saturated_lines},
        {"dark gradients in JPEG", dark_gradients},
        {"many turns", many_moves},
        {"over the pole", over_the_pole},
        {"through the focus", through_the_focus},
        {"the largest numbers", largest_numbers},
        {"lost moves", moves_lost},
        {"lost releases", releases_lost},
        {"messages that come twice", repeated_ids},
        {"taps that jitter", jittering_taps},
        {"clocks that jump", jumping_clocks},
        {"bursts of moves", bursts_of_moves},
        {"storms of resizes", storms_of_sizes},
        {"slow links", slow_links},
        {"long links", long_links},
        {"levels over long links", levels_of_long_links},
        {"stalls", stalls},
        {"noisy times", noisy_times},
        {"a load at a border", loads_at_a_border},
        {"a long run", long_runs},
        {"memory of a long run", memory_of_long_runs},
    };
    return all;
}

}  // namespace vrut::stability
