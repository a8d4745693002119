#include "io/gltf/writer.hpp"

#include <cmath>
#include <map>
#include <ostream>
#include <set>

#include "base/srgb.hpp"
#include "io/gltf/binary_chunk.hpp"
#include "io/gltf/json_writer.hpp"
#include "io/gltf/material.hpp"
#include "io/texture_writer.hpp"
#include "io/visible_shapes.hpp"

namespace vrut::io {

namespace {

constexpr std::string_view kLights = "KHR_lights_punctual";
constexpr std::string_view kGlossiness = "KHR_materials_pbrSpecularGlossiness";
constexpr std::string_view kClearCoat = "KHR_materials_clearcoat";
constexpr std::string_view kEmissiveStrength = "KHR_materials_emissive_strength";

std::uint64_t gltf_wrap(scene::Wrap wrap) {
    return wrap == scene::Wrap::clamp ? kGltfClamp : wrap == scene::Wrap::mirror ? kGltfMirror : kGltfRepeat;
}

/// The frame in which a camera looks along -z, with y upwards.
glm::dmat4 frame_of(const scene::CameraData& camera) {
    const glm::dvec3 z = glm::normalize(camera.eye - camera.focus);
    const glm::dvec3 x = glm::normalize(glm::cross(camera.up, z));
    glm::dmat4 frame(glm::dmat3(x, glm::cross(z, x), z));
    frame[3] = glm::dvec4(camera.eye, 1);
    return frame;
}

/// Returns true if the matrix turns, scales and moves, as glTF asks for, and neither shears nor flattens.
bool keeps_right_angles(const glm::dmat4& matrix) {
    return std::abs(std::abs(scene::relative_determinant(glm::dmat3(matrix))) - 1) < 1e-9;
}

/// The texture as far as it is drawn: kNone for a material without metal and roughness.
scene::Index occlusion_roughness_metallic(const scene::Material& material) {
    return material.metallic_roughness ? material.occlusion_roughness_metallic_texture : scene::kNone;
}

class GlbWriter {
public:
    GlbWriter(const scene::Scene& scene, ConversionWarnings& warnings) : scene_(scene), warnings_(warnings) {
        shapes_ = shown_shapes(scene, warnings);
        for (const ShownShape& shape : shapes_) add_shape(shape);
        for (const scene::Index index : material_list_) {
            const scene::Material& material = scene_.material(index);
            for (const scene::Index texture :
                 {material.texture, material.emissive_texture, occlusion_roughness_metallic(material),
                  material.normal_texture})
                if (texture != scene::kNone) images_.emplace(texture, 0);
        }
        int place = 0;
        for (auto& [texture, own] : images_) {
            own = place++;
            const scene::Texture& from = scene_.textures()[static_cast<std::size_t>(texture)];
            buffer_.add_image(encode_png(from.image, from.transparent));
        }
    }

    /// The JSON chunk; after it size(), that of the binary one, is known.
    std::string describe() {
        json_.open_object();
        write_head();
        write_nodes();
        write_cameras_and_lights();
        write_meshes();
        write_materials();
        write_textures();
        size_ = buffer_.describe(json_);
        json_.close();
        std::string text = json_.text();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        return text;
    }

    std::uint64_t size() const { return size_; }

    void write_binary(std::ostream& out, const WriteProgress& progress) const {
        buffer_.write(out, progress);
    }

private:
    // --- what is written, and where

    using MeshKey = std::pair<const scene::Geometry*, scene::Index>;  // with a material

    void add_shape(const ShownShape& shape) {
        const MeshKey mesh{shape.geometry, shape.material};
        if (const auto [found, is_new] = meshes_.emplace(mesh, static_cast<int>(mesh_list_.size())); is_new)
            mesh_list_.push_back(mesh);
        mesh_of_node_[shape.node] = meshes_.at(mesh);
        if (const auto [found, is_new] = materials_.emplace(shape.material, 0); is_new) {
            found->second = static_cast<int>(material_list_.size());
            material_list_.push_back(shape.material);
        }
        if (buffer_.add(*shape.geometry)) report_rounding(*shape.geometry);
    }

