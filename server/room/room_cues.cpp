// Cues: what a presentation shows, one after the other.
#include <algorithm>

#include "room/cues.hpp"
#include "room/hinges.hpp"
#include "room/room.hpp"

namespace vrut::server::room {

using protocol::CueState;
using protocol::Error;
namespace code = protocol::error_code;

namespace {

protocol::Fly flight_to(const scene::Camera& camera, const CueState& cue) {
    return {{{cue.ms, protocol::overlay_of(pose_of(camera))}}, cue.easing};
}

}  // namespace

std::optional<std::string> Room::cue_named(const Received& received, const protocol::Cue& cue) {
    const auto refuse = [&](const char* why, const std::string& sentence) {
        reject(received, why, sentence);
        return std::nullopt;
    };
    if (cue.name.has_value() == cue.step.has_value())
        return refuse(code::bad_message, "a cue is named either by 'name' or by 'step'");
    if (cue.name) {
        if (state_.cues->contains(*cue.name)) return cue.name;
        const Error none = no_cue_named(*cue.name);
        return refuse(none.code.c_str(), none.message);
    }
    const std::vector<std::string> names = protocol::names_in_order(state_.cues);
    const auto shown = state_.cue ? std::ranges::find(names, state_.cue->name) : names.end();
    const std::ptrdiff_t at = shown == names.end() ? -1 : shown - names.begin(), next = at + *cue.step;
    if (next >= 0 && next < std::ssize(names)) return names[static_cast<std::size_t>(next)];
    return refuse(code::unknown_cue,
                  names.empty() ? "there are no cues" : "there is no cue so many steps from the shown one");
}

void Room::apply(const Received& received, const protocol::Cue& message) {
    const std::optional<std::string> name = cue_named(received, message);
    if (!name) return;
    CueState cue = state_.cues->at(*name);
    cue.ms = message.ms.value_or(cue.ms);
    scene::Camera aim = camera_of(cue.camera);
    if (message.camera != protocol::CameraOverlay{}) {
        const auto laid = this->laid({message.camera, name});
        if (!laid) return reject(received, laid.error().code.c_str(), laid.error().message);
        aim = camera_of(laid->state.camera);
    }
    const protocol::Fly fly = flight_to(aim, cue);
    steer(received);
    fly_to_cue(received, fly);
    protocol::State next = state_;
    lay_cue(cue, next);
    next.cue = protocol::ShownCueState{*name};
    swing_to_cue(cue, next);
    std::shared_ptr<const scene::PlacedScene> placed = scene_;
    // Cannot fail: use_cues() has judged the cue in this scene.
    if (const auto error = use_nodes(next, placed))
        return reject(received, error->code.c_str(), error->message);
    state_ = std::move(next);
    scene_ = std::move(placed);
    select(cue.selection.node ? scene_->scene->find_node(*cue.selection.node) : scene::kNone);
    gestures_.restart(camera());
    measure();
    answer(received);
    document();  // the message is its client's doing, what moves nobody's
    advance(time_);
}

void Room::fly_to_cue(const Received& received, const protocol::Fly& fly) {
    if (const auto path = flight_path(fly, camera(), *scene_))
        flight_.emplace(
            InFlight{*path, received.client, received.message.id.value_or(0), time_, state_.camera, fly});
}

void Room::swing_to_cue(const CueState& cue, protocol::State& next) {
    swings_.clear();
    if (cue.ms == 0) return next.swings.set({});
    const auto matrix_in = [](const protocol::State& state, const std::string& id,
                              const glm::dmat4& of_file) {
        const auto found = state.nodes->find(id);
        return found == state.nodes->end() ? of_file : found->second.matrix.value_or(of_file);
    };
    auto nodes = *next.nodes;
    auto keys = *state_.nodes;
    keys.insert(nodes.begin(), nodes.end());
    for (const auto& [id, change] : keys) {
        const scene::Index index = find_node(*scene_->scene, id);
        const scene::Node& node = scene_->scene->nodes()[static_cast<std::size_t>(index)];
        const glm::dmat4 from = matrix_in(state_, id, node.matrix), to = matrix_in(next, id, node.matrix);
        const std::optional<double> part = hinge_part(node, to);
        if (!part || from == to || !hinge_part(node, from)) continue;
        nodes[id].matrix = from;
        const glm::dmat4& stands = scene_->nodes[static_cast<std::size_t>(index)].matrix;
        swings_.begin_at(index, opened_part(node, stands), *part, cue.ms, time_);
    }
    next.nodes.set(std::move(nodes));
    next.swings.set(swings_.states(*scene_->scene));
}

std::optional<Error> Room::use_cues(protocol::State& next) const {
    if (next.cues == state_.cues) return std::nullopt;
    auto cues = *next.cues;
    for (auto& [name, cue] : cues) {
        const auto before = state_.cues->find(name);
        if (before != state_.cues->end() && before->second == cue) continue;
        const std::vector<Error> problems = problems_of(name, cue, starting_, *scene_);
        if (!problems.empty()) return problems.front();
        cue.camera = pose_of(scene::with_orthogonal_up(camera_of(cue.camera)));
    }
    next.cues.set(std::move(cues));
    return std::nullopt;
}

void Room::keep_shown_cue(protocol::State& next) const {
    if (!next.cue || next.cues->contains(next.cue->name)) return;
    const std::string shown = next.cue->name;
    const CueState& cue = state_.cues->at(shown);
    next.cue.reset();
    for (const auto& [name, other] : *next.cues)
        if (other == cue && !state_.cues->contains(name)) next.cue = protocol::ShownCueState{name};
    if (next.cue) return;
    for (const std::string& name : protocol::names_in_order(state_.cues)) {
        if (name == shown) return;
        if (next.cues->contains(name)) next.cue = protocol::ShownCueState{name};
    }
}

protocol::Checked Room::check_cues(const nlohmann::json& list) const {
    return checked(protocol::read_cue_list(list, starting_));
}

protocol::Checked Room::check_cues(const std::string& text) const {
    return checked(protocol::parse_cue_list(text, starting_));
}

protocol::Checked Room::checked(const tl::expected<protocol::ReadCueList, Error>& list) const {
    if (!list) return {0, {{{}, list.error().message}}, {}};
    protocol::Checked checked;
    const auto file_name = [](const std::string& path) { return path.substr(path.rfind('/') + 1); };
    const std::string& file = starting_.scene.value->file;  // a server has it with the folder that it is in
    if (!list->scene.empty() && file_name(list->scene) != file_name(file))
        checked.problems.push_back(
            {{}, "the list was made for '" + list->scene + "', and this is '" + file + "'"});
    for (const auto& [name, cue] : list->cues) {
        const std::vector<Error> errors =
            cue ? problems_of(name, *cue, starting_, *scene_) : std::vector<Error>{cue.error()};
        for (const Error& error : errors) checked.problems.push_back({name, error.message});
        if (errors.empty()) checked.fitting.push_back(name);
    }
    if (checked.problems.size() > protocol::kMaxCueProblems)
        checked.problems.resize(protocol::kMaxCueProblems);
    return checked;
}

void Room::apply(const Received& received, const protocol::Check& check) {
    answer_with(received, check_cues(*check.cues));
}

}  // namespace vrut::server::room
