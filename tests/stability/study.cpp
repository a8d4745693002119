#include "study.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace vrut::stability {

namespace {

/// Three digits that mean something.
std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

std::string at(const Curve& curve, const Curve::Point& point) {
    return "'" + curve.title + "' is " + number(point.y) + " at " + number(point.x);
}

/// Why the curve is none.
std::optional<std::string> flaw(const Curve& curve) {
    for (const Curve::Point& point : curve.points) {
        if (point.y == kNothing) return "'" + curve.title + "' returned nothing at " + number(point.x);
        if (!(std::isfinite(point.x) && std::isfinite(point.y) && point.x >= 0 && point.y >= 0))
            return at(curve, point);
    }
    return std::nullopt;
}

}  // namespace

std::optional<std::string> failure(const Study& study) {
    const auto& points = study.method.points;
    if (points.empty()) return "'" + study.method.title + "' was not measured";
    for (const Curve* curve : {&study.method, &study.baseline})
        if (const auto why = flaw(*curve)) return why;
    for (const Curve::Point& point : points)
        if (point.y > study.bound && !(study.limit && point.x >= *study.limit))
            return at(study.method, point) + ", above " + number(study.bound);
    if (study.limit && points.back().x < *study.limit)
        return "'" + study.method.title + "' was not pushed as far as " + number(*study.limit);
    return std::nullopt;
}

std::optional<std::string> improvement(const Study& study) {
    for (const Curve::Point& point : study.method.points) {
        if (!study.limit || point.x < *study.limit) continue;
        if (point.y > study.bound) return std::nullopt;
        return at(study.method, point) + " and holds: the limit can be told as better";
    }
    return std::nullopt;
}

std::optional<double> fails_from(const Curve& curve, double bound) {
    for (const Curve::Point& point : curve.points)
        if (point.y > bound) return point.x;
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
        {"panes by their ids", panes_by_id},
        {"nearly opaque panes", nearly_opaque_panes},
        {"matrices that shrink", small_matrices},
        {"matrices that mirror", mirroring_matrices},
        {"normals that point inwards", flipped_normals},
        {"textures seen small", minified_textures},
        {"textures of odd sizes", odd_textures},
        {"textures of odd sizes, seen small", small_odd_textures},
        {"many mirrors", many_mirrors},
        {"mirrors edge-on", edge_on_mirrors},
        {"bent mirrors", bent_mirrors},
        {"mirrors in mirrors", mirrors_in_mirrors},
        {"sections along the view", sections_along_the_view},
        {"sections at a face", sections_at_a_face},
        {"sections through many walls", sections_through_many_walls},
        {"sections of slivers", sections_of_slivers},
        {"sections of gaps", sections_of_gaps},
        {"outlines of fewer triangles", outlines_of_levels},
        {"levels that pop", popping_levels},
        {"picking slivers", slivers},
        {"picking where triangles meet", shared_edges},
        {"picking through glass", picks_through_glass},
        {"corners of noisy meshes", corners_of_noisy_meshes},
        {"edges of noisy meshes", edges_of_noisy_meshes},
        {"circles of noisy meshes", circles_of_noisy_meshes},
        {"planes of noisy meshes", planes_of_noisy_meshes},
        {"mistakes on noisy meshes", mistakes_on_noisy_meshes},
        {"values of noisy meshes", values_of_noisy_meshes},
        {"circles of few edges", circles_of_few_edges},
        {"discs of few edges", discs_of_few_edges},
        {"circles of short arcs", circles_of_short_arcs},
        {"planes of slivers", planes_of_slivers},
        {"planes of rounded slivers", planes_of_rounded_slivers},
        {"thin lines in JPEG", thin_saturated_lines},
        {"dark gradients in JPEG", dark_gradients},
        {"many turns", many_moves},
        {"over the pole", over_the_pole},
        {"through the focus", through_the_focus},
        {"the largest numbers", largest_numbers},
        {"lag of walls", lag_of_walls},
        {"walls that catch up", walls_that_catch_up},
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
        {"warped turns", warped_turns},
        {"warped looks aside", warped_looks},
        {"warped zooms", warped_zooms},
        {"warped glass", warped_glass},
        {"warped mirrors", warped_mirrors},
        {"warped highlights", warped_highlights},
        {"warped bars", warped_bars},
        {"warped edges", warped_edges},
        {"warped parts", warped_parts},
        {"noisy times", noisy_times},
        {"a load at a border", loads_at_a_border},
        {"a long run", long_runs},
        {"memory of a long run", memory_of_long_runs},
    };
    return all;
}

}  // namespace vrut::stability
