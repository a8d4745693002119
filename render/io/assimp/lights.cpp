#include "io/assimp/lights.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace vrut::io {

namespace {

glm::dvec3 vector_of(const aiVector3D& from) { return {from.x, from.y, from.z}; }

/// The vertical field of view in degrees; not finite if the file's is not.
double field_of_view(const aiCamera& from) {
    const double aspect = from.mAspect > 0 ? from.mAspect : 1;
    return glm::degrees(2 * std::atan(std::tan(double{from.mHorizontalFOV} / 2) / aspect));
}

/// Of Collada, assimp 5.2 reads only cameras with names, and angles only with enough beside them; of the
/// others it makes this, its default taken for degrees.
bool is_unread(const aiCamera& from, AssimpFormat format) {
    return format == AssimpFormat::collada && std::abs(from.mHorizontalFOV - 0.013708F) < 1e-5F;
}

glm::dvec3 color_of(const aiLight& from) {
    const aiColor3D& color = from.mColorDiffuse;  // times the strength
    const float most = std::max({color.r, color.g, color.b});
    if (!std::isfinite(most)) return glm::dvec3(1);
    return glm::clamp(glm::dvec3(color.r, color.g, color.b) / std::max(1.0, double{most}), 0.0, 1.0);
}

/// The full cone, in degrees.
double cone_of(const aiLight& from, AssimpFormat format) {
    const double angle =
        format == AssimpFormat::collada ? double{from.mAngleInnerCone} : double{from.mAngleOuterCone};
    return std::isfinite(angle) ? std::clamp(glm::degrees(angle), 0.0, 180.0) : 90;
}

/// Only of Collada are these the file's, in its words.
glm::dvec3 attenuation_of(const aiLight& from, AssimpFormat format, ConversionWarnings& warnings) {
    const glm::dvec3 file(from.mAttenuationConstant, from.mAttenuationLinear, from.mAttenuationQuadratic);
    const auto is_usable = [](double part) { return part >= 0 && part <= 1e15; };
    if (format == AssimpFormat::collada && is_usable(file.x) && is_usable(file.y) && is_usable(file.z))
        return file;
    warnings.add("a light's intensity and range are ignored: it does not attenuate with distance");
    return {1, 0, 0};
}

/// Turns the direction in which our lights shine, -z, into another.
glm::dmat4 turn_to(const glm::dvec3& direction) {
    const double length = glm::length(direction);
    if (!(length > 0) || !std::isfinite(length)) return glm::dmat4(1);
    const glm::dvec3 back = -direction / length;
    if (back == glm::dvec3(0, 0, 1)) return glm::dmat4(1);
    const glm::dvec3 other = std::abs(back.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
    const glm::dvec3 right = glm::normalize(glm::cross(other, back));
    return glm::dmat4(glm::dmat3(right, glm::cross(back, right), back));
}

}  // namespace

std::optional<scene::Node> convert_camera(const aiCamera& from, AssimpFormat format,
                                          ConversionWarnings& warnings) {
    if (from.mHorizontalFOV <= 0) {
        warnings.add("an orthographic camera is ignored: only perspective cameras are supported");
        return std::nullopt;
    }
    const double fov = field_of_view(from);
    if (!std::isfinite(fov)) {
        warnings.add("a camera is ignored: its field of view is not finite");
        return std::nullopt;
    }
    scene::Node node;
    node.name = "camera";
    node.type = scene::NodeType::camera;
    scene::CameraData& camera = node.data.emplace<scene::CameraData>();
    if (is_unread(from, format))
        warnings.add("a camera's field of view is unknown: 40 degrees are used");
    else
        camera.fov = std::clamp(fov, 1.0, 170.0);
    // At the node's origin: into its position assimp 5.2 puts the node's own a second time.
    camera.focus = vector_of(from.mLookAt);
    camera.up = vector_of(from.mUp);
    return node;
}

void look_at_targets(scene::SceneParts& parts) {
    std::vector<glm::dmat4> world;  // of node i, whose id is i + 1
    std::map<std::string, glm::dvec3> places;
    for (const auto& part : parts.nodes) {
        const bool below = part.parent_id > 0;
        const glm::dmat4 parent = below ? world[static_cast<std::size_t>(part.parent_id - 1)] : glm::dmat4(1);
        world.push_back(parent * part.node.matrix);
        places.emplace(part.node.name, world.back()[3]);
    }
    for (std::size_t i = 0; i < parts.nodes.size(); ++i) {
        auto& [node, parent_id, line] = parts.nodes[i];
        auto* camera = std::get_if<scene::CameraData>(&node.data);
        if (!camera) continue;
        auto target = places.find(node.name + ".Target");
        if (target == places.end() && parent_id > 0)
            target = places.find(parts.nodes[static_cast<std::size_t>(parent_id - 1)].node.name + ".Target");
        if (target == places.end()) continue;
        const glm::dvec3 focus(glm::inverse(world[i]) * glm::dvec4(target->second, 1));
        if (glm::dot(focus, focus) > 0 && glm::dot(focus, focus) < 1e30) camera->focus = focus;
    }
}

std::optional<scene::Node> convert_light(const aiLight& from, AssimpFormat format,
                                         ConversionWarnings& warnings) {
    scene::Node node;
    node.name = "light";
    node.type = scene::NodeType::light;
    scene::LightData& light = node.data.emplace<scene::LightData>();
    switch (from.mType) {
        case aiLightSource_DIRECTIONAL:
            light.type = scene::LightData::Type::directional;
            break;
        case aiLightSource_SPOT:
            light.type = scene::LightData::Type::spot;
            break;
        case aiLightSource_POINT:
            break;
        default:
            warnings.add(
                "an area or ambient light is ignored: only point, directional and spot lights are supported");
            return std::nullopt;
    }
    light.color = glm::dvec4(color_of(from), 1);
    light.attenuation = attenuation_of(from, format, warnings);
    if (light.type == scene::LightData::Type::spot) light.angle = cone_of(from, format);
    if (light.type != scene::LightData::Type::point) node.matrix = turn_to(vector_of(from.mDirection));
    return node;
}

}  // namespace vrut::io
