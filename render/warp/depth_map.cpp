#include "warp/depth_map.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace vrut::warp {

namespace {

constexpr int kParts = DepthMap::kBits * DepthMap::kBits;
/// Steps between what belongs to two surfaces: an edge goes through the block.
constexpr int kEdge = 3;

using Parts = std::array<std::uint8_t, kParts>;

/// Of a block with an edge.
struct Divided {
    std::uint8_t near = 0, far = 0;
    std::uint16_t mask = 0;
};

std::uint8_t mean(const Parts& parts, std::uint16_t mask) {
    int sum = 0, count = 0;
    for (unsigned i = 0; i < parts.size(); ++i) {
        if ((mask >> i & 1U) == 0) continue;
        sum += parts[i];
        ++count;
    }
    return static_cast<std::uint8_t>((sum + count / 2) / std::max(count, 1));
}

/// The parts of a mask, and those beside them: pixels at an edge have something of the colours of both sides,
/// and go with what is nearer.
std::uint16_t widened(std::uint16_t mask) {
    constexpr unsigned kLeft = 0x1111, kRight = 0x8888;
    const unsigned parts = mask, wide = parts | (parts & ~kRight) << 1U | (parts & ~kLeft) >> 1U;
    return static_cast<std::uint16_t>(wide | wide << 4U | wide >> 4U);
}

/// Divides a block in the middle between its nearest part and its farthest. None where it is a slope, whose
/// parts lie one after the other.
std::optional<Divided> divided_of(const Parts& parts, int lowest, int highest) {
    const int middle = (lowest + highest) / 2;
    int below = lowest, above = highest;
    unsigned mask = 0;
    for (unsigned i = 0; i < parts.size(); ++i) {
        const int part = parts[i];
        const bool is_near = part > middle;
        mask |= static_cast<unsigned>(is_near) << i;
        above = std::min(above, is_near ? part : above);
        below = std::max(below, is_near ? below : part);
    }
    if (above - below < std::max(kEdge, (highest - lowest) / 2)) return {};
    const auto near = static_cast<std::uint16_t>(mask);
    return Divided{mean(parts, near), mean(parts, static_cast<std::uint16_t>(~near)), widened(near)};
}

/// Median of left, upper, and the plane through left, upper and upper left (Weinberger et al., "LOCO-I",
/// 1996).
int median_prediction(int left, int upper, int upper_left) {
    const int low = std::min(left, upper), high = std::max(left, upper);
    return std::max(low, std::min(high, left + upper - upper_left));
}

/// The same of a value in a map; at its edges the neighbour that is there.
int predicted(std::span<const std::uint8_t> values, int columns, int column, int row) {
    const auto at = [&](int x, int y) {
        return static_cast<int>(values[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                                       static_cast<std::size_t>(x)]);
    };
    if (row == 0) return column == 0 ? 0 : at(column - 1, row);
    if (column == 0) return at(column, row - 1);
    return median_prediction(at(column - 1, row), at(column, row - 1), at(column - 1, row - 1));
}

/// The difference of two values modulo 256, small ones of either sign as small ones without.
char difference(int value, int predicted) {
    const int modulo = (value - predicted) & 0xff, wrapped = modulo > 127 ? modulo - 256 : modulo;
    return static_cast<char>(wrapped < 0 ? -2 * wrapped - 1 : 2 * wrapped);
}
std::uint8_t summed(int predicted, char difference) {
    const int folded = static_cast<unsigned char>(difference);
    return static_cast<std::uint8_t>(predicted + (folded % 2 == 1 ? -(folded / 2) - 1 : folded / 2));
}

/// Of a block through which an edge goes: what is near left of it or above it.
int predicted_near(std::span<const std::uint8_t> near, int columns, std::size_t block) {
    const std::size_t above = static_cast<std::size_t>(columns);
    return std::max(block % above > 0 ? near[block - 1] : 0, block >= above ? near[block - above] : 0);
}

std::size_t size_of(int columns, int rows) {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
}

/// Of each `far` from its prediction, row by row: predicted() would ask at each where the map's edges are.
std::string far_differences(const DepthMap& map) {
    const auto columns = static_cast<std::size_t>(map.columns);
    std::string differences(map.far.size(), 0);
    for (std::size_t x = 0; x < columns; ++x)
        differences[x] = difference(map.far[x], x == 0 ? 0 : map.far[x - 1]);
    for (std::size_t start = columns; start < map.far.size(); start += columns) {
        const std::uint8_t *row = map.far.data() + start, *above = row - columns;
        differences[start] = difference(row[0], above[0]);
        for (std::size_t x = 1; x < columns; ++x)
            differences[start + x] =
                difference(row[x], median_prediction(row[x - 1], above[x], above[x - 1]));
    }
    return differences;
}

/// In the format of zlib. What is left of depths after prediction repeats in runs, and seldom in
/// longer strings: a search for runs alone takes half of the time, and its result a few bytes less.
std::string deflated(std::string_view plain) {
    constexpr int kLevel = 3, kLargestWindow = 15, kMemory = 8;
    z_stream stream{};
    if (deflateInit2(&stream, kLevel, Z_DEFLATED, kLargestWindow, kMemory, Z_RLE) != Z_OK) return {};
    std::string bytes(deflateBound(&stream, plain.size()), 0);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(plain.data()));
    stream.avail_in = static_cast<uInt>(plain.size());
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_out = static_cast<uInt>(bytes.size());
    const bool ended = deflate(&stream, Z_FINISH) == Z_STREAM_END;
    bytes.resize(ended ? stream.total_out : 0);
    deflateEnd(&stream);
    return bytes;
}

