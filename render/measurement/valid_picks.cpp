#include <array>
#include <string_view>

#include "measurement/measure.hpp"
#include "measurement/vectors.hpp"

namespace vrut::measurement {

namespace {

std::string_view phrase_of(Kind kind) {
    constexpr std::array<std::string_view, 5> kPhrases{"a distance", "a parallel distance", "an angle",
                                                       "a radius", "a length"};
    return kPhrases[static_cast<std::size_t>(kind)];
}

std::string with_article(Snap snap) {
    return (snap == Snap::edge ? "an " : "a ") + std::string(name_of(snap));
}

std::string counted(std::size_t count, std::string_view what) {
    return std::to_string(count) + " " + std::string(what) + (count == 1 ? "" : "s");
}

std::optional<std::string> invalid_count(Kind kind, std::size_t count) {
    std::string needed;
    switch (kind) {
        case Kind::distance:
        case Kind::parallel:
            if (count != 2) needed = "2 picks";
            break;
        case Kind::angle:
            if (count != 2 && count != 3) needed = "2 or 3 picks";
            break;
        case Kind::radius:
            if (count != 1 && count != 3) needed = "1 or 3 picks";
            break;
        case Kind::length:
            if (count != 1) needed = "1 pick";
            break;
    }
    if (needed.empty()) return {};
    return std::string(phrase_of(kind)) + " needs " + needed + ", not " + std::to_string(count);
}

bool has_direction(Snap snap) { return snap == Snap::edge || snap == Snap::plane || snap == Snap::center; }

std::optional<std::string> invalid_snap(Kind kind, std::span<const Feature> features) {
    const Snap first = features[0].snap;
    if (kind == Kind::parallel && !has_direction(first))
        return "a parallel distance starts from an edge, a plane or a center, not from " +
               with_article(first);
    if (kind == Kind::angle && features.size() == 2)
        for (const Feature& feature : features)
            if (!has_direction(feature.snap))
                return "an angle of 2 picks is between edges, planes or centers, and " +
                       with_article(feature.snap) + " is none of them";
    if (kind == Kind::radius && features.size() == 1 && first != Snap::center)
        return "a radius of 1 pick needs a center, not " + with_article(first);
    if (kind == Kind::length && first != Snap::edge && first != Snap::loop)
        return "a length needs an edge or a loop, not " + with_article(first);
    return {};
}

std::optional<std::string> invalid_points(const Feature& feature) {
    const std::vector<glm::dvec3>& p = feature.points;
    if (p.size() != point_count(feature.snap))
        return with_article(feature.snap) + " has " + counted(point_count(feature.snap), "point") + ", not " +
               std::to_string(p.size());
    for (const glm::dvec3& point : p)
        if (!is_finite(point))
            return "the points of " + with_article(feature.snap) + " must be finite numbers";
    if (p.size() != 3) return {};
    if (feature.snap == Snap::edge && p[1] == p[2]) return "the edge has no length";
    if (feature.snap == Snap::loop && p[1] == p[2]) return "the edge of the loop has no length";
    const double spanned = sine(p[1] - p[0], p[2] - p[0]);
    if (feature.snap == Snap::plane && !(spanned > kLeastSine))
        return "the points of the plane lie on one line";
    if (feature.snap == Snap::center && !(spanned > kLeastSine))
        return "the points of the circle lie on one line";
    return {};
}

}  // namespace

std::optional<std::string> invalid(Kind kind, std::span<const Feature> features) {
    if (auto problem = invalid_count(kind, features.size())) return problem;
    if (auto problem = invalid_snap(kind, features)) return problem;
    for (const Feature& feature : features)
        if (auto problem = invalid_points(feature)) return problem;
    return {};
}

}  // namespace vrut::measurement
