#include "io/gltf/reader.hpp"

#include <algorithm>
#include <map>

#include "io/gltf/buffers.hpp"
#include "io/gltf/cameras_lights.hpp"
#include "io/gltf/extensions.hpp"
#include "io/gltf/geometry.hpp"
#include "io/gltf/images.hpp"
#include "io/gltf/instances.hpp"
#include "io/gltf/material_reader.hpp"
#include "io/gltf/node_tree.hpp"
#include "io/gltf/variants.hpp"
#include "io/import_checks.hpp"
#include "io/scene_textures.hpp"

namespace vrut::io {

namespace {

/// What a node shows: a node, and below a switch what there is to choose.
struct Content {
    scene::Node node;
    std::vector<scene::Node> choices;
};

/// Builds the parts of a scene.
class GltfConverter {
public:
    GltfConverter(const std::filesystem::path& path, const ReadProgress& progress, const ReadOptions& options)
        : path_(path),
          progress_(progress),
          options_(options),
          file_(read_gltf_file(path)),
          document_(file_.document),
          buffers_(path, file_),
          tree_(document_),
          variants_(document_, tree_.meshes()) {}

    scene::SceneParts convert() {
        parts_.name = path_.stem().string();
        parts_.unit = 1;
        check_extensions(document_, warnings_);
        report_lists();
        convert_materials();
        convert_meshes();
        convert_nodes();
        convert_images();
        return std::move(parts_);
    }

private:
    void report_lists() {
        warnings_.add("a skin is ignored: its mesh is shown undeformed", array_in(document_, "skins").size());
        warnings_.add("an animation is ignored", array_in(document_, "animations").size());
    }

    // --- materials

    /// Of the meshes that are shown, in their order; the default one comes last.
    void convert_materials() {
        bool needs_default = false;
        const auto add = [&](GltfMaterialNumber number) {
            needs_default = needs_default || !number;
            if (number) add_material(number);
        };
        for (const std::uint32_t mesh : tree_.meshes())
            for (const GltfJson& primitive : primitives_of(mesh)) {
                add(index_in(primitive, "material"));
                for (const GltfVariants::Choice& choice : variants_.choices_of(primitive))
                    add(choice.material);
            }
        if (needs_default) add_material(std::nullopt);
    }

    void add_material(GltfMaterialNumber number) {
        const auto [found, is_new] =
            material_indices_.emplace(number, static_cast<scene::Index>(materials_.size()));
        if (!is_new) return;
        ReadGltfMaterial read = read_gltf_material(document_, number, warnings_);
        read.material.id = found->second;
        const auto name_of_image = [&](std::optional<std::uint32_t> image) {
            return image ? image_name(document_, *image, path_.parent_path()) : std::string();
        };
        read.material.image = name_of_image(read.image);
        read.material.emissive_image = name_of_image(read.emissive_image);
        read.material.occlusion_roughness_metallic_image =
            name_of_image(read.occlusion_roughness_metallic_image);
        read.material.normal_image = name_of_image(read.normal_image);
        parts_.materials.push_back(read.material);
        materials_.push_back(std::move(read));
    }

    // --- meshes

    /// Those of one primitive by how its texture lies.
    using GeometryIndices = std::map<decltype(GltfTextureMapping().key()), scene::Index>;

    const GltfJson& mesh_json(std::uint32_t mesh) const { return array_in(document_, "meshes")[mesh]; }
    const GltfJson& primitives_of(std::uint32_t mesh) const {
        return array_in(mesh_json(mesh), "primitives");
    }

    std::string name_of(std::uint32_t mesh) const {
        const std::string& name = string_in(mesh_json(mesh), "name");
        return name.empty() ? "meshes[" + std::to_string(mesh) + "]" : name;
    }

    void convert_meshes() {
        std::size_t done = 0;
        for (const std::uint32_t mesh : tree_.meshes()) {
            convert_mesh(mesh);
            if (progress_)
                progress_(static_cast<double>(++done) / static_cast<double>(tree_.meshes().size()));
        }
        if (parts_.geometries.empty()) throw ImportError("it has no triangles");
    }

    /// A part for each of its primitives that can be drawn.
    void convert_mesh(std::uint32_t mesh) {
        const GltfJson& primitives = primitives_of(mesh);
        std::vector<Content>& shown = shown_[mesh];
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            report_lost_parts(primitives[i]);
            if (!has_triangles(primitives[i])) continue;
            const std::string suffix = primitives.size() > 1 ? "-" + std::to_string(i) : "";
            shown.push_back(convert_primitive(primitives[i], name_of(mesh) + suffix));
        }
    }

    /// Where there are variants, a switch with a part for each.
    Content convert_primitive(const GltfJson& primitive, const std::string& name) {
        GeometryIndices geometries;
        const auto convert = [&](const std::string& part_name, GltfMaterialNumber number) {
            scene::Node node;
            node.name = part_name;
            node.type = scene::NodeType::geometry;
            const scene::Index material = material_indices_.at(number);
            node.data = scene::GeometryData{add_geometry(primitive, material, name, geometries), material};
            return node;
        };
        const std::vector<GltfVariants::Choice> choices = variants_.choices_of(primitive);
        if (choices.empty()) return {convert(name, index_in(primitive, "material")), {}};
        Content content;
        content.node.name = name;
        content.node.type = scene::NodeType::switch_;
        content.node.data = scene::SwitchData{variants_.default_choice()};
        for (const GltfVariants::Choice& choice : choices)
            content.choices.push_back(convert(choice.name, choice.material));
        return content;
    }

