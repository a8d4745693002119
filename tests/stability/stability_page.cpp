#include "stability_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
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
        if (!std::isfinite(value)) return;
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
    for (const Curve::Point& point : curve.points)
        if (std::isfinite(point.y)) series.marks.push_back({point.x, point.y, {}, {}});
    return series;
}

std::string held(const Study& study) {
    const std::string end = server::measure::short_number(study.limit.value_or(study.method.points.back().x));
    return (study.limit ? "below " : "as far as it was measured, to ") + end + " (" + study.parameter + ")";
}

std::vector<std::string> sentences_on(const Study& study) {
    std::vector<std::string> sentences{"'" + study.method.title + "' holds " + held(study) + "."};
    const auto& baseline = study.baseline;
    if (const auto fails = fails_from(baseline, study.bound))
        sentences.push_back("For comparison: '" + baseline.title + "' fails from " +
                            server::measure::short_number(*fails) + ".");
    sentences.push_back(study.explanation);
    sentences.push_back("Cost: " + study.cost);
    if (const auto why = failure(study)) sentences.push_back("Failed: " + *why + ".");
    if (const auto better = improvement(study)) sentences.push_back("Remark: " + *better + ".");
    return sentences;
}

/// Numbers with six digits: what is measured is not known better.
nlohmann::ordered_json json_of(const Study& study) {
    const auto rounded = [](double value) {
        char text[32];
        std::snprintf(text, sizeof text, "%.6g", value);
        return std::strtod(text, nullptr);
    };
    auto points = nlohmann::ordered_json::array();
    for (const Curve::Point& point : study.method.points)
        points.push_back({rounded(point.x), rounded(point.y)});
    nlohmann::ordered_json json{{"study", study.file},          {"title", study.title},
                                {"method", study.method.title}, {"parameter", study.parameter},
                                {"measure", study.measure},     {"bound", study.bound}};
    if (study.limit) json["limit"] = *study.limit;
    if (const auto why = failure(study)) json["failure"] = *why;
    json["points"] = points;
    return json;
}

std::string csv_of(const std::vector<Study>& studies) {
    std::ostringstream csv;
    csv.precision(9);
    csv << "study,curve,x,y\n";
    for (const Study& study : studies)
        for (const Curve* curve : {&study.method, &study.baseline})
            for (const Curve::Point& point : curve->points)
                csv << server::measure::line_of(std::vector{study.file, curve->title}) << ',' << point.x
                    << ',' << point.y << '\n';
    return csv.str();
}

}  // namespace

server::measure::Section section_of(const Study& study) {
    constexpr int kMethod = 0, kBaseline = 1, kBound = 3;
    Range range;
    range.add(study.bound);
    range.add(study.method);
    range.add(study.baseline);
    // A logarithmic axis has no 0: exact values are drawn at its lower end. Any decade does if all are exact.
    const double least = std::isfinite(range.least) ? range.least : 1;
    const double lowest = range.has_zero ? std::pow(10, std::floor(std::log10(least)) - 1) : least;
    Plot plot{"stability-" + study.file, study.title, study.parameter, study.measure, {}, {}};
    if (range.has_zero) plot.floor = lowest;
    plot.floor_name = "0";
    plot.series.push_back(series_of(study.method, kMethod));
    if (!study.baseline.points.empty()) plot.series.push_back(series_of(study.baseline, kBaseline));
    const auto line = [&](double x1, double y1, double x2, double y2, const std::string& label, int color) {
        plot.series.push_back({Series::Look::rule, "", {{x1, y1, {}, {}, label}, {x2, y2, {}, {}}}, color});
    };
    const auto& points = study.method.points;
    line(points.front().x, study.bound, points.back().x, study.bound, "bound", kBound);
    if (study.limit) line(*study.limit, range.greatest, *study.limit, lowest, "limit", kMethod);
    return {study.title, sentences_on(study), {plot}};
}

std::vector<std::string> write_page(const std::vector<Study>& studies, const std::string& renderer,
                                    const std::string& machine, const std::filesystem::path& folder) {
    std::vector<server::measure::Section> sections{{"Limits", {}, {}, {{{"method", "holds", "cost"}, {}}}}};
    std::vector<std::string> failures;
    for (const Study& study : studies) {
        if (const auto why = failure(study)) {
            failures.push_back(study.title + ": " + *why + ".");
            sections.front().sentences.push_back("Failed: " + failures.back());
        }
        if (study.method.points.empty()) continue;
        sections.front().tables.front().rows.push_back(
            {study.title + ": " + study.method.title, held(study), study.cost});
        sections.push_back(section_of(study));
        sections.back().plots.front().subtitle = renderer;
    }
    server::measure::write_text(folder / "stability.csv", csv_of(studies));
    server::measure::write_page(folder / "stability.html",
                                {"VRUT Preview: how far each method holds",
                                 {"Each method was pushed as far as its limit or beyond. Drawn by " +
                                  renderer + " on " + machine + "."}},
                                sections);
    return failures;
}

void write_results(const std::vector<Study>& studies, const std::filesystem::path& file) {
    std::string text = "[\n";
    for (const Study& study : studies)
        text += json_of(study).dump() + (&study == &studies.back() ? "\n" : ",\n");
    server::measure::write_text(file, text + "]\n");
}

}  // namespace vrut::stability
