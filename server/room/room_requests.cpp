// What scripts ask for: moves, flights, pictures, the tree and scenes.
#include <cmath>

#include "codec.hpp"
#include "navigation/camera_moves.hpp"
#include "room/cues.hpp"
#include "room/room.hpp"
#include "room/scene_tree.hpp"

namespace vrut::server::room {

using protocol::Error;
namespace code = protocol::error_code;

void Room::apply(const Received& received, const protocol::Navigate& navigate) {
    steer(received);
    scene::Camera moved =
        navigation::rotated(camera(), navigate.rotate.x, navigate.rotate.y, state_.navigation.keep_upright);
    moved = navigation::panned(moved, navigate.pan.x, navigate.pan.y);
    move_camera(navigation::zoomed(moved, navigate.zoom, scene_->bounds.radius()));
    answer(received);
}

void Room::apply(const Received& received, const protocol::Fit& fit) {
    const scene::Index node = fit.node ? scene_->scene->find_node(*fit.node) : 0;
    const std::string name = "node " + std::to_string(fit.node.value_or(0));
    if (node == scene::kNone) return reject(received, code::unknown_node, "there is no " + name);
    const navigation::FitTarget target =
        fit_target(*scene_, node, loaded_.picking_trees.get(), visible_.clip_planes);
    if (fit.node && target.box.empty())
        return reject(received, code::failed, "nothing of " + name + " is to be seen");
    steer(received);
    move_camera(navigation::fitted(camera(), target, aspect(), cover()));
    answer(received);
}

// --- flights

void Room::apply(const Received& received, const protocol::Fly& fly) {
    auto path = flight_path(fly, camera(), *scene_);
    if (!path) return reject(received, path.error().code.c_str(), path.error().message);
    const scene::Camera before = camera();
    steer(received);  // which may bring another size, and so another home
    if (camera() != before) path = flight_path(fly, camera(), *scene_);
    if (!path) return answer(received);  // whose poses do not fit to that: it stays there
    flight_.emplace(
        InFlight{*path, received.client, received.message.id.value_or(0), time_, state_.camera, fly});
    answer(received);
    document();  // the message is its client's doing, what follows nobody's
    advance(time_);
}

// --- pictures and the tree

tl::expected<Room::Laid, Error> Room::laid(const protocol::OtherView& other) {
    Laid laid{state_, scene_};
    if (other.cue) {
        const auto cue = state_.cues->find(*other.cue);
        if (cue == state_.cues->end()) return tl::unexpected(no_cue_named(*other.cue));
        lay_cue(cue->second, laid.state);
        if (auto error = use_laid_nodes(laid.state, laid.placed)) return tl::unexpected(*std::move(error));
        laid.state.camera = state_of(camera_of(cue->second.camera), laid.placed->bounds);
    }
    const scene::Camera camera = camera_of(laid.state.camera);
    const auto moved = overlaid(camera, other.camera, *laid.placed, "camera");
    if (!moved) return tl::unexpected(moved.error());
    if (*moved != camera) laid.state.camera = state_of(*moved, laid.placed->bounds);
    return laid;
}

std::optional<Error> Room::use_laid_nodes(protocol::State& next,
                                          std::shared_ptr<const scene::PlacedScene>& placed) {
    std::erase_if(laid_scenes_, [](const auto& laid) { return laid.second.expired(); });
    const protocol::SharedMap<protocol::NodeOverride> asked = next.nodes;
    for (const auto& [nodes, weak] : laid_scenes_) {
        auto laid = weak.lock();
        if (!laid || laid->scene != scene_->scene || !(nodes == asked)) continue;
        placed = std::move(laid);
        count_classes(next, *placed);
        return std::nullopt;
    }
    if (auto error = use_nodes(next, placed)) return error;
    if (placed != scene_) laid_scenes_.emplace_back(asked, placed);
    return std::nullopt;
}

plan::View Room::view_of_laid(const Laid& laid) const {
    plan::View view = view_of(laid.state, laid.placed);
    view.markers = visible_.markers;
    if (laid.placed != scene_)
        view.markers = std::make_shared<const std::vector<plan::PlacedMarker>>(
            markers_of(*state_.markers, *laid.placed));
    return view;
}

void Room::apply(const Received& received, const protocol::Snapshot& snapshot) {
    if (!received.message.id) {  // nobody could tell the picture from a frame
        accepted_ = !snapshot.cue || state_.cues->contains(*snapshot.cue);
        if (accepted_) return;
        const Error none = no_cue_named(*snapshot.cue);
        return reject(received, none.code.c_str(), none.message);
    }
    auto laid = this->laid({snapshot.camera, snapshot.cue});
    if (!laid) return reject(received, laid.error().code.c_str(), laid.error().message);
    protocol::RendererState& renderer = laid->state.renderer;
    renderer.mode = snapshot.renderer.mode.value_or(renderer.mode);
    renderer.wireframe = snapshot.renderer.wireframe.value_or(renderer.wireframe);
    renderer.show_selection = snapshot.renderer.show_selection.value_or(renderer.show_selection);
    accepted_ = true;
    plan::View view = view_of_laid(*laid);
    view.width = snapshot.width;
    view.height = snapshot.height;
    PictureOrder order{received.client,
                       view,
                       header_of(laid->state, view, view_size_),
                       snapshot.format,
                       snapshot.jpeg_quality,
                       snapshot.samples};
    order.header.revision = document()->revision();
    order.header.snapshot = received.message.id;
    order.header.handled = *received.message.id;
    orders_.push_back(std::move(order));
}

tl::expected<PictureOrder, Error> Room::order(int width, int height, const protocol::OtherView& other) {
    const auto laid = this->laid(other);
    if (!laid) return tl::unexpected(laid.error());
    plan::View view = view_of_laid(*laid);
    view.width = width;
    view.height = height;
    PictureOrder order{{}, view, header_of(laid->state, view, view_size_)};
    order.header.revision = document()->revision();
    return order;
}

void Room::apply(const Received& received, const protocol::Tree& tree) {
    const auto page = tree_page(*scene_, tree);
    if (!page) return reject(received, page.error().code.c_str(), page.error().message);
    answer_with(received, *page);
}

// --- scenes

void Room::apply(const Received& received, const protocol::Open& open) {
    if (options_.load) return options_.load(answer_later(received), open);
    steer(received);
    answer(received);
}

void Room::apply(const Received& received, const protocol::Scenes&) {
    if (!options_.scenes) return answer_with(received, protocol::SceneList{});
    accepted_ = true;
    options_.scenes(answer_later(received));
}

// --- as things stood when a recording began

tl::expected<void, Error> Room::restore(const protocol::LogHeader& header) {
    if (header.home) {
        starting_.views.set("home", *header.home);
        if (!starting_.camera.node) starting_.camera = state_of(camera_of(*header.home), scene_->bounds);
    }
    auto state = protocol::restored(starting_, *header.state);
    if (!state) return tl::unexpected(state.error());
    auto nodes = node_states(*scene_->scene, state->nodes);
    if (!nodes) return tl::unexpected(nodes.error());
    scene_ = std::make_shared<const scene::PlacedScene>(scene::place(scene_->scene, *std::move(nodes)));
    for (const auto& [name, cue] : *state->cues)
        if (auto problems = problems_of(name, cue, starting_, *scene_); !problems.empty())
            return tl::unexpected(std::move(problems.front()));
    view_size_ = header.view;
    at_home_ = header.at_home;
    state_ = *std::move(state);
    count_classes(state_, *scene_);
    const std::optional<scene::Id> node = state_.camera.node, selected = state_.selection.node;
    const scene::Index at = node ? scene_->scene->find_node(*node) : scene::kNone;
    state_.camera =
        at != scene::kNone ? state_at_node(camera(), *scene_, at) : state_of(camera(), scene_->bounds);
    select(selected ? scene_->scene->find_node(*selected) : scene::kNone);
    restore_clients(header.clients);
    for (const protocol::LoggedFrame& frame : header.frames)
        frames_.add({frame.frame, camera_of(frame.camera), frame.view});
    if (const auto& flight = header.flight) {
        const auto path = flight_path(flight->fly, camera_of(flight->from), *scene_);
        if (!path) return tl::unexpected(path.error());
        const SessionTime since(std::llround(flight->since * 1000));
        flight_.emplace(
            InFlight{*path, flight->client, flight->id, time_ - since, flight->from, flight->fly});
    }
    gestures_.restart(camera());
    update_visible();
    use_walls();
    if (header.walls)
        if (auto error = walls_.restore(*header.walls, time_)) return tl::unexpected(*std::move(error));
    if (header.revision > 0) revisions_.go_to(header.revision, state_, true);
    return {};
}

void Room::restore_clients(const std::vector<protocol::LogHeader::Client>& clients) {
    for (const protocol::LogHeader::Client& client : clients) {
        if (may(client.role, protocol::Right::hold_control)) steering_.arrive(client.client, client.resume);
        clients_.add(client.client, {client.role, client.wanted, client.name, client.resume});
    }
    if (state_.control.holder) steering_.take(*state_.control.holder);
    for (const protocol::ControlState::Asking& asking : state_.control.asking) steering_.ask(asking.client);
    state_.clients.set(clients_.listed());
}

}  // namespace vrut::server::room