    void report_lost_parts(const GltfJson& primitive) {
        if (!has_triangles(primitive))
            warnings_.add("a primitive of points or lines is ignored: only triangles are supported");
        if (!array_in(primitive, "targets").empty()) warnings_.add("morph targets are ignored");
    }

    scene::Index add_geometry(const GltfJson& primitive, scene::Index material, const std::string& name,
                              GeometryIndices& known) {
        const ReadGltfMaterial& read = materials_[static_cast<std::size_t>(material)];
        const auto [found, is_new] =
            known.emplace(read.mapping.key(), static_cast<scene::Index>(parts_.geometries.size()));
        if (is_new) {
            parts_.geometries.push_back(
                read_gltf_geometry(document_, primitive, read.mapping, name, buffers_, warnings_));
            parts_.geometries.back().id = found->second;
        }
        return found->second;
    }

    // --- nodes

    void convert_nodes() {
        std::vector<scene::Id> ids;
        for (const GltfTreeNode& node : tree_.nodes())
            ids.push_back(add_node(node, node.parent == scene::kNone
                                             ? scene::Id{0}
                                             : ids[static_cast<std::size_t>(node.parent)]));
    }

    scene::Id add_node(const GltfTreeNode& from, scene::Id parent) {
        std::vector<Content> shown, contents;
        if (from.mesh) shown = shown_.at(*from.mesh);
        const auto instances = read_gltf_instances(document_, from.json, buffers_);
        if (!instances) contents = shown;
        if (auto camera = read_gltf_camera(document_, from.json, warnings_))
            contents.push_back({*std::move(camera), {}});
        if (auto light = read_gltf_light(document_, from.json, warnings_))
            contents.push_back({*std::move(light), {}});
        const bool may_be_one = !instances && !from.has_children;
        const scene::Id id = add_with(std::move(contents), from.name, from.matrix, parent, may_be_one);
        if (instances && !shown.empty())
            for (const glm::dmat4& matrix : *instances)
                add_with(shown, name_of(*from.mesh), matrix, id, true);
        return id;
    }

    /// What a node shows hangs below it, or is the node itself where it is alone and may be.
    scene::Id add_with(std::vector<Content> contents, const std::string& name, const glm::dmat4& matrix,
                       scene::Id parent, bool may_be_one) {
        const bool alone = may_be_one && contents.size() == 1;
        Content content = alone ? std::move(contents.front()) : Content{};
        content.node.name = name;
        content.node.matrix = matrix;
        const scene::Id id = add(std::move(content), parent);
        if (!alone)
            for (Content& below : contents) add(std::move(below), id);
        return id;
    }

    scene::Id add(Content content, scene::Id parent) {
        const scene::Id id = add(std::move(content.node), parent);
        for (scene::Node& choice : content.choices) add(std::move(choice), id);
        return id;
    }

    scene::Id add(scene::Node node, scene::Id parent) {
        buffers_.charge(sizeof(scene::SceneParts::PartNode) + node.name.size());
        node.id = static_cast<scene::Id>(parts_.nodes.size()) + 1;
        parts_.nodes.push_back({std::move(node), parent});
        return parts_.nodes.back().node.id;
    }

    // --- images

    void convert_images() {
        decode_embedded_textures(parts_, path_, [&](const std::string& name, std::uint64_t max_pixels) {
            return decode_gltf_image(document_, buffers_, name, max_pixels);
        });
        warnings_.append_to(parts_.notices, path_.string());
        read_textures(parts_, path_, progress_, options_.texture_folders);
        std::vector<TextureChange> changes, surface_changes;
        for (const ReadGltfMaterial& material : materials_) {
            changes.push_back(material.change);
            surface_changes.push_back(material.surface_change);
        }
        const bool all = change_textures(parts_.materials, changes, parts_.textures);
        if (!change_textures(parts_.materials, surface_changes, parts_.textures,
                             &scene::Material::occlusion_roughness_metallic_texture) ||
            !all)
            parts_.notices.push_back(path_.string() + ": " + kUnchangedTextures);
    }

    const std::filesystem::path& path_;
    const ReadProgress& progress_;
    const ReadOptions& options_;
    GltfFile file_;
    const GltfJson& document_;
    GltfBuffers buffers_;
    GltfNodeTree tree_;
    GltfVariants variants_;
    scene::SceneParts parts_;
    ConversionWarnings warnings_;
    std::map<GltfMaterialNumber, scene::Index> material_indices_;
    std::vector<ReadGltfMaterial> materials_;              // for each of ours
    std::map<std::uint32_t, std::vector<Content>> shown_;  // what a mesh shows
};

}  // namespace

PartsResult read_gltf_scene(const std::filesystem::path& path, const ReadProgress& progress,
                            const ReadOptions& options) {
    try {
        if (progress) progress(0);
        return GltfConverter(path, progress, options).convert();
    } catch (const ImportError& error) {
        return tl::unexpected(path.string() + ": " + error.what());
    }
}

}  // namespace vrut::io
