#include "frame_plan.hpp"

#include <algorithm>
#include <cmath>

namespace vrut {

FramePlan plan_frame(const PlacedScene& placed, const Camera& camera) {
    const std::vector<bool> shown = shown_nodes(placed, camera.eye);
    const glm::dmat4 view = view_from_world(camera);

    FramePlan plan;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const auto* data = std::get_if<GeometryData>(&placed.scene->nodes()[i].data);
        if (!shown[i] || !data || data->geometry == kNone) continue;
        const Geometry& geometry = placed.scene->geometries()[static_cast<std::size_t>(data->geometry)];
        if (geometry.triangles.empty()) continue;
        const Index material = placed.nodes[i].material;
        DrawItem item{static_cast<Index>(i), data->geometry, material, view * placed.world[i], {}, false};
        const Bounds in_view = transformed(item.view_from_node, geometry.bounds);
        if (!(glm::length(in_view.min) < kFarthestDrawn && glm::length(in_view.max) < kFarthestDrawn))
            continue;
        const double determinant = relative_determinant(glm::dmat3(item.view_from_node));
        const bool singular = !(std::abs(determinant) > 1e-12);
        item.sides = singular || placed.scene->material(material).two_sided ? Sides::both : Sides::front;
        item.mirrored = determinant < 0;
        plan.opaque.push_back(item);
    }
    // Equal depth: the higher id is in front, so it comes last.
    std::sort(plan.opaque.begin(), plan.opaque.end(), [&](const DrawItem& a, const DrawItem& b) {
        const auto& nodes = placed.scene->nodes();
        return nodes[static_cast<std::size_t>(a.node)].id < nodes[static_cast<std::size_t>(b.node)].id;
    });
    return plan;
}

std::vector<std::string> undrawn_features(const Scene& scene) {
    const auto& materials = scene.materials();
    const auto& nodes = scene.nodes();
    std::vector<std::string> notices;
    const auto say = [&](auto count, const std::string& what) {
        if (count > 0) notices.push_back(std::to_string(count) + what);
    };
    say(std::count_if(materials.begin(), materials.end(), [](const Material& m) { return m.diffuse.a < 1; }),
        " transparent materials are drawn opaque");
    say(std::count_if(materials.begin(), materials.end(), [](const Material& m) { return !m.image.empty(); }),
        " textures are not drawn");
    say(std::count_if(materials.begin(), materials.end(),
                      [](const Material& m) { return m.reflectivity > 0; }),
        " reflective materials are drawn without reflections");
    say(std::count_if(nodes.begin(), nodes.end(), [](const Node& n) { return n.type == NodeType::light; }),
        " lights cannot be chosen: the headlight shines");
    say(std::count_if(nodes.begin(), nodes.end(),
                      [&](const Node& node) {
                          const auto* data = std::get_if<BackgroundData>(&node.data);
                          return data && (data->cube_map || !scene.material(data->material).image.empty());
                      }),
        " background pictures are drawn as their material's colour");
    return notices;
}

}  // namespace vrut
