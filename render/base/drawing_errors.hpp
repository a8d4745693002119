#pragma once

#include <stdexcept>

namespace vrut::base {

/// The GL context was lost, and all GPU resources with it. Create a new Renderer; it may succeed only after a
/// moment.
class ContextLost : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// An allocation for drawing failed. The message is one sentence and names what it was for and its size. GPU
/// resources that existed before stay valid.
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
