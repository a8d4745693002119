#pragma once

#include <optional>

#include "event_log.hpp"
#include "math/bounds.hpp"
#include "navigation/comfort_limiter.hpp"
#include "room/steering.hpp"
#include "scene/camera.hpp"
#include "state.hpp"

namespace vrut::server::room {

/// The camera of hosts, who stand in the picture: it follows the room's at bearable speeds, in steps of 16
/// ms. It begins to step at what makes it move, and not at a clock's ticks: a log may begin at any time.
class WallsCamera {
public:
    /// Where it is not limited, hosts have the room's camera. `moves`: that goes on to move.
    void use(bool limited, bool moves, const scene::Camera& room, SessionTime now);
    /// Hosts have the room's camera at once.
    void jump() { following_.reset(); }
    /// Of the next step; none: it rests, where nothing moves.
    std::optional<SessionTime> due() const;
    /// Makes the step that is due. `metres`: of a unit of the scene.
    void step(const scene::Camera& room, const protocol::ComfortState& comfort, double metres);

    /// For the state; none: hosts have the room's camera.
    std::optional<protocol::WallsState> state(const scene::Camera& room, const math::Bounds& bounds,
                                              double metres) const;
    /// For a log; none: it rests.
    std::optional<protocol::LogHeader::Walls> logged(SessionTime now) const;
    /// As logged() told, where it is limited; or what is wrong with it.
    std::optional<protocol::Error> restore(const protocol::LogHeader::Walls& walls, SessionTime now);

private:
    struct Following {
        navigation::ComfortLimiter limiter;
        std::optional<SessionTime> due = {};
    };
    std::optional<Following> following_;  ///< none: it is not limited
};

}  // namespace vrut::server::room
