#include "picture_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "reference/reference.hpp"
#include "reference/shading.hpp"
#include "reference/tracer.hpp"

namespace vrut {

namespace {

/// A flat face, or all that is smooth of a part.
struct SurfaceId {
    std::uint32_t part = 0;
    bool reflected = false;
    glm::dvec3 face{0};  ///< unit normal of a flat face, 0 of a smooth one

    bool operator==(const SurfaceId& other) const {
        return part == other.part && reflected == other.reflected && glm::distance(face, other.face) < 1e-6;
    }
};

bool is_flat(const scene::Geometry& geometry, const glm::uvec3& triangle) {
    if (geometry.normals.empty()) return true;
    const glm::vec3 none(0);
    return geometry.normals[triangle.x] == none && geometry.normals[triangle.y] == none &&
           geometry.normals[triangle.z] == none;
}

/// One behind the other, and in a mirror what is seen there.
std::vector<SurfaceId> surfaces_at(const reference::Tracer& tracer, const glm::dvec2& raster) {
    std::vector<SurfaceId> surfaces;
    for (const auto& [hit, ray, reflected] : tracer.hits_at(raster)) {
        const reference::TracedInstance& part = tracer.parts()[hit.part];
        SurfaceId& surface = surfaces.emplace_back(SurfaceId{hit.part, reflected, {}});
        if (is_flat(*part.geometry, part.geometry->triangles[hit.triangle]))
            surface.face = reference::interaction_of(part, hit, ray).normal;
    }
    return surfaces;
}

bool has_edge(const reference::Tracer& tracer, int x, int y) {
    const std::vector<SurfaceId> center = surfaces_at(tracer, {x + 0.5, y + 0.5});
    for (const double dx : {0.02, 0.98})
        for (const double dy : {0.02, 0.98})
            if (surfaces_at(tracer, {x + dx, y + dy}) != center) return true;
    return false;
}

std::string described(int x, int y, const glm::dvec3& expected, const glm::ivec3& found) {
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(), "at %d, %d: expected %.2f %.2f %.2f, found %d %d %d", x, y,
                  expected.r, expected.g, expected.b, found.r, found.g, found.b);
    return text.data();
}

}  // namespace

PictureMismatch mismatch(const plan::View& view, const scene::Image& drawn) {
    const reference::ReferenceImage expected = reference::trace(view);
    const reference::Tracer tracer(view);
    PictureMismatch result;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            if (has_edge(tracer, x, y)) continue;
            const auto at =
                static_cast<std::size_t>(view.height - 1 - y) * static_cast<std::size_t>(view.width) +
                static_cast<std::size_t>(x);
            ++result.compared;
            result.surfaces += expected.node[at] != scene::kNone;
            const glm::dvec3 should = expected.color[at] * 255.0;
            const glm::ivec3 is = pixel_of(drawn, x, y);
            const glm::dvec3 off = glm::abs(glm::dvec3(is) - should);
            result.rms += glm::dot(off, off) / 3;
            const double worst = std::max({off.r, off.g, off.b});
            if (worst <= result.worst) continue;
            result.worst = worst;
            result.where = described(x, y, should, is);
        }
    result.rms = std::sqrt(result.rms / std::max(result.compared, 1));
    return result;
}

glm::ivec3 pixel_of(const scene::Image& image, int x, int y) {
    const std::uint8_t* bytes = image.rgba.data() + (static_cast<std::size_t>(image.height - 1 - y) *
                                                         static_cast<std::size_t>(image.width) +
                                                     static_cast<std::size_t>(x)) *
                                                        4;
    return {bytes[0], bytes[1], bytes[2]};
}

glm::ivec3 bytes_of(const glm::dvec3& color) { return glm::ivec3(glm::floor(color * 255.0 + 0.5)); }

}  // namespace vrut
