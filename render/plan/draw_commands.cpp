#include "plan/draw_commands.hpp"

namespace vrut::plan {

namespace {

using Kind = DrawCommand::Kind;
using Commands = std::vector<DrawCommand>;

void add(Commands& commands, Kind kind, const MirrorItem* mirror, std::span<const DrawItem> items) {
    if (!items.empty()) commands.push_back({kind, mirror, items});
}

void add_draw_lists(Commands& commands, const DrawLists& lists, const MirrorItem* mirror) {
    add(commands, Kind::opaque, mirror, lists.opaque);
    // What a mirror shows costs as much as the image: it is drawn only where the mirror can be seen.
    if (!lists.mirrors.empty()) commands.push_back({Kind::find_mirrors, mirror, {}, lists.mirrors});
    for (const MirrorItem& within : lists.mirrors) {
        commands.push_back({Kind::open_mirror, &within});
        add_draw_lists(commands, within.reflected, &within);
        commands.push_back({Kind::close_mirror, &within});
    }
    add(commands, Kind::cut_lines, mirror, lists.cut_lines);
    for (const TransparentGroup& group : lists.transparent)
        add(commands, group.exact ? Kind::per_pixel_glass : Kind::sorted_glass, mirror, group.items);
}

void add_selection(Commands& commands, const FramePlan& plan, const View& view) {
    const scene::Style style = style_of(view);
    if (!style.faces) return add(commands, Kind::edges_overlay, nullptr, plan.selected);
    add(commands, Kind::reset_depth, nullptr, plan.selected);
    add_draw_lists(commands, plan.overlay, nullptr);
    if (style.edges) add(commands, Kind::edges, nullptr, plan.selected);
    add(commands, Kind::outline_mask, nullptr, plan.selected);
    commands.push_back({Kind::outline, nullptr, plan.selected});
}

}  // namespace

bool is_reflected(const DrawCommand& command) { return command.mirror && command.kind != Kind::close_mirror; }

std::vector<DrawCommand> draw_commands(const FramePlan& plan, const View& view) {
    Commands commands{{Kind::clear}};
    add_draw_lists(commands, plan.scene, nullptr);
    add(commands, Kind::edges, nullptr, plan.edges);
    if (!plan.selected.empty()) add_selection(commands, plan, view);
    if (!plan.markers.empty()) commands.push_back({Kind::markers});
    return commands;
}

}  // namespace vrut::plan
