#pragma once

#include <string>

#include "study.hpp"

namespace vrut::stability {

// What studies of pictures share.

Image drawn(const Laboratory& laboratory, const View& view);
/// The time of a picture, in ms, when everything that it needs is on the GPU: the least of a few.
double time_of(const Laboratory& laboratory, const View& view);
/// "1.4 times the time".
std::string times_the_time(double successor, double method);
/// A small view of `scene`.
View looking(const std::shared_ptr<const PlacedScene>& scene, const glm::dvec3& eye,
             const glm::dvec3& focus = glm::dvec3(0));
/// Pixels off by more than 8 of 255, in percent.
double percent_off(const Image& a, const Image& b);

}  // namespace vrut::stability
