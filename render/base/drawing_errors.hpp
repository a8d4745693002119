#pragma once

#include <stdexcept>

namespace vrut::base {

/// The GL context was lost, and all GPU resources with it. Create a new Renderer; it may succeed only after a
/// moment.
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

}  // namespace vrut::base
