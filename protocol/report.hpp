#pragma once

#include <cstdint>
#include <string>
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

std::string encode(const RenderReport& report);
/// What `replay` prints: the state's `camera`.
std::string encode(const CameraState& camera);
/// What `info --json` prints: the state's `scene` and the tree, root first.
std::string encode_info(const SceneState& scene, const std::vector<NodeReport>& nodes);

}  // namespace vrut::protocol
