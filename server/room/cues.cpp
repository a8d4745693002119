#include "room/cues.hpp"

#include "room/scene_state.hpp"

namespace vrut::server::room {

using protocol::Error;
namespace code = protocol::error_code;

Error no_cue_named(const std::string& name) {
    return Error{{}, code::unknown_cue, "there is no cue '" + name + "'"};
}

std::vector<Error> problems_of(const std::string& name, const protocol::CueState& cue,
                               const protocol::State& starting, const scene::PlacedScene& placed) {
    const std::string path = "'cues." + name.substr(0, 40) + ".";
    std::vector<Error> problems;
    const auto add = [&](const char* code, const std::string& sentence) {
        problems.push_back({{}, code, path + sentence});
    };
    const scene::Camera camera = camera_of(cue.camera);
    if (!scene::is_valid_pose(camera, placed.bounds.radius()))
        add(code::out_of_range,
            "camera': eye and focus must be apart, and up neither zero nor along the view");
    const std::string &light = cue.lights.active, &background = cue.backgrounds.active;
    if (!starting.lights.items->contains(light))
        add(code::unknown_node, "lights.active': there is no light '" + light.substr(0, 40) + "'");
    if (background != "color" && !starting.backgrounds.items->contains(background))
        add(code::unknown_node,
            "backgrounds.active': there is no background '" + background.substr(0, 40) + "'");
    const std::optional<scene::Id>& selected = cue.selection.node;
    if (selected && placed.scene->find_node(*selected) == scene::kNone)
        add(code::unknown_node, "selection.node': there is no node " + std::to_string(*selected));
    for (const Error& error : node_problems(*placed.scene, cue.nodes))
        add(error.code.c_str(), error.message.substr(1));  // which begins with 'nodes
    return problems;
}

}  // namespace vrut::server::room
