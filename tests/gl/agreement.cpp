#include "agreement.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <thread>

#include "compare/difference.hpp"
#include "reference/shading.hpp"
#include "reference/tracer.hpp"

namespace vrut {

namespace {

using reference::SurfaceInteraction;
using reference::TracedInstance;
using reference::Tracer;

struct Bound {
    double each, rms;  ///< of 255
};
constexpr double kAny = std::numeric_limits<double>::infinity();
/// By Kind.
constexpr std::array<Bound, kPixelClasses> kBounds{{{1, 0.5}, {2, kAny}, {2, kAny}, {3, kAny}, {kAny, 3}}};
/// Of the pixels, so many may be further off than the bound, or show another node.
constexpr double kShareBeyond = 1e-4;

/// A surface that a pixel shows something of.
struct SeenSurface {
    reference::Tracer::VisibleHit layer;
    reference::SurfaceInteraction interaction;
    glm::dvec3 face{0};  ///< normal of the triangle's plane
};
using SurfaceStack = std::vector<SeenSurface>;

SurfaceStack stack_at(const reference::Tracer& tracer, const glm::dvec2& raster) {
    SurfaceStack stack;
    for (const reference::Tracer::VisibleHit& layer : tracer.hits_at(raster)) {
        const reference::TracedInstance& part = tracer.parts()[layer.hit.part];
        const glm::uvec3& at = part.geometry->triangles[layer.hit.triangle];
        const glm::dvec3& a = part.positions[at.x];
        const glm::dvec3 face = glm::cross(part.positions[at.y] - a, part.positions[at.z] - a);
        stack.push_back({layer, reference::interaction_of(part, layer.hit, layer.ray),
                         layer.hit.cap ? layer.hit.cap->normal : glm::normalize(face)});
    }
    return stack;
}

/// Whether `there`, seen `dx` pixels to the right and `dy` above, goes on where `here` ends: on the same
/// sheet, without a crease, and without a seam of the texture.
bool goes_on(const SeenSurface& here, const SeenSurface& there, double dx, double dy) {
    if (here.layer.hit.part != there.layer.hit.part || here.layer.reflected != there.layer.reflected ||
        here.layer.hit.cap.has_value() != there.layer.hit.cap.has_value())
        return false;
    const auto& ray = here.layer.ray;
    const double distance = here.layer.hit.distance;
    const glm::dvec3 step = (ray.dorigin_dxy[0] + ray.ddirection_dxy[0] * distance) * dx +
                            (ray.dorigin_dxy[1] + ray.ddirection_dxy[1] * distance) * dy;
    const double off_plane = glm::dot(here.face, there.interaction.point - here.interaction.point) /
                             std::abs(glm::dot(here.face, ray.direction));
    if (!(std::abs(off_plane) < 2 * glm::length(step))) return false;
    const glm::dvec3 normal_step = here.interaction.dn_dxy[0] * dx + here.interaction.dn_dxy[1] * dy;
    if (!(glm::distance(there.interaction.normal, here.interaction.normal + normal_step) <
          0.02 + glm::length(normal_step)))
        return false;
    const glm::dvec2 uv_step = here.interaction.duv_dxy[0] * dx + here.interaction.duv_dxy[1] * dy;
    return glm::distance(there.interaction.texcoord, here.interaction.texcoord + uv_step) <
           0.01 + glm::length(uv_step);
}

bool same(const SurfaceStack& here, const SurfaceStack& there, int dx, int dy) {
    if (here.size() != there.size()) return false;
    for (std::size_t i = 0; i < here.size(); ++i)
        if (!goes_on(here[i], there[i], dx, dy)) return false;
    return true;
}

/// `stack` is one of a picture `width` wide, with neighbours on all sides.
bool is_interior(const SurfaceStack* stack, int width) {
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
            if ((dx != 0 || dy != 0) && !same(*stack, stack[dy * width + dx], dx, dy)) return false;
    return true;
}

/// On all of the processor's cores.
void for_each_row(int rows, const std::function<void(int)>& work) {
    std::atomic<int> next = 0;
    const auto some = [&] {
        for (int row = next++; row < rows; row = next++) work(row);
    };
    std::vector<std::jthread> others(std::max(std::thread::hardware_concurrency(), 1U) - 1);
    for (std::jthread& other : others) other = std::jthread(some);
    some();
}

/// Texels in the longer side of a pixel.
double texels(const scene::Image& image, const std::array<glm::dvec2, 2>& change) {
    const glm::dvec2 size(image.width, image.height);
    return std::max(glm::length(change[0] * size), glm::length(change[1] * size));
}

/// The same of a cube map, seen in a direction that changes so.
double texels(const scene::Image& side, const glm::dvec3& direction,
              const std::array<glm::dvec3, 2>& change) {
    const glm::dvec3 size = glm::abs(direction);
    const double largest = std::max({size.x, size.y, size.z});
    return side.width / 2.0 * std::max(glm::length(change[0]), glm::length(change[1])) / (largest * largest);
}

PixelClass filtered(double texels) { return texels > 1 ? PixelClass::minified : PixelClass::magnified; }

const scene::Image& image_of(const plan::View& view, scene::Index texture) {
    return view.scene->scene->textures()[static_cast<std::size_t>(texture)].image;
}

PixelClass kind_of_surface(const plan::View& view, const reference::TracedInstance& part,
                           const SeenSurface& seen) {
    if (seen.layer.hit.cap) return seen.layer.reflected ? PixelClass::mirror : PixelClass::opaque;
    PixelClass kind = part.transparent ? PixelClass::glass : PixelClass::opaque;
    if (part.mirror || seen.layer.reflected) kind = std::max(kind, PixelClass::mirror);
    const scene::Material& material = *part.material;
    for (const scene::Index texture :
         {material.texture, material.occlusion_roughness_metallic_texture, material.normal_texture})
        if (texture != scene::kNone && !part.geometry->texcoords.empty())
            kind = std::max(kind, filtered(texels(image_of(view, texture), seen.interaction.duv_dxy)));
    const bool coated = material.metallic_roughness && material.metallic_roughness->clear_coat > 0;
    if ((coated || (material.reflectivity > 0 && !part.mirror)) && view.background.cube_map) {
        const glm::dvec3 &d = seen.layer.ray.direction, &n = seen.interaction.normal;
        std::array<glm::dvec3, 2> change{};
        for (std::size_t i = 0; i < 2; ++i)
            change[i] = glm::reflect(seen.layer.ray.ddirection_dxy[i], n) -
                        2.0 * (glm::dot(d, seen.interaction.dn_dxy[i]) * n +
                               glm::dot(d, n) * seen.interaction.dn_dxy[i]);
        const scene::Image& side = image_of(view, view.background.cube_map->front());
        kind = std::max(kind, filtered(texels(side, glm::reflect(d, n), change)));
    }
    return kind;
}

PixelClass kind_of_background(const plan::View& view, const reference::Tracer& tracer,
                              const glm::dvec2& raster) {
    if (!view.scene) return PixelClass::opaque;
    if (view.background.cube_map) {
        const auto ray = tracer.generate_ray(raster);
        return filtered(
            texels(image_of(view, view.background.cube_map->front()), ray.direction, ray.ddirection_dxy));
    }
    if (view.background.texture == scene::kNone) return PixelClass::opaque;
    return filtered(texels(image_of(view, view.background.texture),
                           {glm::dvec2(1.0 / view.width, 0), glm::dvec2(0, 1.0 / view.height)}));
}

PixelClass kind_of(const plan::View& view, const reference::Tracer& tracer, const glm::dvec2& raster,
                   const SurfaceStack& stack) {
    const auto opaque = [&](const SeenSurface& seen) {
        const reference::TracedInstance& part = tracer.parts()[seen.layer.hit.part];
        return (!part.transparent || seen.layer.hit.cap) && !(part.mirror && !seen.layer.reflected);
    };
    const bool to_the_background = std::none_of(stack.begin(), stack.end(), opaque);
    PixelClass kind = to_the_background ? kind_of_background(view, tracer, raster) : PixelClass::opaque;
    for (const SeenSurface& seen : stack)
        kind = std::max(kind, kind_of_surface(view, tracer.parts()[seen.layer.hit.part], seen));
    return kind;
}

/// How far the pixel drawn at `at` is off, of 255.
glm::dvec3 off_at(const JudgedReference& judge, const scene::Image& drawn, std::size_t at) {
    const std::uint8_t* rgba = &drawn.rgba[4 * at];
    return glm::dvec3(rgba[0], rgba[1], rgba[2]) - 255.0 * judge.picture.color[at];
}

double largest(const glm::dvec3& off) {
    return std::max({std::abs(off.r), std::abs(off.g), std::abs(off.b)});
}

std::string describe(const JudgedReference& judge, const scene::Image& drawn, std::size_t at) {
    const int x = static_cast<int>(at) % drawn.width, row = static_cast<int>(at) / drawn.width;
    const glm::dvec3 expected = 255.0 * judge.picture.color[at];
    const std::uint8_t* rgba = &drawn.rgba[4 * at];
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(), "%d,%d: drawn %d %d %d, expected %.2f %.2f %.2f", x,
                  drawn.height - 1 - row, rgba[0], rgba[1], rgba[2], expected.r, expected.g, expected.b);
    return text.data();
}

}  // namespace

