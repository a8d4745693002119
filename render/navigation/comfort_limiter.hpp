#pragma once

#include <glm/glm.hpp>

#include "scene/camera.hpp"

namespace vrut::navigation {

/// Of a camera that people stand in; each above 0. Lengths are in units of the scene.
struct ComfortLimits {
    double degrees_per_second = 45, degrees_per_second_squared = 180;  ///< of the view
    double units_per_second = 2, units_per_second_squared = 8;         ///< of the eye
};

/// A camera that follows another one gently. It steps at a fixed time: the same targets in the same steps
/// lead to the same camera to the last bit.
///
/// Between two steps the view turns, and the eye moves, no faster than the limits, and neither velocity
/// changes faster than they allow: rotation vector and displacement over the time of a step. It goes the way
/// of on_the_way(), so that a turn about the focus goes around it; where the eye moves less than the focus,
/// the eye goes straight. It does not go beyond a target that rests, and arrives there to the last bit.
/// Behind a target that moves steadily below the limits it stays by the way on which it can stop, a time of
/// speed / (2 · acceleration).
///
/// Where the target's eye is farther than kLongestWay at full speed, it jumps: a cut is easier to bear than a
/// long pursuit.
class ComfortLimiter {
public:
    static constexpr double kStep = 0.016;     ///< s
    static constexpr double kLongestWay = 10;  ///< s

    /// Where it is on its way.
    struct Motion {
        /// `guide` goes to the target at the speeds allowed, however suddenly it starts or stops.
        scene::Camera pose, guide;
        glm::dvec3 velocity{0};  ///< of the eye, units/s
        glm::dvec3 spin{0};      ///< world axis, radians/s
    };

    /// It rests at `pose`, a valid one with orthogonal up, as all targets must be.
    explicit ComfortLimiter(const scene::Camera& pose) : motion_{pose, pose} {}
    /// It goes on from there; both cameras are valid, with orthogonal up.
    explicit ComfortLimiter(const Motion& motion) : motion_(motion) {}

    const scene::Camera& pose() const { return motion_.pose; }
    const Motion& motion() const { return motion_; }
    /// It is there, and does not move.
    bool rests_at(const scene::Camera& target) const;
    /// Goes on by kStep.
    void step(const scene::Camera& target, const ComfortLimits& limits);

private:
    void rest(const scene::Camera& pose);
    void move_guide(const scene::Camera& target, const ComfortLimits& limits);

    Motion motion_;
};

/// How far `pose` is from `target`.
struct Behind {
    double degrees = 0;  ///< of the whole frame's turn
    double units = 0;    ///< between the eyes
};
Behind behind(const scene::Camera& pose, const scene::Camera& target);

}  // namespace vrut::navigation
