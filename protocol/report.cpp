#include "report.hpp"

#include "descriptions.hpp"

namespace vrut::protocol {

std::string encode(const RenderReport& report) {
    return dump({{"device", report.device},
                 {"width", report.width},
                 {"height", report.height},
                 {"samples", report.samples},
                 {"passes", report.passes},
                 {"draws", report.draws},
                 {"triangles", report.triangles},
                 {"renderMs", report.render_ms},
                 {"readbackMs", report.readback_ms}});
}

std::string encode(const CameraState& camera) { return dump(write_struct(camera)); }

std::string encode_info(const SceneState& scene, const std::vector<NodeReport>& nodes) {
    Json list = Json::array();
    for (const NodeReport& node : nodes)
        list.push_back({{"id", node.id},
                        {"name", node.name},
                        {"type", node.type},
                        {"triangles", node.triangles},
                        {"active", node.active},
                        {"depth", node.depth}});
    Json info = write_struct(scene);
    info["tree"] = std::move(list);
    return dump(info);
}

}  // namespace vrut::protocol
