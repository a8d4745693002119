#pragma once

#include "commands/commands.hpp"

namespace vrut::server::commands {

/// Draws the cues of a list, one after the other: `--cues`. Throws std::runtime_error with a sentence.
void draw_cues(const RenderArguments& arguments);

}  // namespace vrut::server::commands
