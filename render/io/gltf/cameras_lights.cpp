#include "io/gltf/cameras_lights.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/srgb.hpp"
#include "io/import_checks.hpp"

namespace vrut::io {

namespace {

constexpr const char* kPunctual = "KHR_lights_punctual";

/// As displayed, of the brightest channel 1: our lights have no intensity.
glm::dvec3 light_color(const GltfJson& json) {
    const glm::dvec3 color = vector_in<3>(json, "color", glm::dvec3(1)) * number_in(json, "intensity", 1);
    const double most = std::max({color.r, color.g, color.b});
    if (!std::isfinite(most)) return glm::dvec3(1);
    return base::srgb_from_linear(most > 0 ? color / most : color);
}

std::optional<scene::LightData::Type> light_type(const std::string& name) {
    if (name == "directional") return scene::LightData::Type::directional;
    if (name == "point") return scene::LightData::Type::point;
    if (name == "spot") return scene::LightData::Type::spot;
    return std::nullopt;
}

/// As the writer of GLB stores it; else 1. Extras may be anything.
double focus_distance_in(const GltfJson& camera) {
    const auto extras = camera.find("extras");
    if (extras == camera.end() || !extras->is_object()) return 1;
    const auto distance = extras->find("focusDistance");
    if (distance == extras->end() || !distance->is_number()) return 1;
    const double number = distance->get<double>();
    return number > 0 && number < 1e30 ? number : 1;
}

}  // namespace

std::optional<scene::Node> read_gltf_camera(const GltfJson& document, const GltfJson& node,
                                            ConversionWarnings& warnings) {
    const auto index = index_in(node, "camera");
    if (!index) return std::nullopt;
    const GltfJson& cameras = array_in(document, "cameras");
    if (*index >= cameras.size()) throw ImportError("there is no camera " + std::to_string(*index));
    const GltfJson& json = cameras[*index];
    if (string_in(json, "type") == "orthographic") {
        warnings.add("an orthographic camera is ignored: only perspective cameras are supported");
        return std::nullopt;
    }
    const double yfov = number_in(object_in(json, "perspective"), "yfov", std::numbers::pi / 2);
    if (!(yfov > 0 && yfov < std::numbers::pi)) {
        warnings.add("a camera is ignored: its field of view is not between 0 and 180 degrees");
        return std::nullopt;
    }
    scene::Node camera;
    camera.name = "camera";
    camera.type = scene::NodeType::camera;
    auto& data = camera.data.emplace<scene::CameraData>();
    data.fov = std::clamp(glm::degrees(yfov), 1.0, 170.0);
    data.focus.z = -focus_distance_in(json);
    return camera;
}

std::optional<scene::Node> read_gltf_light(const GltfJson& document, const GltfJson& node,
                                           ConversionWarnings& warnings) {
    const auto index = index_in(extension_in(node, kPunctual), "light");
    if (!index) return std::nullopt;
    const GltfJson& lights = array_in(extension_in(document, kPunctual), "lights");
    if (*index >= lights.size()) throw ImportError("there is no light " + std::to_string(*index));
    const GltfJson& json = lights[*index];
    const auto type = light_type(string_in(json, "type"));
    if (!type) {
        warnings.add("a light is ignored: only point, directional and spot lights are supported");
        return std::nullopt;
    }
    warnings.add("a light's intensity and range are ignored: it does not attenuate with distance");
    scene::Node made;
    made.name = "light";
    made.type = scene::NodeType::light;
    scene::LightData& light = made.data.emplace<scene::LightData>();
    light.type = *type;
    light.color = glm::dvec4(light_color(json), 1);
    if (light.type == scene::LightData::Type::spot) {
        const double half = number_in(object_in(json, "spot"), "outerConeAngle", std::numbers::pi / 4);
        light.angle = std::clamp(glm::degrees(2 * half), 0.0, 180.0);
    }
    return made;
}

}  // namespace vrut::io
