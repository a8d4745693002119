#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "state.hpp"

namespace vrut::protocol {

/// What `render --stats` prints.
struct RenderReport {
    std::string device;
    int width = 0, height = 0, samples = 1;
    int passes = 0, draws = 0;
    std::uint64_t triangles = 0;
    double render_ms = 0, readback_ms = 0;
};

struct NodeReport {
    std::int64_t id = 0;
    std::string name, type;
    std::uint64_t triangles = 0;
    bool active = true;
    int depth = 0;  ///< below the root
};

/// What `compare --json` prints.
struct CompareReport {
    int width = 0, height = 0;
    int maximum = 0;                ///< of a channel, in steps of 1/255
    double rms = 0;                 ///< over channels and pixels, in steps of 1/255
    std::optional<double> psnr;     ///< dB; none (null) where the pictures are equal
    double above2 = 0, above8 = 0;  ///< parts of the pixels, 0 to 1, off by more than so many steps
    struct Flip {
        double mean = 0, weighted_median = 0, first_weighted_quartile = 0, third_weighted_quartile = 0;
        double min = 0, max = 0;
    } flip;
};

std::string encode(const RenderReport& report);
std::string encode(const CompareReport& report);
/// What `replay` prints: the state's `camera`.
std::string encode(const CameraState& camera);
/// A JSON string of printable ASCII, everything else escaped; what is not UTF-8 is U+FFFD.
std::string json_string(std::string_view text);
/// What `info --json` prints: the state's `scene` and the tree, root first.
std::string encode_info(const SceneState& scene, const std::vector<NodeReport>& nodes);

}  // namespace vrut::protocol
