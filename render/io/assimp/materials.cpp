#include "io/assimp/materials.hpp"

#include <assimp/material.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/srgb.hpp"
#include "io/assimp/text.hpp"
#include "io/assimp/textures.hpp"

namespace vrut::io {

namespace {

double in_unit_range(double value) { return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 0.0; }

glm::dvec3 as_written(const aiColor4D& color) {
    return {in_unit_range(color.r), in_unit_range(color.g), in_unit_range(color.b)};
}

std::optional<double> number_of(const aiMaterial& material, const char* key) {
    float value = 0;
    if (material.Get(key, 0, 0, value) != aiReturn_SUCCESS || !std::isfinite(value)) return std::nullopt;
    return value;
}

double part_of(const aiMaterial& material, const char* key, double otherwise) {
    return in_unit_range(number_of(material, key).value_or(otherwise));
}

std::optional<aiColor4D> color_of(const aiMaterial& material, const char* key) {
    aiColor4D color;
    if (material.Get(key, 0, 0, color) != aiReturn_SUCCESS) return std::nullopt;
    return color;
}

/// Colours and exponent of Phong's model.
void convert_phong(const aiMaterial& from, AssimpFormat format, scene::Material& material,
                   ConversionWarnings& warnings) {
    const aiColor4D white(1, 1, 1, 1), black(0, 0, 0, 1);
    const bool none_told = format == AssimpFormat::stl || format == AssimpFormat::ply;
    const aiColor4D diffuse = color_of(from, "$clr.diffuse").value_or(white);
    if (!none_told || diffuse != white)  // which assimp makes up
        material.diffuse = glm::dvec4(as_written(diffuse), 1);
    if (!has_texture(from, aiTextureType_OPACITY)) material.diffuse.a = part_of(from, "$mat.opacity", 1);
    if (material.diffuse.a == 0) {  // as programs write it that take 1 for transparent
        material.diffuse.a = 1;
        warnings.add("a material is opaque, though its file calls it wholly transparent");
    }
    if (const double exponent = number_of(from, "$mat.shininess").value_or(0); exponent > 0) {
        const aiColor4D specular = color_of(from, "$clr.specular").value_or(black);
        material.specular = glm::dvec4(part_of(from, "$mat.shinpercent", 1) * as_written(specular), 1);
        material.shininess = std::clamp(exponent, 1.0, 10'000.0);
    }
    material.emission = glm::dvec4(as_written(color_of(from, "$clr.emissive").value_or(black)), 1);
    material.two_sided = true;
}

/// Where assimp has a surface by metal and roughness.
struct MetallicRoughnessKeys {
    const char *metallic, *roughness, *clear_coat, *base_color;
};
constexpr MetallicRoughnessKeys kMetallicRoughnessKeys[] = {
    // OBJ (Pm, Pr, Pc), and FBX of Maya's Stingray
    {"$mat.metallicFactor", "$mat.roughnessFactor", "$mat.clearcoat.factor", "$clr.base"},
    // FBX of 3ds Max: the Physical and the PBR material
    {"$raw.3dsMax|Parameters|metalness", "$raw.3dsMax|Parameters|roughness", "$raw.3dsMax|Parameters|coating",
     "$raw.3dsMax|Parameters|base_color"},
    {"$raw.3dsMax|main|metalness", "$raw.3dsMax|main|roughness", "", "$raw.3dsMax|main|basecolor"},
    // FBX of Maya: the Standard Surface, and Arnold's
    {"$raw.Maya|metalness", "$raw.Maya|specularRoughness", "$raw.Maya|coat", "$raw.Maya|baseColor"},
};

/// Where the file tells it. In FBX assimp makes up a roughness for each exponent.
void convert_metallic_roughness(const aiMaterial& from, AssimpFormat format, scene::Material& material) {
    for (const MetallicRoughnessKeys& keys : kMetallicRoughnessKeys) {
        const bool is_roughness_told = format != AssimpFormat::fbx && number_of(from, keys.roughness);
        if (!number_of(from, keys.metallic) && !is_roughness_told) continue;
        const double roughness = part_of(from, keys.roughness, 1);
        const bool is_glossiness = number_of(from, "$raw.3dsMax|Parameters|roughness_inv").value_or(0) != 0;
        material.metallic_roughness = {part_of(from, keys.metallic, 0),
                                       is_glossiness ? 1 - roughness : roughness,
                                       part_of(from, keys.clear_coat, 0)};
        if (const auto color = color_of(from, keys.base_color))
            material.diffuse = glm::dvec4(as_written(*color), material.diffuse.a);
        material.emissive = base::linear_from_srgb(glm::dvec3(material.emission));
        material.emission = {0, 0, 0, 1};
        return;
    }
}

}  // namespace

scene::Material convert_material(const aiMaterial& from, const aiScene& scene,
                                 const std::filesystem::path& folder, AssimpFormat format,
                                 ConversionWarnings& warnings) {
    scene::Material material;
    aiString name;
    if (from.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS) material.name = text_of(name);
    convert_phong(from, format, material, warnings);
    convert_metallic_roughness(from, format, material);
    material.ambient = glm::dvec4(glm::dvec3(material.diffuse) * 0.1, 1);
    set_texture_name(from, scene, folder, material, warnings);
    // In the other formats it takes the colour's place. Some programs write black with every texture.
    const glm::dvec3 color(material.diffuse);
    if (format == AssimpFormat::obj && !material.image.empty() && color != glm::dvec3(1) &&
        color != glm::dvec3(0))
        warnings.add("a texture is not multiplied by the diffuse colour");
    set_emissive_texture(from, scene, folder, material, warnings);
    set_normal_texture(from, scene, folder, material, warnings);
    report_unsupported_textures(from, warnings);
    return material;
}

}  // namespace vrut::io
