// Studies of the camera that walls have.
#include <algorithm>
#include <cmath>

#include "navigation/comfort_limiter.hpp"
#include "study.hpp"

namespace vrut::stability {

namespace {

using navigation::ComfortLimiter;

constexpr double kFlickTime = 0.5;  // s

/// A camera a metre from what it turns about.
scene::Camera turned_by(double degrees) {
    const double angle = degrees * scene::kRadiansPerDegree;
    scene::Camera camera;
    camera.eye = glm::dvec3(std::sin(angle), 0, std::cos(angle));
    return camera;
}

struct Lag {
    double largest = 0;     ///< degrees
    double catches_up = 0;  ///< s after the flick
};

/// Of walls behind a flick, without jumps; nothing where they never catch up.
Lag lag_of(double degrees_per_second, const navigation::ComfortLimits& limits) {
    ComfortLimiter limiter(turned_by(0));
    Lag lag;
    for (int step = 1; step < 10'000; ++step) {
        const double time = step * ComfortLimiter::kStep;
        const scene::Camera target = turned_by(degrees_per_second * std::min(time, kFlickTime));
        limiter.step(target, limits);
        lag.largest = std::max(lag.largest, navigation::behind(limiter.pose(), target).degrees);
        lag.catches_up = std::max(time - kFlickTime, 0.0);
        if (time > kFlickTime && limiter.rests_at(target)) return lag;
    }
    return {kNothing, kNothing};
}

/// Speed alone: it starts and stops at once.
Lag lag_of_speed(double degrees_per_second, double limit) {
    const double lag = std::max(degrees_per_second - limit, 0.0) * kFlickTime;
    return {lag, lag / limit};
}

}  // namespace

Study lag_of_walls(const Laboratory& laboratory) {
    Study study{"walls-lag", "Walls behind a flick of half a second at 180 degrees a second",
                "most that walls turn, degrees a second", "largest lag, degrees"};
    study.bound = 90;
    study.baseline.title = "a limit of the speed alone, which starts and stops at once";
    study.method.title = "speed and acceleration limited, to full speed in a quarter of a second";
    study.explanation =
        "Walls follow the camera no faster than the state's 'comfort' allows, and stop where it is without "
        "going beyond. The tablet is not slowed.";
    study.cost = "Some microseconds a step, of which there are 62.5 a second while walls are behind.";
    for (const double limit : laboratory.chosen({10, 20, 30, 45, 60, 90, 120, 180, 360, 720})) {
        const navigation::ComfortLimits limits{limit, 4 * limit, 100, 400};
        study.baseline.points.push_back({limit, lag_of_speed(180, limit).largest});
        study.method.points.push_back({limit, lag_of(180, limits).largest});
    }
    return study;
}

Study walls_that_catch_up(const Laboratory& laboratory) {
    Study study{"walls-catch-up", "Walls that catch up with a flick of half a second",
                "speed of the flick, degrees a second", "time until they rest where the camera is, s"};
    study.bound = 4.5;
    study.baseline.title = "a limit of the speed alone, which starts and stops at once";
    study.method.title = "45 degrees a second, and 180 of acceleration";
    study.explanation =
        "Half a turn is the farthest: beyond it, walls turn the other way. So they catch up within the time "
        "of "
        "half a turn and of easing.";
    study.cost = "As above.";
    for (const double speed : laboratory.chosen({5, 10, 20, 45, 60, 90, 180, 270, 360})) {
        study.baseline.points.push_back({speed, lag_of_speed(speed, 45).catches_up});
        study.method.points.push_back({speed, lag_of(speed, {}).catches_up});
    }
    return study;
}

}  // namespace vrut::stability