    void report_rounding(const scene::Geometry& geometry) {
        for (const glm::dvec3& position : geometry.positions)
            if (glm::dvec3(glm::vec3(position)) != position)
                return warnings_.add("a geometry's positions are rounded to single precision");
    }

    // --- JSON

    void write_head() {
        json_.open_object("asset").string("2.0", "version").string("vrut-preview", "generator").close();
        json_.number(0, "scene");
        std::set<std::string_view> extensions;
        for (const scene::Node& node : scene_.nodes())
            if (node.type == scene::NodeType::light) extensions.insert(kLights);
        for (const scene::Index index : material_list_) {
            const GltfMaterial material = gltf_material(scene_, scene_.material(index), warnings_);
            if (material.glossiness) extensions.insert(kGlossiness);
            if (material.clear_coat > 0) extensions.insert(kClearCoat);
            if (material.emissive_strength > 1) extensions.insert(kEmissiveStrength);
            converted_.push_back(material);
        }
        if (extensions.empty()) return;
        json_.open_array("extensionsUsed");
        for (const std::string_view extension : extensions) json_.string(extension);
        json_.close();
    }

    /// Ours without the root, unless it moves them all; cameras that do not look along -z get nodes of their
    /// own below.
    void write_nodes() {
        const std::vector<scene::Node>& nodes = scene_.nodes();
        const bool has_root = nodes[0].matrix != glm::dmat4(1);
        const int first = has_root ? 0 : 1;
        int next = static_cast<int>(nodes.size()) - first;
        std::vector<std::pair<scene::Index, int>> extra;  // cameras with a frame, and their nodes
        json_.open_array("nodes");
        for (std::size_t i = static_cast<std::size_t>(first); i < nodes.size(); ++i) {
            const auto* const camera = std::get_if<scene::CameraData>(&nodes[i].data);
            const bool framed = camera != nullptr && frame_of(*camera) != glm::dmat4(1);
            const bool below = framed && !nodes[i].children.empty();
            if (below) extra.emplace_back(static_cast<scene::Index>(i), next++);
            write_node(static_cast<scene::Index>(i), first,
                       framed && !below ? frame_of(*camera) : glm::dmat4(1),
                       below ? extra.back().second : scene::kNone);
        }
        for (const auto& [node, place] : extra) write_extra_camera(node);
        json_.close();
        json_.open_array("scenes").open_object().string(nodes[0].name, "name").open_array("nodes");
        if (has_root) json_.number(0);
        for (const scene::Index child : nodes[0].children)
            if (!has_root) json_.number(child - first);
        json_.close().close().close();
    }

    void write_node(scene::Index index, int first, const glm::dmat4& frame, int extra_child) {
        const scene::Node& node = scene_.nodes()[static_cast<std::size_t>(index)];
        json_.open_object().string(node.name, "name");
        if (const glm::dmat4 matrix = node.matrix * frame; matrix != glm::dmat4(1))
            json_.numbers(&matrix[0][0], 16, "matrix");
        if (!keeps_right_angles(node.matrix))
            warnings_.add(
                "a node's matrix shears or flattens, which glTF forbids: other programs may reject "
                "it");
        if (!node.children.empty() || extra_child != scene::kNone) {
            json_.open_array("children");
            for (const scene::Index child : node.children) json_.number(child - first);
            if (extra_child != scene::kNone) json_.number(extra_child);
            json_.close();
        }
        if (const auto mesh = mesh_of_node_.find(index); mesh != mesh_of_node_.end())
            json_.number(mesh->second, "mesh");
        if (node.type == scene::NodeType::camera && extra_child == scene::kNone) add_camera(index);
        if (node.type == scene::NodeType::light) add_light(index);
        json_.close();
    }

    void write_extra_camera(scene::Index index) {
        const scene::Node& node = scene_.nodes()[static_cast<std::size_t>(index)];
        const glm::dmat4 frame = frame_of(std::get<scene::CameraData>(node.data));
        json_.open_object().string(node.name + " camera", "name").numbers(&frame[0][0], 16, "matrix");
        add_camera(index);
        json_.close();
    }

    void add_camera(scene::Index node) {
        json_.number(cameras_.size(), "camera");
        cameras_.push_back(&std::get<scene::CameraData>(scene_.nodes()[static_cast<std::size_t>(node)].data));
    }

