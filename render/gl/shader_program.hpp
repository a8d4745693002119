#pragma once

#include <glm/glm.hpp>
#include <string_view>

#include "gl/handles.hpp"

namespace vrut::gl {

/// A vertex and a fragment shader, linked. Throws std::logic_error with the driver's log: our own fault.
GlProgram make_program(std::string_view vertex_source, std::string_view fragment_source);

}  // namespace vrut::gl
