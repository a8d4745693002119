#include "io/assimp/polygons.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "mesh/triangulation.hpp"

namespace vrut::io {

namespace {

bool is_large(const aiFace& face) { return face.mNumIndices > 50; }

/// Returns the end of what is written to `to`.
aiFace* write_triangles(const aiFace& face, const aiVector3D* vertices, aiFace* to) {
    std::vector<glm::dvec3> corners;
    corners.reserve(face.mNumIndices);
    for (const unsigned* i = face.mIndices; i != face.mIndices + face.mNumIndices; ++i)
        corners.emplace_back(vertices[*i].x, vertices[*i].y, vertices[*i].z);
    for (const glm::uvec3& t : mesh::triangulate(corners)) {
        to->mNumIndices = 3;
        to->mIndices = new unsigned[3]{face.mIndices[t.x], face.mIndices[t.y], face.mIndices[t.z]};
        ++to;
    }
    return to;
}

}  // namespace

void triangulate_large_polygons(aiMesh& mesh) {
    aiFace* const end = mesh.mFaces + mesh.mNumFaces;
    std::size_t count = mesh.mNumFaces;
    for (const aiFace* face = mesh.mFaces; face != end; ++face)
        if (is_large(*face)) count += face->mNumIndices - 3;
    if (count == mesh.mNumFaces) return;
    auto faces = std::make_unique<aiFace[]>(count);
    aiFace* to = faces.get();
    for (aiFace* face = mesh.mFaces; face != end; ++face) {
        if (is_large(*face)) {
            to = write_triangles(*face, mesh.mVertices, to);
            continue;
        }
        std::swap(to->mNumIndices, face->mNumIndices);
        std::swap(to->mIndices, face->mIndices);
        ++to;
    }
    delete[] std::exchange(mesh.mFaces, faces.release());
    mesh.mNumFaces = static_cast<unsigned>(count);
    mesh.mPrimitiveTypes |= aiPrimitiveType_TRIANGLE;
    const bool polygons = std::any_of(mesh.mFaces, mesh.mFaces + count,
                                      [](const aiFace& face) { return face.mNumIndices > 3; });
    if (!polygons) mesh.mPrimitiveTypes &= ~unsigned{aiPrimitiveType_POLYGON};  // assimp insists on it
}

}  // namespace vrut::io
