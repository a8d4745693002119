#pragma once

#include <span>
#include <string>

#include "level_table.hpp"
#include "measure/front.hpp"
#include "measure/measure.hpp"

namespace vrut::server::measure {

/// Milliseconds until a picture is there: made, and sent over a link of kLinkMegabits.
inline constexpr double kLinkMegabits = 50;
double latency_cost(double ms, double bytes);

/// The levels among what was measured, of one setting each: points of the front of latency_cost and error,
/// 8 at most, each at least 1.25 times as dear as the one below and worth it, up to the most accurate; with
/// the reason of each in a sentence. What takes more than one sample a pixel is no picture for a view that
/// moves.
std::vector<protocol::Level> choose_levels(std::span<const Setting> settings, std::span<const Cost> costs,
                                           std::span<const Error> errors);

/// Measures what pictures of `home`, of its size, cost on an orbit, and how far they are from its scene, and
/// chooses; last comes the picture at rest, where it takes less than a second. Takes about 20 s where the
/// processor draws, and less on faster machines; where pictures take seconds it measures fewer, and longer.
/// Knows nothing of files: the table's scene is left empty.
protocol::LevelTable calibrate(const plan::View& home, renderer::Renderer& renderer,
                               const PartDone& done = {});

}  // namespace vrut::server::measure
