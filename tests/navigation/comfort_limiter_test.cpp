#include "navigation/comfort_limiter.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "navigation/flight.hpp"
#include "navigation/orientation.hpp"

using namespace vrut;
using navigation::behind;
using navigation::ComfortLimiter;
using navigation::ComfortLimits;

namespace {

constexpr double kStep = ComfortLimiter::kStep;

/// Where a scene's units and origin lie, and whether it stands on its head.
struct Frame {
    double unit = 1;  ///< of a metre
    glm::dvec3 origin{0};
    double up = 1;

    /// Degrees around and above the focus; metres.
    scene::Camera orbit(double around, double above, double distance, const glm::dvec3& focus = {}) const {
        const double a = around * scene::kRadiansPerDegree, e = above * scene::kRadiansPerDegree;
        const glm::dvec3 out(std::sin(a), 0, std::cos(a));
        scene::Camera camera;
        camera.focus = camera.center = origin + focus * unit;
        camera.eye = camera.focus + (out * std::cos(e) + scene::kVertical * std::sin(e)) * distance * unit;
        camera.up = (scene::kVertical * std::cos(e) - out * std::sin(e)) * up;
        return scene::with_orthogonal_up(camera);
    }
    ComfortLimits limits() const {
        ComfortLimits limits;
        limits.units_per_second *= unit;
        limits.units_per_second_squared *= unit;
        return limits;
    }
};

/// What is measured between steps.
struct Speeds {
    glm::dvec3 spin{0}, velocity{0};
};
Speeds speeds(const scene::Camera& from, const scene::Camera& to) {
    return {navigation::turn_between(from, to) / kStep, (to.eye - from.eye) / kStep};
}

/// One step, whose speeds and accelerations are checked; it may be a jump to a target that is far.
void checked_step(ComfortLimiter& limiter, Speeds& before, const scene::Camera& target,
                  const ComfortLimits& limits) {
    const scene::Camera pose = limiter.pose();
    limiter.step(target, limits);
    const Speeds now = speeds(pose, limiter.pose());
    constexpr double kRounding = 1.002;
    const double speed = glm::length(now.velocity);
    if (speed > kRounding * limits.units_per_second) {
        CHECK(limiter.rests_at(target));
        CHECK(speed * kStep > ComfortLimiter::kLongestWay * limits.units_per_second);
        before = {};
        return;
    }
    CHECK(glm::length(now.spin) <= kRounding * limits.degrees_per_second * scene::kRadiansPerDegree);
    CHECK(glm::length(now.spin - before.spin) / kStep <=
          kRounding * limits.degrees_per_second_squared * scene::kRadiansPerDegree);
    CHECK(glm::length(now.velocity - before.velocity) / kStep <= kRounding * limits.units_per_second_squared);
    before = now;
}

/// Steps until it rests; returns how many.
int arrive(ComfortLimiter& limiter, const scene::Camera& target, const ComfortLimits& limits) {
    for (int steps = 0; steps < 100'000; ++steps) {
        if (limiter.rests_at(target)) return steps;
        limiter.step(target, limits);
    }
    return -1;
}

class Dice {
public:
    explicit Dice(unsigned seed) : engine_(seed) {}
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    bool one_in(unsigned number) { return engine_() % number == 0; }

private:
    std::mt19937 engine_;
};

/// What hands do to a camera: drags, flicks across ±180 degrees, zooms by 100, jumps, and turns over a pole.
class Hand {
public:
    Hand(const Frame& frame, unsigned seed) : frame_(frame), dice_(seed) {}
    scene::Camera next() {
        if (dice_.one_in(40))
            rate_ = {dice_.between(-300, 300), dice_.between(-100, 100), dice_.between(-3, 3)};
        if (dice_.one_in(40)) rate_ = {};
        if (dice_.one_in(150)) distance_ = dice_.one_in(2) ? 0.05 : 5;
        if (dice_.one_in(150)) focus_ = {dice_.between(-4, 4), dice_.between(-1, 1), dice_.between(-4, 4)};
        if (dice_.one_in(200)) around_ += 180;
        if (dice_.one_in(200)) above_ += 120;
        around_ += rate_.x * kStep;
        above_ += rate_.y * kStep;
        distance_ *= std::exp(rate_.z * kStep);
        distance_ = std::clamp(distance_, 0.05, 9.0);
        return pose();
    }

private:
    scene::Camera pose() const {
        scene::Camera camera = frame_.orbit(around_, 0, distance_, focus_);
        // Above 90 degrees it stands on its head.
        const glm::dquat turn =
            glm::angleAxis(-above_ * scene::kRadiansPerDegree, scene::right_direction(camera));
        camera.eye = camera.focus + turn * (camera.eye - camera.focus);
        camera.up = turn * camera.up;
        return scene::with_orthogonal_up(camera);
    }

    Frame frame_;
    Dice dice_;
    glm::dvec3 rate_{0}, focus_{0};
    double around_ = 170, above_ = 10, distance_ = 5;
};

const Frame kFrames[] = {{}, {1000, {}, 1}, {1, {1e7, -1e7, 1e7}, 1}, {1, {}, -1}};

}  // namespace

TEST_CASE("no step is faster than the limits, nor changes its speed faster, whatever the target does") {
    for (const Frame& frame : kFrames)
        for (unsigned seed = 1; seed <= 20; ++seed) {
            CAPTURE(seed);
            CAPTURE(frame.unit);
            Dice dice(seed);
            Hand hand(frame, seed);
            ComfortLimits limits = frame.limits();
            if (seed > 10) {
                limits.degrees_per_second = dice.between(10, 360);
                limits.degrees_per_second_squared = dice.between(10, 1000);
                limits.units_per_second = dice.between(0.1, 10) * frame.unit;
                limits.units_per_second_squared = dice.between(0.2, 40) * frame.unit;
            }
            ComfortLimiter limiter(hand.next());
            Speeds before;
            for (int step = 0; step < 2000; ++step) checked_step(limiter, before, hand.next(), limits);
            const scene::Camera last = hand.next();
            const int steps = arrive(limiter, last, limits);
            CHECK(steps >= 0);
            if (seed <= 10) CHECK(steps * kStep < 18);
            CHECK(limiter.pose() == last);
        }
}

