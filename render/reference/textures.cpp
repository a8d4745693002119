#include "reference/textures.hpp"

#include <algorithm>
#include <cmath>

#include "math/cube_faces.hpp"

namespace vrut::reference {

namespace {

/// The row of an image (or a column, where `next` is 1) in fewer texels: each takes what it covers of the old
/// ones, by length.
void shrink(const glm::dvec4* from, int from_count, glm::dvec4* to, int to_count, std::size_t next_from,
            std::size_t next_to) {
    const double ratio = static_cast<double>(from_count) / to_count;
    for (int i = 0; i < to_count; ++i) {
        const double begin = i * ratio, end = (i + 1) * ratio;
        glm::dvec4 sum(0);
        for (int k = static_cast<int>(begin); k < from_count && k < end; ++k)
            sum += (std::min<double>(k + 1, end) - std::max<double>(k, begin)) *
                   from[static_cast<std::size_t>(k) * next_from];
        to[static_cast<std::size_t>(i) * next_to] = sum / ratio;
    }
}

/// Where in the image from 0 to 1 a coordinate lies.
double wrapped(double coordinate, scene::Wrap wrap) {
    if (wrap == scene::Wrap::clamp) return std::clamp(coordinate, 0.0, 1.0);
    if (wrap == scene::Wrap::repeat) return coordinate - std::floor(coordinate);
    const double twice = coordinate - 2 * std::floor(coordinate / 2);
    return twice <= 1 ? twice : 2 - twice;
}

/// Of a texel beside those of the image.
int wrapped(int i, int count, scene::Wrap wrap) {
    if (wrap != scene::Wrap::repeat) return std::clamp(i, 0, count - 1);
    const int rest = i % count;
    return rest < 0 ? rest + count : rest;
}

/// The four texels whose centres surround a place, and how far it lies from the first to the last.
struct BilinearFootprint {
    BilinearFootprint(const glm::dvec2& uv, int width, int height) {
        const glm::dvec2 at = uv * glm::dvec2(width, height) - 0.5;
        x = static_cast<int>(std::floor(at.x));
        y = static_cast<int>(std::floor(at.y));
        part = at - glm::dvec2(x, y);
    }
    glm::dvec4 mix(const auto& texel) const {
        return glm::mix(glm::mix(texel(x, y), texel(x + 1, y), part.x),
                        glm::mix(texel(x, y + 1), texel(x + 1, y + 1), part.x), part.y);
    }

    int x, y;
    glm::dvec2 part{0};
};

/// What `of_level` gives at the level that belongs to a pixel `texels` long, between two of them.
template <typename OfLevel>
glm::dvec4 trilinear(double texels, int levels, const OfLevel& of_level) {
    if (texels <= 1) return of_level(0);
    const double last = levels - 1;
    const double level = texels < std::exp2(last) ? std::log2(texels) : last;  // NaN: the last
    const int finer = static_cast<int>(level);
    if (finer == levels - 1) return of_level(finer);
    return glm::mix(of_level(finer), of_level(finer + 1), level - finer);
}

double longer_side(const std::array<glm::dvec2, 2>& change, const glm::dvec2& size) {
    return std::max(glm::length(change[0] * size), glm::length(change[1] * size));
}

MipMap mip_map_of_face(const std::vector<std::array<scene::Image, 6>>& levels, std::size_t face) {
    std::vector<const scene::Image*> images;
    images.reserve(levels.size());
    for (const auto& level : levels) images.push_back(&level[face]);
    return MipMap(images);
}

std::array<MipMap, 6> mip_maps(const std::array<const scene::Image*, 6>& images) {
    return {MipMap(*images[0]), MipMap(*images[1]), MipMap(*images[2]),
            MipMap(*images[3]), MipMap(*images[4]), MipMap(*images[5])};
}

}  // namespace

MipMap::MipLevel MipMap::level_of(const scene::Image& image) {
    MipLevel level{image.width, image.height, {}};
    level.texels.reserve(image.rgba.size() / 4);
    for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4)
        level.texels.push_back(
            glm::dvec4(image.rgba[i], image.rgba[i + 1], image.rgba[i + 2], image.rgba[i + 3]) / 255.0);
    return level;
}

MipMap::MipMap(const std::vector<const scene::Image*>& levels) {
    for (const scene::Image* image : levels) levels_.push_back(level_of(*image));
}

MipMap::MipMap(const scene::Image& image) {
    levels_.push_back(level_of(image));
    while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(half_of(levels_.back()));
}

MipMap::MipLevel MipMap::half_of(const MipLevel& level) {
    MipLevel half{std::max(1, level.width / 2), std::max(1, level.height / 2), {}};
    const auto width = static_cast<std::size_t>(level.width),
               half_width = static_cast<std::size_t>(half.width);
    const auto height = static_cast<std::size_t>(level.height);
    std::vector<glm::dvec4> rows(half_width * height);
    for (std::size_t y = 0; y < height; ++y)
        shrink(&level.texels[y * width], level.width, &rows[y * half_width], half.width, 1, 1);
    half.texels.resize(half_width * static_cast<std::size_t>(half.height));
    for (std::size_t x = 0; x < half_width; ++x)
        shrink(&rows[x], level.height, &half.texels[x], half.height, half_width, half_width);
    return half;
}

