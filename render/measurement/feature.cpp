#include "measurement/feature.hpp"

#include <array>

namespace vrut::measurement {

std::string_view name_of(Snap snap) {
    constexpr std::array<std::string_view, 7> kNames{"point", "vertex", "midpoint", "center",
                                                     "edge",  "loop",   "plane"};
    return kNames[static_cast<std::size_t>(snap)];
}

std::size_t point_count(Snap snap) {
    return snap == Snap::point || snap == Snap::vertex || snap == Snap::midpoint ? 1 : 3;
}

}  // namespace vrut::measurement
