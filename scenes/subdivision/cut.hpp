#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "cage.hpp"

namespace vrut {

/// How far a point lies from a cut's outline, in its projections: below 0 inside. The gradient is a unit
/// vector, or zero where the value is only a lower bound.
struct CutDistance {
    double value = 0;
    glm::dvec3 gradient{0};
};

/// A cut with its corners rounded.
class CutShape {
public:
    explicit CutShape(const Cut& cut);

    double gap() const { return gap_; }
    /// Exact where it is below `reach`.
    CutDistance at(const glm::dvec3& point, double reach) const;

private:
    struct Ring {
        Outline::From from;
        std::vector<glm::dvec2> points;  ///< counter-clockwise
        glm::dvec2 low, high;
    };
    double gap_;
    std::vector<Ring> rings_;
};

/// An outline's corners and arcs as a polygon, counter-clockwise. Radii for which there is no room become
/// smaller.
std::vector<glm::dvec2> rounded_polygon(const std::vector<Outline::Corner>& corners);

/// Which part of a skin a panel keeps: `keep` cut's inside (kNone: all of the skin) without the cuts before
/// it, each boundary half its gap and `margin` away; it reaches `grow` beyond its own outline instead, if
/// that is not 0.
class PanelField {
public:
    PanelField(const std::vector<CutShape>& cuts, int keep, double margin, double grow = 0)
        : cuts_(cuts), keep_(keep), margin_(margin), grow_(grow) {}

    /// Distance along the surface from the panel's border: below 0 inside it.
    double at(const glm::dvec3& point, const glm::dvec3& normal) const;

private:
    const std::vector<CutShape>& cuts_;
    int keep_;
    double margin_;
    double grow_;
};

}  // namespace vrut
