#include "scenes/level_store.hpp"

namespace vrut::server::scenes {

// As `chart --calibrate --size 1180x820` measured the car, drawn by two cores. Of other scenes the errors are
// others.
const protocol::LevelTable& built_in_levels() {
    using protocol::Quality;
    constexpr auto kMoving = Quality::Level::moving, kStill = Quality::Level::still;
    constexpr auto k420 = Quality::Subsampling::yuv420, k444 = Quality::Subsampling::yuv444;
    static const protocol::LevelTable table{
        "d8a2199b011e56649929bacd5a3bb837f93a3e0cc5d6e536bb186468ae1dc109",
        "llvmpipe",
        1180,
        820,
        {{{kMoving, 0.25, 1, 2, 60, k420, 0.083}, 21, 5'500, ""},
         {{kMoving, 0.35, 1, 2, 85, k444, 0.054}, 25, 19'000, ""},
         {{kMoving, 0.5, 1, 2, 85, k444, 0.045}, 34, 32'000, ""},
         {{kMoving, 0.71, 1, 2, 85, k444, 0.038}, 51, 55'000, ""},
         {{kMoving, 1, 1, 0, 90, k444, 0.028}, 80, 115'000, ""},
         {{kStill, 1, 16, 0, 90, k444, 0.025}, 1160, 103'000, ""}}};
    return table;
}

}  // namespace vrut::server::scenes
