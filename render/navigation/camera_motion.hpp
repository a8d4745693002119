#pragma once

#include <deque>
#include <optional>

#include "scene/camera.hpp"

namespace vrut::navigation {

/// How a camera moves, by its last steps: where it will be if it goes on like that.
class CameraMotion {
public:
    /// The camera at a time in ms, which never falls. One that has not moved is no step.
    void add(double ms, const scene::Camera& camera);
    /// The camera `ahead` ms after `ms`; none if it stands still. It goes on in the direction of its last
    /// step and as fast, but at most twice as fast as in the step before: what begins or jumps goes less far.
    /// At most it turns by 45 degrees, or moves by the like part of the focus' distance.
    std::optional<scene::Camera> ahead(double ms, double ahead) const;
    /// Radians a second, or parts of the focus' distance; 0 if it stands still.
    double speed(double ms) const;

private:
    struct Step {
        double ms = 0;
        scene::Camera camera;
    };
    bool stands_still(double ms) const;

    std::deque<Step> steps_;  // the last three at most
};

}  // namespace vrut::navigation
