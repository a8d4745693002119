#pragma once

#include <string>

#include "study.hpp"

namespace vrut::stability {

// What studies of pictures share.

/// `stats`, where it is given, is told what the picture took.
scene::Image drawn(const Laboratory& laboratory, const plan::View& view, plan::FrameStats* stats = nullptr);
/// Whether all pixels have one colour, or there are none.
bool is_plain(const scene::Image& image);
/// The time of a picture, in ms, when everything that it needs is on the GPU: the least of a few.
double time_of(const Laboratory& laboratory, const plan::View& view);
/// "1.4 times the time".
std::string times_the_time(double method, double baseline);
/// A small view of `scene`.
plan::View looking(const std::shared_ptr<const scene::PlacedScene>& scene, const glm::dvec3& eye,
                   const glm::dvec3& focus = glm::dvec3(0));
/// What `view` has to show, by the reference; without pixels where that shows the background alone.
scene::Image truth_of(const plan::View& view);
/// Pixels off by more than 8 of 255, in percent; kNothing where `right` has no pixels, or others.
double percent_off(const scene::Image& image, const scene::Image& right);
/// Of a channel, of 255; kNothing where `right` has no pixels, or others.
double largest_error(const scene::Image& image, const scene::Image& right);

}  // namespace vrut::stability
