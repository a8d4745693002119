#pragma once

#include <string>

namespace vrut::server::measure {

/// The processor's name and how many hardware threads it has, for the caption of a chart.
std::string machine();

}  // namespace vrut::server::measure
