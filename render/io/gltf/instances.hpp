#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "io/gltf/buffers.hpp"

namespace vrut::io {

/// Returns the matrix (node from instance) of each instance of a node's mesh (EXT_mesh_gpu_instancing), or
/// none where the node has no such instances. Throws ImportError.
std::optional<std::vector<glm::dmat4>> read_gltf_instances(const GltfJson& document, const GltfJson& node,
                                                           GltfBuffers& buffers);

/// The matrix that scales, turns by a quaternion (x, y, z, w), and shifts.
glm::dmat4 matrix_of(const glm::dvec3& translation, const glm::dvec4& rotation, const glm::dvec3& scale);

}  // namespace vrut::io
