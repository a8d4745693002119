#include "io/gltf/extensions.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include "io/import_checks.hpp"
#include "io/vrut/tokenizer.hpp"

namespace vrut::io {

namespace {

constexpr std::string_view kSupported[] = {
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_clearcoat",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_mesh_quantization",
    "KHR_texture_basisu",  // the image has its own notice
    "KHR_texture_transform",
};

/// Without it the shapes are there, and look another way.
bool is_about_looks(std::string_view name) {
    return name.starts_with("KHR_materials_") || name.starts_with("KHR_technique") ||
           name.starts_with("EXT_materials_") || name.starts_with("KHR_texture_") ||
           name.starts_with("EXT_texture_") || name.starts_with("MSFT_texture_") ||
           name.starts_with("EXT_lights_");
}

bool is_supported(std::string_view name) {
    return std::find(std::begin(kSupported), std::end(kSupported), name) != std::end(kSupported);
}

std::set<std::string> unsupported_in(const GltfJson& document, const char* list) {
    std::set<std::string> names;
    for (const GltfJson& name : array_in(document, list))
        if (name.is_string() && !is_supported(name.get_ref<const std::string&>()))
            names.insert(name.get<std::string>());
    return names;
}

}  // namespace

void check_extensions(const GltfJson& document, ConversionWarnings& warnings) {
    for (const std::string& name : unsupported_in(document, "extensionsRequired"))
        if (!is_about_looks(name))
            throw ImportError("it requires the glTF extension " + excerpt(name) +
                              ", which is not supported: export it without that extension");
    for (const std::string& name : unsupported_in(document, "extensionsUsed"))
        warnings.add("the glTF extension " + excerpt(name) + " is not supported");
}

}  // namespace vrut::io
