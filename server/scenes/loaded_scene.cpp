#include "scenes/loaded_scene.hpp"

#include <string_view>

#include "plan/frame_plan.hpp"
#include "scene/camera.hpp"

namespace vrut::server::scenes {

std::string LoadedScene::changes_key() const {
    return up_axis == protocol::UpAxis::z ? sha256 + " z" : sha256;
}

std::vector<protocol::Notice> all_notices(const scene::PlacedScene& placed) {
    const scene::Scene& scene = *placed.scene;
    std::vector<protocol::Notice> notices;
    for (const auto& sentences : {scene.notices(), plan::unsupported_features(scene)})
        for (const std::string& sentence : sentences)
            notices.push_back({protocol::notice_code::scene, sentence});
    if (const auto sentence = scene::why_not_first_camera(placed))
        notices.push_back({protocol::notice_code::scene, *sentence});
    return notices;
}

namespace {

// The state names these by their ids, a number has at most 24 characters, a colour has four.
constexpr std::size_t kNameBytes = 40, kLightBytes = 300, kBackgroundBytes = 180, kNoticeBytes = 40;

std::size_t json_bytes(std::string_view text) {
    std::size_t bytes = 2;  // quotation marks
    for (const char c : text)
        bytes += static_cast<unsigned char>(c) < 0x20 ? 6 : c == '"' || c == '\\' ? 2 : 1;
    return bytes;
}

std::size_t bytes_of(const scene::Node& node, const scene::Scene& scene) {
    if (node.type == scene::NodeType::camera) return kNameBytes + json_bytes(node.name);
    if (std::holds_alternative<scene::LightData>(node.data)) return kLightBytes + json_bytes(node.name);
    const auto* background = std::get_if<scene::BackgroundData>(&node.data);
    if (!background) return 0;
    const std::string& image =
        background->cube_map ? background->cube_map->front() : scene.material(background->material).image;
    return kBackgroundBytes + json_bytes(node.name) + json_bytes(image);
}

}  // namespace

std::size_t most_state_bytes(const LoadedScene& loaded) {
    const scene::Scene& scene = *loaded.placed->scene;
    std::size_t bytes = 0;
    for (const scene::Node& node : scene.nodes()) bytes += bytes_of(node, scene);
    for (const scene::Material& material : scene.materials()) bytes += kNameBytes + json_bytes(material.name);
    for (const protocol::Notice& notice : loaded.notices) bytes += kNoticeBytes + json_bytes(notice.message);
    return bytes;
}

}  // namespace vrut::server::scenes
