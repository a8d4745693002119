#include "io/gltf/material_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/srgb.hpp"
#include "io/gltf/material.hpp"
#include "io/import_checks.hpp"

namespace vrut::io {

namespace {

const GltfJson& empty_object() {
    static const GltfJson kEmpty = GltfJson::object();
    return kEmpty;
}

/// Phong's exponent that is about as sharp as the roughness.
double phong_exponent(double roughness) {
    const double sharpness = std::pow(std::max(roughness, 0.01), -4);
    return std::clamp((sharpness - 1) / 2, 1.0, 10'000.0);
}

const GltfJson& element(const GltfJson& document, const char* list, std::uint32_t index, const char* what) {
    const GltfJson& elements = array_in(document, list);
    if (index >= elements.size())
        throw ImportError("there is no " + std::string(what) + " " + std::to_string(index));
    return elements[index];
}

class MaterialReader {
public:
    MaterialReader(const GltfJson& document, const GltfJson& json, ConversionWarnings& warnings)
        : document_(document),
          json_(json),
          metallic_roughness_(object_in(json, "pbrMetallicRoughness")),
          glossiness_(extension_in(json, "KHR_materials_pbrSpecularGlossiness")),
          warnings_(warnings) {}

    ReadGltfMaterial read() {
        scene::Material& material = result_.material;
        material.name = string_in(json_, "name");
        material.two_sided = boolean_in(json_, "doubleSided", false);
        const std::string& alpha_mode = string_in(json_, "alphaMode");
        result_.change.opaque = alpha_mode.empty() || alpha_mode == "OPAQUE";
        const bool glossy = is_glossy();
        const glm::dvec4 color = glossy ? vector_in<4>(glossiness_, "diffuseFactor", glm::dvec4(1))
                                        : vector_in<4>(metallic_roughness_, "baseColorFactor", glm::dvec4(1));
        material.diffuse = glm::dvec4(base::srgb_from_linear(color),
                                      alpha_mode == "BLEND" ? std::clamp(color.a, 0.0, 1.0) : 1.0);
        material.ambient = glm::dvec4(glm::dvec3(material.diffuse) * 0.1, 1);
        result_.change.factor = glm::clamp(glm::dvec3(color), 0.0, 1.0);
        set_highlight(has_extension(kGlossiness));
        set_texture(glossy ? object_in(glossiness_, "diffuseTexture")
                           : object_in(metallic_roughness_, "baseColorTexture"));
        set_emissive();
        set_metallic_roughness(glossy);
        set_normal_map();
        if (has_extension("KHR_materials_unlit")) make_unlit();
        return std::move(result_);
    }

private:
    static constexpr const char* kGlossiness = "KHR_materials_pbrSpecularGlossiness";

    /// The extension is archived: what else the material says goes before it, unless it lacks the texture.
    bool is_glossy() const {
        const bool has_texture = metallic_roughness_.contains("baseColorTexture");
        return has_extension(kGlossiness) && (!json_.contains("pbrMetallicRoughness") ||
                                              (glossiness_.contains("diffuseTexture") && !has_texture));
    }

    bool has_extension(const char* name) const { return object_in(json_, "extensions").contains(name); }

    /// Its colour is seen whatever the light. An image whose alpha counts stays where light shows it.
    void make_unlit() {
        scene::Material& material = result_.material;
        const glm::dvec4 black(0, 0, 0, 1);
        material.specular = black;
        material.emissive = glm::dvec3(0);
        material.metallic_roughness.reset();
        result_.occlusion_roughness_metallic_image.reset();
        result_.normal_image.reset();
        result_.emissive_image.reset();
        if (result_.image && !result_.change.opaque)
            return warnings_.add("the texture of an unlit material that is not opaque is lit");
        material.emissive = base::linear_from_srgb(glm::dvec3(material.diffuse));
        std::swap(result_.image, result_.emissive_image);
        material.diffuse = glm::dvec4(0, 0, 0, material.diffuse.a);
        material.ambient = black;
    }

    /// A factor from 0 to 1.
    static double part(const GltfJson& parent, const char* name, double otherwise = 1) {
        return std::clamp(number_in(parent, name, otherwise), 0.0, 1.0);
    }

    void set_metallic_roughness(bool glossy) {
        const GltfJson& coat = extension_in(json_, "KHR_materials_clearcoat");
        scene::MetallicRoughness& surface = result_.material.metallic_roughness.emplace();
        surface.metallic = glossy ? 0 : part(metallic_roughness_, "metallicFactor");
        surface.roughness =
            glossy ? 1 - part(glossiness_, "glossinessFactor") : part(metallic_roughness_, "roughnessFactor");
        surface.clear_coat = part(coat, "clearcoatFactor", 0);
        if (surface.clear_coat > 0) report_clear_coat(coat);
        if (glossy) report(glossiness_, "specularGlossinessTexture", "a specular texture is ignored");
        set_surface_image(glossy ? empty_object()
                                 : object_in(metallic_roughness_, "metallicRoughnessTexture"));
    }

    /// Of the metallic-roughness texture, and the occlusion texture if it is the same or alone.
    void set_surface_image(const GltfJson& surface) {
        const GltfJson& occlusion = object_in(json_, "occlusionTexture");
        const auto image = image_of(surface), occlusion_image = image_of(occlusion);
        result_.occlusion_roughness_metallic_image = image ? image : occlusion_image;
        result_.surface_change.roughness_metallic = image.has_value();
        const bool occludes = occlusion_image && (!image || image == occlusion_image);
        result_.surface_change.occlusion = occludes ? part(occlusion, "strength") : 0;
        if (occlusion_image && !occludes)
            warnings_.add("an occlusion texture beside a metallic-roughness texture is ignored");
        if (image) add_mapping(surface, "a metallic-roughness texture");
        if (occludes) add_mapping(occlusion, "an occlusion texture");
    }

    void report_clear_coat(const GltfJson& coat) {
        constexpr double kSmooth = 0.1;
        report(coat, "clearcoatTexture", "a clear coat's texture is ignored");
        report(coat, "clearcoatNormalTexture", "a clear coat's normal map is ignored");
        if (image_of(object_in(coat, "clearcoatRoughnessTexture")) ||
            part(coat, "clearcoatRoughnessFactor", 0) > kSmooth)
            warnings_.add("a clear coat is drawn smooth");
    }

    void set_normal_map() {
        const GltfJson& info = object_in(json_, "normalTexture");
        result_.normal_image = image_of(info);
        if (!result_.normal_image) return;
        constexpr double kMostScale = 1e6;
        result_.material.normal_scale = std::clamp(number_in(info, "scale", 1), -kMostScale, kMostScale);
        add_mapping(info, "a normal map");
    }

    void set_highlight(bool glossy) {
        scene::Material& material = result_.material;
        const double roughness =
            glossy ? 1 - part(glossiness_, "glossinessFactor") : part(metallic_roughness_, "roughnessFactor");
        const glm::dvec3 color(material.diffuse);
        const glm::dvec3 reflected =
            glossy
                ? base::srgb_from_linear(vector_in<3>(glossiness_, "specularFactor", glm::dvec3(1)))
                : kGltfDielectric + (color - kGltfDielectric) * part(metallic_roughness_, "metallicFactor");
        material.specular = glm::dvec4((1 - roughness) * reflected, 1);
        material.shininess = phong_exponent(roughness);
    }

    /// The texture that a textureInfo refers to; empty where it refers to none.
    const GltfJson& texture_of(const GltfJson& info) const {
        const auto index = index_in(info, "index");
        return index ? element(document_, "textures", *index, "texture") : empty_object();
    }

    /// An image that every program reads goes before those of extensions.
    std::optional<std::uint32_t> image_of(const GltfJson& info) const {
        const GltfJson& texture = texture_of(info);
        if (const auto image = index_in(texture, "source")) return image;
        for (const char* extension : {"EXT_texture_webp", "KHR_texture_basisu", "MSFT_texture_dds"})
            if (const auto image = index_in(extension_in(texture, extension), "source")) return image;
        return std::nullopt;
    }

    void set_texture(const GltfJson& info) {
        result_.image = image_of(info);
        if (result_.image) add_mapping(info, "a base colour texture");
    }

    /// Light of more than a thousand times white shows as no more.
    void set_emissive() {
        constexpr double kMost = 1000;
        const GltfJson& strength = extension_in(json_, "KHR_materials_emissive_strength");
        scene::Material& material = result_.material;
        material.emissive =
            vector_in<3>(json_, "emissiveFactor", glm::dvec3(0)) * number_in(strength, "emissiveStrength", 1);
        for (int i = 0; i < 3; ++i)
            material.emissive[i] = material.emissive[i] > 0 ? std::min(material.emissive[i], kMost) : 0;
        const GltfJson& info = object_in(json_, "emissiveTexture");
        if (material.emissive != glm::dvec3(0)) result_.emissive_image = image_of(info);
        if (result_.emissive_image) add_mapping(info, "an emissive texture");
    }

    /// Of a further texture: all lie as the first one does.
    void add_mapping(const GltfJson& info, const std::string& what) {
        const GltfTextureMapping mapping = mapping_of(info);
        const GltfJson& from = sampler_of(info);
        const scene::Sampler sampler{{wrap_in(from, "wrapS"), wrap_in(from, "wrapT")},
                                     size_in(from, "magFilter", kGltfLinear) == kGltfNearest
                                         ? scene::Magnification::nearest
                                         : scene::Magnification::linear};
        if (!has_mapping_) {
            result_.mapping = mapping;
            result_.material.sampler = sampler;
        }
        has_mapping_ = true;
        if (mapping.key() != result_.mapping.key() || sampler != result_.material.sampler)
            warnings_.add(what + " lies as the material's first texture does, not as the file says");
    }

    GltfTextureMapping mapping_of(const GltfJson& info) const {
        const GltfJson& transform = extension_in(info, "KHR_texture_transform");
        const GltfJson& set = transform.contains("texCoord") ? transform : info;
        return {index_in(set, "texCoord").value_or(0), vector_in<2>(transform, "offset", glm::dvec2(0)),
                vector_in<2>(transform, "scale", glm::dvec2(1)), number_in(transform, "rotation", 0)};
    }

    const GltfJson& sampler_of(const GltfJson& info) const {
        const auto sampler = index_in(texture_of(info), "sampler");
        return sampler ? element(document_, "samplers", *sampler, "sampler") : empty_object();
    }

    static scene::Wrap wrap_in(const GltfJson& sampler, const char* name) {
        const std::uint64_t wrap = size_in(sampler, name, kGltfRepeat);
        return wrap == kGltfClamp    ? scene::Wrap::clamp
               : wrap == kGltfMirror ? scene::Wrap::mirror
                                     : scene::Wrap::repeat;
    }

    void report(const GltfJson& parent, const char* name, const char* what) {
        if (image_of(object_in(parent, name))) warnings_.add(what);
    }

    const GltfJson &document_, &json_, &metallic_roughness_, &glossiness_;
    ConversionWarnings& warnings_;
    ReadGltfMaterial result_;
    bool has_mapping_ = false;
};

}  // namespace

ReadGltfMaterial read_gltf_material(const GltfJson& document, std::optional<std::uint32_t> index,
                                    ConversionWarnings& warnings) {
    const GltfJson& json = index ? element(document, "materials", *index, "material") : empty_object();
    return MaterialReader(document, json, warnings).read();
}

}  // namespace vrut::io
