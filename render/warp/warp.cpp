#include "warp/warp.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

namespace vrut::warp {

namespace {

/// What is nearer, what is farther, and what a surface hides.
enum class Layer { near, far, hidden };
/// By how much the last lies behind what is seen, as a reciprocal distance.
constexpr double kBehind = 1e-9;
/// How far the grid goes on beside the image, in parts of that.
constexpr double kBeside = 2;

/// A corner of the grid: where it lies in the image, and where the warp takes it.
struct Corner {
    glm::dvec2 uv{0};      ///< 0 to 1, from the top left
    glm::dvec4 clip{0};    ///< x, y, 1 / scale of both, reciprocal distance
    glm::dvec3 behind{0};  ///< the colour of what lies behind this corner
    int steps = 0, slope = 0;
    std::size_t block = 0;
};

bool is_step(int low, int high, int slope) { return high - low > kGap + 2 * slope || (low == 0 && high > 0); }

std::size_t index_of(int columns, int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
}

/// Row by row, with the block itself.
template <class Visit>
void for_each_beside(const DepthMap& map, int column, int row, int blocks, Visit visit) {
    for (int y = std::max(row - blocks, 0); y <= std::min(row + blocks, map.rows - 1); ++y)
        for (int x = std::max(column - blocks, 0); x <= std::min(column + blocks, map.columns - 1); ++x)
            visit(index_of(map.columns, x, y));
}

/// Of a block, or of a part of it that shows what is farther.
glm::dvec2 middle_of_farther(const DepthMap& map, std::size_t block) {
    const int at = static_cast<int>(block), column = at % map.columns, row = at / map.columns;
    glm::dvec2 middle(0.5);
    if (map.near[block] != map.far[block]) {
        constexpr int kLast = DepthMap::kBits * DepthMap::kBits - 1;
        const int bit = std::min(std::countr_one(map.mask[block]), kLast);
        const int x = bit % DepthMap::kBits, y = bit / DepthMap::kBits;
        middle = (glm::dvec2(x, y) + 0.5) / static_cast<double>(DepthMap::kBits);
    }
    return (glm::dvec2(column, row) + middle) / glm::dvec2(map.columns, map.rows);
}

/// From the four nearest pixels, those at the side repeated.
glm::dvec3 sampled(const scene::Image& image, const glm::dvec2& uv) {
    const double x = uv.x * image.width - 0.5, y = uv.y * image.height - 0.5;
    const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
    const auto pixel = [&](int i, int j) {
        const std::size_t at = 4 * index_of(image.width, std::clamp(i, 0, image.width - 1),
                                            image.height - 1 - std::clamp(j, 0, image.height - 1));
        return glm::dvec3(image.rgba[at], image.rgba[at + 1], image.rgba[at + 2]);
    };
    const glm::dvec2 part(x - left, y - top);
    return glm::mix(glm::mix(pixel(left, top), pixel(left + 1, top), part.x),
                    glm::mix(pixel(left, top + 1), pixel(left + 1, top + 1), part.x), part.y);
}

class Raster {
public:
    Raster(const scene::Image& from, const DepthMap& depth, const Layers& layers, scene::Image& to)
        : from_(from),
          depth_(depth),
          layers_(layers),
          to_(to),
          nearest_(static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height), -1.0) {}

