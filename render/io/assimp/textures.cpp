#include "io/assimp/textures.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/srgb.hpp"
#include "io/assimp/text.hpp"
#include "io/foreign_paths.hpp"
#include "io/image/image_file.hpp"

namespace vrut::io {

namespace {

std::string texture_name(const aiMaterial& material, aiTextureType type) {
    aiString name;
    return material.Get(AI_MATKEY_TEXTURE(type, 0), name) == aiReturn_SUCCESS ? text_of(name) : "";
}

/// The texture of the colour; of some materials it is called another thing than of most.
aiTextureType color_texture_type(const aiMaterial& material) {
    return has_texture(material, aiTextureType_DIFFUSE) ? aiTextureType_DIFFUSE : aiTextureType_BASE_COLOR;
}

aiTextureType normal_texture_type(const aiMaterial& material) {
    return has_texture(material, aiTextureType_NORMALS) ? aiTextureType_NORMALS : aiTextureType_NORMAL_CAMERA;
}

/// As assimp looks for it: a texture inside the file may be meant by its number or by its name.
std::string name_of(const std::string& address, const aiScene& scene, const std::filesystem::path& folder) {
    const int number = scene.GetEmbeddedTextureAndIndex(address.c_str()).second;
    return number >= 0 ? "*" + std::to_string(number) : file_name_of_foreign_path(folder, address);
}

/// A decal is meant to end at its edge; where its edge is clear, clamping shows the same.
scene::Wrap wrap_of(const aiMaterial& from, aiTextureType type, const char* key) {
    int mode = aiTextureMapMode_Wrap;
    if (from.Get(key, type, 0, mode) != aiReturn_SUCCESS) return scene::Wrap::repeat;
    return mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal ? scene::Wrap::clamp
           : mode == aiTextureMapMode_Mirror                                ? scene::Wrap::mirror
                                                                            : scene::Wrap::repeat;
}

/// All images of a material lie as its first one does.
void set_sampling(const aiMaterial& from, aiTextureType type, bool first, scene::Material& material,
                  ConversionWarnings& warnings) {
    const scene::Sampler sampler{
        {wrap_of(from, type, "$tex.mapmodeu"), wrap_of(from, type, "$tex.mapmodev")}};
    if (first) material.sampler = sampler;
    if (material.sampler != sampler)
        warnings.add(
            "a texture goes on beyond its edges as the material's first texture does, not as the file says");
    aiUVTransform shift;
    if (from.Get(AI_MATKEY_UVTRANSFORM(type, 0), shift) == aiReturn_SUCCESS &&
        (shift.mTranslation != aiVector2D(0, 0) || shift.mScaling != aiVector2D(1, 1) ||
         shift.mRotation != 0))
        warnings.add("a texture is drawn without the offset, scale and rotation of the file");
    if (from.GetTextureCount(type) > 1) warnings.add("only the first of several layered textures is shown");
}

}  // namespace

bool has_texture(const aiMaterial& material, aiTextureType type) {
    return material.GetTextureCount(type) > 0;
}

unsigned texcoord_set_of(const aiMaterial& material) {
    int set = 0;
    const aiTextureType color = color_texture_type(material);
    const aiTextureType type = has_texture(material, color) ? color : normal_texture_type(material);
    const bool told = material.Get(AI_MATKEY_UVWSRC(type, 0), set) == aiReturn_SUCCESS;
    return told && set > 0 && set < AI_MAX_NUMBER_OF_TEXTURECOORDS ? static_cast<unsigned>(set) : 0;
}

void set_texture_name(const aiMaterial& from, const aiScene& scene, const std::filesystem::path& folder,
                      scene::Material& material, ConversionWarnings& warnings) {
    const aiTextureType type = color_texture_type(from);
    if (!has_texture(from, type)) return;
    material.image = name_of(texture_name(from, type), scene, folder);
    set_sampling(from, type, true, material, warnings);
}

void set_emissive_texture(const aiMaterial& from, const aiScene& scene, const std::filesystem::path& folder,
                          scene::Material& material, ConversionWarnings& warnings) {
    if (!has_texture(from, aiTextureType_EMISSIVE)) return;
    material.emissive += base::linear_from_srgb(glm::dvec3(material.emission));
    if (material.emissive == glm::dvec3(0)) material.emissive = glm::dvec3(1);
    material.emission = {0, 0, 0, 1};
    material.emissive_image = name_of(texture_name(from, aiTextureType_EMISSIVE), scene, folder);
    set_sampling(from, aiTextureType_EMISSIVE, material.image.empty(), material, warnings);
}

void set_normal_texture(const aiMaterial& from, const aiScene& scene, const std::filesystem::path& folder,
                        scene::Material& material, ConversionWarnings& warnings) {
    const aiTextureType type = normal_texture_type(from);
    if (!has_texture(from, type)) return;
    material.normal_image = name_of(texture_name(from, type), scene, folder);
    float scale = 1;
    const bool told = from.Get(AI_MATKEY_BUMPSCALING, scale) == aiReturn_SUCCESS ||
                      from.Get("$tex.bumpmult", type, 0, scale) == aiReturn_SUCCESS;
    if (told && std::isfinite(scale)) material.normal_scale = std::clamp<double>(scale, -1000, 1000);
    const bool first = material.image.empty() && material.emissive_image.empty();
    set_sampling(from, type, first, material, warnings);
}

void report_unsupported_textures(const aiMaterial& from, ConversionWarnings& warnings) {
    constexpr std::pair<aiTextureType, const char*> kLost[] = {
        {aiTextureType_HEIGHT, kIgnoredBumpMap},
        {aiTextureType_DISPLACEMENT, "a displacement map is ignored"},
        {aiTextureType_METALNESS, "a metallic texture is ignored"},
        {aiTextureType_DIFFUSE_ROUGHNESS, "a roughness texture is ignored"},
        {aiTextureType_SPECULAR, "a specular texture is ignored"},
        {aiTextureType_SHININESS, "a shininess texture is ignored"},
        {aiTextureType_REFLECTION, "a reflection map is ignored"},
        {aiTextureType_LIGHTMAP, "an occlusion texture is ignored"},
        {aiTextureType_AMBIENT_OCCLUSION, "an occlusion texture is ignored"},
    };
    for (const auto& [type, what] : kLost)
        if (has_texture(from, type)) warnings.add(what);
    if (has_texture(from, aiTextureType_OPACITY) && ignores_alpha(from))
        warnings.add("an opacity map that is not the diffuse texture is ignored");
}

bool is_grey(const scene::Image& image) {
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        const auto [least, most] = std::minmax({image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]});
        if (most - least > 8) return false;
    }
    return true;
}

bool ignores_alpha(const aiMaterial& material) {
    const std::string opacity = texture_name(material, aiTextureType_OPACITY);
    return opacity.empty() || opacity != texture_name(material, color_texture_type(material));
}

tl::expected<scene::Image, std::string> decode_embedded_texture(aiScene& scene, const std::string& name,
                                                                std::uint64_t max_pixels) {
    unsigned index = 0;
    const auto [end, error] = std::from_chars(name.data() + 1, name.data() + name.size(), index);
    if (error != std::errc() || end != name.data() + name.size() || index >= scene.mNumTextures)
        return tl::unexpected(std::string("the file has no such embedded texture"));
    aiTexture& from = *scene.mTextures[index];
    if (from.mHeight != 0 || from.pcData == nullptr)
        return tl::unexpected(std::string("its pixels are not in an image file"));
    auto image = decode_image({reinterpret_cast<const char*>(from.pcData), from.mWidth}, max_pixels);
    delete[] from.pcData;  // each is decoded once
    from.pcData = nullptr;
    return image;
}

}  // namespace vrut::io
