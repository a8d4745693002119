#include "warp/depth_map.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace vrut::warp {

namespace {

constexpr int kParts = DepthMap::kBits * DepthMap::kBits;
/// Steps between what belongs to two surfaces: an edge goes through the block.
constexpr int kEdge = 3;
constexpr std::size_t kAtOnce = 16;  // parts in a vector of the processor
constexpr std::size_t kAddedRepeated = DepthMap::kBits / kAddedSide;

using Parts = std::array<std::uint8_t, kParts>;

/// By value: the compiler makes no vectors of std::min's references.
std::uint8_t smaller(std::uint8_t a, std::uint8_t b) { return a < b ? a : b; }
std::uint8_t larger(std::uint8_t a, std::uint8_t b) { return a > b ? a : b; }

/// Of a block with an edge.
struct Divided {
    std::uint8_t near = 0, far = 0;
    std::uint16_t mask = 0;
};

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
    int below = lowest, above = highest, all = 0, near = 0;
    unsigned mask = 0;
    for (unsigned i = 0; i < parts.size(); ++i) {
        const int part = parts[i];
        const bool is_near = part > middle;
        mask |= static_cast<unsigned>(is_near) << i;
        above = std::min(above, is_near ? part : above);
        below = std::max(below, is_near ? below : part);
        all += part;
        near += is_near ? part : 0;
    }
    if (above - below < std::max(kEdge, (highest - lowest) / 2)) return {};
    const int count = std::popcount(mask);
    const auto mean = [](int sum, int of) { return static_cast<std::uint8_t>((sum + of / 2) / of); };
    return Divided{mean(near, count), mean(all - near, kParts - count),
                   widened(static_cast<std::uint16_t>(mask))};
}