    void draw(const std::array<const Corner*, 3>& corners, Layer layer) {
        // Nothing here is clipped: what a corner has behind the eye is not seen.
        std::array<glm::dvec2, 3> at{};
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec4& clip = corners[i]->clip;
            if (clip.z <= 0) return;
            at[i] = {(clip.x / clip.z + 1) / 2 * to_.width, (1 - clip.y / clip.z) / 2 * to_.height};
        }
        const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
        const double area = cross(at[1] - at[0], at[2] - at[0]);
        if (area == 0 || !std::isfinite(area)) return;
        const auto bound = [&](auto of, int most) {
            const auto [low, high] = std::minmax({of(at[0]), of(at[1]), of(at[2])});
            return std::pair(static_cast<int>(std::clamp(std::floor(low - 0.5), 0.0, most - 1.0)),
                             static_cast<int>(std::clamp(std::ceil(high - 0.5), 0.0, most - 1.0)));
        };
        const auto [left, right] = bound([](const glm::dvec2& p) { return p.x; }, to_.width);
        const auto [top, bottom] = bound([](const glm::dvec2& p) { return p.y; }, to_.height);
        for (int y = top; y <= bottom; ++y)
            for (int x = left; x <= right; ++x) {
                const glm::dvec2 p(x + 0.5, y + 0.5);
                const glm::dvec3 weights(cross(at[1] - p, at[2] - p) / area,
                                         cross(at[2] - p, at[0] - p) / area,
                                         cross(at[0] - p, at[1] - p) / area);
                if (weights.x < 0 || weights.y < 0 || weights.z < 0) continue;
                fill(corners, weights, index_of(to_.width, x, to_.height - 1 - y), layer);
            }
    }

private:
    void fill(const std::array<const Corner*, 3>& corners, const glm::dvec3& weights, std::size_t pixel,
              Layer layer) {
        glm::dvec2 uv(0);
        glm::dvec3 behind(0);
        double sum = 0, distance = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const double weight = weights[static_cast<int>(i)] / corners[i]->clip.z;
            uv += weight * corners[i]->uv;
            behind += weight * corners[i]->behind;
            distance += weights[static_cast<int>(i)] * corners[i]->clip.w;
            sum += weight;
        }
        uv /= sum;
        if (layer == Layer::hidden) {
            const Corner& far =
                **std::ranges::min_element(corners, {}, [](const Corner* corner) { return corner->steps; });
            distance = far.clip.w - kBehind;
        } else if (!is_in_layer(uv, layer)) {
            return;
        }
        if (distance <= nearest_[pixel]) return;
        nearest_[pixel] = distance;
        const glm::dvec3 color = layer == Layer::hidden ? behind / sum : sampled(from_, uv);
        for (unsigned k = 0; k < 3; ++k)
            to_.rgba[4 * pixel + k] = static_cast<std::uint8_t>(std::lround(color[static_cast<int>(k)]));
    }

    bool is_in_layer(const glm::dvec2& uv, Layer layer) const {
        const auto part = [](double u, int blocks) {
            return std::clamp(static_cast<int>(u * blocks * DepthMap::kBits), 0,
                              blocks * DepthMap::kBits - 1);
        };
        const int x = part(uv.x, depth_.columns), y = part(uv.y, depth_.rows);
        const std::size_t block = index_of(depth_.columns, x / DepthMap::kBits, y / DepthMap::kBits);
        if (layers_.near[block] == layers_.far[block]) return true;
        const int bit = DepthMap::kBits * (y % DepthMap::kBits) + x % DepthMap::kBits;
        return (layers_.mask[block] >> bit & 1) == (layer == Layer::near ? 1 : 0);
    }

    const scene::Image& from_;
    const DepthMap& depth_;
    const Layers& layers_;
    scene::Image& to_;
    std::vector<double> nearest_;
};

}  // namespace

glm::dmat4 warp_matrix(const scene::Camera& from, const scene::Camera& to, double aspect) {
    const auto rays = [&](const scene::Camera& camera) {
        const math::Projection sides = scene::projection_of(camera, aspect);
        return glm::dvec2(sides.right, sides.top);
    };
    const glm::dvec2 before = rays(from), after = rays(to);
    // A point of the view is (x, y, -1, d), and so are those of the world with w = d.
    glm::dmat4 view_from_image(0);
    view_from_image[0][0] = before.x;
    view_from_image[1][1] = before.y;
    view_from_image[2][2] = -1;
    view_from_image[3][3] = 1;
    glm::dmat4 image_from_view(0);
    image_from_view[0][0] = 1 / after.x;
    image_from_view[1][1] = 1 / after.y;
    image_from_view[2][2] = -1;
    image_from_view[3][3] = 1;
    return image_from_view * scene::view_from_world(to) * glm::inverse(scene::view_from_world(from)) *
           view_from_image;
}

/// Reciprocal distances are linear in the image where a surface is a plane: it rises on both sides alike.
std::vector<std::uint8_t> slopes_of(const std::vector<std::uint8_t>& steps, int columns, int rows) {
    std::vector<std::uint8_t> slopes;
    slopes.reserve(steps.size());
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const auto rise = [&](int x, int y) {
                return std::abs(
                    steps[index_of(columns, column, row)] -
                    steps[index_of(columns, std::clamp(x, 0, columns - 1), std::clamp(y, 0, rows - 1))]);
            };
            // At a side of the image the other one counts.
            const int left = rise(column > 0 ? column - 1 : 1, row);
            const int right = rise(column + 1 < columns ? column + 1 : column - 1, row);
            const int above = rise(column, row > 0 ? row - 1 : 1);
            const int below = rise(column, row + 1 < rows ? row + 1 : row - 1);
            slopes.push_back(static_cast<std::uint8_t>(
                std::min(std::min(left, right) + std::min(above, below), DepthMap::kSteps)));
        }
    return slopes;
}

