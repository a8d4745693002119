#include "io/assimp/polygons.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "io/import_checks.hpp"
#include "mesh/triangulation.hpp"

namespace vrut::io {

namespace {

constexpr auto kStripEnd = static_cast<unsigned>(-1);

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

/// Calls `add(a, b, c)` for each triangle of a strip.
template <class Add>
void for_each_triangle_of_strip(const aiFace& face, const Add& add) {
    unsigned length = 0;  // of the strip so far
    for (unsigned i = 0; i < face.mNumIndices; ++i) {
        const unsigned* const last = face.mIndices + i;
        length = *last == kStripEnd ? 0 : length + 1;
        if (length < 3 || last[-2] == last[-1] || last[-1] == last[0] || last[-2] == last[0]) continue;
        length % 2 == 1 ? add(last[-2], last[-1], last[0]) : add(last[-1], last[-2], last[0]);
    }
}

}  // namespace

void triangulate_strips(aiMesh& mesh) {
    const std::span strips(mesh.mFaces, mesh.mNumFaces);
    std::size_t count = 0;
    for (const aiFace& strip : strips)
        for_each_triangle_of_strip(strip, [&](unsigned, unsigned, unsigned) { ++count; });
    if (count > std::numeric_limits<unsigned>::max())
        throw ImportError("its strips have more triangles than can be numbered");
    auto faces = std::make_unique<aiFace[]>(count);
    aiFace* to = faces.get();
    for (const aiFace& strip : strips)
        for_each_triangle_of_strip(strip, [&](unsigned a, unsigned b, unsigned c) {
            to->mNumIndices = 3;
            to->mIndices = new unsigned[3]{a, b, c};
            ++to;
        });
    delete[] std::exchange(mesh.mFaces, faces.release());
    mesh.mNumFaces = static_cast<unsigned>(count);
    mesh.mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
}

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