/// An image's depth at the middle of each part of its blocks, in steps, rows from the top down.
struct Samples {
    Samples(std::span<const float> depth, int width, int height, const DepthMapSize& size,
            std::span<const float> added)
        : columns(static_cast<std::size_t>(DepthMap::kBits) * static_cast<std::size_t>(size.columns)) {
        const auto pixels = [](std::size_t parts, int side) {
            std::vector<std::size_t> at(parts);
            for (std::size_t i = 0; i < parts; ++i)
                at[i] = (2 * i + 1) * static_cast<std::size_t>(side) / (2 * parts);
            return at;
        };
        const std::vector<std::size_t> across = pixels(columns, width);
        const std::vector<std::size_t> down =
            pixels(static_cast<std::size_t>(DepthMap::kBits) * static_cast<std::size_t>(size.rows), height);
        std::vector<float> values(columns * down.size());
        float* value = values.data();
        for (const std::size_t y : down) {
            const float* row =
                depth.data() + (static_cast<std::size_t>(height) - 1 - y) * static_cast<std::size_t>(width);
            for (const std::size_t x : across) *value++ = row[x];
        }
        if (!added.empty()) add(values, added);
        // By several at once: the compiler may not reorder a maximum of floats.
        std::array<float, kParts> largest{};
        for (std::size_t i = 0; i < values.size(); i += largest.size())
            for (std::size_t k = 0; k < largest.size(); ++k)
                largest[k] = values[i + k] > largest[k] ? values[i + k] : largest[k];
        nearest = std::ranges::max(largest);
        const float twice = nearest > 0 ? static_cast<float>(2 * DepthMap::kSteps) / nearest : 0;
        steps.resize(values.size());
        for (std::size_t i = 0; i < values.size(); ++i)
            steps[i] = static_cast<std::uint8_t>((static_cast<int>(values[i] * twice) + 1) / 2);
    }

    std::array<const std::uint8_t*, DepthMap::kBits> rows_of(int block_row) const {
        std::array<const std::uint8_t*, DepthMap::kBits> rows{};
        for (std::size_t i = 0; i < rows.size(); ++i)
            rows[i] = steps.data() + (static_cast<std::size_t>(block_row) * rows.size() + i) * columns;
        return rows;
    }

    /// Its rows go from the bottom up.
    void add(std::vector<float>& values, std::span<const float> added) const {
        constexpr std::size_t kRepeated = DepthMap::kBits / kAddedSide;
        const std::size_t row_size = columns / kRepeated, rows = added.size() / row_size;
        std::vector<float> repeated(columns);
        float* value = values.data();
        for (std::size_t y = rows; y-- > 0;) {
            const float* row = added.data() + y * row_size;
            for (std::size_t x = 0; x < row_size; ++x)
                for (std::size_t k = 0; k < kRepeated; ++k) repeated[kRepeated * x + k] = row[x];
            for (std::size_t k = 0; k < kRepeated; ++k, value += columns)
                for (std::size_t x = 0; x < columns; ++x)
                    value[x] = repeated[x] > value[x] ? repeated[x] : value[x];
        }
    }

    std::size_t columns = 0;
    float nearest = 0;
    std::vector<std::uint8_t> steps;
};

}  // namespace

DepthMapSize depth_map_size(int width, int height, double pixels) {
    const double side = std::max(pixels, static_cast<double>(std::max(width, height)) / kMostBlocks);
    const auto count = [&](int length) {
        return std::clamp(static_cast<int>(std::ceil(length / side)), 1, kMostBlocks);
    };
    return {count(width), count(height)};
}

void BlockChoice::took(std::size_t map_bytes, std::size_t frame_bytes) {
    // The bytes of a map grow with its blocks, and so with the square of their size.
    const double most = std::max(kMostOfFrame * static_cast<double>(frame_bytes), kEnough);
    const double wanted = pixels_ * std::sqrt(static_cast<double>(map_bytes) / most);
    if (wanted > pixels_ || wanted < 0.85 * pixels_) pixels_ = std::clamp(wanted * 1.05, kFinest, kCoarsest);
}

