#include "io/assimp/scene.hpp"

#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>

#include "io/assimp/axes.hpp"
#include "io/assimp/files.hpp"
#include "io/assimp/lights.hpp"
#include "io/assimp/materials.hpp"
#include "io/assimp/meshes.hpp"
#include "io/assimp/ply_check.hpp"
#include "io/assimp/polygons.hpp"
#include "io/assimp/text.hpp"
#include "io/assimp/textures.hpp"
#include "io/assimp/up_axis_guess.hpp"
#include "io/scene_textures.hpp"
#include "io/vrut/tokenizer.hpp"
#include "mesh/watertight.hpp"

namespace vrut::io {

namespace {

/// Builds the parts of a scene, and frees what it has taken over from assimp's.
class AssimpConverter {
public:
    AssimpConverter(aiScene& scene, AssimpFormat format, ConversionWarnings warnings,
                    const std::filesystem::path& path, const ReadProgress& progress,
                    const ReadOptions& options)
        : scene_(scene),
          format_(format),
          path_(path),
          progress_(progress),
          options_(options),
          warnings_(std::move(warnings)) {}

    scene::SceneParts convert() {
        parts_.name = path_.stem().string();
        parts_.unit = metres_per_unit(scene_, format_);
        for (unsigned i = 0; i < scene_.mNumCameras; ++i)
            cameras_.emplace(scene_.mCameras[i]->mName.C_Str(), i);
        for (unsigned i = 0; i < scene_.mNumLights; ++i) lights_.emplace(scene_.mLights[i]->mName.C_Str(), i);
        convert_materials();
        convert_meshes();
        convert_nodes();
        look_at_targets(parts_);
        warnings_.add("a camera or light that no node references is ignored",
                      cameras_.size() + lights_.size());
        warnings_.add("an animation is ignored", scene_.mNumAnimations);
        if (lacks_up_axis(path_) && !options_.z_up && seems_z_up(parts_, path_))
            warnings_.add(
                "it seems to lie on its side: choose z as its up axis, in the page's menu or by --up-axis z");
        read_textures(parts_, path_, progress_, options_.texture_folders);
        omit_bump_maps();
        warnings_.append_to(parts_.notices, path_.string());
        if (!change_textures(parts_.materials, texture_changes_, parts_.textures))
            parts_.notices.push_back(path_.string() + ": " + kUnchangedTextures);
        find_single_sided();
        return std::move(parts_);
    }

private:
    // --- materials and meshes

    /// Only those that meshes have: assimp adds one of its own.
    void convert_materials() {
        std::vector<bool> used(scene_.mNumMaterials);
        for (unsigned i = 0; i < scene_.mNumMeshes; ++i) {
            if (scene_.mMeshes[i]->mMaterialIndex >= used.size())
                throw ImportError("a mesh references a material that does not exist");
            used[scene_.mMeshes[i]->mMaterialIndex] = true;
        }
        materials_.assign(scene_.mNumMaterials, scene::kNone);
        for (unsigned i = 0; i < scene_.mNumMaterials; ++i) {
            if (!used[i]) continue;
            materials_[i] = static_cast<scene::Index>(parts_.materials.size());
            parts_.materials.push_back(
                convert_material(*scene_.mMaterials[i], scene_, path_.parent_path(), format_, warnings_));
            parts_.materials.back().id = materials_[i];
            texture_changes_.push_back({.opaque = ignores_alpha(*scene_.mMaterials[i])});
        }
        decode_embedded_textures(parts_, path_, [&](const std::string& name, std::uint64_t max_pixels) {
            return decode_embedded_texture(scene_, name, max_pixels);
        });
    }

    /// Where the file or assimp calls them normal maps, as it does in Collada.
    void omit_bump_maps() {
        for (scene::Material& material : parts_.materials) {
            if (material.normal_texture == scene::kNone ||
                !is_grey(parts_.textures[static_cast<std::size_t>(material.normal_texture)].image))
                continue;
            material.normal_image.clear();
            material.normal_texture = scene::kNone;
            warnings_.add(kIgnoredBumpMap);
        }
    }