TEST_CASE("it comes to rest at the target to the bit, never beyond it, with a level horizon") {
    for (const double around : {0.5, 3.0, 20.0, 90.0, 179.0, -179.0}) {
        CAPTURE(around);
        const Frame frame;
        const scene::Camera start = frame.orbit(10, 5, 3),
                            target = frame.orbit(10 + around, 40, 2, {1, 0, 0});
        ComfortLimiter limiter(start);
        navigation::Behind before = behind(start, target);
        double beyond = 0;
        const double sign = around > 0 ? 1 : -1, turn = std::abs(around);
        while (!limiter.rests_at(target)) {
            limiter.step(target, frame.limits());
            const auto angles = navigation::level_angles(limiter.pose());
            REQUIRE(angles);
            const double turned = sign * std::remainder(angles->around / scene::kRadiansPerDegree - 10, 360);
            if (turned >= 0) beyond = std::max(beyond, turned - turn);
            CHECK(angles->above <= 40 * scene::kRadiansPerDegree + 1e-12);
            const navigation::Behind now = behind(limiter.pose(), target);
            CHECK(now.degrees <= before.degrees + 1e-9);
            before = now;
        }
        CHECK(beyond < 1e-9);
        CHECK(limiter.pose() == target);
        limiter.step(target, frame.limits());
        CHECK(limiter.rests_at(target));
    }
}

TEST_CASE("the eye stops without going beyond") {
    const Frame frame;
    const scene::Camera start = frame.orbit(0, 0, 4);
    for (const double metres : {0.0001, 0.003, 0.1, 1.0, 5.0}) {
        CAPTURE(metres);
        const scene::Camera target = frame.orbit(0, 0, 4, {metres, 0, 0});
        ComfortLimiter limiter(start);
        double before = metres;
        while (!limiter.rests_at(target)) {
            limiter.step(target, frame.limits());
            const double left = target.eye.x - limiter.pose().eye.x;
            CHECK(left >= 0);
            CHECK(left <= before);
            before = left;
        }
        CHECK(before == 0);
    }
}

TEST_CASE("it goes around the focus, not through it") {
    for (const ComfortLimits& limits :
         {ComfortLimits{}, ComfortLimits{360, 100, 10, 0.5}, ComfortLimits{360, 1000, 0.5, 40}})
        for (const double distance : {0.1, 1.0, 4.0}) {
            CAPTURE(distance);
            const Frame frame;
            const scene::Camera target = frame.orbit(175, 20, distance);
            ComfortLimiter limiter(frame.orbit(0, 20, distance));
            double nearest = distance;
            for (int step = 0; step < 10'000 && !limiter.rests_at(target); ++step) {
                limiter.step(target, limits);
                nearest = std::min(nearest, glm::length(limiter.pose().eye));
            }
            CHECK(limiter.rests_at(target));
            CHECK(nearest > 0.95 * distance);
        }
}

TEST_CASE("it looks around without moving the eye") {
    const Frame frame;
    const scene::Camera start = frame.orbit(0, 0, 4);
    scene::Camera target = frame.orbit(170, 0, 4);
    const glm::dvec3 shift = start.eye - target.eye;
    target.eye = start.eye;
    target.focus += shift;
    ComfortLimiter limiter(start);
    while (!limiter.rests_at(target)) {
        limiter.step(target, frame.limits());
        REQUIRE(glm::distance(limiter.pose().eye, start.eye) < 1e-12);
    }
}

TEST_CASE("a slow motion is followed within 50 ms") {
    const Frame frame;
    ComfortLimiter limiter(frame.orbit(0, 0, 1));
    for (int step = 1; step < 200; ++step) {
        const double turned = 14 * step * kStep;
        limiter.step(frame.orbit(turned, 0, 1), frame.limits());
        if (step > 50) CHECK(behind(limiter.pose(), frame.orbit(turned, 0, 1)).degrees < 14 * 0.05);
    }
    ComfortLimiter walking(frame.orbit(0, 0, 4));
    for (int step = 1; step < 200; ++step) {
        const glm::dvec3 walked(0.7 * step * kStep, 0, 0);
        walking.step(frame.orbit(0, 0, 4, walked), frame.limits());
        if (step > 50) CHECK(behind(walking.pose(), frame.orbit(0, 0, 4, walked)).units < 0.7 * 0.05);
    }
}

TEST_CASE("it jumps where the way is longer than ten seconds at full speed, and where steps are too fine") {
    const Frame frame;
    ComfortLimiter limiter(frame.orbit(0, 0, 4));
    limiter.step(frame.orbit(0, 0, 4, {19, 0, 0}), frame.limits());
    CHECK(limiter.pose().eye.x < 0.01);
    const scene::Camera far = frame.orbit(0, 0, 4, {21, 0, 0});
    limiter.step(far, frame.limits());
    CHECK(limiter.rests_at(far));

    const Frame distant{1, {1e15, 0, 0}, 1};
    const scene::Camera target = distant.orbit(30, 10, 8);
    ComfortLimiter stuck(distant.orbit(0, 10, 8));
    CHECK(arrive(stuck, target, frame.limits()) >= 0);
    CHECK(stuck.pose() == target);
}
