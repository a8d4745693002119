#include "io/assimp/axes.hpp"

#include <cmath>

namespace vrut::io {

namespace {

/// One of FBX's axes, by the names of its number and its sign.
glm::dvec3 axis_of(const aiMetadata& settings, const char* name, const char* sign_name) {
    std::int32_t axis = -1, sign = 1;
    settings.Get(name, axis);
    settings.Get(sign_name, sign);
    glm::dvec3 direction(0);
    if (axis >= 0 && axis < 3) direction[axis] = sign < 0 ? -1 : 1;
    return direction;
}

}  // namespace

glm::dmat4 upright_from_file(const aiScene& scene, AssimpFormat format, bool z_up,
                             ConversionWarnings& warnings) {
    if (z_up) return {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
    if (format != AssimpFormat::fbx || scene.mMetaData == nullptr) return glm::dmat4(1);
    const glm::dvec3 right = axis_of(*scene.mMetaData, "CoordAxis", "CoordAxisSign");
    const glm::dvec3 up = axis_of(*scene.mMetaData, "UpAxis", "UpAxisSign");
    const glm::dvec3 front = axis_of(*scene.mMetaData, "FrontAxis", "FrontAxisSign");
    const glm::dmat3 upright = glm::transpose(glm::dmat3(right, up, front));
    if (glm::determinant(upright) == 1) return glm::dmat4(upright);
    warnings.add("its axes are not converted: the coordinate system that it declares is not right-handed");
    return glm::dmat4(1);
}

std::optional<double> metres_per_unit(const aiScene& scene, AssimpFormat format) {
    if (format == AssimpFormat::collada) return 1;
    float centimetres = 0;
    if (format != AssimpFormat::fbx || scene.mMetaData == nullptr) return {};
    scene.mMetaData->Get("UnitScaleFactor", centimetres);
    if (!std::isfinite(centimetres) || centimetres <= 0) return {};
    return double{centimetres} / 100;
}

}  // namespace vrut::io
