#include "report.hpp"

#include "state_descriptions.hpp"

namespace vrut::protocol {

std::string json_string(std::string_view text) {
    return Json(text).dump(-1, ' ', true, Json::error_handler_t::replace);
}

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

std::string encode(const CompareReport& report) {
    return dump({{"width", report.width},
                 {"height", report.height},
                 {"maximum", report.maximum},
                 {"rms", report.rms},
                 {"psnr", report.psnr ? Json(*report.psnr) : Json()},
                 {"above2", report.above2},
                 {"above8", report.above8},
                 {"flip",
                  {{"mean", report.flip.mean},
                   {"weightedMedian", report.flip.weighted_median},
                   {"firstWeightedQuartile", report.flip.first_weighted_quartile},
                   {"thirdWeightedQuartile", report.flip.third_weighted_quartile},
                   {"min", report.flip.min},
                   {"max", report.flip.max}}}});
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
