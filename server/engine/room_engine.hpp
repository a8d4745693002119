#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/clock.hpp"
#include "engine/frame_quality.hpp"
#include "engine/mailbox.hpp"
#include "messages.hpp"

namespace vrut::server::engine {

/// Who asks to come in.
struct Admission {
    std::string client;
    protocol::Role role = protocol::Role::view;
    std::string token;
};

/// What connections ask of a room: its engine, in this process or on another machine. From any thread.
class RoomEngine {
public:
    RoomEngine() = default;
    virtual ~RoomEngine() = default;
    RoomEngine(const RoomEngine&) = delete;
    RoomEngine& operator=(const RoomEngine&) = delete;

    virtual void push(EngineEvent event) = 0;
    /// Of a picture that is asked for.
    virtual PictureLimits limits() const = 0;
    /// What draws; empty: it is not known.
    virtual std::string description() const = 0;
    /// Why it cannot draw now, a sentence; none if it can.
    virtual std::optional<std::string> why_unready() const = 0;
    /// Events that came and are not handled yet.
    virtual std::size_t events_waiting() const = 0;
    /// How long each of its threads has not come round, 0 where it waits for something to do.
    virtual std::vector<std::pair<const char*, base::Clock::duration>> busy_times() const = 0;
    /// Ends its work, without waiting for that.
    virtual void stop() = 0;
};

}  // namespace vrut::server::engine
