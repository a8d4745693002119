#pragma once

#include <assimp/mesh.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "io/assimp/format.hpp"
#include "io/conversion_warnings.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// Why the file's scene is none, without the file's name.
struct ImportError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// As for scene text: beyond this, coordinates would leave the range of float when squared on the GPU. No
/// NaN.
inline bool is_coordinate(float value) { return std::abs(value) <= 1e15F; }

/// Throws Refused where a face has no corners or names a vertex that there is not: assimp would crash on
/// them.
void check_faces(const aiMesh& mesh);

/// The mesh's triangles, by the rules that assimp_scene.hpp tells; frees what it has taken over. The mesh is
/// checked. Throws Refused.
scene::Geometry convert_geometry(aiMesh& mesh, AssimpFormat format);

void report_unsupported_parts(const aiMesh& mesh, ConversionWarnings& warnings);

}  // namespace vrut::io
