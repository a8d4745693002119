#include "io/gltf/images.hpp"

#include "io/foreign_paths.hpp"
#include "io/gltf/data_uri.hpp"
#include "io/image/image_file.hpp"
#include "io/import_checks.hpp"

namespace vrut::io {

std::string image_name(const GltfJson& document, std::uint32_t image, const std::filesystem::path& folder) {
    const GltfJson& images = array_in(document, "images");
    if (image >= images.size()) throw ImportError("there is no image " + std::to_string(image));
    const std::string& uri = string_in(images[image], "uri");
    if (uri.empty() || is_data_uri(uri)) return "*" + std::to_string(image);
    const std::string name = file_name_of_foreign_path(folder, uri);
    return name.starts_with('*') ? "./" + name : name;
}

tl::expected<scene::Image, std::string> decode_gltf_image(const GltfJson& document, GltfBuffers& buffers,
                                                          const std::string& name, std::uint64_t max_pixels) {
    const GltfJson& image = array_in(document, "images")[std::stoul(name.substr(1))];
    try {
        const std::string& uri = string_in(image, "uri");
        if (is_data_uri(uri)) return decode_image(decode_data_uri(uri), max_pixels);
        return decode_image(buffers.view(required_index_in(image, "bufferView")), max_pixels);
    } catch (const ImportError& error) {
        return tl::unexpected(std::string(error.what()));
    }
}

}  // namespace vrut::io
