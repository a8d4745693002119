#include "assimp_materials.hpp"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "assimp_files.hpp"
#include "assimp_text.hpp"
#include "notices.hpp"
#include "picture_file.hpp"
#include "scene_pictures.hpp"
#include "tokenizer.hpp"

namespace vrut {

namespace {

double in_unit_range(double value) { return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 0.0; }

double displayed(double linear) {
    const double light = in_unit_range(linear);
    if (light == 1) return 1;  // which pow() misses
    return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

glm::dvec3 displayed(const aiColor4D& color) { return displayed_color({color.r, color.g, color.b}); }

double number_of(const aiMaterial& material, const char* key, double otherwise) {
    float value = 0;
    return material.Get(key, 0, 0, value) == aiReturn_SUCCESS ? in_unit_range(value) : otherwise;
}

std::optional<aiColor4D> color_of(const aiMaterial& material, const char* key) {
    aiColor4D color;
    if (material.Get(key, 0, 0, color) != aiReturn_SUCCESS) return std::nullopt;
    return color;
}

bool has_picture(const aiMaterial& material, aiTextureType type) {
    return material.GetTextureCount(type) > 0;
}

std::string alpha_mode(const aiMaterial& material) {
    aiString mode;
    return material.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == aiReturn_SUCCESS ? mode.C_Str() : "OPAQUE";
}

/// See assimp_scene.hpp.
double phong_exponent(double roughness) {
    const double sharpness = std::pow(std::max(roughness, 0.01), -4);
    return std::clamp((sharpness - 1) / 2, 1.0, 10'000.0);
}

void convert_highlight(const aiMaterial& from, Material& material) {
    constexpr double kDielectric = 0.22;  // how a reflectance of 4 % displays
    const double metallic = number_of(from, "$mat.metallicFactor", 0);
    const double roughness =
        1 - number_of(from, "$mat.glossinessFactor", 1 - number_of(from, "$mat.roughnessFactor", 1));
    const glm::dvec3 color(material.diffuse);
    glm::dvec3 reflected = kDielectric + (color - kDielectric) * metallic;
    if (const auto own = color_of(from, "$clr.specular")) reflected = displayed(*own);
    material.specular = glm::dvec4((1 - roughness) * reflected, 1);
    material.shininess = phong_exponent(roughness);
}

void name_picture(const aiMaterial& from, const std::filesystem::path& folder, Material& material,
                  Losses& losses) {
    aiString name;
    int set = 0, wrap = aiTextureMapMode_Wrap;
    from.Get(AI_MATKEY_TEXTURE(aiTextureType_DIFFUSE, 0), name);
    material.image = name_of_address(folder, text_of(name));
    if (from.Get(AI_MATKEY_UVWSRC(aiTextureType_DIFFUSE, 0), set) == aiReturn_SUCCESS && set != 0)
        losses.add("a picture is laid by the first texture coordinates, and not by others as the file says");
    for (const char* key : {"$tex.mapmodeu", "$tex.mapmodev"})
        if (from.Get(key, aiTextureType_DIFFUSE, 0, wrap) == aiReturn_SUCCESS &&
            wrap != aiTextureMapMode_Wrap)
            losses.add("a picture is repeated where the file clamps or mirrors it");
    if (glm::dvec3(material.diffuse) != glm::dvec3(1))
        losses.add("a picture's colours are shown as they are, and not multiplied by the base colour");
}

void tell_lost_pictures(const aiMaterial& from, Losses& losses) {
    constexpr std::pair<aiTextureType, const char*> kLost[] = {
        {aiTextureType_NORMALS, "a normal map is not shown"},
        {aiTextureType_METALNESS, "a picture of metal and roughness is not shown"},
        {aiTextureType_SPECULAR, "a picture of highlights is not shown"},
        {aiTextureType_LIGHTMAP, "a picture of occlusion is not shown"},
        {aiTextureType_EMISSIVE, "a picture that glows is not shown"},
    };
    for (const auto& [type, what] : kLost)
        if (has_picture(from, type)) losses.add(what);
}

using TextureResult = tl::expected<Index, std::string>;

TextureResult decode_embedded(aiScene& scene, const std::string& name, std::uint64_t max_pixels,
                              std::vector<Texture>& textures) {
    unsigned index = 0;
    const auto [end, error] = std::from_chars(name.data() + 1, name.data() + name.size(), index);
    if (error != std::errc() || end != name.data() + name.size() || index >= scene.mNumTextures)
        return tl::unexpected(std::string("there is no such picture in the file"));
    aiTexture& from = *scene.mTextures[index];
    if (from.mHeight != 0 || from.pcData == nullptr)
        return tl::unexpected(std::string("it is neither PNG nor JPEG"));
    auto image = decode_picture({reinterpret_cast<const char*>(from.pcData), from.mWidth}, max_pixels);
    delete[] from.pcData;  // each is decoded once
    from.pcData = nullptr;
    if (!image) return tl::unexpected(image.error());
    const bool transparent = has_transparent_pixel(*image);
    textures.push_back({name, *std::move(image), transparent});
    return static_cast<Index>(textures.size() - 1);
}

}  // namespace

glm::dvec3 displayed_color(const aiColor3D& color) {
    return {displayed(color.r), displayed(color.g), displayed(color.b)};
}

Material convert_material(const aiMaterial& from, const std::filesystem::path& folder, Losses& losses) {
    Material material;
    aiString name;
    if (from.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS) material.name = text_of(name);
    const aiColor4D base = color_of(from, "$clr.diffuse").value_or(aiColor4D(0.6F, 0.6F, 0.6F, 1));
    const bool blend = alpha_mode(from) == "BLEND";
    material.diffuse = glm::dvec4(displayed(base), blend ? in_unit_range(base.a) : 1);
    material.ambient = glm::dvec4(glm::dvec3(material.diffuse) * 0.1, 1);
    convert_highlight(from, material);
    if (const auto emission = color_of(from, "$clr.emissive");
        emission && !has_picture(from, aiTextureType_EMISSIVE))
        material.emission = glm::dvec4(displayed(*emission), 1);
    int two_sided = 0;
    material.two_sided = from.Get(AI_MATKEY_TWOSIDED, two_sided) == aiReturn_SUCCESS && two_sided != 0;
    if (has_picture(from, aiTextureType_DIFFUSE)) name_picture(from, folder, material, losses);
    tell_lost_pictures(from, losses);
    return material;
}

bool ignores_alpha(const aiMaterial& material) { return alpha_mode(material) == "OPAQUE"; }

void read_embedded_pictures(aiScene& scene, std::vector<Material>& materials, std::vector<Texture>& textures,
                            const std::string& file, std::vector<std::string>& notices) {
    Notices faults;
    std::map<std::string, TextureResult> known;
    std::uint64_t pixels_left = kMaxScenePixels;
    for (Material& material : materials) {
        if (!material.image.starts_with('*')) continue;
        auto found = known.find(material.image);
        if (found == known.end()) {
            found = known
                        .emplace(material.image,
                                 decode_embedded(scene, material.image,
                                                 std::min(pixels_left, kMaxPicturePixels), textures))
                        .first;
            if (found->second) pixels_left -= textures.back().image.rgba.size() / 4;
        }
        if (found->second)
            material.texture = *found->second;
        else
            faults.add(file + ": material " + std::to_string(material.id) +
                       " is drawn without its picture '" + excerpt(material.image) +
                       "': " + found->second.error());
        material.image.clear();  // no file that could be read
    }
    faults.append_to(notices);
}

void make_pictures_opaque(std::vector<Material>& materials, const std::vector<bool>& ignore_alpha,
                          std::vector<Texture>& textures) {
    std::vector<bool> keeps_alpha(textures.size());
    for (std::size_t i = 0; i < materials.size(); ++i)
        if (materials[i].texture != kNone && !ignore_alpha[i])
            keeps_alpha[static_cast<std::size_t>(materials[i].texture)] = true;
    std::map<Index, Index> opaque;  // by the picture that it was made from
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const Index from = materials[i].texture;
        if (from == kNone || !ignore_alpha[i] || !textures[static_cast<std::size_t>(from)].transparent)
            continue;
        const auto [found, is_new] = opaque.emplace(from, from);
        if (is_new && keeps_alpha[static_cast<std::size_t>(from)]) {
            found->second = static_cast<Index>(textures.size());
            textures.push_back(textures[static_cast<std::size_t>(from)]);
        }
        materials[i].texture = found->second;
    }
    for (const auto& [from, made] : opaque) {
        Texture& texture = textures[static_cast<std::size_t>(made)];
        for (std::size_t i = 3; i < texture.image.rgba.size(); i += 4) texture.image.rgba[i] = 255;
        texture.transparent = false;
    }
}

}  // namespace vrut
