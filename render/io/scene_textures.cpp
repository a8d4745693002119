#include "io/scene_textures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "base/file_bytes.hpp"
#include "base/srgb.hpp"
#include "io/image/image_file.hpp"
#include "io/notices.hpp"
#include "io/vrut/tokenizer.hpp"

namespace vrut::io {

namespace {

namespace fs = std::filesystem;

using TextureResult = tl::expected<scene::Index, std::string>;

struct FoundFile {
    fs::path path;
    std::string name;  ///< relative to the scene's folder, or absolute
};

class TextureReader {
public:
    TextureReader(scene::SceneParts& parts, const fs::path& scene_file, const ReadProgress& progress,
                  const std::vector<fs::path>& folders, std::uint64_t max_pixels)
        : textures_(parts.textures),
          folder_(scene_file.parent_path()),
          folders_(folders),
          progress_(progress),
          pixels_left_(max_pixels) {
        for (const scene::Texture& texture : textures_)
            pixels_left_ -= std::min<std::uint64_t>(pixels_left_, texture.image.rgba.size() / 4);
    }

    TextureResult read(const std::string& name) {
        const auto file = find(name);
        if (!file) return tl::unexpected(file.error());
        const std::string path = file->path.string();
        if (const auto known = known_.find(path); known != known_.end()) return known->second;
        if (progress_) progress_(1);
        return known_.emplace(path, read_new(*file)).first->second;
    }

private:
    tl::expected<FoundFile, std::string> find(const std::string& name) const {
        const auto file = base::find_below(folder_, name);
        if (file) return FoundFile{*file, name};
        const std::string last = name.substr(name.rfind('/') + 1);
        for (const fs::path& folder : folders_)
            if (const auto found = base::find_below(folder, last)) return FoundFile{*found, found->string()};
        return tl::unexpected(file.error());
    }

    TextureResult read_new(const FoundFile& file) {
        auto image = read_image_file(file.path, std::min(pixels_left_, kMaxImagePixels));
        if (!image) return tl::unexpected(image.error());
        pixels_left_ -= image->rgba.size() / 4;
        const bool transparent = has_transparent_pixel(*image);
        textures_.push_back({file.name, *std::move(image), transparent});
        return static_cast<scene::Index>(textures_.size() - 1);
    }

    std::vector<scene::Texture>& textures_;
    const fs::path folder_;
    const std::vector<fs::path>& folders_;
    const ReadProgress& progress_;
    std::uint64_t pixels_left_;
    std::map<std::string, TextureResult> known_;  // by the file's own path
};

using CubeResult = tl::expected<std::array<scene::Index, 6>, std::string>;

CubeResult read_cube(TextureReader& reader, const std::vector<scene::Texture>& textures,
                     const std::array<std::string, 6>& names) {
    std::array<scene::Index, 6> faces{};
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const TextureResult face = reader.read(names[i]);
        if (!face) return tl::unexpected("'" + excerpt(names[i]) + "': " + face.error());
        faces[i] = *face;
    }
    const int side = textures[static_cast<std::size_t>(faces[0])].image.width;
    for (std::size_t i = 0; i < faces.size(); ++i)
        if (const scene::Image& image = textures[static_cast<std::size_t>(faces[i])].image;
            image.width != side || image.height != side)
            return tl::unexpected("its six images must be squares of one size, but '" + excerpt(names[i]) +
                                  "' is " + std::to_string(image.width) + " x " +
                                  std::to_string(image.height) + " pixels");
    return faces;
}

/// A change that has an effect on its texture, by the members of TextureChange.
using ChangeKey = std::tuple<bool, double, double, double, double, bool>;
constexpr ChangeKey kUnchanged{false, 1, 1, 1, 1, true};

ChangeKey key_of(const TextureChange& change, const scene::Texture& texture) {
    return {change.opaque && texture.transparent,
            change.factor.r,
            change.factor.g,
            change.factor.b,
            change.occlusion,
            change.roughness_metallic};
}

std::uint8_t displayed_byte(double light) {
    return static_cast<std::uint8_t>(std::lround(255 * base::srgb_from_linear(light)));
}

void apply(const ChangeKey& change, scene::Texture& texture) {
    const auto [opaque, red, green, blue, occlusion, roughness_metallic] = change;
    std::array<std::array<std::uint8_t, 256>, 3> multiplied{};
    for (std::size_t i = 0; i < 256; ++i) {
        const double light = base::linear_from_srgb(static_cast<double>(i) / 255);
        multiplied[0][i] = displayed_byte(red * light);
        multiplied[1][i] = displayed_byte(green * light);
        multiplied[2][i] = displayed_byte(blue * light);
    }
    std::vector<std::uint8_t>& rgba = texture.image.rgba;
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        for (std::size_t k = 0; k < 3; ++k) rgba[i + k] = multiplied[k][rgba[i + k]];
        if (opaque) rgba[i + 3] = 255;
        if (occlusion != 1)
            rgba[i] = static_cast<std::uint8_t>(std::lround(255 - occlusion * (255 - rgba[i])));
        if (!roughness_metallic) rgba[i + 1] = rgba[i + 2] = 255;
    }
    if (opaque) texture.transparent = false;
}

}  // namespace