const glm::dvec4& MipMap::texel(int level, int x, int y) const {
    const MipLevel& from = levels_[static_cast<std::size_t>(level)];
    return from.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(from.width) +
                       static_cast<std::size_t>(x)];
}

glm::dvec4 MipMap::sample(const glm::dvec2& uv, const std::array<glm::dvec2, 2>& change,
                          const scene::Sampler& sampler) const {
    glm::dvec2 inside(wrapped(uv.x, sampler.wraps[0]), wrapped(uv.y, sampler.wraps[1]));
    if (!(std::isfinite(inside.x) && std::isfinite(inside.y))) inside = glm::dvec2(0);
    const double texels = longer_side(change, glm::dvec2(width(0), height(0)));
    return trilinear(texels, levels(), [&](int level) {
        const int w = width(level), h = height(level);
        if (level == 0 && sampler.magnification == scene::Magnification::nearest)
            return texel(0, std::min(static_cast<int>(inside.x * w), w - 1),
                         std::min(static_cast<int>(inside.y * h), h - 1));
        return BilinearFootprint(inside, w, h).mix([&](int x, int y) {
            return texel(level, wrapped(x, w, sampler.wraps[0]), wrapped(y, h, sampler.wraps[1]));
        });
    });
}

CubeMap::CubeMap(const std::array<const scene::Image*, 6>& images) : faces_(mip_maps(images)) {}

CubeMap::CubeMap(const std::vector<std::array<scene::Image, 6>>& levels)
    : faces_{mip_map_of_face(levels, 0), mip_map_of_face(levels, 1), mip_map_of_face(levels, 2),
             mip_map_of_face(levels, 3), mip_map_of_face(levels, 4), mip_map_of_face(levels, 5)} {}

glm::dvec3 CubeMap::sample(const glm::dvec3& direction, const std::array<glm::dvec3, 2>& change) const {
    const std::size_t number = math::cube_face_of(direction);
    const math::CubeFace& face = math::kCubeFaces[number];
    const glm::dvec2 uv = math::uv_on(face, direction);
    // The quotient's derivative.
    const auto duv_of = [&](const glm::dvec3& d) {
        const glm::dvec2 across(glm::dot(d, face.right), glm::dot(d, face.up));
        return (across / 2.0 - (uv - 0.5) * glm::dot(d, face.forward)) / glm::dot(direction, face.forward);
    };
    const MipMap& map = faces_[number];
    const double texels = longer_side({duv_of(change[0]), duv_of(change[1])}, glm::dvec2(map.width(0)));
    return trilinear(texels, map.levels(), [&](int level) { return bilinear(number, level, uv); });
}

glm::dvec3 CubeMap::sample(const glm::dvec3& direction, double level) const {
    const std::size_t number = math::cube_face_of(direction);
    const glm::dvec2 uv = math::uv_on(math::kCubeFaces[number], direction);
    return trilinear(std::exp2(level), faces_[number].levels(),
                     [&](int at) { return bilinear(number, at, uv); });
}

glm::dvec4 CubeMap::bilinear(std::size_t face, int level, const glm::dvec2& uv) const {
    const int size = faces_[face].width(level);
    return BilinearFootprint(uv, size, size).mix([&](int x, int y) { return texel(face, level, x, y); });
}

/// One beyond an edge is the neighbouring face's, on the other side of that edge; there is none beyond a
/// corner, where the three around it are averaged.
glm::dvec4 CubeMap::texel(std::size_t face, int level, int x, int y) const {
    const int size = faces_[face].width(level);
    const int inside_x = std::clamp(x, 0, size - 1), inside_y = std::clamp(y, 0, size - 1);
    if (x == inside_x && y == inside_y) return faces_[face].texel(level, x, y);
    if (x != inside_x && y != inside_y)
        return (texel(face, level, inside_x, inside_y) + texel(face, level, x, inside_y) +
                texel(face, level, inside_x, y)) /
               3.0;
    // The cube reaches from -1 to 1. Half a texel around the edge:
    const math::CubeFace& from = math::kCubeFaces[face];
    const auto across = [&](int i) { return std::clamp((2 * i + 1.0) / size - 1, -1.0, 1.0); };
    const glm::dvec3 point = from.forward * (1 - 1.0 / size) + from.right * across(x) + from.up * across(y);
    const std::size_t to = math::cube_face_of(point);
    const glm::dvec2 uv = math::uv_on(math::kCubeFaces[to], point) * static_cast<double>(size);
    return faces_[to].texel(level, std::clamp(static_cast<int>(uv.x), 0, size - 1),
                            std::clamp(static_cast<int>(uv.y), 0, size - 1));
}

}  // namespace vrut::reference
