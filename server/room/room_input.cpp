// What fingers, mouse and keys do, and what they point at.
#include <algorithm>
#include <cmath>

#include "codec.hpp"
#include "navigation/keys.hpp"
#include "room/hinges.hpp"
#include "room/named_part.hpp"
#include "room/room.hpp"

namespace vrut::server::room {

namespace code = protocol::error_code;

namespace {

constexpr std::size_t kLongestPath = 32;
constexpr double kLeastDeterminant = 1e-12;  // below it a node is flattened, as for the picture

navigation::PointerInput input_of(const std::string& client, const protocol::Pointer& pointer) {
    navigation::PointerInput input;
    input.action = static_cast<navigation::PointerInput::Action>(pointer.event);
    input.client = client;
    input.pointer = pointer.pointer_id;
    input.device = static_cast<navigation::PointerInput::Device>(pointer.pointer_type);
    input.x = pointer.x;
    input.y = pointer.y;
    input.button = pointer.button;
    input.buttons = pointer.buttons;
    const protocol::Modifiers& keys = pointer.modifiers;
    input.modifiers = {keys.alt, keys.ctrl, keys.shift, keys.meta};
    return input;
}

}  // namespace

void Room::apply(const Received& received, const protocol::Pointer& pointer) {
    // Hovering does nothing.
    const bool press = pointer.event == protocol::Pointer::Event::down;
    // A third finger drags nothing, but its release counts.
    const bool known = press || gestures_.is_pressed(received.client, pointer.pointer_id) ||
                       clicks_.is_pressed(received.client, pointer.pointer_id);
    if (!known || !may_steer(received)) return;
    steer(received);
    if (press) swings_.forget_tap();
    const navigation::PointerInput input = input_of(received.client, pointer);
    const navigation::NavigationContext context = navigation_context(pointer.touched);
    drag_camera(gestures_.pointer(input, camera(), context));
    const auto click = clicks_.pointer(input, {pointer.time_stamp, time_}, context.style);
    const bool taps = state_.navigation.tap_swings && pointer.event == protocol::Pointer::Event::up;
    const auto tap = taps ? clicks_.tap() : std::nullopt;
    if (!click && !tap) return;
    const SeenFrame* seen = pointer.frame ? frames_.find(*pointer.frame) : nullptr;
    if (!seen) seen = frames_.newest();  // not told, or long forgotten
    const glm::dvec2 place = click ? glm::dvec2(click->x, click->y) : *tap;
    const std::optional<mesh::Hit> hit =
        hit_along((seen ? *seen : present()).ray_at(place.x, place.y), false);
    if (click) return apply(click->operation, hit);
    const scene::Index turns = hit ? hinged(*scene_->scene, hit->node) : scene::kNone;
    if (turns != scene::kNone) swings_.tap(turns, time_ + navigation::Clicks::kNextWithin);
}

void Room::apply(const Received& received, const protocol::Wheel& wheel) {
    steer(received);
    const navigation::WheelInput input{
        wheel.delta_y, static_cast<navigation::WheelInput::Unit>(wheel.delta_mode), wheel.x, wheel.y};
    move_camera(navigation::wheel(input, camera(), navigation_context(wheel.touched)));
}

void Room::apply(const Received& received, const protocol::Key& key) {
    using Kind = navigation::KeyOperation::Kind;
    const navigation::KeyInput input{key.key, key.modifiers.shift, key.code};
    if (!key.down) {
        accepted_ = steering_.holds(received.client);
        return gestures_.key_up(received.client, input);
    }
    const bool flew = flies();
    steer(received);
    gestures_.key_down(received.client, input);
    const std::optional<navigation::KeyOperation> operation = navigation::key_operation(input);
    if (!operation) return;
    protocol::RendererState& renderer = state_.renderer;
    if (operation->kind == Kind::escape && !flew) select(scene::kNone);
    if (operation->kind == Kind::toggle_wireframe) renderer.wireframe = !renderer.wireframe;
    if (operation->kind == Kind::toggle_stylized)
        renderer.mode = renderer.mode == protocol::DrawMode::stylized ? protocol::DrawMode::realistic
                                                                      : protocol::DrawMode::stylized;
    if (operation->kind == Kind::fit) return fit_selection();
    move_camera(navigation::apply_key_operation(*operation, camera(), camera_of(state_.views->at("home")),
                                                navigation_context()));
}

void Room::fit_selection() {
    const mesh::PickingTrees* trees = loaded_.picking_trees.get();
    const scene::Index node = selected();
    const auto& planes = visible_.clip_planes;
    navigation::FitTarget target = fit_target(*scene_, node == scene::kNone ? 0 : node, trees, planes);
    if (target.box.empty()) target = fit_target(*scene_, 0, trees, planes);
    move_camera(navigation::fitted(camera(), target, aspect(), cover()));
}

void Room::apply(const Received& received, const protocol::Pick& pick) {
    using Then = protocol::Pick::Then;
    if (pick.then && !(may_send(received, protocol::Right::hold_control) && may_steer(received))) return;
    const auto seen = frame_named(received, pick.frame);
    if (!seen) return;
    const std::optional<mesh::Hit> hit = hit_along(seen->ray_at(pick.x, pick.y), pick.through);
    if (pick.then) {
        steer(received);
        if (*pick.then == Then::select)
            select(hit ? hit->node : scene::kNone);
        else
            apply(*pick.then == Then::center ? navigation::Click::Operation::set_center
                                             : navigation::Click::Operation::look_at,
                  hit);
    }
    protocol::Picked picked;
    if (hit) {
        const scene::Node& node = scene_->scene->nodes()[static_cast<std::size_t>(hit->node)];
        picked = {0,          node.id,     node.name,     path_of(hit->node).names,
                  hit->point, hit->normal, hit->distance, {}};
        const glm::dmat4& world_from_node = scene_->world[static_cast<std::size_t>(hit->node)];
        if (std::abs(scene::relative_determinant(glm::dmat3(world_from_node))) > kLeastDeterminant) {
            const glm::dvec3 local(glm::inverse(world_from_node) * glm::dvec4(hit->point, 1));
            if (std::isfinite(local.x + local.y + local.z)) picked.local = local;
        }
    }
    if (pick.snap)
        picked.snapped = measures_.snapped(
            *scene_, *seen, pick, [&](const mesh::Ray& ray) { return hit_along(ray, pick.through); },
            visible_.clip_planes);
    answer_with(received, picked);
}

std::optional<SeenFrame> Room::frame_named(const Received& received,
                                           const std::optional<std::int64_t>& number) {
    if (!number) return present();
    if (const SeenFrame* named = frames_.find(*number)) return *named;
    reject(received, code::unknown_frame,
           "frame " + std::to_string(*number) + " is not among the last " +
               std::to_string(SeenFrames::kMost) + " of the view; snapshots are not remembered");
    return std::nullopt;
}

std::optional<mesh::Hit> Room::hit_along(const mesh::Ray& ray, bool through) const {
    return mesh::pick(*scene_, ray,
                      {.through_transparent = through,
                       .trees = loaded_.picking_trees.get(),
                       .mode = visible_.mode,
                       .clip_planes = visible_.clip_planes,
                       // At once, not once a thread has found it: a replay has to hit what was hit.
                       .is_solid = [this](scene::Index geometry) {
                           return watertight_.is_watertight(scene_->scene, geometry);
                       }});
}

void Room::apply(navigation::Click::Operation operation, const std::optional<mesh::Hit>& hit) {
    if (operation == navigation::Click::Operation::select)
        return select(named_part(*scene_, hit ? hit->node : scene::kNone, selected()));
    if (!hit) return;
    scene::Camera moved = camera();
    moved.center = hit->point;
    if (operation == navigation::Click::Operation::look_at) {
        moved.eye += hit->point - moved.focus;
        moved.focus = hit->point;
    }
    move_camera(moved);
}

scene::Index Room::selected() const {
    return state_.selection.node ? scene_->scene->find_node(*state_.selection.node) : scene::kNone;
}

void Room::select(scene::Index node) {
    state_.selection = {};
    if (node == scene::kNone) return;
    const scene::Node& selected = scene_->scene->nodes()[static_cast<std::size_t>(node)];
    const auto [names, ids] = path_of(node);
    state_.selection = {selected.id, selected.name, names, ids, {}};
    if (const scene::Index turns = hinged(*scene_->scene, node); turns != scene::kNone)
        state_.selection.hinge = scene_->scene->nodes()[static_cast<std::size_t>(turns)].id;
}

Room::Path Room::path_of(scene::Index index) const {
    Path path;
    while (index != scene::kNone && path.ids.size() < kLongestPath) {
        const scene::Node& node = scene_->scene->nodes()[static_cast<std::size_t>(index)];
        path.names.push_back(node.name);
        path.ids.push_back(node.id);
        index = node.parent;
    }
    std::reverse(path.names.begin(), path.names.end());
    std::reverse(path.ids.begin(), path.ids.end());
    return path;
}

}  // namespace vrut::server::room