DepthMap depth_map_of(std::span<const float> depth, int width, int height, double near_distance,
                      const DepthMapSize& size, std::span<const float> added) {
    const Samples samples(depth, width, height, size, added);
    DepthMap map{size.columns, size.rows, static_cast<double>(samples.nearest) / near_distance, {}, {}, {}};
    const std::size_t blocks = size_of(size.columns, size.rows);
    map.near.resize(blocks);
    map.far.resize(blocks);
    map.mask.assign(blocks, 0xffff);
    std::vector<std::uint8_t> low(samples.columns), high(samples.columns);
    std::vector<std::uint16_t> sum(samples.columns);
    std::size_t block = 0;
    for (int row = 0; row < size.rows; ++row) {
        // Most blocks are smooth. Their columns are summed up first, many at once.
        const auto [a, b, c, d] = samples.rows_of(row);
        for (std::size_t x = 0; x < samples.columns; ++x) {
            low[x] = std::min(std::min(a[x], b[x]), std::min(c[x], d[x]));
            high[x] = std::max(std::max(a[x], b[x]), std::max(c[x], d[x]));
            sum[x] = static_cast<std::uint16_t>(a[x] + b[x] + c[x] + d[x]);
        }
        for (std::size_t x = 0; x < samples.columns; x += DepthMap::kBits, ++block) {
            const int lowest = std::min(std::min(low[x], low[x + 1]), std::min(low[x + 2], low[x + 3]));
            const int highest = std::max(std::max(high[x], high[x + 1]), std::max(high[x + 2], high[x + 3]));
            const int all = sum[x] + sum[x + 1] + sum[x + 2] + sum[x + 3];
            map.near[block] = map.far[block] = static_cast<std::uint8_t>((all + kParts / 2) / kParts);
            if (highest - lowest < kEdge) continue;
            Parts parts;
            constexpr std::size_t kSide = DepthMap::kBits;
            for (std::size_t i = 0; i < kSide; ++i) {
                parts[i] = a[x + i];
                parts[kSide + i] = b[x + i];
                parts[2 * kSide + i] = c[x + i];
                parts[3 * kSide + i] = d[x + i];
            }
            const std::optional<Divided> divided = divided_of(parts, lowest, highest);
            if (!divided) continue;
            map.near[block] = divided->near;
            map.far[block] = divided->far;
            map.mask[block] = divided->mask;
        }
    }
    return map;
}

std::string encode(const DepthMap& map) {
    const std::size_t blocks = size_of(map.columns, map.rows);
    std::string edges((blocks + 7) / 8, 0), nearer, masks;
    for (std::size_t i = 0; i < blocks; ++i) {
        if (map.near[i] == map.far[i]) continue;
        edges[i / 8] = static_cast<char>(edges[i / 8] | 1 << i % 8);
        nearer += difference(map.near[i], predicted_near(map.near, map.columns, i));
        masks += static_cast<char>(map.mask[i] & 0xff);
        masks += static_cast<char>(map.mask[i] >> 8);
    }
    return deflated(far_differences(map) + edges + nearer + masks);
}

std::optional<DepthMap> decode(std::string_view bytes, int columns, int rows, double scale) {
    if (columns < 1 || rows < 1 || columns > kMostBlocks || rows > kMostBlocks) return {};
    const std::size_t blocks = size_of(columns, rows), edges_at = blocks,
                      nearer_at = edges_at + (blocks + 7) / 8;
    std::string plain(nearer_at + 3 * blocks, 0);
    uLongf size = plain.size();
    if (uncompress(reinterpret_cast<Bytef*>(plain.data()), &size,
                   reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()) != Z_OK)
        return {};
    plain.resize(size);
    if (plain.size() < nearer_at || (plain.size() - nearer_at) % 3 != 0) return {};
    const std::size_t edges = (plain.size() - nearer_at) / 3, masks_at = nearer_at + edges;

    DepthMap map{columns, rows, scale, {}, {}, {}};
    map.near.reserve(blocks);
    map.far.reserve(blocks);
    map.mask.reserve(blocks);
    std::size_t edge = 0;
    for (std::size_t i = 0; i < blocks; ++i) {
        const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
        map.far.push_back(summed(predicted(map.far, columns, column, row), plain[i]));
        if ((plain[edges_at + i / 8] >> i % 8 & 1) == 0) {
            map.near.push_back(map.far.back());
            map.mask.push_back(0xffff);
            continue;
        }
        if (edge == edges) return {};
        const auto byte = [&](std::size_t at) {
            return static_cast<unsigned>(static_cast<unsigned char>(plain[at]));
        };
        map.near.push_back(summed(predicted_near(map.near, columns, i), plain[nearer_at + edge]));
        map.mask.push_back(
            static_cast<std::uint16_t>(byte(masks_at + 2 * edge) | byte(masks_at + 2 * edge + 1) << 8U));
        if (map.near.back() <= map.far.back()) return {};
        ++edge;
    }
    if (edge != edges) return {};
    return map;
}

}  // namespace vrut::warp
