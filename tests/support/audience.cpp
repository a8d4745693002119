#include "audience.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

namespace vrut::test {

using Clock = std::chrono::steady_clock;

namespace {

// The picture's angle tells which change it shows: numbers are kept to the last bit.
constexpr double kFirstFov = 20, kStep = 1.0 / 1024;

}  // namespace

Audience::Audience(std::vector<Door> doors, std::size_t clients) : swarm_(std::move(doors)) {
    swarm_.join("control");
    while (swarm_.size() < clients) swarm_.join("view");
}

void Audience::change() {
    changed_.push_back(Clock::now());
    const double fov = kFirstFov + kStep * static_cast<double>(changed_.size());
    swarm_.send(0, {{"type", "patch"}, {"patch", {{"camera", {{"fov", fov}}}}}});
}

void Audience::on_frame(const Swarm::Frame& frame) {
    newest_.resize(swarm_.size());
    std::size_t& newest = newest_[frame.client];
    const double shown = (frame.fov - kFirstFov) / kStep;
    if (shown != std::floor(shown) || shown <= static_cast<double>(newest)) return;
    if (shown > static_cast<double>(changed_.size())) return;  // a camera from before the first change
    newest = static_cast<std::size_t>(shown);
    waited_ms_.push_back(std::chrono::duration<double, std::milli>(frame.at - changed_[newest - 1]).count());
    if (frame.client == 0 && newest == changed_.size()) change();
}

void Audience::work_until(Clock::time_point end, const std::function<bool()>& enough) {
    if (changed_.empty()) change();
    swarm_.read_until(
        end, [this](const Swarm::Frame& frame) { on_frame(frame); }, enough);
}

double percentile(std::vector<double>& values, double part) {
    REQUIRE_FALSE(values.empty());
    const auto at = std::llround(part * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
}

}  // namespace vrut::test