std::string name_of(PixelClass kind) {
    constexpr std::array<const char*, kPixelClasses> names{"opaque", "magnified", "mirror", "glass",
                                                           "minified"};
    return names[static_cast<std::size_t>(kind)];
}

JudgedReference judge_of(const plan::View& view) {
    JudgedReference judge{reference::trace(view), {}, {}, {}};
    judge.one_node = compare::interior_pixels(judge.picture.node, view.width, view.height);
    const reference::Tracer tracer(view);
    const auto width = static_cast<std::size_t>(view.width), height = static_cast<std::size_t>(view.height);
    std::vector<SurfaceStack> stacks(width * height);
    judge.kind.resize(stacks.size());
    judge.interior.resize(stacks.size());
    for_each_row(view.height, [&](int y) {
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t at = static_cast<std::size_t>(y) * width + x;
            const glm::dvec2 raster(static_cast<double>(x) + 0.5, view.height - y - 0.5);
            stacks[at] = stack_at(tracer, raster);
            judge.kind[at] = kind_of(view, tracer, raster, stacks[at]);
        }
    });
    for (std::size_t y = 1; y + 1 < height; ++y)
        for (std::size_t x = 1; x + 1 < width; ++x) {
            const std::size_t at = y * width + x;
            judge.interior[at] = is_interior(&stacks[at], view.width);
        }
    return judge;
}

