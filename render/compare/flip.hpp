#pragma once

#include <vector>

#include "scene/image.hpp"

namespace vrut::compare {

/// The difference that eyes see when two images alternate: LDR-FLIP as published by Andersson et al.,
/// "FLIP: A Difference Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2),
/// 2020, with the errata of its reference implementation (NVlabs, version 1.6). Images are taken as sRGB,
/// alpha is not compared; the viewer sees them on a screen 0.7 m wide with 3840 pixels, from 0.7 m: 67 pixels
/// per degree.

/// For each pixel, as the images' rows go, 0 (no difference) to 1. Symmetric in its images. Throws
/// std::invalid_argument where sizes differ.
std::vector<float> flip(const scene::Image& a, const scene::Image& b);

/// Section 5. A weighted percentile p is the value up to which values, from the lowest, make p of their sum.
struct FlipSummary {
    double mean = 0;
    double weighted_median = 0, first_weighted_quartile = 0, third_weighted_quartile = 0;
    double min = 0, max = 0;
};
FlipSummary summary_of(std::vector<float> errors);

/// Renders errors as grey levels, 0 black and 1 white.
scene::Image grey_map(const std::vector<float>& errors, int width, int height);

}  // namespace vrut::compare
