#pragma once

#include <string>
#include <vector>

#include "level_table.hpp"
#include "measure/plot.hpp"
#include "measure/rows.hpp"

namespace vrut::server::measure {

/// A part of the page: charts that belong together, and what is to be said of them.
struct Section {
    std::string title;
    std::vector<std::string> sentences;
    std::vector<Plot> plots;
    struct Table {
        std::vector<std::string> head;
        std::vector<std::vector<std::string>> rows;
    };
    std::vector<Table> tables = {};
};

/// Rows of one scene, of one size and number of frames each.
struct SceneRows {
    std::string name, slug;  ///< the slug is for file names: letters, digits and hyphens
    bool traced = false;     ///< the judge of what varies one thing is the reference in double precision
    std::vector<Row> rows;
    protocol::LevelTable levels;
    bool stored = false;  ///< they are the server's table; else those that calibrate() would choose
};

/// Letters, digits and hyphens; those of `taken` are avoided, and it is added there.
std::string slug_of(const std::string& name, std::vector<std::string>& taken);

/// The whole rows of `chart` that were measured for a scene, in `mode` where one is named.
std::vector<Row> rows_for(const std::vector<Row>& rows, const std::string& chart,
                          const std::string& mode = {});
/// The server's levels by the rows of chart "modes".
std::vector<protocol::Level> levels_from(const std::vector<Row>& rows);

std::vector<Section> sections_of(const std::vector<SceneRows>& scenes, const std::vector<Row>& triangles);
/// Time against triangles and pixels.
Section growth_section(const std::vector<SceneRows>& scenes, const std::vector<Row>& triangles);
/// Mean, median and p95 of the four modes, beside the thesis's.
Section::Table table_7_1(const std::vector<Row>& rows);

/// A number with three digits that mean something.
std::string short_number(double value);

}  // namespace vrut::server::measure
