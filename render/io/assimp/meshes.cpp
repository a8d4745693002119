#include "io/assimp/meshes.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "io/assimp/text.hpp"
#include "io/vrut/tokenizer.hpp"

namespace vrut::io {

namespace {

std::string called(const aiMesh& mesh) {
    const std::string name = text_of(mesh.mName);
    return name.empty() ? "the mesh" : "mesh '" + excerpt(name) + "'";
}

bool are_coordinates(const aiVector3D& v) {
    return (int{is_coordinate(v.x)} & int{is_coordinate(v.y)} & int{is_coordinate(v.z)}) != 0;
}

void require_coordinates(const aiVector3D* vectors, const char* what, const aiMesh& mesh) {
    int all = 1;  // without an early end, so that several are looked at at once
    for (const aiVector3D* v = vectors; v != vectors + mesh.mNumVertices; ++v)
        all &= int{are_coordinates(*v)};
    if (all == 0)
        throw ImportError("a " + std::string(what) + " of " + called(mesh) +
                          " is not a number from -1e15 to 1e15");
}

float displayed(float value) { return std::isfinite(value) ? std::clamp(value, 0.0F, 1.0F) : 0.0F; }

/// Frees one of a mesh's arrays as soon as it is copied: both together may be large.
template <class T>
void release(T*& array) {
    delete[] array;
    array = nullptr;
}

void move_vertices(aiMesh& mesh, scene::Geometry& geometry) {
    geometry.positions.reserve(mesh.mNumVertices);
    for (const aiVector3D* v = mesh.mVertices; v != mesh.mVertices + mesh.mNumVertices; ++v)
        geometry.bounds.add(geometry.positions.emplace_back(v->x, v->y, v->z));
    release(mesh.mVertices);
}

/// A normal that vanishes is drawn as the face's.
void move_normals(aiMesh& mesh, scene::Geometry& geometry, ConversionWarnings& warnings) {
    if (!mesh.HasNormals()) return;
    geometry.normals.reserve(mesh.mNumVertices);
    std::size_t unusable = 0;
    for (const aiVector3D* v = mesh.mNormals; v != mesh.mNormals + mesh.mNumVertices; ++v) {
        const bool usable = are_coordinates(*v);
        geometry.normals.emplace_back(usable ? glm::vec3(v->x, v->y, v->z) : glm::vec3(0));
        unusable += usable ? 0 : 1;
    }
    warnings.add("a normal that is not a number is replaced by the face's", unusable);
    release(mesh.mNormals);
}

/// assimp has turned v upwards already, as we have it.
void move_texcoords(aiMesh& mesh, unsigned set, scene::Geometry& geometry) {
    aiVector3D*& from = mesh.mTextureCoords[mesh.HasTextureCoords(set) ? set : 0];
    if (from == nullptr) return;
    require_coordinates(from, "texture coordinate", mesh);
    geometry.texcoords.reserve(mesh.mNumVertices);
    for (const aiVector3D* v = from; v != from + mesh.mNumVertices; ++v)
        geometry.texcoords.emplace_back(v->x, v->y);
    release(from);
}

/// Colours as displayed. A file may give them more than it can show.
void move_colors(aiMesh& mesh, scene::Geometry& geometry, ConversionWarnings& warnings) {
    aiColor4D*& from = mesh.mColors[0];
    if (from == nullptr) return;
    geometry.colors.reserve(mesh.mNumVertices);
    bool opaque = true;
    for (const aiColor4D* color = from; color != from + mesh.mNumVertices; ++color) {
        geometry.colors.emplace_back(displayed(color->r), displayed(color->g), displayed(color->b));
        opaque = opaque && !(color->a < 1);
    }
    if (!opaque) warnings.add("the opacity of vertex colours is ignored");
    release(from);
}

void move_triangles(aiMesh& mesh, scene::Geometry& geometry) {
    geometry.triangles.reserve(mesh.mNumFaces);
    unsigned last = 0;
    for (const aiFace* face = mesh.mFaces; face != mesh.mFaces + mesh.mNumFaces; ++face) {
        if (face->mNumIndices != 3) continue;
        const unsigned* i = face->mIndices;
        geometry.triangles.emplace_back(i[0], i[1], i[2]);
        last = std::max({last, i[0], i[1], i[2]});
    }
    if (mesh.mNumFaces > 0 && last >= mesh.mNumVertices)
        throw ImportError(called(mesh) + " has a vertex index out of range");
    release(mesh.mFaces);
    mesh.mNumFaces = 0;
}

template <class T>
void add_stream(const std::vector<T>& values, std::vector<meshopt_Stream>& streams) {
    if (!values.empty()) streams.push_back({values.data(), sizeof(T), sizeof(T)});
}

template <class T>
void remap(std::vector<T>& values, const std::vector<unsigned>& numbers, std::size_t count) {
    if (values.empty()) return;
    std::vector<T> kept(count);
    meshopt_remapVertexBuffer(kept.data(), values.data(), values.size(), sizeof(T), numbers.data());
    values = std::move(kept);
}

/// Makes one of vertices that are equal in everything: most readers of assimp give each corner its own.
void weld(scene::Geometry& geometry) {
    std::vector<meshopt_Stream> streams;
    add_stream(geometry.positions, streams);
    add_stream(geometry.normals, streams);
    add_stream(geometry.texcoords, streams);
    add_stream(geometry.colors, streams);
    std::vector<unsigned> numbers(geometry.positions.size());
    unsigned* const indices = &geometry.triangles[0].x;
    const std::size_t corners = 3 * geometry.triangles.size();
    const std::size_t count = meshopt_generateVertexRemapMulti(
        numbers.data(), indices, corners, numbers.size(), streams.data(), streams.size());
    if (count == numbers.size()) return;
    meshopt_remapIndexBuffer(indices, indices, corners, numbers.data());
    remap(geometry.positions, numbers, count);
    remap(geometry.normals, numbers, count);
    remap(geometry.texcoords, numbers, count);
    remap(geometry.colors, numbers, count);
    geometry.bounds = {};  // a vertex that no triangle has is gone
    for (const glm::dvec3& position : geometry.positions) geometry.bounds.add(position);
}

}  // namespace

void check_faces(const aiMesh& mesh) {
    if (!mesh.HasPositions() && mesh.mNumFaces > 0) throw ImportError(called(mesh) + " has no vertices");
    require_coordinates(mesh.mVertices, "vertex", mesh);
    for (const aiFace* face = mesh.mFaces; face != mesh.mFaces + mesh.mNumFaces; ++face) {
        if (face->mNumIndices == 0) throw ImportError(called(mesh) + " has a face without vertices");
        for (unsigned i = 0; i < face->mNumIndices; ++i)
            if (face->mIndices[i] >= mesh.mNumVertices)
                throw ImportError(called(mesh) + " has a vertex index out of range");
    }
}

scene::Geometry convert_geometry(aiMesh& mesh, AssimpFormat format, unsigned texcoord_set,
                                 ConversionWarnings& warnings) {
    scene::Geometry geometry;
    move_triangles(mesh, geometry);
    move_vertices(mesh, geometry);
    if (format != AssimpFormat::stl)
        move_normals(mesh, geometry, warnings);  // there each triangle has its own
    move_texcoords(mesh, texcoord_set, geometry);
    move_colors(mesh, geometry, warnings);
    if (!geometry.triangles.empty()) weld(geometry);
    return geometry;
}

void report_unsupported_parts(const aiMesh& mesh, ConversionWarnings& warnings) {
    if (mesh.HasBones()) warnings.add("a skin is ignored: its mesh is shown undeformed");
    if (mesh.mNumAnimMeshes > 0) warnings.add("morph targets are ignored");
    if ((mesh.mPrimitiveTypes & (aiPrimitiveType_LINE | aiPrimitiveType_POINT)) != 0)
        warnings.add("a primitive of points or lines is ignored: only triangles are supported");
}

}  // namespace vrut::io