Layers layers_of(const DepthMap& map) {
    // The middle of a block with an edge has maybe the colour of what is nearer.
    const auto reach = [&](std::size_t block) {
        return map.far[block] + (map.near[block] != map.far[block] ? kGap : 0);
    };
    Layers layers{map.near,
                  map.far,
                  map.mask,
                  slopes_of(map.near, map.columns, map.rows),
                  slopes_of(map.far, map.columns, map.rows),
                  std::vector<std::uint32_t>(map.far.size())};
    for (int row = 0; row < map.rows; ++row)
        for (int column = 0; column < map.columns; ++column) {
            const std::size_t at = index_of(map.columns, column, row);
            std::size_t nearest = at, lowest = at, farthest = at;
            for_each_beside(map, column, row, 1, [&](std::size_t beside) {
                if (map.near[beside] > map.near[nearest]) nearest = beside;
                if (map.far[beside] < map.far[lowest]) lowest = beside;
            });
            for_each_beside(map, column, row, 2, [&](std::size_t beside) {
                if (reach(beside) < reach(farthest)) farthest = beside;
            });
            layers.farthest[at] = static_cast<std::uint32_t>(farthest);
            if (map.near[at] != map.far[at]) continue;
            const int near_slope = std::min(layers.near_slope[at], layers.near_slope[nearest]);
            const int far_slope = std::min(layers.far_slope[at], layers.far_slope[lowest]);
            if (is_step(map.near[at], map.near[nearest], near_slope)) {
                layers.near[at] = map.near[nearest];
                layers.mask[at] = 0;  // it belongs to the other layer
            } else if (is_step(map.far[lowest], map.far[at], far_slope)) {
                layers.far[at] = map.far[lowest];
            }
        }
    return layers;
}

scene::Image warped(const scene::Image& image, const DepthMap& depth, const scene::Camera& from,
                    const scene::Camera& to, Background background) {
    scene::Image result = image;  // where nothing covers it
    if (depth.columns < 1) return result;
    const Layers layers = layers_of(depth);
    const glm::dmat4 matrix = warp_matrix(from, to, static_cast<double>(image.width) / image.height);
    Raster raster(image, depth, layers, result);

    // The blocks' centres, and a row and a column beyond each side of the image.
    const int columns = depth.columns + 2, rows = depth.rows + 2;
    std::vector<Corner> corners(index_of(columns, 0, rows));
    const auto place = [](int i, int blocks) {
        return i == 0 ? -kBeside : i == blocks + 1 ? 1 + kBeside : (i - 0.5) / blocks;
    };
    for (const auto& [layer, values] :
         {std::pair(Layer::near, &layers.near), std::pair(Layer::far, &layers.far),
          std::pair(Layer::hidden, &depth.far)}) {
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) {
                Corner& corner = corners[index_of(columns, column, row)];
                corner.block = index_of(depth.columns, std::clamp(column - 1, 0, depth.columns - 1),
                                        std::clamp(row - 1, 0, depth.rows - 1));
                corner.uv = {place(column, depth.columns), place(row, depth.rows)};
                corner.behind = sampled(image, middle_of_farther(depth, layers.farthest[corner.block]));
                corner.steps = (*values)[corner.block];
                corner.slope = (layer == Layer::near ? layers.near_slope : layers.far_slope)[corner.block];
                corner.clip = matrix * glm::dvec4(2 * corner.uv.x - 1, 1 - 2 * corner.uv.y, 1,
                                                  depth.scale * corner.steps / DepthMap::kSteps);
                // Of what it sees: the reciprocal of the distance along the view.
                corner.clip.w /= corner.clip.z;
                if (corner.steps == 0 && background == Background::stays)
                    corner.clip = {2 * corner.uv.x - 1, 1 - 2 * corner.uv.y, 1, 0};
            }
        for (int row = 0; row + 1 < rows; ++row)
            for (int column = 0; column + 1 < columns; ++column) {
                const std::array<const Corner*, 4> cell{&corners[index_of(columns, column, row)],
                                                        &corners[index_of(columns, column + 1, row)],
                                                        &corners[index_of(columns, column, row + 1)],
                                                        &corners[index_of(columns, column + 1, row + 1)]};
                const auto has_two_layers = [&](const Corner* corner) {
                    return layers.near[corner->block] != layers.far[corner->block];
                };
                if (layer == Layer::far && std::ranges::none_of(cell, has_two_layers)) continue;
                for (const std::array<std::size_t, 3> triangle :
                     {std::array<std::size_t, 3>{0, 1, 2}, std::array<std::size_t, 3>{2, 1, 3}}) {
                    const std::array<const Corner*, 3> three{cell[triangle[0]], cell[triangle[1]],
                                                             cell[triangle[2]]};
                    const auto [low, high] = std::minmax({three[0]->steps, three[1]->steps, three[2]->steps});
                    const int slope = std::min({three[0]->slope, three[1]->slope, three[2]->slope});
                    if (is_step(low, high, slope) == (layer == Layer::hidden)) raster.draw(three, layer);
                }
            }
    }
    return result;
}

}  // namespace vrut::warp
