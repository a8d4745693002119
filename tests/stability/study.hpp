#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "renderer/renderer.hpp"

/// Each method is pushed as far as its limit or beyond: how far it holds, and what happens there.
namespace vrut::stability {

/// As much as a test has time for, or all that the page shows.
enum class Form { brief, whole };

/// Of a method that returned nothing where its study asks for something: a failure.
inline constexpr double kNothing = std::numeric_limits<double>::infinity();

/// A measure over the parameter; both 0 or above. The parameter rises.
struct Curve {
    std::string title;
    struct Point {
        double x = 0, y = 0;
    };
    std::vector<Point> points = {};
};

/// How far a method of the product holds.
struct Study {
    std::string file;                ///< of its chart: letters, digits and hyphens
    std::string title;               ///< what the method is pushed by
    std::string parameter, measure;  ///< with their units
    double bound = 0;                ///< of the measure: what is above it has failed
    /// The parameter from which the method may fail; none: it has to hold as far as it is measured.
    std::optional<double> limit = {};
    Curve method = {};             ///< measured, of the product's own code
    Curve baseline = {};           ///< how another method does, for comparison only; without points: none
    std::string explanation = {};  ///< sentences: how the method does it, and what happens beyond its limit
    std::string cost = {};         ///< a sentence
};

/// Why the study fails, in a sentence; none where it does not: the method was measured as far as its limit,
/// is within the bound below it, and everything is a number.
std::optional<std::string> failure(const Study& study);
/// That the method is within the bound at its limit, too, so that the limit can be told as better.
std::optional<std::string> improvement(const Study& study);
/// The first parameter at which the curve is above the bound; none where it never is.
std::optional<double> fails_from(const Curve& curve, double bound);

/// Numbers from -1 to 1, the same in each run (Numerical Recipes' generator).
class Noise {
public:
    double next() {
        state_ = state_ * 1664525 + 1013904223;
        return (state_ >> 8) / double(1 << 23) - 1;
    }

private:
    std::uint32_t state_ = 1;
};

/// What studies are made with.
struct Laboratory {
    renderer::Renderer& renderer;
    Form form = Form::whole;

    /// The first of `points`, which rise, the last, and in between as many as the form has time for.
    std::vector<double> chosen(std::vector<double> points) const;
};

/// What there is to study, in the page's order.
struct Topic {
    const char* name;
    Study (*study)(const Laboratory&);
};
const std::vector<Topic>& topics();

// traced_scene.cpp
Study far_positions(const Laboratory& laboratory);
Study deep_views(const Laboratory& laboratory);
Study large_triangles(const Laboratory& laboratory);
// detail.cpp
Study outlines_of_levels(const Laboratory& laboratory);
Study popping_levels(const Laboratory& laboratory);
// glass.cpp
Study crossing_panes(const Laboratory& laboratory);
Study rings_of_panes(const Laboratory& laboratory);
Study many_panes(const Laboratory& laboratory);
Study panes_in_one_place(const Laboratory& laboratory);
Study panes_by_id(const Laboratory& laboratory);
Study nearly_opaque_panes(const Laboratory& laboratory);
// materials.cpp
Study minified_textures(const Laboratory& laboratory);
Study odd_textures(const Laboratory& laboratory);
Study small_odd_textures(const Laboratory& laboratory);
Study small_matrices(const Laboratory& laboratory);
Study mirroring_matrices(const Laboratory& laboratory);
Study flipped_normals(const Laboratory& laboratory);
// mirrors.cpp
Study many_mirrors(const Laboratory& laboratory);
Study edge_on_mirrors(const Laboratory& laboratory);
Study bent_mirrors(const Laboratory& laboratory);
Study mirrors_in_mirrors(const Laboratory& laboratory);
// sections.cpp
Study sections_along_the_view(const Laboratory& laboratory);
Study sections_at_a_face(const Laboratory& laboratory);
Study sections_through_many_walls(const Laboratory& laboratory);
Study sections_of_slivers(const Laboratory& laboratory);
Study sections_of_gaps(const Laboratory& laboratory);
// measures.cpp
Study corners_of_noisy_meshes(const Laboratory& laboratory);
Study edges_of_noisy_meshes(const Laboratory& laboratory);
Study circles_of_noisy_meshes(const Laboratory& laboratory);
Study planes_of_noisy_meshes(const Laboratory& laboratory);
Study mistakes_on_noisy_meshes(const Laboratory& laboratory);
Study values_of_noisy_meshes(const Laboratory& laboratory);
Study circles_of_few_edges(const Laboratory& laboratory);
Study discs_of_few_edges(const Laboratory& laboratory);
Study circles_of_short_arcs(const Laboratory& laboratory);
Study planes_of_slivers(const Laboratory& laboratory);
Study planes_of_rounded_slivers(const Laboratory& laboratory);
// moves.cpp
Study many_moves(const Laboratory& laboratory);
Study over_the_pole(const Laboratory& laboratory);
Study through_the_focus(const Laboratory& laboratory);
Study largest_numbers(const Laboratory& laboratory);
// comfort.cpp
Study lag_of_walls(const Laboratory& laboratory);
Study walls_that_catch_up(const Laboratory& laboratory);
// input.cpp
Study moves_lost(const Laboratory& laboratory);
Study releases_lost(const Laboratory& laboratory);
Study jittering_taps(const Laboratory& laboratory);
Study jumping_clocks(const Laboratory& laboratory);
// picks.cpp
Study slivers(const Laboratory& laboratory);
Study shared_edges(const Laboratory& laboratory);
Study picks_through_glass(const Laboratory& laboratory);
// encoding.cpp
Study thin_saturated_lines(const Laboratory& laboratory);
Study dark_gradients(const Laboratory& laboratory);
// bursts.cpp
Study repeated_ids(const Laboratory& laboratory);
Study bursts_of_moves(const Laboratory& laboratory);
Study storms_of_sizes(const Laboratory& laboratory);
// links.cpp
Study slow_links(const Laboratory& laboratory);
Study long_links(const Laboratory& laboratory);
Study levels_of_long_links(const Laboratory& laboratory);
Study stalls(const Laboratory& laboratory);
// warps.cpp
Study warped_turns(const Laboratory& laboratory);
Study warped_looks(const Laboratory& laboratory);
Study warped_zooms(const Laboratory& laboratory);
Study warped_glass(const Laboratory& laboratory);
Study warped_mirrors(const Laboratory& laboratory);
Study warped_highlights(const Laboratory& laboratory);
Study warped_bars(const Laboratory& laboratory);
Study warped_edges(const Laboratory& laboratory);
Study warped_parts(const Laboratory& laboratory);
// levels.cpp
Study noisy_times(const Laboratory& laboratory);
Study loads_at_a_border(const Laboratory& laboratory);
// long_run.cpp
Study long_runs(const Laboratory& laboratory);
Study memory_of_long_runs(const Laboratory& laboratory);

}  // namespace vrut::stability
