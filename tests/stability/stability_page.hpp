#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "measure/charts.hpp"
#include "study.hpp"

namespace vrut::stability {

/// The study's chart, with its bound and the point where the method fails, and what is to be said of it.
server::measure::Section section_of(const Study& study);

/// Makes all studies and writes them to a folder: stability.csv, the charts, and the page stability.html.
/// `machine` is what it runs on; `progress` is told the part that is done, and what comes next. Throws
/// std::runtime_error.
void write_all(Renderer& renderer, const std::string& machine, const std::filesystem::path& folder,
               const std::function<void(double, const std::string&)>& progress);

}  // namespace vrut::stability
