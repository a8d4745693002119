#include "assimp_scene.hpp"

#include <assimp/BaseImporter.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <unordered_map>

#include "assimp_files.hpp"
#include "assimp_materials.hpp"
#include "assimp_text.hpp"
#include "gltf_check.hpp"
#include "scene_pictures.hpp"
#include "tokenizer.hpp"

namespace vrut {

namespace {

// As for scene text: beyond this, coordinates would leave the range of float when squared on the GPU.
constexpr float kMaxCoordinate = 1e15F;

/// Why the file's scene is none, without the file's name.
struct Refused : std::runtime_error {
    using std::runtime_error::runtime_error;
};

bool is_coordinate(float value) { return std::abs(value) <= kMaxCoordinate; }  // and no NaN

template <class Vector>
void require_coordinates(const Vector& vector, const char* what, const aiMesh& mesh) {
    if (!is_coordinate(vector.x) || !is_coordinate(vector.y) || !is_coordinate(vector.z))
        throw Refused("a " + std::string(what) + " of mesh '" + excerpt(text_of(mesh.mName)) +
                      "' is not a number from -1e15 to 1e15");
}

/// Frees one of a mesh's arrays as soon as it is copied: both together may be large.
template <class T>
void release(T*& array) {
    delete[] array;
    array = nullptr;
}

void take_vertices(aiMesh& mesh, Geometry& geometry) {
    geometry.positions.reserve(mesh.mNumVertices);
    for (const aiVector3D* v = mesh.mVertices; v != mesh.mVertices + mesh.mNumVertices; ++v) {
        require_coordinates(*v, "vertex", mesh);
        geometry.bounds.add(geometry.positions.emplace_back(v->x, v->y, v->z));
    }
    release(mesh.mVertices);
}

void take_normals(aiMesh& mesh, Geometry& geometry) {
    if (!mesh.HasNormals()) return;
    geometry.normals.reserve(mesh.mNumVertices);
    for (const aiVector3D* v = mesh.mNormals; v != mesh.mNormals + mesh.mNumVertices; ++v) {
        require_coordinates(*v, "normal", mesh);
        geometry.normals.emplace_back(v->x, v->y, v->z);
    }
    release(mesh.mNormals);
}

/// assimp has turned v upwards already, as we have it.
void take_texcoords(aiMesh& mesh, Geometry& geometry) {
    if (!mesh.HasTextureCoords(0)) return;
    geometry.texcoords.reserve(mesh.mNumVertices);
    for (const aiVector3D* v = mesh.mTextureCoords[0]; v != mesh.mTextureCoords[0] + mesh.mNumVertices; ++v) {
        require_coordinates(*v, "texture coordinate", mesh);
        geometry.texcoords.emplace_back(v->x, v->y);
    }
    release(mesh.mTextureCoords[0]);
}

void take_triangles(aiMesh& mesh, Geometry& geometry) {
    geometry.triangles.reserve(mesh.mNumFaces);
    for (const aiFace* face = mesh.mFaces; face != mesh.mFaces + mesh.mNumFaces; ++face) {
        if (face->mNumIndices != 3) continue;
        const unsigned* i = face->mIndices;
        if (std::max({i[0], i[1], i[2]}) >= mesh.mNumVertices)
            throw Refused("mesh '" + excerpt(text_of(mesh.mName)) + "' has an index out of range");
        geometry.triangles.emplace_back(i[0], i[1], i[2]);
    }
    release(mesh.mFaces);
    mesh.mNumFaces = 0;
}

void tell_lost_parts(const aiMesh& mesh, Losses& losses) {
    if (mesh.HasBones()) losses.add("a skin is not shown: the mesh stands as it was modelled");
    if (mesh.mNumAnimMeshes > 0) losses.add("the shapes that a mesh can take on are not shown");
    if (mesh.HasVertexColors(0)) losses.add("a mesh's colours at its vertices are not shown");
    if (mesh.HasTextureCoords(1)) losses.add("a mesh's further texture coordinates are not read");
    if ((mesh.mPrimitiveTypes & (aiPrimitiveType_LINE | aiPrimitiveType_POINT)) != 0)
        losses.add("a mesh of points or lines is not shown");
}

/// Builds the parts of a scene, and frees what it has taken over from assimp's.
class AssimpConverter {
public:
    AssimpConverter(aiScene& scene, Losses losses, const std::filesystem::path& path,
                    const ReadProgress& progress)
        : scene_(scene), path_(path), progress_(progress), losses_(std::move(losses)) {}

    SceneParts convert() {
        parts_.name = path_.stem().string();
        for (unsigned i = 0; i < scene_.mNumCameras; ++i)
            cameras_.emplace(scene_.mCameras[i]->mName.C_Str(), i);
        for (unsigned i = 0; i < scene_.mNumLights; ++i) lights_.emplace(scene_.mLights[i]->mName.C_Str(), i);
        convert_materials();
        convert_meshes();
        convert_nodes();
        if (scene_.mNumAnimations > 0) losses_.add("an animation is not shown", scene_.mNumAnimations);
        losses_.append_to(parts_.notices, path_.string());
        read_pictures(parts_, path_, progress_);
        make_pictures_opaque(parts_.materials, ignore_alpha_, parts_.textures);
        return std::move(parts_);
    }

private:
    // --- materials and meshes

