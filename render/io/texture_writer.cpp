#include "io/texture_writer.hpp"

#include <png.h>

#include <ostream>

#include "io/plain_name.hpp"

namespace vrut::io {

std::vector<std::uint8_t> encode_png(const scene::Image& image, bool with_alpha) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(image.width);
    header.height = static_cast<png_uint_32>(image.height);
    header.format = with_alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
    std::vector<std::uint8_t> rgb;
    if (!with_alpha) rgb.reserve(image.rgba.size() / 4 * 3);
    for (std::size_t i = 0; !with_alpha && i < image.rgba.size(); i += 4)
        rgb.insert(rgb.end(), image.rgba.begin() + static_cast<std::ptrdiff_t>(i),
                   image.rgba.begin() + static_cast<std::ptrdiff_t>(i) + 3);
    const int bottom_up = -image.width * (with_alpha ? 4 : 3);
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
    std::vector<std::uint8_t> png(size);
    if (!png_image_write_to_memory(&header, png.data(), &size, 0, with_alpha ? image.rgba.data() : rgb.data(),
                                   bottom_up, nullptr))
        throw std::runtime_error(std::string("an image cannot be encoded as PNG: ") + header.message);
    png.resize(size);
    return png;
}

std::vector<std::string> write_textures(const scene::Scene& scene, const std::filesystem::path& scene_file,
                                        base::OutputFiles& files) {
    std::vector<std::string> names;
    for (const scene::Texture& texture : scene.textures()) {
        const std::string own = plain_name(std::filesystem::path(texture.file).stem().string());
        names.push_back(plain_name(scene_file.stem().string()) + ".textures/" + std::to_string(names.size()) +
                        (own.empty() ? "" : "-" + own) + ".png");
        const auto png = encode_png(texture.image, texture.transparent);
        files.write(scene_file.parent_path() / names.back(), [&](std::ostream& out) {
            out.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
        });
    }
    return names;
}

}  // namespace vrut::io
