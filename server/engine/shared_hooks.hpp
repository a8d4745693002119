#pragma once

#include <functional>
#include <string>

#include "event_log.hpp"
#include "room/answers.hpp"

namespace vrut::server::engine {

/// Where the engine of a room that servers share reports what happens in it. It follows another server until
/// TakeOver.
struct SharedHooks {
    std::function<void(const protocol::LogLine& line)> on_line;  ///< on the render thread
    /// On the render thread; the lines before it led here.
    std::function<void(const room::Checkpoint& checkpoint)> on_checkpoint;
    std::function<void(const std::string& why)>
        on_failure;  ///< the room cannot be followed: the server has to start again
};

}  // namespace vrut::server::engine
