#include "io/gltf/instances.hpp"

#include <glm/gtc/quaternion.hpp>

#include "io/gltf/accessor.hpp"
#include "io/import_checks.hpp"

namespace vrut::io {

namespace {

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

/// Takes the values of an attribute, of as many components as they have; leaves them where there is none.
template <glm::length_t N>
void read_values(const GltfJson& document, const GltfJson& attributes, const char* name, GltfBuffers& buffers,
                 std::vector<glm::vec<N, double>>& values) {
    const auto accessor = index_in(attributes, name);
    if (!accessor) return;
    const GltfArray array = read_accessor(document, buffers, *accessor);
    if (array.components != N || array.count != values.size())
        throw ImportError(
            "the attributes of an EXT_mesh_gpu_instancing object differ in count, or are of a wrong type");
    std::size_t i = 0;
    for_each_vector<N>(array, [&](const glm::vec<N, float>& value) { values[i++] = value; });
}

/// Of the first attribute that there is.
std::size_t count_instances(const GltfJson& document, const GltfJson& attributes) {
    for (const char* name : {"TRANSLATION", "ROTATION", "SCALE"})
        if (const auto accessor = index_in(attributes, name))
            return describe_accessor(document, *accessor).count;
    return 0;
}

}  // namespace

glm::dmat4 matrix_of(const glm::dvec3& translation, const glm::dvec4& rotation, const glm::dvec3& scale) {
    glm::dmat4 matrix(glm::mat3_cast(glm::dquat(rotation.w, rotation.x, rotation.y, rotation.z)));
    for (int i = 0; i < 3; ++i) matrix[i] *= scale[i];
    matrix[3] = glm::dvec4(translation, 1);
    return matrix;
}

std::optional<std::vector<glm::dmat4>> read_gltf_instances(const GltfJson& document, const GltfJson& node,
                                                           GltfBuffers& buffers) {
    if (!node.contains("mesh") || extension_in(node, kInstancing).empty()) return std::nullopt;
    const GltfJson& attributes = object_in(extension_in(node, kInstancing), "attributes");
    const std::size_t count = count_instances(document, attributes);
    buffers.charge(count * (sizeof(glm::dmat4) + 10 * sizeof(double)));
    std::vector<glm::dvec3> translations(count, glm::dvec3(0)), scales(count, glm::dvec3(1));
    std::vector<glm::dvec4> rotations(count, glm::dvec4(0, 0, 0, 1));
    read_values<3>(document, attributes, "TRANSLATION", buffers, translations);
    read_values<4>(document, attributes, "ROTATION", buffers, rotations);
    read_values<3>(document, attributes, "SCALE", buffers, scales);
    std::vector<glm::dmat4> matrices;
    matrices.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dmat4& matrix = matrices.emplace_back(matrix_of(translations[i], rotations[i], scales[i]));
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row)
                if (!is_coordinate(matrix[column][row]))
                    throw ImportError(
                        "the matrix of an instance has an element that is not a number from -1e15 to 1e15");
    }
    return matrices;
}

}  // namespace vrut::io
