#include "navigation/comfort_limiter.hpp"

#include <algorithm>
#include <cmath>

#include "navigation/flight.hpp"
#include "navigation/orientation.hpp"

namespace vrut::navigation {

namespace {

constexpr double kStepTime = ComfortLimiter::kStep;
constexpr double kBraking = 0.95;  // of the acceleration: the rest is for turns on the way

/// Speed and acceleration in radians or units.
struct MotionLimit {
    double speed, acceleration;
};

/// Of turns by azimuth and elevation: where both change, the axis of elevation turns, too. That takes no more
/// than half of the acceleration.
MotionLimit turn_limit(const ComfortLimits& limits) {
    const double acceleration = limits.degrees_per_second_squared * scene::kRadiansPerDegree;
    const double speed =
        std::min(limits.degrees_per_second * scene::kRadiansPerDegree, std::sqrt(acceleration));
    return {speed, 0.98 * (acceleration - speed * speed / 2)};
}

MotionLimit eye_limit(const ComfortLimits& limits) {
    return {limits.units_per_second, limits.units_per_second_squared};
}

/// The highest speed from which it stops within `distance`, this step included, where the speed falls by
/// `change` a step.
double stopping_speed(double distance, double change) {
    // After it, so many steps at speeds that are lower by 1, 2, … times `change`.
    const double more = std::floor((std::sqrt(1 + 8 * distance / (change * kStepTime)) - 1) / 2);
    return (distance / kStepTime + change * more * (more + 1) / 2) / (more + 1);
}

struct NextMotion {
    glm::dvec3 velocity;
    bool arrives;  ///< at the end of the step
};

/// The velocity of the next step, for what goes at `velocity` and has `way` before it.
NextMotion approach(const glm::dvec3& way, const glm::dvec3& velocity, const MotionLimit& limit) {
    const double change = limit.acceleration * kStepTime, distance = glm::length(way);
    const glm::dvec3 at_once = way / kStepTime;
    if (distance <= std::min(limit.speed, change) * kStepTime && glm::length(at_once - velocity) <= change)
        return {at_once, true};
    const double speed =
        std::min(limit.speed, stopping_speed(distance, kBraking * limit.acceleration * kStepTime));
    const glm::dvec3 wanted = distance > 0 ? way * (speed / distance) : glm::dvec3(0);
    const double wanted_change = glm::length(wanted - velocity);
    const double share = wanted_change > change ? change / wanted_change : 1;
    return {velocity + (wanted - velocity) * share, false};
}

/// The frame after a step, and how it turns on.
struct Turned {
    ViewBasis basis;
    glm::dvec3 spin;
    bool arrives;
};

ViewBasis basis_of(const scene::Camera& camera) { return {scene::view_direction(camera), camera.up}; }

/// By azimuth and elevation: the horizon stays level.
Turned turn_level(const LevelAngles& from, const LevelAngles& to, const glm::dvec3& spin,
                  const glm::dvec3& right, const MotionLimit& limit) {
    const glm::dvec3 way(std::remainder(to.around - from.around, 2 * std::numbers::pi), to.above - from.above,
                         0);
    const glm::dvec3 rates(spin.y, -glm::dot(spin, right), 0);
    const NextMotion next = approach(way, rates, limit);
    const LevelAngles angles{from.around + next.velocity.x * kStepTime,
                             from.above + next.velocity.y * kStepTime};
    const ViewBasis basis = view_basis(angles);
    const glm::dvec3 axis = glm::cross(basis.view, basis.up);
    return {basis, scene::kVertical * next.velocity.x - axis * next.velocity.y, next.arrives};
}

Turned turn_any(const scene::Camera& from, const scene::Camera& to, const glm::dvec3& spin,
                const MotionLimit& limit) {
    const NextMotion next = approach(turn_between(from, to), spin, limit);
    const double angle = glm::length(next.velocity) * kStepTime;
    const ViewBasis before = basis_of(from);
    if (angle == 0) return {before, next.velocity, next.arrives};
    const glm::dquat turn = glm::angleAxis(angle, glm::normalize(next.velocity));
    return {{turn * before.view, turn * before.up}, next.velocity, next.arrives};
}

Turned turned(const scene::Camera& from, const scene::Camera& to, const glm::dvec3& spin,
              const MotionLimit& limit) {
    const auto angles = level_angles(from), aim = level_angles(to);
    Turned result = angles && aim ? turn_level(*angles, *aim, spin, scene::right_direction(from), limit)
                                  : turn_any(from, to, spin, limit);
    if (result.arrives) result.basis = basis_of(to);
    return result;
}

/// How far the frame turns on the way, radians.
double turn_length(const scene::Camera& a, const scene::Camera& b) {
    const auto from = level_angles(a), to = level_angles(b);
    if (!from || !to) return glm::length(turn_between(a, b));
    return std::hypot(std::remainder(to->around - from->around, 2 * std::numbers::pi),
                      to->above - from->above);
}

/// The eye stays rather than the focus: who looks around does not go around what is looked at.
bool looks_around(const scene::Camera& a, const scene::Camera& b) {
    return glm::distance(a.eye, b.eye) < glm::distance(a.focus, b.focus);
}

scene::Camera part_of_way(const scene::Camera& a, const scene::Camera& b, double part) {
    scene::Camera result = on_the_way(a, b, part);
    if (part == 1 || !looks_around(a, b)) return result;
    const glm::dvec3 shift = a.eye + (b.eye - a.eye) * part - result.eye;
    result.eye += shift;
    result.focus += shift;
    return scene::is_valid_pose(result, 0) ? scene::with_orthogonal_up(result) : b;
}

/// A step of the least that it goes on by is finer than double holds there.
bool is_stuck(const glm::dvec3& eye, const glm::dvec3& way, const MotionLimit& limit) {
    const double distance = glm::length(way);
    const double step =
        std::min({limit.speed, limit.acceleration * kStepTime, distance / kStepTime}) * kStepTime;
    return distance > 0 && eye + way * (step / distance) == eye;
}

double share_of(double length, double most) { return length > most ? most / length : 1; }

}  // namespace

bool ComfortLimiter::rests_at(const scene::Camera& target) const {
    constexpr glm::dvec3 kNone(0);
    return motion_.pose == target && motion_.velocity == kNone && motion_.spin == kNone;
}

void ComfortLimiter::rest(const scene::Camera& pose) { *this = ComfortLimiter(pose); }

/// Around the focus it goes no faster than an eye can stop within a quarter of the distance: the eye behind
/// it does not cut across.
void ComfortLimiter::move_guide(const scene::Camera& target, const ComfortLimits& limits) {
    const double from = scene::focus_distance(motion_.guide), to = scene::focus_distance(target);
    const double step = limits.units_per_second * kStep, turn = turn_length(motion_.guide, target);
    const bool around_eye = looks_around(motion_.guide, target);
    const double distance = std::min(from + step, std::max(from, to));  // at most, within this step
    const double orbit = around_eye ? 0 : distance * (turn + std::abs(std::log(to / from)));
    const double pan = around_eye ? glm::distance(motion_.guide.eye, target.eye)
                                  : glm::distance(motion_.guide.focus, target.focus);
    const double part =
        std::min({share_of(orbit + pan, step),
                  share_of(orbit, std::sqrt(limits.units_per_second_squared * distance / 2) * kStep),
                  share_of(turn, turn_limit(limits).speed * kStep)});
    const scene::Camera moved = part_of_way(motion_.guide, target, part);
    motion_.guide = moved == motion_.guide ? target : moved;  // where the step is finer than double holds
}

void ComfortLimiter::step(const scene::Camera& target, const ComfortLimits& limits) {
    if (glm::distance(motion_.pose.eye, target.eye) > kLongestWay * limits.units_per_second)
        return rest(target);
    move_guide(target, limits);
    const Turned turn = turned(motion_.pose, motion_.guide, motion_.spin, turn_limit(limits));
    const glm::dvec3 way = motion_.guide.eye - motion_.pose.eye;
    const NextMotion motion = approach(way, motion_.velocity, eye_limit(limits));
    motion_.spin = turn.spin;
    motion_.velocity = motion.velocity;
    if (motion.arrives && turn.arrives) {
        motion_.pose = motion_.guide;
        return;
    }
    scene::Camera next = motion_.guide;
    if (is_stuck(motion_.pose.eye, way, eye_limit(limits))) return rest(target);
    if (!motion.arrives) next.eye = motion_.pose.eye + motion_.velocity * kStep;
    next.focus = next.eye + turn.basis.view * scene::focus_distance(motion_.guide);
    next.up = turn.basis.up;
    if (!scene::is_valid_pose(next, 0)) return rest(target);
    motion_.pose = scene::with_orthogonal_up(next);
}

Behind behind(const scene::Camera& pose, const scene::Camera& target) {
    return {glm::length(turn_between(pose, target)) / scene::kRadiansPerDegree,
            glm::distance(pose.eye, target.eye)};
}

}  // namespace vrut::navigation
