#include "io/gltf/material.hpp"

#include <algorithm>
#include <cmath>

#include "base/srgb.hpp"

namespace vrut::io {

namespace {

constexpr double kVisible = 0.5 / 255;  // what rounds to the same byte is the same
constexpr double kSharpest = 10'000;    // Phong's exponent, which is what the reader gives smoother ones
constexpr const char* kColorClamped = "a colour above 1 is clamped to 1";

glm::dvec3 linear(const glm::dvec3& displayed) {
    return base::linear_from_srgb(glm::clamp(displayed, 0.0, 1.0));
}

double largest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// The roughness whose highlight has this exponent; the reader's exponents are 1 to 10,000.
double roughness_of(double shininess) { return std::pow(2 * shininess + 1, -0.25); }

/// What the reader makes of it is k · 0.22 + q (c - 0.22), with k = 1 - roughness and q = k · metallic.
struct Highlight {
    double k = 0, q = 0;
    glm::dvec3 color{0};
};

/// The nearest to `wanted` with k in a range and q from 0 to k, for the displayed base colour c.
Highlight fit(const glm::dvec3& wanted, const glm::dvec3& c, double least_k, double most_k) {
    const glm::dvec3 a(kGltfDielectric), b = c - kGltfDielectric;
    const double aa = glm::dot(a, a), ab = glm::dot(a, b), bb = glm::dot(b, b);
    const double determinant = aa * bb - ab * ab;
    // With a grey base there are many: the one without metal.
    double k = determinant > 1e-9 ? (glm::dot(a, wanted) * bb - glm::dot(b, wanted) * ab) / determinant
                                  : glm::dot(a, wanted) / aa;
    k = std::clamp(k, least_k, most_k);
    const double q = bb > 1e-12 ? std::clamp(glm::dot(wanted - k * a, b) / bb, 0.0, k) : 0;
    return {k, q, k * a + q * b};
}

/// At both ends of its exponents the reader's rule leaves the roughness free.
std::pair<double, double> range_of_k(double shininess) {
    if (shininess <= 1) return {0, 1 - roughness_of(1)};
    if (shininess >= kSharpest) return {1 - roughness_of(kSharpest), 1};
    return {1 - roughness_of(shininess), 1 - roughness_of(shininess)};
}

void convert_highlight(const scene::Material& from, const glm::dvec3& c, GltfMaterial& material,
                       ConversionWarnings& warnings) {
    const glm::dvec3 wanted(from.specular);
    const auto [least_k, most_k] = range_of_k(from.shininess);
    if (from.shininess < 1 && largest(wanted) > 0) warnings.add("a shininess below 1 is written as 1");
    const Highlight best = fit(wanted, c, least_k, most_k);
    if (largest(best.color - wanted) <= kVisible) {
        material.roughness = 1 - best.k;
        material.metallic = best.k > 0 ? best.q / best.k : 0;
        return;
    }
    if (largest(wanted) == 0) return;  // roughness 1 has none
    material.roughness = 1 - most_k;
    material.glossiness = {linear(wanted / most_k), most_k};
    if (largest(wanted) > most_k + kVisible)
        warnings.add(
            "a wide specular highlight becomes weaker: the metallic-roughness model cannot express it");
}

/// What the reader would not find for Phong's equation.
void keep_highlight(const scene::Material& from, const glm::dvec3& c, GltfMaterial& material) {
    const glm::dvec3 wanted(from.specular);
    const glm::dvec3 found =
        (1 - material.roughness) * (kGltfDielectric + (c - kGltfDielectric) * material.metallic);
    const double k = range_of_k(from.shininess).second;
    const bool is_found = std::abs(1 - material.roughness - k) < 1e-6 || largest(wanted) == 0;
    if ((is_found && largest(found - wanted) <= kVisible) || !(k > 0)) return;
    material.glossiness = {linear(wanted / k), k};
}

void report_lost_phong(const scene::Material& from, const glm::dvec3& c, ConversionWarnings& warnings) {
    const glm::dvec3 emission(from.emission);
    if (largest(glm::dvec3(from.ambient) - c * 0.1) > kVisible)
        warnings.add("a material's ambient colour becomes a tenth of its diffuse colour");
    if (largest(emission) > kVisible &&
        (largest(glm::dvec3(from.diffuse)) > kVisible || from.emissive_texture != scene::kNone))
        warnings.add("a material's emission becomes light, which brightens less what is lit");
    if (largest(emission) > 1) warnings.add(kColorClamped);
}

}  // namespace

GltfMaterial gltf_material(const scene::Scene& scene, const scene::Material& from,
                           ConversionWarnings& warnings) {
    GltfMaterial material;
    const bool has_texture = from.texture != scene::kNone;
    const glm::dvec3 diffuse(from.diffuse), c = has_texture ? glm::dvec3(1) : glm::clamp(diffuse, 0.0, 1.0);
    material.base = linear(c);
    material.alpha = std::clamp(from.diffuse.a, 0.0, 1.0);
    material.blend = scene.is_transparent(from);
    glm::dvec3 emissive = from.emissive;
    if (const auto& surface = from.metallic_roughness) {
        material.metallic = surface->metallic;
        material.roughness = surface->roughness;
        material.clear_coat = surface->clear_coat;
        keep_highlight(from, c, material);
    } else {
        emissive += linear(from.emission);
        convert_highlight(from, c, material, warnings);
        report_lost_phong(from, c, warnings);
    }
    material.emissive_strength = std::max(largest(emissive), 1.0);
    material.emissive = emissive / material.emissive_strength;
    if (has_texture && largest(diffuse - c) > kVisible)
        warnings.add("the diffuse colour of a textured material becomes white");
    if (largest(diffuse) > 1) warnings.add(kColorClamped);
    if (from.reflectivity > 0) warnings.add("a material's reflectivity is lost");
    return material;
}

}  // namespace vrut::io
