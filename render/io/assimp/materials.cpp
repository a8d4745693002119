#include "io/assimp/materials.hpp"

#include <assimp/material.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "io/assimp/text.hpp"
#include "io/assimp/textures.hpp"

namespace vrut::io {

namespace {

double in_unit_range(double value) { return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 0.0; }

glm::dvec3 as_written(const aiColor4D& color) {
    return {in_unit_range(color.r), in_unit_range(color.g), in_unit_range(color.b)};
}

double number_of(const aiMaterial& material, const char* key, double otherwise) {
    float value = 0;
    const bool found = material.Get(key, 0, 0, value) == aiReturn_SUCCESS && std::isfinite(value);
    return found ? double{value} : otherwise;
}

double part_of(const aiMaterial& material, const char* key, double otherwise) {
    return in_unit_range(number_of(material, key, otherwise));
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
    if (const double exponent = number_of(from, "$mat.shininess", 0); exponent > 0) {
        const aiColor4D specular = color_of(from, "$clr.specular").value_or(black);
        material.specular = glm::dvec4(part_of(from, "$mat.shinpercent", 1) * as_written(specular), 1);
        material.shininess = std::clamp(exponent, 1.0, 10'000.0);
    }
    material.emission = glm::dvec4(as_written(color_of(from, "$clr.emissive").value_or(black)), 1);
    material.two_sided = true;
}

}  // namespace

scene::Material convert_material(const aiMaterial& from, const aiScene& scene,
                                 const std::filesystem::path& folder, AssimpFormat format,
                                 ConversionWarnings& warnings) {
    scene::Material material;
    aiString name;
    if (from.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS) material.name = text_of(name);
    convert_phong(from, format, material, warnings);
    material.ambient = glm::dvec4(glm::dvec3(material.diffuse) * 0.1, 1);
    set_texture_name(from, scene, folder, material, warnings);
    // In the other formats it takes the colour's place. Some programs write black with every texture.
    const glm::dvec3 color(material.diffuse);
    if (format == AssimpFormat::obj && !material.image.empty() && color != glm::dvec3(1) &&
        color != glm::dvec3(0))
        warnings.add("a texture is not multiplied by the diffuse colour");
    set_emissive_texture(from, scene, folder, material, warnings);
    report_unsupported_textures(from, warnings);
    return material;
}

}  // namespace vrut::io