double interior_share(const JudgedReference& judge) {
    double surfaces = 0, interior = 0;
    for (std::size_t i = 0; i < judge.picture.node.size(); ++i) {
        if (judge.picture.node[i] == scene::kNone) continue;
        ++surfaces;
        if (judge.interior[i]) ++interior;
    }
    return interior / surfaces;
}

Agreement agreement(const JudgedReference& judge, const scene::Image& drawn, const std::vector<bool>& hidden,
                    const std::vector<scene::Id>& nodes, const std::vector<scene::Id>& expected) {
    Agreement result;
    result.pixels = static_cast<int>(judge.picture.color.size());
    for (std::size_t i = 0; i < judge.picture.color.size(); ++i) {
        if (nodes[i] != expected[i]) ++result.other_nodes;
        if (!judge.one_node[i] || hidden[i]) continue;
        const auto kind = static_cast<std::size_t>(judge.kind[i]);
        const glm::dvec3 off = off_at(judge, drawn, i);
        const bool beyond = largest(off) > kBounds[kind].each;
        ++result.one_node;
        result.one_node_beyond += beyond;
        if (!judge.interior[i]) continue;
        ErrorTally& tally = result.tallies[kind];
        ++tally.pixels;
        tally.beyond += beyond;
        tally.rms += glm::dot(off, off) / 3;
        if (largest(off) <= tally.worst) continue;
        tally.worst = largest(off);
        tally.where = describe(judge, drawn, i);
    }
    for (ErrorTally& tally : result.tallies)
        if (tally.pixels > 0) tally.rms = std::sqrt(tally.rms / tally.pixels);
    return result;
}

std::string violations(const Agreement& agreement) {
    std::string text;
    if (agreement.other_nodes > kShareBeyond * agreement.pixels)
        text += "other nodes at " + std::to_string(agreement.other_nodes) + " pixels; ";
    if (agreement.one_node_beyond > kShareBeyond * agreement.one_node)
        text += "off at " + std::to_string(agreement.one_node_beyond) + " pixels of one node; ";
    for (std::size_t kind = 0; kind < kPixelClasses; ++kind) {
        const ErrorTally& tally = agreement.tallies[kind];
        if (tally.beyond > kShareBeyond * tally.pixels || tally.rms > kBounds[kind].rms)
            text += name_of(static_cast<PixelClass>(kind)) + " off, worst at " + tally.where + "; ";
    }
    return text;
}

std::string line_of(const Agreement& agreement) {
    std::string text = "nodes " + std::to_string(agreement.other_nodes) + "  one node " +
                       std::to_string(agreement.one_node) + " px beyond " +
                       std::to_string(agreement.one_node_beyond);
    for (std::size_t kind = 0; kind < kPixelClasses; ++kind) {
        const ErrorTally& tally = agreement.tallies[kind];
        if (tally.pixels == 0) continue;
        std::array<char, 128> numbers{};
        std::snprintf(numbers.data(), numbers.size(), "  %s %d px rms %.3f max %.2f beyond %d",
                      name_of(static_cast<PixelClass>(kind)).c_str(), tally.pixels, tally.rms, tally.worst,
                      tally.beyond);
        text += numbers.data();
    }
    return text;
}

}  // namespace vrut
