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

double srgb_encoded(double linear) {
    const double light = in_unit_range(linear);
    if (light == 1) return 1;  // which pow() misses
    return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

glm::dvec3 srgb_encoded(const aiColor4D& color) { return srgb_from_linear({color.r, color.g, color.b}); }

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

/// See assimp_scene.hpp.
double phong_exponent(double roughness) {
    const double sharpness = std::pow(std::max(roughness, 0.01), -4);
    return std::clamp((sharpness - 1) / 2, 1.0, 10'000.0);
}

void convert_highlight(const aiMaterial& from, scene::Material& material) {
    constexpr double kDielectric = 0.22;  // how a reflectance of 4 % displays
    const double metallic = part_of(from, "$mat.metallicFactor", 0);
    const double roughness =
        1 - part_of(from, "$mat.glossinessFactor", 1 - part_of(from, "$mat.roughnessFactor", 1));
    const glm::dvec3 color(material.diffuse);
    glm::dvec3 reflected = kDielectric + (color - kDielectric) * metallic;
    if (const auto own = color_of(from, "$clr.specular")) reflected = srgb_encoded(*own);
    material.specular = glm::dvec4((1 - roughness) * reflected, 1);
    material.shininess = phong_exponent(roughness);
}

/// Metal and roughness.
void convert_metallic_roughness(const aiMaterial& from, scene::Material& material) {
    const aiColor4D base = color_of(from, "$clr.diffuse").value_or(aiColor4D(0.6F, 0.6F, 0.6F, 1));
    material.diffuse =
        glm::dvec4(srgb_encoded(base), alpha_mode(from) == "BLEND" ? in_unit_range(base.a) : 1);
    convert_highlight(from, material);
    if (const auto emission = color_of(from, "$clr.emissive"))
        material.emission = glm::dvec4(srgb_encoded(*emission), 1);
    int two_sided = 0;
    material.two_sided = from.Get(AI_MATKEY_TWOSIDED, two_sided) == aiReturn_SUCCESS && two_sided != 0;
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

glm::dvec3 srgb_from_linear(const aiColor3D& color) {
    return {srgb_encoded(color.r), srgb_encoded(color.g), srgb_encoded(color.b)};
}

scene::Material convert_material(const aiMaterial& from, const aiScene& scene,
                                 const std::filesystem::path& folder, AssimpFormat format,
                                 ConversionWarnings& warnings) {
    scene::Material material;
    aiString name;
    if (from.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS) material.name = text_of(name);
    if (format == AssimpFormat::gltf)
        convert_metallic_roughness(from, material);
    else
        convert_phong(from, format, material, warnings);
    material.ambient = glm::dvec4(glm::dvec3(material.diffuse) * 0.1, 1);
    if (has_texture(from, aiTextureType_EMISSIVE)) material.emission = {0, 0, 0, 1};
    set_texture_name(from, scene, folder, format, material, warnings);
    report_unsupported_textures(from, warnings);
    return material;
}

}  // namespace vrut::io
