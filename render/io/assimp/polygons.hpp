#pragma once

#include <assimp/mesh.h>

namespace vrut::io {

/// Makes triangles of a mesh's faces that are strips: each index with the two before it, every second one the
/// other way round. An index of -1 ends a strip and begins another.
void triangulate_strips(aiMesh& mesh);

/// Makes triangles of a mesh's faces with many corners, since assimp 5.2 takes time by the square of their
/// number. The mesh must have passed check_faces().
void triangulate_large_polygons(aiMesh& mesh);

}  // namespace vrut::io