bool has_transparent_pixel(const scene::Image& image) {
    for (std::size_t i = 3; i < image.rgba.size(); i += 4)
        if (image.rgba[i] < 255) return true;
    return false;
}

void read_textures(scene::SceneParts& parts, const fs::path& scene_file, const ReadProgress& progress,
                   const std::vector<fs::path>& folders, std::uint64_t max_pixels) {
    TextureReader reader(parts, scene_file, progress, folders, max_pixels);
    Notices notices;
    const auto say = [&](const std::string& what) { notices.add(scene_file.string() + ": " + what); };
    const auto read = [&](const scene::Material& material, const std::string& image, scene::Index& texture) {
        if (image.empty()) return;
        if (const TextureResult found = reader.read(image))
            texture = *found;
        else
            say("material " + std::to_string(material.id) + " is drawn without its texture '" +
                excerpt(image) + "': " + found.error());
    };
    for (scene::Material& material : parts.materials) {
        read(material, material.image, material.texture);
        read(material, material.emissive_image, material.emissive_texture);
        read(material, material.occlusion_roughness_metallic_image,
             material.occlusion_roughness_metallic_texture);
        read(material, material.normal_image, material.normal_texture);
    }
    for (auto& [node, parent_id, line] : parts.nodes) {
        auto* background = std::get_if<scene::BackgroundData>(&node.data);
        if (!background || !background->cube_map) continue;
        if (const CubeResult faces = read_cube(reader, parts.textures, *background->cube_map))
            background->cube_textures = *faces;
        else
            say("background " + std::to_string(node.id) + " is drawn without its cube map: " + faces.error());
    }
    notices.append_to(parts.notices);
}

void decode_embedded_textures(scene::SceneParts& parts, const fs::path& scene_file,
                              const EmbeddedDecoder& decode) {
    std::map<std::string, TextureResult> known;
    std::uint64_t pixels_left = kMaxTexturePixels;
    const auto decode_new = [&](const std::string& name) -> TextureResult {
        auto image = decode(name, std::min(pixels_left, kMaxImagePixels));
        if (!image) return tl::unexpected(image.error());
        pixels_left -= image->rgba.size() / 4;
        const bool transparent = has_transparent_pixel(*image);
        parts.textures.push_back({name, *std::move(image), transparent});
        return static_cast<scene::Index>(parts.textures.size() - 1);
    };
    Notices notices;
    const auto find = [&](const scene::Material& material, std::string& image, scene::Index& texture) {
        if (!image.starts_with('*')) return;
        auto found = known.find(image);
        if (found == known.end()) found = known.emplace(image, decode_new(image)).first;
        if (found->second)
            texture = *found->second;
        else
            notices.add(scene_file.string() + ": material " + std::to_string(material.id) +
                        " is drawn without its texture '" + excerpt(image) + "': " + found->second.error());
        image.clear();  // no file that could be read
    };
    for (scene::Material& material : parts.materials) {
        find(material, material.image, material.texture);
        find(material, material.emissive_image, material.emissive_texture);
        find(material, material.occlusion_roughness_metallic_image,
             material.occlusion_roughness_metallic_texture);
        find(material, material.normal_image, material.normal_texture);
    }
    notices.append_to(parts.notices);
}

