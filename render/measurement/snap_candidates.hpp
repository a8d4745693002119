#pragma once

#include <vector>

#include "measurement/feature.hpp"
#include "measurement/neighborhood.hpp"

namespace vrut::measurement {

/// Lower ones are preferred.
enum class Rank { corner, midpoint, center, loop, edge, vertex, plane, point };

struct Candidate {
    Rank rank = Rank::point;
    Snap snap = Snap::point;
    double offset = 0, depth = 0;    ///< Neighborhood's
    glm::dvec3 seen{0};              ///< what must be visible: relative to the hit
    std::vector<glm::dvec3> points;  ///< of the feature
};

/// Everything near the ray to which it may snap, but for what is hidden behind the part, and in no order.
/// `to`: as SnapOptions.
std::vector<Candidate> snap_candidates(const Neighborhood& around, const std::vector<Snap>& to);

}  // namespace vrut::measurement
