#include "stability_page.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "measure/page.hpp"

namespace vrut::stability {

namespace {

using server::measure::Plot;
using server::measure::Series;

/// What the chart shows, from the least above 0 to the greatest.
struct Range {
    double least = std::numeric_limits<double>::infinity(), greatest = 0;
    bool has_zero = false;

    void add(double value) {
        has_zero = has_zero || value == 0;
        if (value > 0) least = std::min(least, value);
        greatest = std::max(greatest, value);
    }
    void add(const Curve& curve) {
        for (const Curve::Point& point : curve.points) add(point.y);
    }
};

Series series_of(const Curve& curve, int color) {
    Series series{Series::Look::line, curve.title, {}, color};
    for (const Curve::Point& point : curve.points) series.marks.push_back({point.x, point.y, {}, {}});
    return series;
}

}  // namespace

server::measure::Section section_of(const Study& study) {
    constexpr int kMethod = 1, kSuccessor = 0, kBound = 3;
    Range range;
    range.add(study.bound);
    range.add(study.method);
    if (study.successor) range.add(*study.successor);
    // What is exact has no place of its own on a logarithmic axis.
    const double lowest =
        range.has_zero ? std::pow(10, std::floor(std::log10(range.least)) - 1) : range.least;
    Plot plot{"stability-" + study.file, study.title, study.parameter, study.measure, {}, {}};
    if (range.has_zero) plot.floor = lowest;
    plot.floor_name = "0";
    plot.series.push_back(series_of(study.method, kMethod));
    if (study.successor) plot.series.push_back(series_of(*study.successor, kSuccessor));
    const auto line = [&](double x1, double y1, double x2, double y2, const std::string& label, int color) {
        plot.series.push_back({Series::Look::rule, "", {{x1, y1, {}, {}, label}, {x2, y2, {}, {}}}, color});
    };
    const auto& points = study.method.points;
    line(points.front().x, study.bound, points.back().x, study.bound, "bound", kBound);
    if (study.limit) line(*study.limit, range.greatest, *study.limit, lowest, "fails from here", kMethod);
    server::measure::Section section{study.title, {}, {plot}};
    section.sentences.push_back("'" + study.method.title + "' " +
                                (study.limit ? "holds below " + server::measure::short_number(*study.limit) +
                                                   " (" + study.parameter + ")."
                                             : "holds as far as it was measured."));
    section.sentences.push_back(study.takes_over);
    section.sentences.push_back("Cost: " + study.cost);
    if (const auto wrong = contradiction(study)) section.sentences.push_back("Not so here: " + *wrong + ".");
    return section;
}

void write_all(Renderer& renderer, const std::string& machine, const std::filesystem::path& folder,
               const std::function<void(double, const std::string&)>& progress) {
    const Laboratory laboratory{renderer};
    std::vector<server::measure::Section> sections;
    server::measure::Section overview{
        "Limits", {}, {}, {{{"method", "fails from", "what takes over", "cost"}, {}}}};
    std::ostringstream csv;
    csv.precision(9);
    csv << "study,curve,x,y\n";
    for (const Topic& topic : topics()) {
        progress(static_cast<double>(sections.size()) / static_cast<double>(topics().size()), topic.name);
        const Study study = topic.study(laboratory);
        sections.push_back(section_of(study));
        sections.back().plots.front().subtitle = renderer.description();
        overview.tables.front().rows.push_back(
            {study.title + ": " + study.method.title,
             study.limit ? server::measure::short_number(*study.limit) + " (" + study.parameter + ")"
                         : "nowhere",
             study.successor ? study.successor->title : study.takes_over, study.cost});
        for (const Curve* curve : {&study.method, study.successor ? &*study.successor : nullptr})
            if (curve)
                for (const Curve::Point& point : curve->points)
                    csv << server::measure::line_of(std::vector{study.file, curve->title}) << ',' << point.x
                        << ',' << point.y << '\n';
    }
    sections.insert(sections.begin(), overview);
    server::measure::write_text(folder / "stability.csv", csv.str());
    server::measure::write_page(
        folder / "stability.html",
        {"VRUT Preview: how far each method holds",
         {"Each method was pushed past its limit on purpose, to see where it fails and what "
          "takes over there. Drawn by " +
          renderer.description() + " on " + machine + "."}},
        sections);
}

}  // namespace vrut::stability
