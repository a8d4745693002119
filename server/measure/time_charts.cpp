// What costs time alone: the size of scenes and pictures, and the thesis's four modes.
#include <algorithm>
#include <array>

#include "measure/charts.hpp"
#include "measure/experiments.hpp"

namespace vrut::server::measure {

namespace {

Series line_of(const std::vector<Row>& rows, double (*x)(const Row&), const std::string& title) {
    Series series{Series::Look::line, title, {}};
    for (const Row& row : rows) series.marks.push_back({x(row), row.cost.ms.median, {}, row.cost.ms, ""});
    std::sort(series.marks.begin(), series.marks.end(),
              [](const Mark& a, const Mark& b) { return a.x < b.x; });
    return series;
}

}  // namespace

Section growth_section(const std::vector<SceneRows>& scenes, const std::vector<Row>& triangles) {
    Section section{"Time against size", {}, {}};
    Plot plot{"triangles",
              "time against triangles",
              "triangles of the scene (log)",
              "ms a frame: draw, read back (lower is better, log)",
              {},
              {}};
    for (const std::string method : {"every triangle", "detail 0.5"}) {
        std::vector<Row> rows;
        for (const Row& row : triangles)
            if (row.method.substr(row.method.find(' ') + 1) == method) rows.push_back(row);
        if (rows.empty()) continue;
        plot.series.push_back(line_of(
            rows, [](const Row& row) { return std::stod(row.method); }, method));
        plot.series.back().color = static_cast<int>(plot.series.size()) - 1;
    }
    section.plots.push_back(std::move(plot));
    Plot pixels{"pixels",
                "time against pixels",
                "pixels of the picture (log)",
                "ms a frame: draw, read back (lower is better, log)",
                {},
                {}};
    for (const SceneRows& scene : scenes) {
        pixels.series.push_back(line_of(
            rows_for(scene.rows, "pixels"),
            [](const Row& row) { return static_cast<double>(row.width) * row.height; }, scene.name));
        pixels.series.back().color = static_cast<int>(pixels.series.size()) - 1;
    }
    section.plots.push_back(std::move(pixels));
    Plot planes{"sections",
                "time against clip planes with caps",
                "clip planes: none, one through the middle, the six of a box",
                "ms a frame: draw, read back (lower is better, log)",
                {},
                {}};
    planes.linear_x = true;
    for (const SceneRows& scene : scenes) {
        planes.series.push_back(line_of(
            rows_for(scene.rows, "sections"),
            [](const Row& row) { return static_cast<double>(row.setting.clip_planes); }, scene.name));
        planes.series.back().color = static_cast<int>(planes.series.size()) - 1;
    }
    section.plots.push_back(std::move(planes));
    section.sentences = {
        "Medians, with whiskers from the 5th to the 95th percentile of the frames of one orbit. The scenes "
        "of so many triangles are rings made for it, all in view."};
    return section;
}

Section::Table table_7_1(const std::vector<Row>& rows) {
    // Macků, "Využití WebGL engine pro zobrazování automobilů", 2016, table 7.1: Firefox, Chrome, Opera;
    // phone.
    constexpr std::array kDesktop{"7.18 / 6.91 / 6.92", "7.95 / 6.64 / 6.57", "3.63 / 2.24 / 2.27",
                                  "2.79 / 2.30 / 2.25"};
    constexpr std::array kPhone{"323 / 357 / 241", "356 / 358 / 137", "35 / 56 / 47", "32 / 47 / 41"};
    Section::Table table{
        {"mode", "mean ms", "median ms", "p95 ms", "thesis, desktop 2016 ms", "thesis, phone 2016 ms"}, {}};
    for (std::size_t i = 0; i < kModes.size(); ++i)
        for (const Row& row : rows_for(rows, "table-7-1", kModes[i].name))
            table.rows.push_back({kModes[i].name, short_number(row.cost.ms.mean),
                                  short_number(row.cost.ms.median), short_number(row.cost.ms.p95),
                                  kDesktop[i], kPhone[i]});
    return table;
}

}  // namespace vrut::server::measure