    /// Only those that meshes have: assimp adds one of its own.
    void convert_materials() {
        std::vector<bool> used(scene_.mNumMaterials);
        for (unsigned i = 0; i < scene_.mNumMeshes; ++i) used.at(scene_.mMeshes[i]->mMaterialIndex) = true;
        materials_.assign(scene_.mNumMaterials, kNone);
        for (unsigned i = 0; i < scene_.mNumMaterials; ++i) {
            if (!used[i]) continue;
            materials_[i] = static_cast<Index>(parts_.materials.size());
            parts_.materials.push_back(convert_material(*scene_.mMaterials[i], path_.parent_path(), losses_));
            parts_.materials.back().id = materials_[i];
            ignore_alpha_.push_back(ignores_alpha(*scene_.mMaterials[i]));
        }
        read_embedded_pictures(scene_, parts_.materials, parts_.textures, path_.string(), parts_.notices);
    }

    void convert_meshes() {
        for (unsigned i = 0; i < scene_.mNumMeshes; ++i) {
            if (progress_) progress_(0.5 + 0.5 * i / scene_.mNumMeshes);
            geometries_.push_back(take_geometry(*scene_.mMeshes[i]));
        }
        if (parts_.geometries.empty()) throw Refused("it has no triangles to show");
    }

    /// kNone: there is nothing in it that could be drawn.
    Index take_geometry(aiMesh& mesh) {
        tell_lost_parts(mesh, losses_);
        if ((mesh.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0) return kNone;
        Geometry geometry;
        take_triangles(mesh, geometry);
        take_vertices(mesh, geometry);
        take_normals(mesh, geometry);
        take_texcoords(mesh, geometry);
        geometry.id = static_cast<Id>(parts_.geometries.size());
        parts_.geometries.push_back(std::move(geometry));
        return static_cast<Index>(parts_.geometries.size() - 1);
    }

    // --- nodes

    /// From the root downwards, each before its children; without recursion, since a chain may be long.
    void convert_nodes() {
        struct Place {
            const aiNode* node;
            Id parent;
        };
        std::vector<Place> open;
        const auto open_children = [&](const aiNode& node, Id id) {
            for (unsigned i = node.mNumChildren; i-- > 0;) open.push_back({node.mChildren[i], id});
        };
        const aiNode& root = *scene_.mRootNode;
        if (is_made_up(root))
            open_children(root, 0);
        else
            open.push_back({&root, 0});
        while (!open.empty()) {
            const Place place = open.back();
            open.pop_back();
            open_children(*place.node, add_node(*place.node, place.parent));
        }
    }

    /// Whether assimp added this root to hold several.
    bool is_made_up(const aiNode& root) const {
        return root.mNumMeshes == 0 && root.mTransformation.IsIdentity() && text_of(root.mName) == "ROOT" &&
               cameras_.count("ROOT") == 0 && lights_.count("ROOT") == 0;
    }

    /// What a node shows: it alone is the node itself, several hang below it.
    Id add_node(const aiNode& from, Id parent) {
        std::vector<Node> contents;
        for (unsigned i = 0; i < from.mNumMeshes; ++i) add_mesh(from.mMeshes[i], contents);
        add_camera(from, contents);
        add_light(from, contents);
        const bool alone = contents.size() == 1 && from.mNumChildren == 0;
        Node node = alone ? std::move(contents.front()) : Node{};
        node.name = text_of(from.mName);
        node.matrix = matrix_of(from);
        const Id id = add(std::move(node), parent);
        if (!alone)
            for (Node& content : contents) add(std::move(content), id);
        return id;
    }

    Id add(Node node, Id parent) {
        node.id = static_cast<Id>(parts_.nodes.size()) + 1;
        parts_.nodes.push_back({std::move(node), parent});
        return parts_.nodes.back().node.id;
    }

    void add_mesh(unsigned mesh, std::vector<Node>& contents) const {
        if (geometries_.at(mesh) == kNone) return;
        Node& node = contents.emplace_back();
        node.name = text_of(scene_.mMeshes[mesh]->mName);
        node.type = NodeType::geometry;
        node.data = GeometryData{geometries_[mesh], materials_.at(scene_.mMeshes[mesh]->mMaterialIndex)};
    }

    /// assimp knows cameras and lights by their nodes' names; of nodes with one name the first has them.
    void add_camera(const aiNode& from, std::vector<Node>& contents) {
        const auto found = cameras_.find(from.mName.C_Str());
        if (found == cameras_.end()) return;
        const aiCamera& camera = *scene_.mCameras[found->second];
        cameras_.erase(found);
        if (camera.mHorizontalFOV <= 0) {
            losses_.add("a camera without perspective is not read");
            return;
        }
        // Its horizontal angle is the file's vertical one times the aspect.
        const double fov = camera.mHorizontalFOV / (camera.mAspect > 0 ? camera.mAspect : 1);
        if (!std::isfinite(fov)) {
            losses_.add("a camera whose field of view is no number is not read");
            return;
        }
        Node& node = contents.emplace_back();
        node.name = "camera";
        node.type = NodeType::camera;
        // Not its position, into which assimp 5.2 puts the node's own a second time.
        node.data.emplace<CameraData>().fov = std::clamp(glm::degrees(fov), 1.0, 170.0);
    }

    void add_light(const aiNode& from, std::vector<Node>& contents) {
        const auto found = lights_.find(from.mName.C_Str());
        if (found == lights_.end()) return;
        const aiLight& light = *scene_.mLights[found->second];
        lights_.erase(found);
        Node& node = contents.emplace_back();
        node.name = "light";
        node.type = NodeType::light;
        node.data = light_data(light);
        losses_.add("a light shines with full colour at any distance: its strength and range are not read");
    }

    static LightData light_data(const aiLight& from) {
        LightData light;
        light.type = from.mType == aiLightSource_DIRECTIONAL ? LightData::Type::directional
                     : from.mType == aiLightSource_SPOT      ? LightData::Type::spot
                                                             : LightData::Type::point;
        const aiColor3D color = from.mColorDiffuse;  // times the strength
        const float most = std::max({color.r, color.g, color.b});
        if (std::isfinite(most))
            light.color = glm::dvec4(displayed_color(most > 0 ? color * (1 / most) : color), 1);
        light.angle = std::clamp(2 * glm::degrees(double{from.mAngleOuterCone}), 0.0, 180.0);
        return light;
    }

    static glm::dmat4 matrix_of(const aiNode& node) {
        const aiMatrix4x4& from = node.mTransformation;
        glm::dmat4 matrix;
        for (unsigned row = 0; row < 4; ++row)
            for (unsigned column = 0; column < 4; ++column) {
                if (!is_coordinate(from[row][column]))
                    throw Refused("the matrix of node '" + excerpt(text_of(node.mName)) +
                                  "' has an element that is not a number from -1e15 to 1e15");
                matrix[static_cast<int>(column)][static_cast<int>(row)] = from[row][column];
            }
        if (from.d1 != 0 || from.d2 != 0 || from.d3 != 0 || from.d4 != 1)
            throw Refused("the matrix of node '" + excerpt(text_of(node.mName)) +
                          "' does not end with the row 0 0 0 1");
        return matrix;
    }

    aiScene& scene_;
    const std::filesystem::path& path_;
    const ReadProgress& progress_;
    SceneParts parts_;
    Losses losses_;
    std::vector<Index> materials_, geometries_;  // ours for each of assimp's
    std::vector<bool> ignore_alpha_;             // for each of ours
    std::unordered_map<std::string, unsigned> cameras_, lights_;
};

/// assimp takes what it knows best for a file that it does not know by its ending: only this reader is left
/// it.
void leave_only(Assimp::Importer& importer, const char* reader) {
    for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
        Assimp::BaseImporter* other = importer.GetImporter(i);
        if (std::string_view(other->GetInfo()->mName) == reader) continue;
        importer.UnregisterLoader(other);
        delete other;
    }
}

std::uint64_t count_triangles(const aiScene& scene) {
    std::uint64_t count = 0;
    for (unsigned i = 0; i < scene.mNumMeshes; ++i)
        if ((scene.mMeshes[i]->mPrimitiveTypes & aiPrimitiveType_TRIANGLE) != 0)
            count += scene.mMeshes[i]->mNumFaces;
    return count;
}

std::unique_ptr<aiScene> import(const std::filesystem::path& path, std::string head) {
    Assimp::Importer importer;
    leave_only(importer, "glTF2 Importer");
    auto* files = new SceneFiles(path, std::move(head));
    importer.SetIOHandler(files);  // which it deletes
    if (importer.ReadFile(files->main_name(), 0) == nullptr)
        throw Refused(!files->refusal().empty()
                          ? files->refusal()
                          : "it cannot be read: " + excerpt(importer.GetErrorString(), 300));
    return std::unique_ptr<aiScene>(importer.GetOrphanedScene());
}

}  // namespace

PartsResult read_assimp_scene(const std::filesystem::path& path, const ReadProgress& progress) {
    try {
        if (progress) progress(0);
        auto checked = check_gltf(path);
        if (!checked) throw Refused(checked.error());
        const auto scene = import(path, std::move(checked->head));
        if (count_triangles(*scene) != checked->triangles) throw Refused("a mesh has an index out of range");
        if (progress) progress(0.5);
        return AssimpConverter(*scene, std::move(checked->losses), path, progress).convert();
    } catch (const Refused& refused) {
        return tl::unexpected(path.string() + ": " + refused.what());
    }
}

}  // namespace vrut