    void add_light(scene::Index node) {
        json_.open_object("extensions").open_object(kLights).number(lights_.size(), "light").close().close();
        lights_.push_back(&std::get<scene::LightData>(scene_.nodes()[static_cast<std::size_t>(node)].data));
    }

    void write_cameras_and_lights() {
        if (!cameras_.empty()) json_.open_array("cameras");
        for (const scene::CameraData* const camera : cameras_) {
            json_.open_object().string("perspective", "type").open_object("perspective");
            json_.number(glm::radians(camera->fov), "yfov").number(0.01, "znear").close();
            // What glTF has no member for; our reader reads it.
            json_.open_object("extras").number(glm::distance(camera->eye, camera->focus), "focusDistance");
            json_.close().close();
        }
        if (!cameras_.empty()) json_.close();
        if (lights_.empty()) return;
        json_.open_object("extensions").open_object(kLights).open_array("lights");
        for (const scene::LightData* const light : lights_) write_light(*light);
        json_.close().close().close();
    }

    void write_light(const scene::LightData& light) {
        constexpr std::string_view kTypes[] = {"point", "directional", "spot"};
        const glm::dvec3 color = base::linear_from_srgb(light.color);
        json_.open_object().string(kTypes[static_cast<std::size_t>(light.type)], "type");
        json_.numbers(&color[0], 3, "color");
        if (light.type == scene::LightData::Type::spot) {
            const double cone = glm::radians(std::max(light.angle, 0.1));
            json_.open_object("spot")
                .number(0.45 * cone, "innerConeAngle")
                .number(0.5 * cone, "outerConeAngle")
                .close();
        }
        json_.close();
        if (light.attenuation != glm::dvec3(1, 0, 0) && light.attenuation != glm::dvec3(0))
            warnings_.add("a light's attenuation is lost");
    }

    void write_meshes() {
        if (mesh_list_.empty()) return;
        json_.open_array("meshes");
        for (const auto& [geometry, material] : mesh_list_) {
            const GltfBinaryChunk::Accessors& accessors = buffer_.accessors_of(*geometry);
            json_.open_object().open_array("primitives").open_object().open_object("attributes");
            json_.number(accessors.positions, "POSITION");
            if (accessors.normals != scene::kNone) json_.number(accessors.normals, "NORMAL");
            if (accessors.texcoords != scene::kNone) json_.number(accessors.texcoords, "TEXCOORD_0");
            if (accessors.colors != scene::kNone) json_.number(accessors.colors, "COLOR_0");
            json_.close().number(accessors.indices, "indices").number(materials_.at(material), "material");
            json_.close().close().close();
        }
        json_.close();
    }

    void write_materials() {
        if (material_list_.empty()) return;
        json_.open_array("materials");
        for (std::size_t i = 0; i < material_list_.size(); ++i)
            write_material(scene_.material(material_list_[i]), converted_[i]);
        json_.close();
    }

    void write_material(const scene::Material& from, const GltfMaterial& material) {
        const glm::dvec4 base(material.base, material.alpha);
        const scene::Index surface = occlusion_roughness_metallic(from);
        json_.open_object().string(from.name, "name").open_object("pbrMetallicRoughness");
        json_.numbers(&base[0], 4, "baseColorFactor");
        json_.number(material.metallic, "metallicFactor").number(material.roughness, "roughnessFactor");
        write_texture(from.texture, "baseColorTexture");
        write_texture(surface, "metallicRoughnessTexture");
        json_.close();
        write_texture(surface, "occlusionTexture");
        write_normal_texture(from);
        if (material.emissive != glm::dvec3(0)) json_.numbers(&material.emissive[0], 3, "emissiveFactor");
        write_texture(from.emissive_texture, "emissiveTexture");
        if (material.blend) json_.string("BLEND", "alphaMode");
        if (from.two_sided) json_.boolean(true, "doubleSided");
        write_material_extensions(from, material);
        json_.close();
    }

