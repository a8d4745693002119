#include "study.hpp"

#include <algorithm>
#include <cmath>

namespace vrut::stability {

namespace {

std::string at(const Curve& curve, const Curve::Point& point) {
    return "'" + curve.title + "' is " + std::to_string(point.y) + " at " + std::to_string(point.x);
}

}  // namespace

std::optional<std::string> contradiction(const Study& study) {
    for (const Curve* curve : {&study.method, study.successor ? &*study.successor : &study.method}) {
        if (curve->points.empty()) return "'" + curve->title + "' was not measured";
        for (const Curve::Point& point : curve->points)
            if (!(std::isfinite(point.x) && std::isfinite(point.y) && point.x >= 0 && point.y >= 0))
                return at(*curve, point);
    }
    for (const Curve::Point& point : study.method.points)
        if (point.y > study.bound && !(study.limit && point.x >= *study.limit))
            return at(study.method, point) + ", before its limit";
    const Curve::Point& last = study.method.points.back();
    if (study.limit && !(last.x >= *study.limit && last.y > study.bound))
        return at(study.method, last) + ", beyond its limit, and has not failed";
    if (!study.successor) return std::nullopt;
    for (const Curve::Point& point : study.successor->points)
        if (point.y > study.bound) return at(*study.successor, point) + ", and fails, too";
    return std::nullopt;
}

std::vector<double> Laboratory::chosen(std::vector<double> points) const {
    constexpr std::size_t kBrief = 4;
    if (form == Form::whole || points.size() <= kBrief) return points;
    std::vector<double> few;
    for (std::size_t i = 0; i < kBrief; ++i) few.push_back(points[i * (points.size() - 1) / (kBrief - 1)]);
    return few;
}

const std::vector<Topic>& topics() {
    static const std::vector<Topic> all{
        {"positions far from the origin", far_positions},
        {"depth of the view", deep_views},
        {"many moves", many_moves},
        {"panes that cross", crossing_panes},
        {"large triangles in light", large_triangles},
    };
    return all;
}

}  // namespace vrut::stability
