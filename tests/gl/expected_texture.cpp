#include "expected_texture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "expected_image.hpp"

namespace vrut {

namespace {

/// How much of the new texel `i` of `count` lies over the old one `k` of `old_count`, as a share of the new
/// one.
double share(int i, int count, int k, int old_count) {
    const double ratio = static_cast<double>(old_count) / count;
    return std::max(0.0, std::min((i + 1) * ratio, k + 1.0) - std::max(i * ratio, 1.0 * k)) / ratio;
}

int wrapped(int i, int count, bool repeat) {
    return repeat ? ((i % count) + count) % count : std::clamp(i, 0, count - 1);
}

}  // namespace

ExpectedTexture::ExpectedTexture(const scene::Image& image) {
    ExpectedMipLevel first{{image.width, image.height}, {}};
    for (std::size_t i = 0; i < image.rgba.size(); i += 4)
        first.texels.push_back(glm::dvec3(image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]) / 255.0);
    levels_.push_back(std::move(first));
    while (levels_.back().size != glm::ivec2(1)) {
        const glm::ivec2 old = levels_.back().size, size = glm::max(old / 2, 1);
        ExpectedMipLevel level{size, {}};
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                glm::dvec3 sum(0);
                const glm::ivec2 from{x * old.x / size.x, y * old.y / size.y};
                for (int v = from.y; v < std::min(from.y + 4, old.y); ++v)
                    for (int u = from.x; u < std::min(from.x + 4, old.x); ++u)
                        sum += share(x, size.x, u, old.x) * share(y, size.y, v, old.y) *
                               texel(levels() - 1, u, v);
                level.texels.push_back(sum);
            }
        levels_.push_back(std::move(level));
    }
}

const glm::dvec3& ExpectedTexture::texel(int level, int x, int y) const {
    const ExpectedMipLevel& from = levels_[static_cast<std::size_t>(level)];
    return from.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(from.size.x) +
                       static_cast<std::size_t>(x)];
}

glm::dvec3 ExpectedTexture::bilinear(int level, const glm::dvec2& uv, bool repeat) const {
    const glm::ivec2 count = size(level);
    const glm::dvec2 at = uv * glm::dvec2(count) - 0.5, low = glm::floor(at), part = at - low;
    const auto corner = [&](int dx, int dy) {
        return texel(level, wrapped(static_cast<int>(low.x) + dx, count.x, repeat),
                     wrapped(static_cast<int>(low.y) + dy, count.y, repeat));
    };
    return glm::mix(glm::mix(corner(0, 0), corner(1, 0), part.x),
                    glm::mix(corner(0, 1), corner(1, 1), part.x), part.y);
}

glm::dvec3 ExpectedTexture::at(const glm::dvec2& uv, const glm::dvec2& across, const glm::dvec2& up,
                               bool repeat) const {
    const glm::dvec2 count(size(0));
    const double level = std::min<double>(expected_level(across * count, up * count), levels() - 1);
    const int finer = static_cast<int>(level), coarser = std::min(finer + 1, levels() - 1);
    return glm::mix(bilinear(finer, uv, repeat), bilinear(coarser, uv, repeat), level - finer);
}

const std::array<ExpectedEnvironment::ExpectedFace, 6> ExpectedEnvironment::kFaces{
    ExpectedFace{{1, 0, 0}, {0, 1, 0}}, ExpectedFace{{-1, 0, 0}, {0, 1, 0}},
    ExpectedFace{{0, 1, 0}, {0, 0, 1}}, ExpectedFace{{0, -1, 0}, {0, 0, -1}},
    ExpectedFace{{0, 0, 1}, {0, 1, 0}}, ExpectedFace{{0, 0, -1}, {0, 1, 0}}};

namespace {

std::size_t face_towards(const glm::dvec3& direction) {
    const auto ahead = [&](const ExpectedEnvironment::ExpectedFace& face) {
        return glm::dot(face.view, direction);
    };
    const auto& faces = ExpectedEnvironment::kFaces;
    return static_cast<std::size_t>(
        std::max_element(faces.begin(), faces.end(),
                         [&](const auto& a, const auto& b) { return ahead(a) < ahead(b); }) -
        faces.begin());
}

/// Where a direction meets a face's picture, (0, 0) to (1, 1).
glm::dvec2 uv_on(const ExpectedEnvironment::ExpectedFace& face, const glm::dvec3& direction) {
    return glm::dvec2(glm::dot(direction, face.right()), glm::dot(direction, face.up)) /
               glm::dot(direction, face.view) / 2.0 +
           0.5;
}

}  // namespace

ExpectedEnvironment::ExpectedEnvironment(const std::array<scene::Image, 6>& images)
    : faces_(images.begin(), images.end()) {}

