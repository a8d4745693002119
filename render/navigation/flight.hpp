#pragma once

#include <vector>

#include "scene/camera.hpp"

namespace vrut::navigation {

struct CameraKeyframe {
    double at = 0;  ///< ms since the start
    scene::Camera camera;
};

enum class Easing {
    smooth,  ///< starts and ends softly, and passes the keyframes between without a stop
    linear,  ///< equal steps in equal times from each to the next
};

/// The camera at a part of the way from `a` to `b`, or beyond `b` where that is above 1. Focus, centre and
/// fov go straight, the distance eye-focus by equal factors in equal parts of the way, and the direction
/// around the focus by azimuth (the shorter way) and elevation where both stand level and upright, so that
/// the horizon stays level, else by the shortest turn of the whole frame.
scene::Camera on_the_way(const scene::Camera& a, const scene::Camera& b, double part);

/// A path through cameras in time, from each to the next as on_the_way(). Pure: the same time gives the same
/// camera to the last bit.
class CameraPath {
public:
    /// The path starts at `from`. The keyframes' times rise from 0 or above; their poses are valid. A
    /// keyframe at 0 replaces `from`.
    CameraPath(const scene::Camera& from, const std::vector<CameraKeyframe>& keyframes, Easing easing);

    /// Returns a keyframe's camera bit-identical at its time; the first before the start, the last after the
    /// end.
    scene::Camera at(double ms) const;
    double duration() const { return path_.back().at; }

private:
    /// Returns the progress from `path_[index]` to the next keyframe, 0 to 1.
    double progress(std::size_t index, double ms) const;
    double slope(std::size_t index) const;

    std::vector<CameraKeyframe> path_;  // the start and the keyframes
    Easing easing_;
};

}  // namespace vrut::navigation