/// Median of left, upper, and the plane through left, upper and upper left (Weinberger et al., "LOCO-I",
/// 1996).
int median_prediction(int left, int upper, int upper_left) {
    const int low = left < upper ? left : upper, high = left < upper ? upper : left;
    const int plane = left + upper - upper_left, at_most = plane < high ? plane : high;
    return at_most < low ? low : at_most;
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
    const int wrapped = ((value - predicted + 128) & 0xff) - 128;
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
        char* to = differences.data() + start;
        to[0] = difference(row[0], above[0]);
        for (std::size_t x = 1; x < columns; ++x)
            to[x] = difference(row[x], median_prediction(row[x - 1], above[x], above[x - 1]));
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

/// The middles of so many parts of a side, in pixels.
std::vector<std::uint32_t> middles(int parts, int side) {
    std::vector<std::uint32_t> middles(static_cast<std::size_t>(parts));
    for (std::size_t i = 0; i < middles.size(); ++i)
        middles[i] =
            static_cast<std::uint32_t>((2 * i + 1) * static_cast<std::size_t>(side) / (2 * middles.size()));
    return middles;
}

std::vector<std::uint32_t> padded(std::vector<std::uint32_t> columns) {
    columns.resize((columns.size() + kAtOnce - 1) / kAtOnce * kAtOnce, columns.back());
    return columns;
}

/// Of values that are not negative: their bits are in the same order, and the compiler may take a maximum of
/// integers in any.
float largest_of(std::span<const float> values, float least) {
    auto largest = std::bit_cast<std::int32_t>(least);
    for (const float value : values) {
        const auto bits = std::bit_cast<std::int32_t>(value);
        largest = bits > largest ? bits : largest;
    }
    return std::bit_cast<float>(largest);
}

/// Depth of the parts of a row of blocks, in steps. Its loops write to arrays of kAtOnce parts, which the
/// compiler knows not to overlap with what they read.
class BlockRow {
public:
    /// `columns` is a multiple of kAtOnce; `twice`: half steps in a value of 1.
    BlockRow(std::size_t columns, float twice)
        : twice_(twice),
          added_(columns / kAddedRepeated),
          repeated_(columns),
          low_(columns + DepthMap::kBits),
          high_(columns + DepthMap::kBits),
          sum_(columns + DepthMap::kBits) {
        for (std::vector<std::uint8_t>& row : rows_) row.resize(columns);
    }

    /// The i-th row of parts.
    void set(std::size_t i, std::span<const float> values) { to_steps(values, rows_[i]); }

    /// The nearer counts. One of these for several rows of parts and several parts.
    void add(std::size_t i, std::span<const float> values) {
        to_steps(values, added_);
        const std::uint8_t* added = added_.data();
        std::uint8_t* repeated = repeated_.data();
        for (std::size_t x = 0; x < values.size(); ++x)
            for (std::size_t k = 0; k < kAddedRepeated; ++k) repeated[x * kAddedRepeated + k] = added[x];
        const std::size_t columns = repeated_.size();
        for (std::size_t k = kAddedRepeated * i; k < kAddedRepeated * (i + 1); ++k) {
            std::uint8_t* steps = rows_[k].data();
            for (std::size_t x = 0; x < columns; ++x) steps[x] = larger(steps[x], repeated[x]);
        }
    }

    /// Fills a row of a map, whose masks are full.
    void divide(DepthMap& map, std::size_t row) {
        sum_columns();
        const std::size_t first = row * static_cast<std::size_t>(map.columns);
        for (std::size_t x = 0; x < rows_[0].size(); x += kAtOnce) {
            std::array<std::uint8_t, kAtOnce> low{}, high{};
            std::array<std::uint16_t, kAtOnce> sum{};
            const std::uint8_t *l = low_.data() + x, *h = high_.data() + x;
            const std::uint16_t* s = sum_.data() + x;
            for (std::size_t k = 0; k < kAtOnce; ++k) {
                low[k] = smaller(smaller(l[k], l[k + 1]), smaller(l[k + 2], l[k + 3]));
                high[k] = larger(larger(h[k], h[k + 1]), larger(h[k + 2], h[k + 3]));
                sum[k] = static_cast<std::uint16_t>(s[k] + s[k + 1] + s[k + 2] + s[k + 3]);
            }
            const std::size_t end = std::min(x / DepthMap::kBits + kAtOnce / DepthMap::kBits,
                                             static_cast<std::size_t>(map.columns));
            for (std::size_t i = x / DepthMap::kBits, k = 0; i < end; ++i, k += DepthMap::kBits) {
                const auto mean = static_cast<std::uint8_t>((sum[k] + kParts / 2) / kParts);
                map.near[first + i] = map.far[first + i] = mean;
                // Most blocks are smooth.
                if (high[k] - low[k] >= kEdge) divide_block(map, first + i, x + k, low[k], high[k]);
            }
        }
    }

private:
    /// The smallest, the largest and the sum of each column of parts.
    void sum_columns() {
        for (std::size_t x = 0; x < rows_[0].size(); x += kAtOnce) {
            std::array<std::uint8_t, kAtOnce> low{}, high{};
            std::array<std::uint16_t, kAtOnce> sum{};
            const std::uint8_t *a = rows_[0].data() + x, *b = rows_[1].data() + x, *c = rows_[2].data() + x,
                               *d = rows_[3].data() + x;
            for (std::size_t k = 0; k < kAtOnce; ++k) {
                low[k] = smaller(smaller(a[k], b[k]), smaller(c[k], d[k]));
                high[k] = larger(larger(a[k], b[k]), larger(c[k], d[k]));
                sum[k] = static_cast<std::uint16_t>(a[k] + b[k] + c[k] + d[k]);
            }
            std::ranges::copy(low, low_.data() + x);
            std::ranges::copy(high, high_.data() + x);
            std::ranges::copy(sum, sum_.data() + x);
        }
    }

    void to_steps(std::span<const float> values, std::vector<std::uint8_t>& steps) const {
        for (std::size_t x = 0; x < values.size(); ++x)
            steps[x] = static_cast<std::uint8_t>(
                (static_cast<unsigned>(static_cast<int>(values[x] * twice_)) + 1) / 2);
    }

    void divide_block(DepthMap& map, std::size_t block, std::size_t x, int lowest, int highest) const {
        Parts parts;
        for (std::size_t i = 0; i < DepthMap::kBits; ++i)
            std::copy_n(rows_[i].data() + x, DepthMap::kBits, parts.data() + i * DepthMap::kBits);
        const std::optional<Divided> divided = divided_of(parts, lowest, highest);
        if (!divided) return;
        map.near[block] = divided->near;
        map.far[block] = divided->far;
        map.mask[block] = divided->mask;
    }

    float twice_;
    std::array<std::vector<std::uint8_t>, DepthMap::kBits> rows_;
    std::vector<std::uint8_t> added_, repeated_;
    std::vector<std::uint8_t> low_, high_;
    std::vector<std::uint16_t> sum_;
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

DepthSamples::DepthSamples(int width, int height, const DepthMapSize& size)
    : size_(size),
      width_(static_cast<std::size_t>(width)),
      columns_(padded(middles(DepthMap::kBits * size.columns, width))),
      rows_(middles(DepthMap::kBits * size.rows, height)) {
    values_.reserve(columns_.size() * rows_.size());
    // From the bottom up, as rows of depth go.
    for (std::uint32_t& row : rows_) row = static_cast<std::uint32_t>(height) - 1 - row;
    std::ranges::reverse(rows_);
}

void DepthSamples::add(std::span<const float> depth) {
    const std::size_t columns = columns_.size(), end = row_ + depth.size() / width_;
    for (std::size_t i = values_.size() / columns; i < rows_.size() && rows_[i] < end; ++i) {
        const float* row = depth.data() + (rows_[i] - row_) * width_;
        values_.resize((i + 1) * columns);
        const std::span<float> sampled = std::span(values_).last(columns);
        for (std::size_t x = 0; x < columns; ++x) sampled[x] = row[columns_[x]];
        nearest_ = largest_of(sampled, nearest_);
    }
    row_ = end;
}

DepthMap DepthSamples::map(double near_distance, std::span<const float> added) const {
    assert(values_.size() == columns_.size() * rows_.size());
    const float nearest = largest_of(added, nearest_);
    const float twice = nearest > 0 ? static_cast<float>(2 * DepthMap::kSteps) / nearest : 0;
    DepthMap map{size_.columns, size_.rows, static_cast<double>(nearest) / near_distance, {}, {}, {}};
    const std::size_t blocks = size_of(size_.columns, size_.rows), columns = columns_.size();
    map.near.resize(blocks);
    map.far.resize(blocks);
    map.mask.assign(blocks, 0xffff);
    // Two rows of parts lie in one that is added, whose rows go from the bottom up.
    const std::size_t added_columns = kAddedSide * static_cast<std::size_t>(size_.columns);
    BlockRow row(columns, twice);
    for (std::size_t y = 0; y < rows_.size(); y += DepthMap::kBits) {
        for (std::size_t i = 0; i < DepthMap::kBits; ++i)
            row.set(i, std::span(values_).subspan((rows_.size() - 1 - y - i) * columns, columns));
        for (std::size_t i = 0; i < kAddedSide && !added.empty(); ++i)
            row.add(
                i, added.subspan(added.size() - (y / kAddedRepeated + i + 1) * added_columns, added_columns));
        row.divide(map, y / DepthMap::kBits);
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
