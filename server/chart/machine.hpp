#pragma once

#include <string>

namespace vrut::chart {

/// The processor's name and how many hardware threads it has, for the caption of a chart.
std::string machine();

}  // namespace vrut::chart
