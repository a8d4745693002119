#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/gltf/json.hpp"

namespace vrut::io {

/// The number of a material in a glTF file; none: the default material.
using GltfMaterialNumber = std::optional<std::uint32_t>;

/// The variants that a glTF file offers of its materials (KHR_materials_variants).
class GltfVariants {
public:
    struct Choice {
        std::string name;
        GltfMaterialNumber material;
    };

    /// `meshes`: those that are shown. The document must outlive this object. Throws ImportError.
    GltfVariants(const GltfJson& document, const std::vector<std::uint32_t>& meshes);

    /// What there is to choose for a primitive: the same names for each. Empty where it looks the same in all
    /// variants. Throws ImportError.
    std::vector<Choice> choices_of(const GltfJson& primitive) const;
    /// The choice that shows what is shown without the extension: a variant, or else one of its own.
    int default_choice() const { return default_.value_or(0); }

private:
    std::vector<GltfMaterialNumber> materials_of(const GltfJson& primitive) const;
    void find_default(const GltfJson& document, const std::vector<std::uint32_t>& meshes);

    std::vector<std::string> names_;
    std::optional<int> default_;  // none: no variant is the default
};

}  // namespace vrut::io
