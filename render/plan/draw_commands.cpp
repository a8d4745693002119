#include "plan/draw_commands.hpp"

namespace vrut {

namespace {

using Kind = DrawCommand::Kind;
using Commands = std::vector<DrawCommand>;

void add(Commands& commands, Kind kind, const MirrorItem* mirror, std::span<const DrawItem> items) {
    if (!items.empty()) commands.push_back({kind, mirror, items});
}

void add_layers(Commands& commands, const Layers& layers, const MirrorItem* mirror) {
    add(commands, Kind::opaque, mirror, layers.opaque);
    // What a mirror shows costs as much as the picture: it is drawn only where the mirror can be seen.
    if (!layers.mirrors.empty()) commands.push_back({Kind::find_mirrors, mirror, {}, layers.mirrors});
    for (const MirrorItem& within : layers.mirrors) {
        commands.push_back({Kind::open_mirror, &within});
        add_layers(commands, within.reflected, &within);
        commands.push_back({Kind::close_mirror, &within});
    }
    for (const TransparentGroup& group : layers.transparent)
        add(commands, group.exact ? Kind::layered_glass : Kind::sorted_glass, mirror, group.items);
}

void add_selection(Commands& commands, const FramePlan& plan, const View& view) {
    if (view.wireframe) return add(commands, Kind::edges_over, nullptr, plan.selected);
    add(commands, Kind::move_behind, nullptr, plan.selected);
    add_layers(commands, plan.over, nullptr);
    if (view.mode == DrawMode::stylized) add(commands, Kind::edges, nullptr, plan.selected);
    add(commands, Kind::outline_cover, nullptr, plan.selected);
    commands.push_back({Kind::outline, nullptr, plan.selected});
}

}  // namespace

bool is_reflected(const DrawCommand& command) { return command.mirror && command.kind != Kind::close_mirror; }

std::vector<DrawCommand> draw_commands(const FramePlan& plan, const View& view) {
    Commands commands{{Kind::clear}};
    add_layers(commands, plan.scene, nullptr);
    add(commands, Kind::edges, nullptr, plan.edges);
    if (!plan.selected.empty()) add_selection(commands, plan, view);
    if (!plan.marks.empty()) commands.push_back({Kind::marks});
    return commands;
}

}  // namespace vrut
