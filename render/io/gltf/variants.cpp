#include "io/gltf/variants.hpp"

#include "io/import_checks.hpp"

namespace vrut::io {

namespace {

constexpr const char* kVariants = "KHR_materials_variants";

}  // namespace

GltfVariants::GltfVariants(const GltfJson& document, const std::vector<std::uint32_t>& meshes) {
    for (const GltfJson& variant : array_in(extension_in(document, kVariants), "variants")) {
        const std::string& name = string_in(variant, "name");
        names_.push_back(name.empty() ? "variant " + std::to_string(names_.size() + 1) : name);
    }
    if (!names_.empty()) find_default(document, meshes);
}

/// The first variant in which each primitive has the material that it has without the extension.
void GltfVariants::find_default(const GltfJson& document, const std::vector<std::uint32_t>& meshes) {
    std::vector<bool> is_default(names_.size(), true);
    for (const std::uint32_t mesh : meshes)
        for (const GltfJson& primitive : array_in(array_in(document, "meshes")[mesh], "primitives")) {
            const std::vector<GltfMaterialNumber> materials = materials_of(primitive);
            for (std::size_t i = 0; i < materials.size(); ++i)
                if (materials[i] != index_in(primitive, "material")) is_default[i] = false;
        }
    for (std::size_t i = is_default.size(); i-- > 0;)
        if (is_default[i]) default_ = static_cast<int>(i);
}

/// One for each variant; empty where the primitive does not take part.
std::vector<GltfMaterialNumber> GltfVariants::materials_of(const GltfJson& primitive) const {
    const GltfJson& mappings = array_in(extension_in(primitive, kVariants), "mappings");
    if (mappings.empty()) return {};
    std::vector<GltfMaterialNumber> materials(names_.size(), index_in(primitive, "material"));
    for (const GltfJson& mapping : mappings)
        for (const GltfJson& variant : array_in(mapping, "variants")) {
            const std::uint32_t number = index_of(variant, "variants");
            if (number >= names_.size()) throw ImportError("there is no variant " + std::to_string(number));
            materials[number] = required_index_in(mapping, "material");
        }
    return materials;
}

std::vector<GltfVariants::Choice> GltfVariants::choices_of(const GltfJson& primitive) const {
    const std::vector<GltfMaterialNumber> materials = materials_of(primitive);
    std::vector<Choice> choices;
    if (!materials.empty() && !default_) choices.push_back({"default", index_in(primitive, "material")});
    for (std::size_t i = 0; i < materials.size(); ++i) choices.push_back({names_[i], materials[i]});
    if (choices.size() < 2) return {};
    return choices;
}

}  // namespace vrut::io
