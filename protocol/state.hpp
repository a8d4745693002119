#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "messages.hpp"

namespace vrut::protocol {

// --- the state document's members, as values. Those marked r are read-only to clients.

struct SceneState {  // r
    std::string name;
    std::uint64_t nodes = 0, materials = 0, geometries = 0, triangles = 0;
    glm::dvec3 min{0}, max{0};
    std::vector<std::string> notices;
    bool operator==(const SceneState&) const = default;
};

struct CameraState {
    glm::dvec3 eye{0, 0, 5}, focus{0}, up{0, 1, 0}, center{0};
    double fov = 40;
    double near = 0.1, far = 100;  // r
    bool operator==(const CameraState&) const = default;
};

struct NavigationState {
    bool keep_upright = true;
    double rotate_speed = 1, pan_speed = 1, zoom_speed = 1;
    bool operator==(const NavigationState&) const = default;
};

struct LightState {
    std::string name, type;  // r
    glm::dvec4 color{1, 1, 1, 1};
    glm::dvec3 attenuation{1, 0, 0};
    bool operator==(const LightState&) const = default;
};

struct LightsState {
    std::string active = "headlight";
    std::map<std::string, LightState> items;
    bool operator==(const LightsState&) const = default;
};

struct BackgroundState {
    std::string name;  // r
    glm::dvec4 color{0, 0, 0, 1};
    bool operator==(const BackgroundState&) const = default;
};

struct BackgroundsState {
    std::string active = "color";  ///< an item's id, or "color" for the plain one
    glm::dvec4 color{230.0 / 255, 235.0 / 255, 242.0 / 255, 1};
    std::map<std::string, BackgroundState> items;
    bool operator==(const BackgroundsState&) const = default;
};

struct SelectionState {
    std::optional<std::int64_t> node;
    std::string name;               // r
    std::vector<std::string> path;  // r: names from the root, the last 32
    bool operator==(const SelectionState&) const = default;
};

struct ControlState {  // r
    std::optional<std::string> holder;
    bool kept = false;
    bool operator==(const ControlState&) const = default;
};

/// What all clients share.
struct State {
    SceneState scene;
    CameraState camera;
    NavigationState navigation;
    LightsState lights;
    BackgroundsState backgrounds;
    SelectionState selection;
    ControlState control;
    bool operator==(const State&) const = default;
};

/// `state` after a merge patch (RFC 7396) of its members, or what is wrong with it: all or nothing. null
/// gives a member back the value it has in `starting`. Checks types, ranges and names, not whether a camera's
/// pose makes sense.
tl::expected<State, Error> patched(const State& state, const State& starting, const nlohmann::json& patch);

/// Whether the patch names `camera.up`.
bool names_camera_up(const nlohmann::json& patch);
/// A camera from the text of a JSON object with members of the state's `camera`; what is left out is as in
/// `base`, read-only and unknown members are ignored.
tl::expected<CameraState, Error> parse_camera(std::string_view text, const CameraState& base);
/// patched() from text.
tl::expected<State, Error> patched_by_text(const State& state, const State& starting, std::string_view text);

/// One revision of the state as JSON, to be shared between threads. Sections that did not change are the same
/// objects in both documents, which makes making and comparing documents cheap.
class StateDocument {
public:
    StateDocument() = default;
    /// The document after `previous`, one revision later; the same object contents where nothing changed.
    static std::shared_ptr<const StateDocument> next(const StateDocument& previous, const State& state);

    std::int64_t revision() const { return revision_; }
    bool shows(const State& state) const { return state_ == state; }
    /// The `state` message.
    std::string encode() const;
    /// The `patch` message that leads from an earlier document to this one; `by` may be empty.
    std::string encode_patch_from(const StateDocument& earlier, const std::string& by) const;
    /// Revision of the last change to anything that `patch` names.
    std::int64_t last_change(const nlohmann::json& patch) const;

private:
    struct Section;
    std::int64_t revision_ = 0;
    State state_;
    std::vector<std::shared_ptr<const Section>> sections_;
};

}  // namespace vrut::protocol
