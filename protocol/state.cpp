#include "state.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "descriptions.hpp"

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
    const CameraState& camera = state.camera;
    CueState cue;
    cue.camera = {camera.eye, camera.focus, camera.up, camera.center, camera.fov};
    cue.lights.active = state.lights.active;
    cue.backgrounds = {state.backgrounds.active, state.backgrounds.color};
    cue.selection.node = state.selection.node;
    cue.nodes = state.nodes;
    cue.sections = state.sections;
    cue.section_box = state.section_box;
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
        save_present(*views, {camera.eye, camera.focus, camera.up, camera.center, camera.fov, {}},
                     start.views, result.views);
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

/// What must be merged into `from` to make `to` of it (RFC 7396); neither holds a null.
Json merge_diff(const Json& from, const Json& to) {
    Json diff = Json::object();
    for (const auto& [name, value] : to.items()) {
        const auto old = from.find(name);
        if (old == from.end())
            diff[name] = value;
        else if (*old == value)
            continue;
        else
            diff[name] = old->is_object() && value.is_object() ? merge_diff(*old, value) : value;
    }
    for (const auto& [name, value] : from.items())
        if (!to.contains(name)) diff[name] = nullptr;
    return diff;
}

}  // namespace

tl::expected<State, Error> patched(const State& state, const State& starting, const Json& patch) {
    return or_error([&] { return patched_or_throw(state, starting, patch); });
}

void sign_notes(const State& before, const Json& patch, const std::optional<std::string>& author,
                State& next) {
    const auto markers = patch.find("markers");
    if (markers == patch.end() || !markers->is_object()) return;
    const CameraState& camera = next.camera;
    auto notes = *next.markers;
    for (const auto& [name, given] : markers->items()) {
        const auto note = notes.find(name);
        if (note == notes.end() || before.markers->contains(name)) continue;
        if (!given.contains("author")) note->second.author = author;
        if (!given.contains("view"))
            note->second.view = Marker::View{camera.eye, camera.focus, camera.up, camera.center, camera.fov};
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
        restore_struct(state, document, "");
        check_key(state.lights.active, "lights.active", state.lights.items);
        check_key(state.backgrounds.active, "backgrounds.active", state.backgrounds.items, "color");
        check_sections(state, starting.cues);
        if (const auto cue = document.find("cue"); cue != document.end()) {
            const std::string name = kName.read(read_object(*cue, "cue").value("name", Json()), "cue.name");
            if (!state.cues->contains(name))
                throw BadJson{error_code::unknown_cue, "'cue.name': there is no cue '" + excerpt(name) + "'"};
            state.cue = ShownCueState{name};
        }
        if (const auto control = document.find("control"); control != document.end()) {
            if (control->contains("holder"))
                state.control.holder = kName.read((*control)["holder"], "holder");
            if (control->contains("name")) state.control.name = kName.read((*control)["name"], "name");
            state.control.kept = control->contains("kept") && Flag{}.read((*control)["kept"], "kept");
            for (const Json& one : control->value("asking", Json::array())) {
                const Json& asking = read_object(one, "asking");
                ControlState::Asking& added = state.control.asking.emplace_back();
                added.client = kName.read(asking.value("client", Json()), "client");
                if (asking.contains("name")) added.name = kName.read(asking["name"], "name");
            }
        }
        return state;
    });
}

std::string kept_changes(const State& starting, const State& state) {
    Json changes = Json::object();
    const auto from = document_of(starting), to = document_of(state);
    for (const char* section : {"views", "markers", "measures", "unit", "cues", "nodes"}) {
        Json diff = merge_diff(from->at(section), to->at(section));
        if (!diff.empty()) changes[section] = std::move(diff);
    }
    return dump(changes);
}

bool has_equal_kept(const State& a, const State& b) {
    return a.views == b.views && a.markers == b.markers && a.measures == b.measures && a.unit == b.unit &&
           a.cues == b.cues && a.nodes == b.nodes;
}

tl::expected<CameraOverlay, Error> parse_camera(std::string_view text) {
    return or_error([&] { return read_struct<CameraOverlay>(parse_strictly(text), "camera"); });
}

bool names_only(const Json& patch, std::initializer_list<std::string_view> sections) {
    for (const auto& [name, value] : patch.items())
        if (std::find(sections.begin(), sections.end(), name) == sections.end()) return false;
    return true;
}

NamedCameraMembers named_camera_members(const Json& patch) {
    const auto camera = patch.find("camera");
    if (camera == patch.end()) return {};
    const auto named = [&](const char* name) { return camera->is_null() || camera->contains(name); };
    return {named("node"), named("eye"), named("focus"), named("up"), named("center"), named("fov")};
}

