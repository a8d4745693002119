#pragma once

#include <assimp/mesh.h>

#include "io/assimp/format.hpp"
#include "io/conversion_warnings.hpp"
#include "io/import_checks.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// Throws ImportError for a face without vertices or with a vertex index out of range, on which assimp would
/// crash, and for a vertex without coordinates (is_coordinate()).
void check_faces(const aiMesh& mesh);

/// Converts the triangles of a mesh that passed check_faces(), by the rules in assimp/scene.hpp. Frees the
/// arrays that it has copied. `texcoord_set`: the texture coordinates to take, if the mesh has them, else the
/// first. Throws ImportError.
scene::Geometry convert_geometry(aiMesh& mesh, AssimpFormat format, unsigned texcoord_set,
                                 ConversionWarnings& warnings);

void report_unsupported_parts(const aiMesh& mesh, ConversionWarnings& warnings);

}  // namespace vrut::io
