#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "measure/charts.hpp"
#include "study.hpp"

namespace vrut::stability {

/// The study's chart, with its bound and its limit, and what is to be said of it.
server::measure::Section section_of(const Study& study);

/// Writes studies to a folder: stability.csv, the charts, and the page stability.html. `renderer` and
/// `machine` are what they were measured on. Returns a sentence for each study that failed. Throws
/// std::runtime_error.
std::vector<std::string> write_page(const std::vector<Study>& studies, const std::string& renderer,
                                    const std::string& machine, const std::filesystem::path& folder);

/// Writes what the table of LIMITS.md is made from, a line for each study: its bound, its limit and the
/// points of its method. Throws std::runtime_error.
void write_results(const std::vector<Study>& studies, const std::filesystem::path& file);

}  // namespace vrut::stability