bool set_samplers(scene::SceneParts& parts, std::uint64_t max_pixels) {
    std::map<std::pair<scene::Index, scene::Sampler>, scene::Index> known;
    std::map<scene::Index, std::uint64_t> seen;  // by how many samplers
    for (const scene::Texture& texture : parts.textures)
        max_pixels -= std::min<std::uint64_t>(max_pixels, texture.image.rgba.size() / 4);
    bool all = true;
    const auto set = [&](scene::Index& index, const scene::Sampler& sampler) {
        if (index == scene::kNone) return;
        const auto [place, is_new] = known.try_emplace({index, sampler}, index);
        scene::Texture& texture = parts.textures[static_cast<std::size_t>(index)];
        if (const std::uint64_t pixels = texture.image.rgba.size() / 4; !is_new) {
            // It is there already.
        } else if (seen[index]++ == 0) {
            texture.sampler = sampler;
        } else if (pixels <= max_pixels) {
            max_pixels -= pixels;
            place->second = static_cast<scene::Index>(parts.textures.size());
            scene::Texture copy = texture;
            copy.sampler = sampler;
            parts.textures.push_back(std::move(copy));
        } else {
            all = false;
        }
        index = place->second;
    };
    for (scene::Material& material : parts.materials)
        for (const auto texture :
             {&scene::Material::texture, &scene::Material::emissive_texture,
              &scene::Material::occlusion_roughness_metallic_texture, &scene::Material::normal_texture})
            set(material.*texture, material.sampler);
    return all;
}

bool change_textures(std::vector<scene::Material>& materials, const std::vector<TextureChange>& changes,
                     std::vector<scene::Texture>& textures, scene::Index scene::Material::*texture,
                     std::uint64_t max_pixels) {
    std::map<scene::Index, std::map<ChangeKey, scene::Index>> views;  // of each texture
    std::vector<ChangeKey> keys(materials.size());
    for (std::size_t i = 0; i < materials.size(); ++i) {
        if (const scene::Index from = materials[i].*texture; from != scene::kNone) {
            keys[i] = key_of(changes[i], textures[static_cast<std::size_t>(from)]);
            views[from].try_emplace(keys[i], from);
        }
        for (const auto other :
             {&scene::Material::texture, &scene::Material::emissive_texture,
              &scene::Material::occlusion_roughness_metallic_texture, &scene::Material::normal_texture})
            if (other != texture && materials[i].*other != scene::kNone)
                views[materials[i].*other].try_emplace(kUnchanged, materials[i].*other);
    }
    for (const scene::Texture& known : textures)
        max_pixels -= std::min<std::uint64_t>(max_pixels, known.image.rgba.size() / 4);
    bool all = true;
    for (auto& [from, changed] : views) {
        // The last one that differs is changed in place, unless the texture is also seen as it is.
        const std::uint64_t pixels = textures[static_cast<std::size_t>(from)].image.rgba.size() / 4;
        bool keeps = changed.contains(kUnchanged);
        std::size_t left = changed.size();
        for (auto& [key, to] : changed) {
            --left;
            if (key == kUnchanged) continue;
            if (keeps || left > 0) {
                if (pixels > max_pixels) {
                    all = false;
                    keeps = true;  // who gets no copy sees it as it is
                    continue;
                }
                max_pixels -= pixels;
                to = static_cast<scene::Index>(textures.size());
                textures.push_back(textures[static_cast<std::size_t>(from)]);
            }
            apply(key, textures[static_cast<std::size_t>(to)]);
        }
    }
    for (std::size_t i = 0; i < materials.size(); ++i)
        if (const scene::Index from = materials[i].*texture; from != scene::kNone)
            materials[i].*texture = views[from].at(keys[i]);
    return all;
}

}  // namespace vrut::io