// --- the document

struct StateDocument::Section {
    std::string name;
    Json json;
    Json changed;  ///< like `json`, with each leaf the revision that changed it last
};

namespace {

constexpr const char* kGone = "";  // no member has an empty name

/// Null where there is none.
const Json& member(const Json& parent, const std::string& name) {
    static const Json kNone;
    if (!parent.is_object()) return kNone;
    const auto found = parent.find(name);
    return found == parent.end() ? kNone : *found;
}

/// `changed` brought up to date for a step from `from` to `to`.
Json mark_changes(const Json& from, const Json& to, const Json& changed, std::int64_t revision) {
    if (!to.is_object()) return from == to && changed.is_number() ? changed : Json(revision);
    Json result = Json::object();
    for (const auto& [name, value] : to.items())
        result[name] = mark_changes(member(from, name), value, member(changed, name), revision);
    // What went leaves its mark, so that a patch that counts on it is found stale. Marks of what went long
    // ago are kept as one, for all: names that come and go must not pile up.
    constexpr std::size_t kMostGone = 1000;
    std::int64_t gone = changed.is_object() ? changed.value(kGone, std::int64_t{0}) : 0;
    const auto is_gone = [&](const std::string& name) { return !to.contains(name); };
    if (changed.is_object())
        for (const auto& [name, mark] : changed.items())
            if (is_gone(name) && name != kGone) result[name] = mark;
    if (from.is_object())
        for (const auto& [name, value] : from.items())
            if (is_gone(name)) result[name] = revision;
    if (result.size() - to.size() > kMostGone) {
        std::erase_if(result.get_ref<Json::object_t&>(),
                      [&](const auto& entry) { return is_gone(entry.first); });
        gone = revision;
    }
    if (gone > 0) result[kGone] = gone;
    return result;
}

std::int64_t newest(const Json& changed) {
    if (changed.is_number()) return changed.get<std::int64_t>();
    std::int64_t result = 0;
    for (const auto& [name, value] : changed.items()) result = std::max(result, newest(value));
    return result;
}

std::int64_t newest_named(const Json& changed, const Json& patch) {
    if (!patch.is_object() || !changed.is_object()) return newest(changed);
    std::int64_t result = 0;
    for (const auto& [name, value] : patch.items())
        if (const auto found = changed.find(name); found != changed.end())
            result = std::max(result, newest_named(*found, value));
        else
            result = std::max(result, changed.value(kGone, std::int64_t{0}));
    return result;
}

}  // namespace

namespace {

/// Tells `update` the name, both values and the writer of each section.
template <class Update>
struct SectionLister {
    const State &state, &previous;
    Update update;

    template <class Member, class Kind>
    void writable(const char* name, Member State::*member, const Kind& kind, const char*) {
        update(name, state.*member == previous.*member, [&] {
            if constexpr (!IsOptional<Member>::value)
                return kind.write(state.*member);
            else
                return state.*member ? kind.write(*(state.*member)) : Json();
        });
    }
    template <class Member, class Kind>
    void fixed(const char* name, Member State::*member, const Kind& kind, const char* meaning) {
        writable(name, member, kind, meaning);
    }
};

}  // namespace

std::shared_ptr<const StateDocument> StateDocument::next(const StateDocument& previous, const State& state) {
    return next(previous, state, previous.revision_ + 1);
}

std::shared_ptr<const StateDocument> StateDocument::next(const StateDocument& previous, const State& state,
                                                         std::int64_t revision) {
    auto document = std::make_shared<StateDocument>(previous);
    document->revision_ = revision;
    document->state_ = state;
    const bool first = previous.sections_.empty();
    std::size_t place = 0;
    const auto update = [&](const char* name, bool equal, const auto& write) {
        const std::size_t at = place++;
        if (!first && equal) return;
        auto fresh = std::make_shared<Section>(Section{name, write(), {}});
        fresh->changed = first ? mark_changes({}, fresh->json, {}, document->revision_)
                               : mark_changes(previous.sections_[at]->json, fresh->json,
                                              previous.sections_[at]->changed, document->revision_);
        if (first)
            document->sections_.push_back(std::move(fresh));
        else
            document->sections_[at] = std::move(fresh);
    };
    SectionLister<decltype(update)> lister{state, previous.state_, update};
    describe(lister, static_cast<const State*>(nullptr));
    return document;
}

namespace {

/// Takes the names of the sections, in their order.
struct SectionNames {
    std::vector<std::string> names;
    template <class Member, class Kind>
    void writable(const char* name, Member, const Kind&, const char*) {
        names.emplace_back(name);
    }
    template <class Member, class Kind>
    void fixed(const char* name, Member, const Kind&, const char*) {
        names.emplace_back(name);
    }
};

const std::vector<std::string>& section_names() {
    static const std::vector<std::string> names = [] {
        SectionNames lister;
        describe(lister, static_cast<const State*>(nullptr));
        return lister.names;
    }();
    return names;
}

}  // namespace