glm::dvec3 ExpectedEnvironment::texel(std::size_t face, int level, const glm::ivec2& at) const {
    const int size = faces_[face].size(level).x;
    const glm::ivec2 inside = glm::clamp(at, 0, size - 1);
    if (at == inside) return faces_[face].texel(level, at.x, at.y);
    if (at.x != inside.x && at.y != inside.y)  // three faces meet
        return (texel(face, level, inside) + texel(face, level, {at.x, inside.y}) +
                texel(face, level, {inside.x, at.y})) /
               3.0;
    // Half a texel beyond the edge, on the face that begins there.
    const ExpectedFace& from = kFaces[face];
    const glm::dvec2 on_face =
        glm::clamp((glm::dvec2(at) + 0.5) * 2.0 / static_cast<double>(size) - 1.0, -1.0, 1.0);
    const glm::dvec3 there = from.view * (1 - 1.0 / size) + from.right() * on_face.x + from.up * on_face.y;
    const std::size_t to = face_towards(there);
    const glm::ivec2 texel_there(uv_on(kFaces[to], there) * static_cast<double>(size));
    return faces_[to].texel(level, std::clamp(texel_there.x, 0, size - 1),
                            std::clamp(texel_there.y, 0, size - 1));
}

glm::dvec3 ExpectedEnvironment::bilinear(std::size_t face, int level, const glm::dvec2& uv) const {
    const glm::dvec2 at = uv * glm::dvec2(faces_[face].size(level)) - 0.5, low = glm::floor(at),
                     part = at - low;
    const auto corner = [&](int dx, int dy) {
        return texel(face, level, glm::ivec2(low) + glm::ivec2(dx, dy));
    };
    return glm::mix(glm::mix(corner(0, 0), corner(1, 0), part.x),
                    glm::mix(corner(0, 1), corner(1, 1), part.x), part.y);
}

glm::dvec3 ExpectedEnvironment::at(const glm::dvec3& direction, const glm::dvec3& across,
                                   const glm::dvec3& up) const {
    const std::size_t face = face_towards(direction);
    const auto change = [&](const glm::dvec3& by) {
        constexpr double kStep = 1e-5;
        return (uv_on(kFaces[face], direction + by * kStep) - uv_on(kFaces[face], direction - by * kStep)) /
               (2 * kStep) * glm::dvec2(faces_[face].size(0));
    };
    const int last = faces_[face].levels() - 1;
    const double level = std::min<double>(expected_level(change(across), change(up)), last);
    const int finer = static_cast<int>(level), coarser = std::min(finer + 1, last);
    const glm::dvec2 uv = uv_on(kFaces[face], direction);
    return glm::mix(bilinear(face, finer, uv), bilinear(face, coarser, uv), level - finer);
}

double expected_level(const glm::dvec2& across, const glm::dvec2& up) {
    return std::log2(std::max({1.0, glm::length(across), glm::length(up)}));
}

scene::Image noise(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    scene::Image image;
    image.resize(width, height);
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] = i % 4 == 3 ? 255 : static_cast<std::uint8_t>(random() >> 24);
    return image;
}

scene::Image cloudy(int width, int height, unsigned seed) {
    scene::Image image;
    image.resize(width, height);
    std::vector<double> sums(image.rgba.size(), 0);
    for (int cell = std::max(width, height); cell >= 1; cell /= 2) {
        const scene::Image layer =
            noise(width / cell + 1, height / cell + 1, seed + static_cast<unsigned>(cell));
        for (std::size_t i = 0; i < sums.size(); ++i) {
            const auto texel = static_cast<int>(i / 4);
            const int x = texel % width / cell, y = texel / width / cell;
            sums[i] += layer.rgba[static_cast<std::size_t>(y * layer.width + x) * 4 + i % 4] - 127.5;
        }
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
        image.rgba[i] =
            i % 4 == 3 ? 255 : static_cast<std::uint8_t>(std::clamp(127.5 + sums[i] / 3, 0.0, 255.0));
    return image;
}

TextureMismatch deviation(const scene::Image& image,
                          const std::function<std::optional<glm::dvec3>(double x, double y)>& expected) {
    TextureMismatch result;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const auto should = expected(x + 0.5, y + 0.5);
            if (!should) continue;
            ++result.pixels;
            const glm::dvec3 off = glm::abs(glm::dvec3(pixel_of(image, x, y)) - *should * 255.0);
            result.rms += glm::dot(off, off) / 3;
            const double worst = std::max({off.r, off.g, off.b});
            if (worst <= result.worst) continue;
            result.worst = worst;
            result.where = "at " + std::to_string(x) + ", " + std::to_string(y);
        }
    result.rms = std::sqrt(result.rms / std::max(result.pixels, 1));
    return result;
}

glm::dvec3 ray_through(const plan::View& view, double x, double y) {
    const scene::Camera& camera = view.camera;
    const glm::dvec3 forward = glm::normalize(camera.focus - camera.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up)), up = glm::cross(right, forward);
    const double pixel = 2 * std::tan(camera.fov * std::numbers::pi / 360) / view.height;
    return forward + right * ((x - view.width / 2.0) * pixel) + up * ((view.height / 2.0 - y) * pixel);
}

}  // namespace vrut