    void convert_meshes() {
        for (unsigned i = 0; i < scene_.mNumMeshes; ++i) {
            if (progress_) progress_(0.5 + 0.5 * i / scene_.mNumMeshes);
            geometries_.push_back(add_geometry(*scene_.mMeshes[i]));
        }
        if (!parts_.geometries.empty()) return;
        const bool other =
            std::any_of(scene_.mMeshes, scene_.mMeshes + scene_.mNumMeshes, [](const aiMesh* mesh) {
                return (mesh->mPrimitiveTypes & (aiPrimitiveType_POINT | aiPrimitiveType_LINE)) != 0;
            });
        throw ImportError(other ? "it has no triangles, only points or lines: export its surfaces as polygons"
                                : "it has no triangles");
    }

    /// kNone: there is nothing in it that could be drawn.
    scene::Index add_geometry(aiMesh& mesh) {
        report_unsupported_parts(mesh, warnings_);
        if ((mesh.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0) return scene::kNone;
        scene::Geometry geometry = convert_geometry(
            mesh, format_, texcoord_set_of(*scene_.mMaterials[mesh.mMaterialIndex]), warnings_);
        if (geometry.triangles.empty()) return scene::kNone;
        if (!geometry.colors.empty()) show_colors(mesh.mMaterialIndex);
        geometry.id = static_cast<scene::Id>(parts_.geometries.size());
        parts_.geometries.push_back(std::move(geometry));
        return static_cast<scene::Index>(parts_.geometries.size() - 1);
    }

    /// Where the file has no material, colours of vertices are shown as they are.
    void show_colors(unsigned index) {
        aiString name;
        scene_.mMaterials[index]->Get(AI_MATKEY_NAME, name);
        scene::Material& material = parts_.materials[static_cast<std::size_t>(materials_[index])];
        const bool is_default = is_one_part() && material.diffuse == scene::Material().diffuse;
        if (!is_default && text_of(name) != AI_DEFAULT_MATERIAL_NAME) return;
        material.diffuse = glm::dvec4(1);
        material.ambient = {0.1, 0.1, 0.1, 1};
    }

    /// Those that may be drawn from one side and look the same: opaque, and on closed parts only.
    void find_single_sided() {
        const std::atomic<bool> go_on{false};
        std::vector<bool> open(parts_.materials.size());
        for (unsigned i = 0; i < scene_.mNumMeshes; ++i) {
            const auto material = static_cast<std::size_t>(materials_[scene_.mMeshes[i]->mMaterialIndex]);
            if (geometries_[i] != scene::kNone && !open[material])
                open[material] =
                    !mesh::is_watertight(parts_.geometries[static_cast<std::size_t>(geometries_[i])], go_on);
        }
        for (std::size_t i = 0; i < open.size(); ++i) {
            scene::Material& material = parts_.materials[i];
            const bool transparent =
                material.diffuse.a < 1 ||
                (material.texture != scene::kNone &&
                 parts_.textures[static_cast<std::size_t>(material.texture)].transparent);
            material.two_sided = open[i] || transparent;
        }
    }

    // --- nodes

    /// From the root downwards, each before its children; without recursion, since a chain may be long.
    void convert_nodes() {
        struct PendingNode {
            const aiNode* node;
            scene::Id parent;
            glm::dmat4 matrix;  // parent from node
        };
        std::vector<PendingNode> open;
        const auto open_children = [&](const aiNode& node, scene::Id id, const glm::dmat4& matrix) {
            for (unsigned i = node.mNumChildren; i-- > 0;)
                open.push_back({node.mChildren[i], id, matrix * matrix_of(*node.mChildren[i])});
        };
        const aiNode& root = *scene_.mRootNode;
        const glm::dmat4 matrix =
            upright_from_file(scene_, format_, options_.z_up && lacks_up_axis(path_), warnings_) *
            matrix_of(root);
        if (is_made_up(root, matrix))
            open_children(root, 0, glm::dmat4(1));
        else
            open.push_back({&root, 0, matrix});
        while (!open.empty()) {
            const PendingNode pending = open.back();
            open.pop_back();
            if (is_step(*pending.node))
                open_children(*pending.node, pending.parent, pending.matrix);
            else
                open_children(*pending.node, add_node(*pending.node, pending.parent, pending.matrix),
                              glm::dmat4(1));
        }
    }

    /// Returns true if assimp added this root to hold what the file has.
    bool is_made_up(const aiNode& root, const glm::dmat4& matrix) const {
        return root.mNumMeshes == 0 && matrix == glm::dmat4(1) && cameras_.count(root.mName.C_Str()) == 0 &&
               lights_.count(root.mName.C_Str()) == 0;
    }

    /// Returns true if it is one of the many that assimp makes of a single node's turns, pivots and shifts in
    /// FBX.
    bool is_step(const aiNode& node) const {
        return format_ == AssimpFormat::fbx &&
               std::string_view(node.mName.C_Str()).find("_$AssimpFbx$_") != std::string_view::npos;
    }

    /// What a node shows: it alone is the node itself, several hang below it.
    scene::Id add_node(const aiNode& from, scene::Id parent, const glm::dmat4& matrix) {
        std::vector<scene::Node> contents;
        for (unsigned i = 0; i < from.mNumMeshes; ++i) add_mesh(from.mMeshes[i], contents);
        add_named(cameras_, scene_.mCameras, convert_camera, from, contents);
        add_named(lights_, scene_.mLights, convert_light, from, contents);
        const bool alone =
            contents.size() == 1 && from.mNumChildren == 0 && contents.front().matrix == glm::dmat4(1);
        scene::Node node = alone ? std::move(contents.front()) : scene::Node{};
        node.name = text_of(from.mName);
        if (node.name.empty() && is_one_part()) node.name = parts_.name;
        node.matrix = matrix;
        const scene::Id id = add(std::move(node), parent);
        if (!alone)
            for (scene::Node& content : contents) add(std::move(content), id);
        return id;
    }

    /// A format of one part, which often has no name.
    bool is_one_part() const { return format_ == AssimpFormat::stl || format_ == AssimpFormat::ply; }

    scene::Id add(scene::Node node, scene::Id parent) {
        node.id = static_cast<scene::Id>(parts_.nodes.size()) + 1;
        parts_.nodes.push_back({std::move(node), parent});
        return parts_.nodes.back().node.id;
    }

    void add_mesh(unsigned mesh, std::vector<scene::Node>& contents) const {
        if (mesh >= geometries_.size()) throw ImportError("a node references a mesh that does not exist");
        if (geometries_[mesh] == scene::kNone) return;
        scene::Node& node = contents.emplace_back();
        node.name = text_of(scene_.mMeshes[mesh]->mName);
        node.type = scene::NodeType::geometry;
        node.data = scene::GeometryData{geometries_[mesh], materials_[scene_.mMeshes[mesh]->mMaterialIndex]};
    }

    using IndicesByName = std::multimap<std::string, unsigned>;

    /// assimp knows cameras and lights by their nodes' names; of nodes with one name each has the next.
    template <class T, class Conversion>
    void add_named(IndicesByName& names, T* const* all, Conversion conversion, const aiNode& from,
                   std::vector<scene::Node>& contents) {
        const auto found = names.find(from.mName.C_Str());
        if (found == names.end()) return;
        const unsigned number = found->second;
        names.erase(found);
        if (auto node = conversion(*all[number], format_, warnings_)) contents.push_back(*std::move(node));
    }

    static glm::dmat4 matrix_of(const aiNode& node) {
        const aiMatrix4x4& from = node.mTransformation;
        glm::dmat4 matrix;
        for (unsigned row = 0; row < 4; ++row)
            for (unsigned column = 0; column < 4; ++column) {
                if (!is_coordinate(from[row][column]))
                    throw ImportError("the matrix of node '" + excerpt(text_of(node.mName)) +
                                      "' has an element that is not a number from -1e15 to 1e15");
                matrix[static_cast<int>(column)][static_cast<int>(row)] = from[row][column];
            }
        constexpr float kRounding = 1e-5F;  // assimp inverts pivots in single precision
        if (std::abs(from.d1) > kRounding || std::abs(from.d2) > kRounding || std::abs(from.d3) > kRounding ||
            std::abs(from.d4 - 1) > kRounding)
            throw ImportError("the matrix of node '" + excerpt(text_of(node.mName)) +
                              "' is not affine: its last row is not 0 0 0 1");
        for (int column = 0; column < 4; ++column) matrix[column][3] = column == 3 ? 1 : 0;
        return matrix;
    }

    aiScene& scene_;
    const AssimpFormat format_;
    const std::filesystem::path& path_;
    const ReadProgress& progress_;
    const ReadOptions& options_;
    scene::SceneParts parts_;
    ConversionWarnings warnings_;
    std::vector<scene::Index> materials_, geometries_;  // ours for each of assimp's
    std::vector<TextureChange> texture_changes_;        // for each of ours
    IndicesByName cameras_, lights_;
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

/// Polygons, or strips instead of them, become triangles, once they are known to be some.
void check_and_triangulate(Assimp::Importer& importer, bool strips) {
    const aiScene& scene = *importer.GetScene();
    for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
        if (strips) triangulate_strips(*scene.mMeshes[i]);
        check_faces(*scene.mMeshes[i]);
        triangulate_large_polygons(*scene.mMeshes[i]);
    }
    if (importer.ApplyPostProcessing(aiProcess_Triangulate) == nullptr)
        throw ImportError("its polygons cannot be triangulated");
}

std::string fault_of(const Assimp::Importer& importer, const SceneFiles& files) {
    if (!files.rejection().empty()) return files.rejection();
    const std::string error = importer.GetErrorString();
    constexpr std::pair<const char*, const char*> kKnown[] = {
        {"No suitable reader", "its contents do not match its file extension"},
        {"STL storage representation",
         "it is neither ASCII STL nor binary STL of the size that its triangle count requires"},
        {"unsupported, old format version",
         "it is FBX of a version before 7.1, which cannot be read: export it as FBX 2011 or later"},
        {"block offset is out of range",
         "it is truncated, or it is binary FBX written by assimp 5.2, which assimp cannot read: export it "
         "with another program"},
        {"FBX-Tokenize (offset",
         "its contents are damaged, or newer than FBX 2013: export it again, as FBX 2013"},
        {"Collada: File came out empty", "it has no scene to show"},
    };
    for (const auto& [part, meaning] : kKnown)
        if (error.find(part) != std::string::npos) return meaning;
    return "it cannot be read: " + excerpt(error, 300);
}

std::unique_ptr<aiScene> import(const std::filesystem::path& path, AssimpFormat format,
                                const PlyStripsPlace& strips, ConversionWarnings& warnings) {
    Assimp::Importer importer;
    leave_only(importer, importer_name(format));
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
    auto* files = new SceneFiles(path);
    // assimp keeps all indices of faces.
    if (strips) files->replace(*strips, "face     ");
    importer.SetIOHandler(files);  // which it deletes
    if (importer.ReadFile(files->main_name(), 0) == nullptr) throw ImportError(fault_of(importer, *files));
    if (!files->rejection().empty()) warnings.add(files->rejection());
    check_and_triangulate(importer, strips.has_value());
    return std::unique_ptr<aiScene>(importer.GetOrphanedScene());
}

std::unique_ptr<aiScene> import_checked(const std::filesystem::path& path, AssimpFormat format,
                                        ConversionWarnings& warnings) {
    PlyStripsPlace strips;
    if (format == AssimpFormat::ply) {
        const auto checked = check_ply(path);
        if (!checked) throw ImportError(checked.error());
        strips = *checked;
    }
    return import(path, format, strips, warnings);
}

}  // namespace

PartsResult read_assimp_scene(const std::filesystem::path& path, AssimpFormat format,
                              const ReadProgress& progress, const ReadOptions& options) {
    try {
        if (progress) progress(0);
        ConversionWarnings warnings;
        const auto scene = import_checked(path, format, warnings);
        if (progress) progress(0.5);
        return AssimpConverter(*scene, format, std::move(warnings), path, progress, options).convert();
    } catch (const ImportError& error) {
        return tl::unexpected(path.string() + ": " + error.what());
    }
}

}  // namespace vrut::io
