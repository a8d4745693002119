#include "state.hpp"

#include <functional>

#include "json_reader.hpp"
#include "state_json.hpp"

namespace vrut::protocol {

// --- values to JSON

Json section_json(const SceneState& scene) {
    return {{"name", scene.name},
            {"nodes", scene.nodes},
            {"materials", scene.materials},
            {"geometries", scene.geometries},
            {"triangles", scene.triangles},
            {"bounds", {{"min", to_json(scene.min)}, {"max", to_json(scene.max)}}},
            {"notices", scene.notices}};
}

Json section_json(const CameraState& camera) {
    return {{"eye", to_json(camera.eye)}, {"focus", to_json(camera.focus)},
            {"up", to_json(camera.up)},   {"center", to_json(camera.center)},
            {"fov", camera.fov},          {"near", camera.near},
            {"far", camera.far}};
}

namespace {

Json section_json(const NavigationState& navigation) {
    return {{"keepUpright", navigation.keep_upright},
            {"rotateSpeed", navigation.rotate_speed},
            {"panSpeed", navigation.pan_speed},
            {"zoomSpeed", navigation.zoom_speed}};
}

Json section_json(const LightsState& lights) {
    Json items = Json::object();
    for (const auto& [id, light] : lights.items)
        items[id] = {{"name", light.name},
                     {"type", light.type},
                     {"color", to_json(light.color)},
                     {"attenuation", to_json(light.attenuation)}};
    return {{"active", lights.active}, {"items", std::move(items)}};
}

Json section_json(const BackgroundsState& backgrounds) {
    Json items = Json::object();
    for (const auto& [id, background] : backgrounds.items)
        items[id] = {{"name", background.name}, {"color", to_json(background.color)}};
    return {
        {"active", backgrounds.active}, {"color", to_json(backgrounds.color)}, {"items", std::move(items)}};
}

Json section_json(const SelectionState& selection) {
    if (!selection.node) return Json::object();
    return {{"node", *selection.node}, {"name", selection.name}, {"path", selection.path}};
}

Json section_json(const ControlState& control) {
    Json json = {{"kept", control.kept}};
    if (control.holder) json["holder"] = *control.holder;
    return json;
}

// --- merge patches to values

struct Member {
    const char* name;
    /// Takes the new value, or null for the starting value; none: the member is read-only.
    std::function<void(const Json& value, const std::string& path)> set;
};

void patch_members(const Json& patch, const std::string& path, std::initializer_list<Member> members) {
    for (const auto& [name, value] : read_object(patch, path.empty() ? "patch" : path).items()) {
        const std::string member_path = path.empty() ? name : path + "." + name;
        const Member* found = nullptr;
        for (const Member& member : members)
            if (name == member.name) found = &member;
        if (!found)
            throw BadJson{error_code::unknown_member,
                          "the state has no member '" + excerpt(member_path) + "'"};
        if (!found->set) throw BadJson{error_code::read_only, "'" + member_path + "' is read-only"};
        found->set(value, member_path);
    }
}

/// A member that is one value: null gives back `start`, anything else goes through `read`.
template <class Value, class Read>
std::function<void(const Json&, const std::string&)> leaf(Value& target, const Value& start, Read read) {
    return [&target, &start, read](const Json& value, const std::string& path) {
        target = value.is_null() ? start : read(value, path);
    };
}

constexpr double kHuge = 1e30;  // products of two coordinates stay finite

glm::dvec3 read_position(const Json& value, const std::string& path) {
    return read_vec3(value, path, -kHuge, kHuge);
}
glm::dvec4 read_color(const Json& value, const std::string& path) { return read_vec4(value, path, 0, 1); }
glm::dvec3 read_attenuation(const Json& value, const std::string& path) {
    return read_vec3(value, path, 0, kHuge);
}
double read_fov(const Json& value, const std::string& path) { return read_number(value, path, 1, 170); }
double read_speed(const Json& value, const std::string& path) { return read_number(value, path, 0.01, 100); }
bool read_flag(const Json& value, const std::string& path) { return read_bool(value, path); }

/// A section that holds members: null resets all of it.
template <class Section, class Patch>
std::function<void(const Json&, const std::string&)> section(Section& target, const Section& start,
                                                             Patch patch) {
    return [&target, &start, patch](const Json& value, const std::string& path) {
        if (value.is_null())
            target = start;
        else
            patch(target, start, value, path);
    };
}

void patch_camera(CameraState& camera, const CameraState& start, const Json& patch, const std::string& path) {
    patch_members(patch, path,
                  {{"eye", leaf(camera.eye, start.eye, read_position)},
                   {"focus", leaf(camera.focus, start.focus, read_position)},
                   {"up", leaf(camera.up, start.up, read_position)},
                   {"center", leaf(camera.center, start.center, read_position)},
                   {"fov", leaf(camera.fov, start.fov, read_fov)},
                   {"near", {}},
                   {"far", {}}});
}

void patch_navigation(NavigationState& navigation, const NavigationState& start, const Json& patch,
                      const std::string& path) {
    patch_members(patch, path,
                  {{"keepUpright", leaf(navigation.keep_upright, start.keep_upright, read_flag)},
                   {"rotateSpeed", leaf(navigation.rotate_speed, start.rotate_speed, read_speed)},
                   {"panSpeed", leaf(navigation.pan_speed, start.pan_speed, read_speed)},
                   {"zoomSpeed", leaf(navigation.zoom_speed, start.zoom_speed, read_speed)}});
}

void patch_light(LightState& light, const LightState& start, const Json& patch, const std::string& path) {
    patch_members(patch, path,
                  {{"name", {}},
                   {"type", {}},
                   {"color", leaf(light.color, start.color, read_color)},
                   {"attenuation", leaf(light.attenuation, start.attenuation, read_attenuation)}});
}

void patch_background(BackgroundState& background, const BackgroundState& start, const Json& patch,
                      const std::string& path) {
    patch_members(patch, path, {{"name", {}}, {"color", leaf(background.color, start.color, read_color)}});
}

/// Items are those of the scene: they are neither added nor removed, and null resets one.
template <class Item, class PatchItem>
void patch_items(std::map<std::string, Item>& items, const std::map<std::string, Item>& start,
                 const Json& patch, const std::string& path, PatchItem patch_item) {
    for (const auto& [id, value] : read_object(patch, path).items()) {
        const auto item = items.find(id);
        if (item == items.end())
            throw BadJson{error_code::unknown_node, "there is no '" + excerpt(id) + "' in '" + path + "'"};
        section(item->second, start.at(id), patch_item)(value, path + "." + id);
    }
}

template <class Item>
std::string read_key(const Json& value, const std::string& path, const std::map<std::string, Item>& items,
                     const char* other) {
    std::string key = read_string(value, path, kMaxMessageBytes);
    if (key != other && !items.contains(key))
        throw BadJson{error_code::unknown_node, "'" + path + "': there is no '" + excerpt(key) + "'"};
    return key;
}

void patch_lights(LightsState& lights, const LightsState& start, const Json& patch, const std::string& path) {
    patch_members(patch, path,
                  {{"active", leaf(lights.active, start.active,
                                   [&](const Json& value, const std::string& at) {
                                       return read_key(value, at, lights.items, "headlight");
                                   })},
                   {"items", section(lights.items, start.items,
                                     [](auto& items, const auto& from, const Json& value, const auto& at) {
                                         patch_items(items, from, value, at, patch_light);
                                     })}});
}

void patch_backgrounds(BackgroundsState& backgrounds, const BackgroundsState& start, const Json& patch,
                       const std::string& path) {
    patch_members(patch, path,
                  {{"active", leaf(backgrounds.active, start.active,
                                   [&](const Json& value, const std::string& at) {
                                       return read_key(value, at, backgrounds.items, "color");
                                   })},
                   {"color", leaf(backgrounds.color, start.color, read_color)},
                   {"items", section(backgrounds.items, start.items,
                                     [](auto& items, const auto& from, const Json& value, const auto& at) {
                                         patch_items(items, from, value, at, patch_background);
                                     })}});
}

void patch_selection(SelectionState& selection, const SelectionState& start, const Json& patch,
                     const std::string& path) {
    patch_members(patch, path,
                  {{"node", leaf(selection.node, start.node,
                                 [](const Json& value, const std::string& at) {
                                     return std::optional(read_integer(value, at, 0, kMaxInteger));
                                 })},
                   {"name", {}},
                   {"path", {}}});
}

State patched_or_throw(const State& state, const State& starting, const Json& patch) {
    State result = state;
    patch_members(patch, "",
                  {{"scene", {}},
                   {"camera", section(result.camera, starting.camera, patch_camera)},
                   {"navigation", section(result.navigation, starting.navigation, patch_navigation)},
                   {"lights", section(result.lights, starting.lights, patch_lights)},
                   {"backgrounds", section(result.backgrounds, starting.backgrounds, patch_backgrounds)},
                   {"selection", section(result.selection, starting.selection, patch_selection)},
                   {"control", {}}});
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
    try {
        return patched_or_throw(state, starting, patch);
    } catch (const BadJson& bad) {
        return tl::unexpected(Error{{}, bad.code, bad.message});
    }
}

tl::expected<State, Error> patched_by_text(const State& state, const State& starting, std::string_view text) {
    try {
        return patched_or_throw(state, starting, parse_strictly(text));
    } catch (const BadJson& bad) {
        return tl::unexpected(Error{{}, bad.code, bad.message});
    }
}

tl::expected<CameraState, Error> parse_camera(std::string_view text, const CameraState& base) {
    try {
        Json json = parse_strictly(text);
        Json writable = Json::object();
        for (const char* name : {"eye", "focus", "up", "center", "fov"})
            if (const auto found = read_object(json, "camera").find(name); found != json.end())
                writable[name] = *found;
        CameraState camera = base;
        patch_camera(camera, base, writable, "camera");
        return camera;
    } catch (const BadJson& bad) {
        return tl::unexpected(Error{{}, bad.code, bad.message});
    }
}

bool names_camera_up(const Json& patch) {
    const auto camera = patch.find("camera");
    return camera != patch.end() && (camera->is_null() || camera->contains("up"));
}

// --- the document

struct StateDocument::Section {
    std::string name;
    Json json;
    Json changed;  ///< like `json`, with each leaf the revision that changed it last
};

namespace {

/// `changed` brought up to date for a step from `from` to `to`.
Json mark_changes(const Json& from, const Json& to, const Json& changed, std::int64_t revision) {
    if (!to.is_object()) return from == to && changed.is_number() ? changed : Json(revision);
    Json result = Json::object();
    for (const auto& [name, value] : to.items())
        result[name] = mark_changes(from.is_object() ? from.value(name, Json()) : Json(), value,
                                    changed.is_object() ? changed.value(name, Json()) : Json(), revision);
    // What went leaves its mark, so that a patch that counts on it is found stale.
    if (from.is_object())
        for (const auto& [name, value] : from.items())
            if (!to.contains(name)) result[name] = revision;
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
    return result;
}

}  // namespace

std::shared_ptr<const StateDocument> StateDocument::next(const StateDocument& previous, const State& state) {
    auto document = std::make_shared<StateDocument>(previous);
    document->revision_ = previous.revision_ + 1;
    document->state_ = state;
    const bool first = previous.sections_.empty();
    std::size_t place = 0;
    const auto update = [&](const char* name, const auto& value, const auto& old_value) {
        const std::size_t at = place++;
        if (!first && value == old_value) return;
        auto fresh = std::make_shared<Section>(Section{name, section_json(value), {}});
        fresh->changed = first ? mark_changes({}, fresh->json, {}, document->revision_)
                               : mark_changes(previous.sections_[at]->json, fresh->json,
                                              previous.sections_[at]->changed, document->revision_);
        if (first)
            document->sections_.push_back(std::move(fresh));
        else
            document->sections_[at] = std::move(fresh);
    };
    update("scene", state.scene, previous.state_.scene);
    update("camera", state.camera, previous.state_.camera);
    update("navigation", state.navigation, previous.state_.navigation);
    update("lights", state.lights, previous.state_.lights);
    update("backgrounds", state.backgrounds, previous.state_.backgrounds);
    update("selection", state.selection, previous.state_.selection);
    update("control", state.control, previous.state_.control);
    return document;
}

std::string StateDocument::encode() const {
    Json state = Json::object();
    for (const auto& section : sections_) state[section->name] = section->json;
    return dump({{"type", "state"}, {"revision", revision_}, {"state", std::move(state)}});
}

std::string StateDocument::encode_patch_from(const StateDocument& earlier, const std::string& by) const {
    Json patch = Json::object();
    for (std::size_t i = 0; i < sections_.size(); ++i) {
        if (sections_[i] == earlier.sections_[i]) continue;
        Json diff = merge_diff(earlier.sections_[i]->json, sections_[i]->json);
        if (!diff.empty()) patch[sections_[i]->name] = std::move(diff);
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
