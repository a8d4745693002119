#pragma once

#include "commands/commands.hpp"

namespace vrut::server::commands {

/// What `chart --glass` does: prints the error at the glass in sessions over links, and draws it if there is
/// a folder for that, which must exist. Throws std::runtime_error.
void chart_glass(const ChartArguments& arguments);

}  // namespace vrut::server::commands
