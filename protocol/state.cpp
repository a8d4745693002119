#include "state.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "state_descriptions.hpp"

namespace vrut::protocol {

namespace {

/// An entry's key, or `other` where that is allowed.
template <class Item>
void check_key(const std::string& key, const char* path, const SharedMap<Item>& items,
               const char* other = nullptr) {
    if ((!other || key != other) && !items->contains(key))
        throw BadJson{error_code::unknown_node,
                      "'" + std::string(path) + "': there is no '" + excerpt(key) + "'"};
}

/// Normals that a patch may give any length get their own. `path`: of what the two are in.
void check_sections(SharedMap<SectionState>& shared, const SectionBoxState& box, const std::string& path) {
    auto sections = *shared;
    for (auto& [name, section] : sections) {
        const double largest =
            std::max({std::abs(section.normal.x), std::abs(section.normal.y), std::abs(section.normal.z)});
        if (largest == 0)
            throw BadJson{error_code::out_of_range, "'" + path + "sections." + excerpt(name) +
                                                        ".normal' is [0, 0, 0]: it must lead somewhere"};
        const glm::dvec3 scaled = section.normal / largest;
        // A unit one stays as it is, to the last bit.
        const double length = glm::length(scaled) * largest;
        if (std::abs(length - 1) > 1e-15) section.normal = scaled / glm::length(scaled);
    }
    shared.set(std::move(sections));
    for (int axis = 0; axis < 3; ++axis)
        if (!(box.min[axis] < box.max[axis]))
            throw BadJson{error_code::out_of_range, "'" + path + "sectionBox.min' must be below '" + path +
                                                        "sectionBox.max' in each direction"};
}

/// Of the state and of the cues that differ from those `before`.
void check_sections(State& state, const SharedMap<CueState>& before) {
    check_sections(state.sections, state.section_box, "");
    if (state.cues == before) return;
    auto cues = *state.cues;
    std::size_t nodes = 0;
    for (auto& [name, cue] : cues) {
        check_sections(cue.sections, cue.section_box, "cues." + excerpt(name) + ".");
        nodes += cue.nodes->size();
    }
    if (nodes > kMaxNodes)
        throw BadJson{error_code::too_many, "the 'nodes' of all cues hold " + std::to_string(kMaxNodes) +
                                                " entries at most together"};
    state.cues.set(std::move(cues));
}

/// Members that entries of a patch do not have, or have as null, are those of `saved`.
template <class T>
void save_present(const Json& entries, const T& saved, SharedMap<T>& starting, SharedMap<T>& present) {
    auto at_start = *starting, now = *present;
    for (const auto& [name, value] : entries.items()) {
        if (!value.is_object() || starting->contains(name)) continue;
        if (name.empty() || at_start.size() > kMaxEntries) continue;  // to be refused
        at_start[name] = saved;
        now.try_emplace(name, saved);
    }
    starting.set(std::move(at_start));
    present.set(std::move(now));
}

CueState cue_of(const State& state) {
    CueState cue;
    cue.camera = static_cast<const Pose&>(state.camera);
    copy_common_fields(in_cues, table_of<CueState>(), &cue, table_of<State>(), &state);
    return cue;
}

/// New cues, less the tables and the selection that the patch gives: those are to be the patch's alone.
SharedMap<CueState>::Map without_given(const Json& patch, SharedMap<CueState>::Map cues,
                                       const SharedMap<CueState>::Map& before) {
    for (const auto& [name, value] : patch.items()) {
        const auto found = cues.find(name);
        if (found == cues.end() || before.contains(name)) continue;
        const auto is_given = [&value = value](const char* member) {
            const auto given = value.find(member);
            return given != value.end() && given->is_object();
        };
        CueState& cue = found->second;
        if (is_given("nodes")) cue.nodes = {};
        if (is_given("sections")) cue.sections = {};
        if (is_given("selection")) cue.selection = {};
    }
    return cues;
}

State patched_or_throw(const State& state, const State& starting, const Json& patch) {
    State result = state, start = starting;
    const auto section = [&](const char* name) -> const Json* {
        const auto found = patch.find(name);
        return found != patch.end() && found->is_object() ? &*found : nullptr;
    };
    if (const Json* views = section("views")) {
        CameraState camera = state.camera;
        if (const Json* named = section("camera")) patch_struct(camera, starting.camera, *named, "camera");
        save_present(*views, {static_cast<const Pose&>(camera), {}}, start.views, result.views);
    }
    if (const Json* cues = section("cues")) {
        State shown = result;
        Json others = patch;
        others.erase("cues");
        patch_struct(shown, start, others, "");
        save_present(*cues, cue_of(shown), start.cues, result.cues);
        result.cues.set(without_given(*cues, *result.cues, *state.cues));
    }
    patch_struct(result, start, patch, "");
    check_key(result.lights.active, "lights.active", result.lights.items);
    check_key(result.backgrounds.active, "backgrounds.active", result.backgrounds.items, "color");
    check_sections(result, state.cues);
    return result;
}

}  // namespace

tl::expected<State, Error> patched(const State& state, const State& starting, const Json& patch) {
    return or_error([&] { return patched_or_throw(state, starting, patch); });
}

void sign_notes(const State& before, const Json& patch, const std::optional<std::string>& author,
                State& next) {
    const auto markers = patch.find("markers");
    if (markers == patch.end() || !markers->is_object()) return;
    auto notes = *next.markers;
    for (const auto& [name, given] : markers->items()) {
        const auto note = notes.find(name);
        if (note == notes.end() || before.markers->contains(name)) continue;
        if (!given.contains("author")) note->second.author = author;
        if (!given.contains("view")) note->second.view = static_cast<const Pose&>(next.camera);
    }
    next.markers.set(std::move(notes));
}

tl::expected<Patch, Error> parse_patch(std::string_view text) {
    return or_error([&] {
        return Patch{std::make_shared<const Json>(read_object(parse_strictly(text), "patch")), {}};
    });
}

tl::expected<State, Error> restored(const State& starting, const Json& document) {
    return or_error([&] {
        State state = starting;
        restore_fields(table_of<State>(), &state, document, "");
        check_key(state.lights.active, "lights.active", state.lights.items);
        check_key(state.backgrounds.active, "backgrounds.active", state.backgrounds.items, "color");
        check_sections(state, starting.cues);
        if (const auto cue = document.find("cue"); cue != document.end()) {
            const std::string name =
                read_string(read_object(*cue, "cue").value("name", Json()), "cue.name", kName.max);
            if (!state.cues->contains(name))
                throw BadJson{error_code::unknown_cue, "'cue.name': there is no cue '" + excerpt(name) + "'"};
            state.cue = ShownCueState{name};
        }
        if (const auto control = document.find("control"); control != document.end()) {
            state.control = read_struct<ControlState>(*control, "control");
            state.control.absent = false;
            for (const ControlState::Asking& asking : state.control.asking)
                if (asking.client.empty())
                    throw BadJson{error_code::bad_message, "member 'control.asking.client' is missing"};
        }
        return state;
    });
}

namespace {

std::vector<const Field*> fields_of(Sections sections) {
    std::vector<const Field*> fields;
    for (const Field& field : table_of<State>().fields)
        if (field.has(sections == Sections::kept ? kept : for_hosts)) fields.push_back(&field);
    return fields;
}

}  // namespace

std::shared_ptr<const Json> document_of(const State& state) {
    return std::make_shared<const Json>(write_struct(state));
}

std::string kept_changes(const State& starting, const State& state) {
    Json changes = Json::object();
    for (const Field* field : fields_of(Sections::kept))
        if (Json diff =
                merge_diff(field->kind->write(field->in(&starting)), field->kind->write(field->in(&state)));
            !diff.empty())
            changes[field->name] = std::move(diff);
    return dump(changes);
}

bool has_equal_kept(const State& a, const State& b) {
    return std::ranges::all_of(fields_of(Sections::kept), [&](const Field* field) {
        return field->type->equal(field->in(&a), field->in(&b));
    });
}

std::vector<std::string> names_of(Sections sections) {
    std::vector<std::string> names;
    for (const Field* field : fields_of(sections)) names.emplace_back(field->name);
    std::ranges::sort(names);
    return names;
}

bool names_only(const Json& patch, Sections sections) {
    const std::vector<std::string> names = names_of(sections);
    return std::ranges::all_of(patch.items(), [&](const auto& member) {
        return std::ranges::find(names, member.key()) != names.end();
    });
}

State opened(State starting, const State& before) {
    copy_fields(table_of<State>(), survives_open, &starting, &before);
    return starting;
}

void lay_cue(const CueState& cue, State& state) {
    const std::optional<std::int64_t> selected = state.selection.node;
    copy_common_fields(in_cues, table_of<State>(), &state, table_of<CueState>(), &cue);
    if (state.selection.node != selected) state.selection = {state.selection.node, {}, {}, {}, {}};
}

tl::expected<CameraOverlay, Error> parse_camera(std::string_view text) {
    return or_error([&] { return read_struct<CameraOverlay>(parse_strictly(text), "camera"); });
}

NamedCameraMembers named_camera_members(const Json& patch) {
    const auto camera = patch.find("camera");
    if (camera == patch.end()) return {};
    const auto named = [&](const char* name) { return camera->is_null() || camera->contains(name); };
    return {named("node"), named("eye"), named("focus"), named("up"), named("center"), named("fov")};
}

}  // namespace vrut::protocol
