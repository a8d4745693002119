#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "measure/front.hpp"
#include "measure/measure.hpp"

namespace vrut::server::measure {

/// A point with what lies between the 5th and the 95th percentile, and a word beside it.
struct Mark {
    double x = 0, y = 0;
    std::optional<Spread> x_spread, y_spread;
    std::string label = {};
};

/// Marks, or a line through them, of one look; the axes reach as far as all but stairs.
struct Series {
    enum class Look { point, dominated, ring, stairs, line, rule };
    Look look = Look::point;
    std::string title;  ///< in the legend; empty: not there
    std::vector<Mark> marks;
    int color = 0;  ///< of kColors, of lines and points
};

/// A chart with logarithmic axes; x may be linear, from 0 on.
struct Plot {
    std::string file;  ///< without .svg: letters, digits and hyphens
    std::string title, x_label, y_label;
    std::vector<Series> series;
    /// Where the axis shows 0: what is below is drawn there, and called by this name.
    std::optional<double> floor;
    std::string floor_name = "exact";
    std::string subtitle = {};
    bool linear_x = false;
};

/// What gnuplot reads: writes an SVG picture to `output`, an absolute path.
std::string script_of(const Plot& plot, const std::filesystem::path& output);
/// Text as gnuplot takes it, in single quotes, on one line.
std::string quoted(const std::string& text);

/// Throws std::runtime_error with a sentence where gnuplot is not installed.
void require_gnuplot();
/// Has gnuplot draw plots into a folder. Throws std::runtime_error.
void draw(const std::vector<Plot>& plots, const std::filesystem::path& folder);

}  // namespace vrut::server::measure