tl::expected<std::shared_ptr<const StateDocument>, std::string> StateDocument::received(
    std::string_view text, const StateDocument* known) {
    const auto read = [&]() -> std::shared_ptr<const StateDocument> {
        const Json message = parse_strictly(text);
        read_object(message, "message");
        constexpr std::array<std::string_view, 2> kTypes{"state", "patch"};
        const bool is_patch = read_word(member(message, "type"), "type", kTypes) == 1;
        if (is_patch && !known)
            throw BadJson{error_code::bad_message, "a patch came before the state that it changes"};
        auto document = std::make_shared<StateDocument>();
        document->revision_ = read_integer(member(message, "revision"), "revision", 1, kMaxInteger);
        const Json& sections = read_object(member(message, is_patch ? "patch" : "state"), "state");
        for (std::size_t i = 0; i < section_names().size(); ++i) {
            const std::string& name = section_names()[i];
            if (is_patch && !sections.contains(name)) {
                document->sections_.push_back(known->sections_[i]);
                continue;
            }
            Json json = is_patch ? known->sections_[i]->json : Json();
            if (const Json& change = member(sections, name); is_patch)
                json.merge_patch(change);
            else
                json = change;
            document->sections_.push_back(
                std::make_shared<Section>(Section{name, std::move(json), document->revision_}));
        }
        return document;
    };
    return or_error(read).map_error([](const Error& error) { return error.message; });
}

std::shared_ptr<const StateDocument> StateDocument::for_hosts() const {
    const auto place = [&](const char* name) {
        return std::ranges::find(sections_, name, [](const auto& section) { return section->name; });
    };
    const auto walls = place("walls"), camera = place("camera");
    if (walls == sections_.end() || camera == sections_.end() || (*walls)->json.is_null()) return nullptr;
    Json json = (*walls)->json;
    json.erase("behindDegrees");
    json.erase("behindMetres");
    auto document = std::make_shared<StateDocument>();
    document->revision_ = revision_;
    document->sections_ = sections_;
    document->sections_[static_cast<std::size_t>(camera - sections_.begin())] =
        std::make_shared<Section>(Section{"camera", std::move(json), revision_});
    return document;
}

const Json& StateDocument::section(std::string_view name) const {
    static const Json none;
    const auto found = std::ranges::find(sections_, name,
                                         [](const auto& section) { return std::string_view(section->name); });
    return found == sections_.end() ? none : (*found)->json;
}

std::optional<std::string> StateDocument::holder() const {
    const Json& control = section("control");
    const auto holder = control.is_object() ? control.find("holder") : control.end();
    return holder != control.end() && holder->is_string() ? std::optional(holder->get<std::string>())
                                                          : std::nullopt;
}

bool StateDocument::has_scene_of(const StateDocument& other) const {
    const Json &own = section("scene"), &others = other.section("scene");
    return &own == &others || own == others;
}

Json StateDocument::json() const {
    Json state = Json::object();
    for (const auto& section : sections_)
        if (!section->json.is_null()) state[section->name] = section->json;
    return state;
}

std::shared_ptr<const Json> document_of(const State& state) {
    return std::make_shared<const Json>(StateDocument::next({}, state)->json());
}

std::string StateDocument::encode() const {
    return dump({{"type", "state"}, {"revision", revision_}, {"state", json()}});
}

std::string StateDocument::encode_patch_from(const StateDocument& earlier, const std::string& by) const {
    Json patch = Json::object();
    for (std::size_t i = 0; i < sections_.size(); ++i) {
        if (sections_[i] == earlier.sections_[i]) continue;
        const Json &from = earlier.sections_[i]->json, &to = sections_[i]->json;
        if (!from.is_object() || !to.is_object()) {
            if (from != to) patch[sections_[i]->name] = to;
        } else if (Json diff = merge_diff(from, to); !diff.empty()) {
            patch[sections_[i]->name] = std::move(diff);
        }
    }
    Json message = {{"type", "patch"}, {"revision", revision_}, {"patch", std::move(patch)}};
    if (!by.empty()) message["by"] = by;
    return dump(message);
}

std::int64_t StateDocument::last_change(const Json& patch) const {
    std::int64_t result = 0;
    for (const auto& section : sections_)
        if (const auto named = patch.find(section->name); named != patch.end())
            result = std::max(result, newest_named(section->changed, *named));
    return result;
}

}  // namespace vrut::protocol
