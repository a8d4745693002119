#include "io/osb/materials.hpp"

#include <algorithm>

#include "base/utf8.hpp"
#include "io/image/image_file.hpp"
#include "io/scene_textures.hpp"

namespace vrut::io {

namespace {

constexpr double kSceneLight = 0.2;         // how much light OpenGL's ambient colours meet
constexpr std::int32_t kBackFaces = 0x405;  // GL_BACK

glm::dvec4 color(const OsbContainer& from, std::string_view field, double otherwise, double alpha) {
    return {glm::clamp(from.vec3(field, glm::dvec3(otherwise)), 0.0, 1.0), alpha};
}

/// What a SimpleMaterial and a MaterialChunk have in common.
void read_phong(const OsbContainer& from, double alpha, scene::Material& material) {
    material.ambient = color(from, "ambient", 0, 1) * glm::dvec4(kSceneLight, kSceneLight, kSceneLight, 1);
    material.diffuse = color(from, "diffuse", 0, alpha);
    material.specular = color(from, "specular", 0, 1);
    material.emission = color(from, "emission", 0, 1);
    material.shininess = std::clamp(from.real("shininess", 0), 0.0, 10'000.0);
    if (from.flag("lit", true)) return;
    material.emission = glm::dvec4(glm::dvec3(material.diffuse), 1);
    material.ambient = material.specular = {0, 0, 0, 1};
    material.diffuse = {0, 0, 0, alpha};
}

/// By GL's number of the format; 0 for others.
std::size_t channels_of(std::int32_t pixel_format) {
    switch (pixel_format) {
        case 0x1909:
            return 1;  // luminance
        case 0x190A:
            return 2;  // with alpha
        case 0x1907:
            return 3;  // RGB
        case 0x1908:
            return 4;  // RGBA
        default:
            return 0;
    }
}

/// Both have their rows from the bottom up.
scene::Image image_of(std::string_view pixels, int width, int height, std::size_t channels) {
    scene::Image image;
    image.width = width;
    image.height = height;
    image.rgba.reserve(pixels.size() / channels * 4);
    for (std::size_t at = 0; at < pixels.size(); at += channels) {
        const std::string_view from = pixels.substr(at, channels);
        for (std::size_t c = 0; c < 3; ++c)
            image.rgba.push_back(static_cast<std::uint8_t>(from[channels < 3 ? 0 : c]));
        image.rgba.push_back(channels % 2 == 1 ? 255 : static_cast<std::uint8_t>(from[channels - 1]));
    }
    return image;
}

}  // namespace

scene::Index OsbMaterials::take(std::uint32_t id) {
    const auto [found, is_new] = known_.emplace(id, scene::kNone);
    const OsbContainer* const from = file_.find(id);
    if (!is_new || from == nullptr) return found->second;
    const bool simple = from->type == "SimpleMaterial" || from->type == "SimpleTexturedMaterial";
    if (!simple && from->type != "ChunkMaterial") return scene::kNone;
    scene::Material material;
    material.id = static_cast<scene::Id>(all.size());
    material.name = osb_name(file_, *from);
    material.two_sided = true;
    if (simple) read_simple(*from, material);
    read_chunks(*from, material);
    all.push_back(std::move(material));
    return found->second = static_cast<scene::Index>(all.size() - 1);
}

void OsbMaterials::read_simple(const OsbContainer& from, scene::Material& material) {
    read_phong(from, 1 - std::clamp(from.real("transparency", 0), 0.0, 1.0), material);
    read_image(from.pointer("image"), material);
}

void OsbMaterials::read_chunks(const OsbContainer& from, scene::Material& material) {
    auto ids = from.find("chunks");
    for (std::size_t left = ids ? ids->take_count(4, "a count") : 0; left > 0; --left) {
        const OsbContainer* const chunk = file_.find(ids->take_unsigned(4, "an id"));
        if (chunk == nullptr) continue;
        if (chunk->type == "MaterialChunk") {
            auto diffuse = chunk->find("diffuse");
            if (diffuse) diffuse->take_vec3("a colour");
            const double alpha = diffuse ? std::clamp(diffuse->take_real("an alpha"), 0.0, 1.0) : 1;
            read_phong(*chunk, alpha, material);
        } else if (chunk->type == "PolygonChunk") {
            material.two_sided = chunk->integer("cullFace", 0) != kBackFaces;
        } else if (chunk->type == "TextureChunk") {
            read_image(chunk->pointer("image"), material);
        }
    }
}

void OsbMaterials::read_image(std::uint32_t id, scene::Material& material) {
    const OsbContainer* const image = file_.find(id);
    if (image == nullptr || image->type != "Image") return;
    const auto pixels = image->find("pixel");
    auto name = image->find("name");
    if (pixels && pixels->left() > 4) {
        const auto [found, is_new] = known_textures_.emplace(id, scene::kNone);
        if (is_new) found->second = decode(*image, *pixels);
        material.texture = found->second;
    } else if (image->find("cpixel")) {
        warnings_.add("a compressed embedded texture is ignored");
    } else if (name) {
        const std::string_view file = name->take_string("a name");
        if (file.size() < 1000) material.image = file.substr(0, base::find_invalid_utf8(file));
    }
}

scene::Index OsbMaterials::decode(const OsbContainer& image, OsbCursor pixels) {
    constexpr std::int32_t kBytes = 0x1401;  // GL_UNSIGNED_BYTE
    const std::int32_t width = image.integer("width", 0), height = image.integer("height", 0);
    const std::size_t channels = channels_of(image.integer("pixelFormat", 0));
    const std::size_t at = pixels.at(), size = pixels.take_count(1, "a count of bytes");
    if (channels == 0 || image.integer("dataType", kBytes) != kBytes || image.integer("depth", 1) > 1) {
        warnings_.add(
            "an embedded texture is ignored: only two-dimensional ones of 8-bit channels are supported");
        return scene::kNone;
    }
    const std::uint64_t pixel_count = std::uint64_t(std::max(width, 0)) * std::uint64_t(std::max(height, 0));
    if (pixel_count == 0 || pixel_count > size / channels)
        throw OsbError(at,
                       "the pixels of an image of " + std::to_string(width) + " x " + std::to_string(height),
                       std::to_string(size));
    if (pixel_count > kMaxImagePixels || std::max(width, height) > static_cast<std::int32_t>(kMaxImageSide)) {
        warnings_.add("an embedded texture is ignored: it exceeds the size limit");
        return scene::kNone;
    }
    const std::string_view bytes = pixels.take(static_cast<std::size_t>(pixel_count) * channels, "pixels");
    scene::Texture texture{"", image_of(bytes, width, height, channels), false};
    texture.transparent = has_transparent_pixel(texture.image);
    textures.push_back(std::move(texture));
    return static_cast<scene::Index>(textures.size() - 1);
}

}  // namespace vrut::io