    void write_material_extensions(const scene::Material& from, const GltfMaterial& material) {
        if (!material.glossiness && material.clear_coat == 0 && material.emissive_strength == 1) return;
        json_.open_object("extensions");
        if (material.glossiness) {
            const glm::dvec4 base(material.base, material.alpha);
            json_.open_object(kGlossiness).numbers(&base[0], 4, "diffuseFactor");
            json_.numbers(&material.glossiness->specular[0], 3, "specularFactor");
            json_.number(material.glossiness->glossiness, "glossinessFactor");
            write_texture(from.texture, "diffuseTexture");
            json_.close();
        }
        if (material.clear_coat > 0)
            json_.open_object(kClearCoat).number(material.clear_coat, "clearcoatFactor").close();
        if (material.emissive_strength > 1)
            json_.open_object(kEmissiveStrength)
                .number(material.emissive_strength, "emissiveStrength")
                .close();
        json_.close();
    }

    void write_texture(scene::Index texture, std::string_view name) {
        if (texture != scene::kNone) json_.open_object(name).number(images_.at(texture), "index").close();
    }

    void write_normal_texture(const scene::Material& from) {
        if (from.normal_texture == scene::kNone) return;
        json_.open_object("normalTexture").number(images_.at(from.normal_texture), "index");
        if (from.normal_scale != 1) json_.number(from.normal_scale, "scale");
        json_.close();
    }

    void write_textures() {
        if (buffer_.image_count() == 0) return;
        std::vector<scene::Sampler> samplers;
        json_.open_array("textures");
        for (const auto& [texture, own] : images_) {
            json_.open_object().number(own, "source");
            const scene::Sampler& sampler = scene_.textures()[static_cast<std::size_t>(texture)].sampler;
            if (sampler != scene::Sampler()) {
                json_.number(samplers.size(), "sampler");
                samplers.push_back(sampler);
            }
            json_.close();
        }
        json_.close();
        if (!samplers.empty()) json_.open_array("samplers");
        for (const scene::Sampler& sampler : samplers) {
            json_.open_object()
                .number(gltf_wrap(sampler.wraps[0]), "wrapS")
                .number(gltf_wrap(sampler.wraps[1]), "wrapT");
            if (sampler.magnification == scene::Magnification::nearest)
                json_.number(kGltfNearest, "magFilter");
            json_.close();
        }
        if (!samplers.empty()) json_.close();
        json_.open_array("images");
        for (std::size_t i = 0; i < buffer_.image_count(); ++i)
            json_.open_object()
                .number(buffer_.view_of_image(i), "bufferView")
                .string("image/png", "mimeType")
                .close();
        json_.close();
    }

    const scene::Scene& scene_;
    ConversionWarnings& warnings_;
    std::vector<ShownShape> shapes_;
    std::map<MeshKey, int> meshes_;
    std::vector<MeshKey> mesh_list_;
    std::map<scene::Index, int> mesh_of_node_, materials_, images_;  // places in the file
    std::vector<scene::Index> material_list_;
    std::vector<GltfMaterial> converted_;  // for each of them
    GltfBinaryChunk buffer_;
    std::vector<const scene::CameraData*> cameras_;
    std::vector<const scene::LightData*> lights_;
    JsonWriter json_;
    std::uint64_t size_ = 0;  // of the binary chunk
};

void write_words(std::ostream& out, std::initializer_list<std::uint64_t> words) {
    for (const std::uint64_t word : words) {
        const auto value = static_cast<std::uint32_t>(word);
        out.write(reinterpret_cast<const char*>(&value), 4);
    }
}

}  // namespace

void write_glb(const scene::Scene& scene, const std::filesystem::path& path, base::OutputFiles& files,
               ConversionWarnings& warnings, const WriteProgress& progress) {
    GlbWriter writer(scene, warnings);
    report_lost_nodes(scene, warnings);
    const std::string json = writer.describe();
    const std::uint64_t binary = writer.size(), all = 12 + 8 + json.size() + (binary > 0 ? 8 + binary : 0);
    if (all > UINT32_MAX) throw base::WriteError(path.string() + ": a GLB file cannot exceed 4 GiB");
    constexpr std::uint32_t kGltf = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;
    files.write(path, [&](std::ostream& out) {
        write_words(out, {kGltf, 2, all, json.size(), kJson});
        out << json;
        if (binary == 0) return;
        write_words(out, {binary, kBinary});
        writer.write_binary(out, progress);
    });
}

}  // namespace vrut::io
