#include "navigation/keys.hpp"

#include <algorithm>
#include <iterator>

#include "navigation/camera_moves.hpp"

namespace vrut::navigation {

namespace {

using Kind = KeyOperation::Kind;

enum class Shift { up, down, any };

struct KeyRow {
    std::string_view key;  ///< `KeyboardEvent.key`
    Shift shift;
    KeyOperation operation;
};

const KeyRow kKeys[] = {
    {"ArrowLeft", Shift::up, {Kind::rotate, {-5, 0}}},
    {"ArrowRight", Shift::up, {Kind::rotate, {5, 0}}},
    {"ArrowUp", Shift::up, {Kind::rotate, {0, -5}}},
    {"ArrowDown", Shift::up, {Kind::rotate, {0, 5}}},
    {"ArrowLeft", Shift::down, {Kind::pan, {-0.05, 0}}},
    {"ArrowRight", Shift::down, {Kind::pan, {0.05, 0}}},
    {"ArrowUp", Shift::down, {Kind::pan, {0, -0.05}}},
    {"ArrowDown", Shift::down, {Kind::pan, {0, 0.05}}},
    {"+", Shift::any, {Kind::zoom, {1.1, 0}}},  // which on many keyboards is typed with Shift
    {"-", Shift::any, {Kind::zoom, {1 / 1.1, 0}}},
    {"f", Shift::any, {Kind::fit, {}}},
    {"Home", Shift::any, {Kind::home, {}}},
    {"w", Shift::any, {Kind::toggle_wireframe, {}}},
    {"s", Shift::any, {Kind::toggle_stylized, {}}},
    {"Escape", Shift::any, {Kind::escape, {}}},
};

bool repeats(Kind kind) { return kind == Kind::rotate || kind == Kind::pan || kind == Kind::zoom; }

}  // namespace

std::vector<KeyName> key_names() {
    std::vector<KeyName> names;
    for (const KeyRow& row : kKeys)
        if (std::none_of(names.begin(), names.end(),
                         [&](const KeyName& name) { return name.key == row.key; }))
            names.push_back({row.key, repeats(row.operation.kind)});
    for (const char* digit : {"1", "2", "3"}) names.push_back({digit, false});
    return names;
}

std::optional<KeyOperation> key_operation(const KeyInput& input) {
    const auto* row = std::find_if(std::begin(kKeys), std::end(kKeys), [&](const KeyRow& candidate) {
        return candidate.key == input.key &&
               (candidate.shift == Shift::any || (candidate.shift == Shift::down) == input.shift);
    });
    return row == std::end(kKeys) ? std::nullopt : std::optional(row->operation);
}

scene::Camera apply_key_operation(const KeyOperation& operation, const scene::Camera& camera,
                                  const scene::Camera& home, const NavigationContext& context) {
    const glm::dvec2& by = operation.by;
    switch (operation.kind) {
        case Kind::rotate:
            return looks_around(camera, context) ? looked_around(camera, by.x, by.y, context.keep_upright)
                                                 : rotated(camera, by.x, by.y, context.keep_upright);
        case Kind::pan:
            return panned(camera, by.x, by.y);
        case Kind::zoom:
            return zoomed(camera, by.x, context.bounds.radius());
        case Kind::home:
            return home;
        case Kind::fit:
        case Kind::toggle_wireframe:
        case Kind::toggle_stylized:
        case Kind::escape:
            break;
    }
    return camera;
}

}  // namespace vrut::navigation
