#pragma once

#include <stdexcept>

namespace vrut::base {

/// What was drawn is lost, with all that the GPU held: a new renderer must be made, in a moment perhaps.
class ContextLost : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// There is no memory for what was to be drawn; one sentence names how much for what. What was on the GPU
/// before can be drawn still.
class OutOfMemory : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// OpenGL reports an error that is no lack of memory, by its name: a bug of this program or of the driver.
class GlError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace vrut::base
