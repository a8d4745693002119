#include <algorithm>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "commands/commands.hpp"
#include "observe/progress.hpp"
#include "report.hpp"
#include "room/scene_state.hpp"
#include "scenes/import_process.hpp"
#include "scenes/loaded_scene.hpp"

namespace vrut::server::commands {

namespace {

/// As it stands; a JSON string where a terminal would take part of it for a command (a C0 or C1 control).
std::string printable(const std::string& name) {
    unsigned char before = 0;
    const bool commands = std::any_of(name.begin(), name.end(), [&](unsigned char byte) {
        const bool is_c1 = std::exchange(before, byte) == 0xC2 && byte < 0xA0;
        return byte < ' ' || byte == 0x7F || is_c1;
    });
    return commands ? protocol::json_string(name) : name;
}

/// Depth first, as a tree is read; without recursion, since a scene may be a chain of a million nodes.
std::vector<protocol::NodeReport> list_nodes(const scene::PlacedScene& placed) {
    const scene::Scene& scene = *placed.scene;
    struct Place {
        scene::Index node;
        int depth;
    };
    std::vector<protocol::NodeReport> list;
    std::vector<Place> open{{0, 0}};
    while (!open.empty()) {
        const Place place = open.back();
        open.pop_back();
        const scene::Node& node = scene.nodes()[static_cast<std::size_t>(place.node)];
        const auto* data = std::get_if<scene::GeometryData>(&node.data);
        const std::uint64_t triangles =
            data && data->geometry != scene::kNone
                ? scene.geometries()[static_cast<std::size_t>(data->geometry)].triangles.size()
                : 0;
        list.push_back({node.id, node.name, std::string(scene::name_of(node.type)), triangles,
                        placed.nodes[static_cast<std::size_t>(place.node)].active, place.depth});
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
            open.push_back({*child, place.depth + 1});
    }
    return list;
}

void print(const protocol::SceneState& scene, const std::vector<protocol::NodeReport>& nodes) {
    std::cout << scene.name << ": " << scene.nodes << " nodes, " << scene.materials << " materials, "
              << scene.geometries << " geometries, " << scene.triangles << " triangles\n"
              << "bounds " << scene.bounds.min.x << " " << scene.bounds.min.y << " " << scene.bounds.min.z
              << " to " << scene.bounds.max.x << " " << scene.bounds.max.y << " " << scene.bounds.max.z
              << "\n";
    for (const protocol::Notice& notice : scene.notices) std::cout << "notice: " << notice.message << "\n";
    for (const protocol::NodeReport& node : nodes) {
        // Deep trees keep to the width of a terminal.
        std::cout << std::string(static_cast<std::size_t>(std::min(node.depth, 30)) * 2, ' ') << node.id
                  << " " << printable(node.name) << " (" << node.type;
        if (node.triangles > 0) std::cout << ", " << node.triangles << " triangles";
        std::cout << (node.active ? ")\n" : ", inactive)\n");
    }
    std::cout.flush();
}

}  // namespace

void info_command(const InfoArguments& arguments) {
    auto scene =
        scenes::import_scene(arguments.scene, observe::loading_bar(arguments.scene.filename().string()));
    if (!scene) throw std::runtime_error(scene.error());
    scenes::LoadedScene loaded;
    loaded.name = arguments.scene.filename().string();
    loaded.placed = std::make_shared<const scene::PlacedScene>(scene::place(*std::move(scene)));
    loaded.notices = scenes::all_notices(*loaded.placed);
    const protocol::SceneState state = *room::starting_state(loaded, 1).scene.value;
    const auto nodes = list_nodes(*loaded.placed);
    if (arguments.json)
        std::cout << protocol::encode_info(state, nodes) << std::endl;
    else
        print(state, nodes);
}

}  // namespace vrut::server::commands
