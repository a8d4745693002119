#include "io/assimp/textures.hpp"

#include <assimp/GltfMaterial.h>

#include <charconv>
#include <cmath>
#include <map>

#include "io/assimp/files.hpp"
#include "io/assimp/text.hpp"
#include "io/image/image_file.hpp"
#include "io/notices.hpp"
#include "io/scene_textures.hpp"
#include "io/vrut/tokenizer.hpp"

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

/// As assimp looks for it: a texture inside the file may be meant by its number or by its name.
std::string name_of(const std::string& address, const aiScene& scene, const std::filesystem::path& folder,
                    AssimpFormat format) {
    if (format == AssimpFormat::gltf) return file_name_of_foreign_path(folder, address);
    const int number = scene.GetEmbeddedTextureAndIndex(address.c_str()).second;
    return number >= 0 ? "*" + std::to_string(number) : file_name_of_foreign_path(folder, address);
}

void report_unsupported_sampling(const aiMaterial& from, aiTextureType type, AssimpFormat format,
                                 ConversionWarnings& warnings) {
    int wrap = aiTextureMapMode_Wrap;
    if (format == AssimpFormat::gltf && texcoord_set_of(from) != 0)  // check_gltf() hides them from assimp
        warnings.add("a texture uses the first texture coordinates, not others as the file says");
    for (const char* key : {"$tex.mapmodeu", "$tex.mapmodev"})
        if (from.Get(key, type, 0, wrap) == aiReturn_SUCCESS && wrap != aiTextureMapMode_Wrap)
            warnings.add("a texture repeats where the file clamps or mirrors it");
    aiUVTransform shift;
    if (from.Get(AI_MATKEY_UVTRANSFORM(type, 0), shift) == aiReturn_SUCCESS &&
        (shift.mTranslation != aiVector2D(0, 0) || shift.mScaling != aiVector2D(1, 1) ||
         shift.mRotation != 0))
        warnings.add("a texture is drawn without the offset, scale and rotation of the file");
    if (from.GetTextureCount(type) > 1) warnings.add("only the first of several layered textures is shown");
}

using TextureResult = tl::expected<scene::Index, std::string>;

TextureResult decode_embedded(aiScene& scene, const std::string& name, std::uint64_t max_pixels,
                              std::vector<scene::Texture>& textures) {
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
    if (!image) return tl::unexpected(image.error());
    const bool transparent = has_transparent_pixel(*image);
    textures.push_back({name, *std::move(image), transparent});
    return static_cast<scene::Index>(textures.size() - 1);
}

}  // namespace

bool has_texture(const aiMaterial& material, aiTextureType type) {
    return material.GetTextureCount(type) > 0;
}

unsigned texcoord_set_of(const aiMaterial& material) {
    int set = 0;
    const aiTextureType type = color_texture_type(material);
    const bool told = material.Get(AI_MATKEY_UVWSRC(type, 0), set) == aiReturn_SUCCESS;
    return told && set > 0 && set < AI_MAX_NUMBER_OF_TEXTURECOORDS ? static_cast<unsigned>(set) : 0;
}

void set_texture_name(const aiMaterial& from, const aiScene& scene, const std::filesystem::path& folder,
                      AssimpFormat format, scene::Material& material, ConversionWarnings& warnings) {
    const aiTextureType type = color_texture_type(from);
    if (!has_texture(from, type)) return;
    material.image = name_of(texture_name(from, type), scene, folder, format);
    report_unsupported_sampling(from, type, format, warnings);
    if (glm::dvec3(material.diffuse) != glm::dvec3(1))
        warnings.add("a texture is not multiplied by the base or diffuse colour");
}

void report_unsupported_textures(const aiMaterial& from, ConversionWarnings& warnings) {
    constexpr std::pair<aiTextureType, const char*> kLost[] = {
        {aiTextureType_NORMALS, "a normal map is ignored"},
        {aiTextureType_HEIGHT, "a bump map is ignored"},
        {aiTextureType_DISPLACEMENT, "a displacement map is ignored"},
        {aiTextureType_METALNESS, "a metallic-roughness texture is ignored"},
        {aiTextureType_SPECULAR, "a specular texture is ignored"},
        {aiTextureType_SHININESS, "a shininess texture is ignored"},
        {aiTextureType_REFLECTION, "a reflection map is ignored"},
        {aiTextureType_LIGHTMAP, "an occlusion texture is ignored"},
        {aiTextureType_EMISSIVE, "an emissive texture is ignored"},
    };
    for (const auto& [type, what] : kLost)
        if (has_texture(from, type)) warnings.add(what);
    if (has_texture(from, aiTextureType_OPACITY) && ignores_alpha(from, AssimpFormat::obj))
        warnings.add("an opacity map that is not the diffuse texture is ignored");
}

std::string alpha_mode(const aiMaterial& material) {
    aiString mode;
    return material.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == aiReturn_SUCCESS ? mode.C_Str() : "OPAQUE";
}

bool ignores_alpha(const aiMaterial& material, AssimpFormat format) {
    if (format == AssimpFormat::gltf) return alpha_mode(material) == "OPAQUE";
    const std::string opacity = texture_name(material, aiTextureType_OPACITY);
    return opacity.empty() || opacity != texture_name(material, color_texture_type(material));
}

void decode_embedded_textures(aiScene& scene, std::vector<scene::Material>& materials,
                              std::vector<scene::Texture>& textures, const std::string& file,
                              std::vector<std::string>& notices) {
    Notices faults;
    std::map<std::string, TextureResult> known;
    std::uint64_t pixels_left = kMaxTexturePixels;
    for (scene::Material& material : materials) {
        if (!material.image.starts_with('*')) continue;
        auto found = known.find(material.image);
        if (found == known.end()) {
            found = known
                        .emplace(material.image,
                                 decode_embedded(scene, material.image,
                                                 std::min(pixels_left, kMaxImagePixels), textures))
                        .first;
            if (found->second) pixels_left -= textures.back().image.rgba.size() / 4;
        }
        if (found->second)
            material.texture = *found->second;
        else
            faults.add(file + ": material " + std::to_string(material.id) +
                       " is drawn without its texture '" + excerpt(material.image) +
                       "': " + found->second.error());
        material.image.clear();  // no file that could be read
    }
    faults.append_to(notices);
}

void make_textures_opaque(std::vector<scene::Material>& materials, const std::vector<bool>& ignore_alpha,
                          std::vector<scene::Texture>& textures) {
    std::vector<bool> keeps_alpha(textures.size());
    for (std::size_t i = 0; i < materials.size(); ++i)
        if (materials[i].texture != scene::kNone && !ignore_alpha[i])
            keeps_alpha[static_cast<std::size_t>(materials[i].texture)] = true;
    std::map<scene::Index, scene::Index> opaque;  // by the texture that it was made from
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const scene::Index from = materials[i].texture;
        if (from == scene::kNone || !ignore_alpha[i] || !textures[static_cast<std::size_t>(from)].transparent)
            continue;
        const auto [found, is_new] = opaque.emplace(from, from);
        if (is_new && keeps_alpha[static_cast<std::size_t>(from)]) {
            found->second = static_cast<scene::Index>(textures.size());
            textures.push_back(textures[static_cast<std::size_t>(from)]);
        }
        materials[i].texture = found->second;
    }
    for (const auto& [from, made] : opaque) {
        scene::Texture& texture = textures[static_cast<std::size_t>(made)];
        for (std::size_t i = 3; i < texture.image.rgba.size(); i += 4) texture.image.rgba[i] = 255;
        texture.transparent = false;
    }
}

}  // namespace vrut::io
