#include "compare/flip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>
#include <numeric>
#include <span>
#include <stdexcept>

namespace vrut::compare {

namespace {

constexpr double kPixelsPerDegree = 0.7 * (3840 / 0.7) * std::numbers::pi / 180;
constexpr std::size_t kBand = 64;  // rows that are worked on at a time

// --- filters

/// Weights from -radius to radius.
using Kernel = std::vector<float>;

/// A term of a contrast sensitivity function, a √(π/b) exp(-π² x²/b) for x in degrees (section 4.1, table 1).
struct Term {
    double a, b;
};
constexpr Term kLightness[] = {{1, 0.0047}}, kRedGreen[] = {{1, 0.0053}},
               kBlueYellow[] = {{34.1, 0.04}, {13.5, 0.025}};
constexpr double kWidestTerm = 0.04;

int contrast_radius() {
    const double deviation = std::sqrt(kWidestTerm / (2 * std::numbers::pi * std::numbers::pi));
    return static_cast<int>(std::ceil(3 * deviation * kPixelsPerDegree));
}

/// One kernel for each term. The filter in the plane is the sum of their products with themselves: it
/// weighs 1.
std::vector<Kernel> contrast_filter(std::span<const Term> terms) {
    const int radius = contrast_radius();
    std::vector<Kernel> kernels;
    double total = 0;
    for (const Term& term : terms) {
        const double root = std::sqrt(term.a * std::sqrt(std::numbers::pi / term.b));
        Kernel& kernel = kernels.emplace_back();
        for (int x = -radius; x <= radius; ++x) {
            const double scaled = std::numbers::pi * x / kPixelsPerDegree;
            kernel.push_back(static_cast<float>(root * std::exp(-scaled * scaled / term.b)));
        }
        const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
        total += sum * sum;
    }
    for (Kernel& kernel : kernels)
        for (float& weight : kernel) weight = static_cast<float>(weight / std::sqrt(total));
    return kernels;
}

/// A Gaussian and its derivatives (section 4.2); of a derivative, weights of either sign make 1.
struct FeatureFilter {
    Kernel smooth, slope, bend;
};

void scale_signs(Kernel& kernel) {
    double up = 0, down = 0;
    for (const float weight : kernel) (weight > 0 ? up : down) += std::abs(weight);
    for (float& weight : kernel) weight = static_cast<float>(weight / (weight > 0 ? up : down));
}

FeatureFilter feature_filter() {
    constexpr double kWidth = 0.082;  // degrees
    const double deviation = 0.5 * kWidth * kPixelsPerDegree;
    const int radius = static_cast<int>(std::ceil(3 * deviation));
    FeatureFilter filter;
    for (int x = -radius; x <= radius; ++x) {
        const double ratio = x / deviation;
        const double gaussian = std::exp(-ratio * ratio / 2);
        filter.smooth.push_back(static_cast<float>(gaussian));
        filter.slope.push_back(static_cast<float>(-x * gaussian));
        filter.bend.push_back(static_cast<float>((ratio * ratio - 1) * gaussian));
    }
    for (Kernel* kernel : {&filter.smooth, &filter.slope, &filter.bend}) scale_signs(*kernel);
    return filter;
}

// --- one channel of some rows of an image

/// Rows of an image and, above and below them, as many as a filter reaches beyond.
struct Channel {
    std::size_t width, height;
    std::vector<float> values = std::vector<float>(width * height);

    float* row(std::size_t y) { return values.data() + y * width; }
    const float* row(std::size_t y) const { return values.data() + y * width; }
};

/// What lies beyond the image's left and right edges is as these edges are.
Channel filter_across(const Channel& in, const Kernel& kernel) {
    const std::size_t radius = kernel.size() / 2;
    Channel out{in.width, in.height};
    std::vector<float> padded(in.width + 2 * radius);
    for (std::size_t y = 0; y < in.height; ++y) {
        std::fill_n(padded.begin(), radius, in.row(y)[0]);
        std::copy_n(in.row(y), in.width, padded.begin() + static_cast<std::ptrdiff_t>(radius));
        std::fill_n(padded.rbegin(), radius, in.row(y)[in.width - 1]);
        for (std::size_t k = 0; k < kernel.size(); ++k)
            for (std::size_t x = 0; x < in.width; ++x) out.row(y)[x] += kernel[k] * padded[x + k];
    }
    return out;
}

/// The rows between `margin` ones, which the kernel's radius does not exceed.
Channel filter_down(const Channel& in, const Kernel& kernel, std::size_t margin) {
    const std::size_t first = margin - kernel.size() / 2;
    Channel out{in.width, in.height - 2 * margin};
    for (std::size_t y = 0; y < out.height; ++y)
        for (std::size_t k = 0; k < kernel.size(); ++k)
            for (std::size_t x = 0; x < in.width; ++x) out.row(y)[x] += kernel[k] * in.row(y + first + k)[x];
    return out;
}

// --- colours

double linear_of_srgb(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

/// XYZ from linear sRGB, under D65.
const glm::dmat3 kXyzOfRgb(glm::dvec3(10135552.0 / 24577794, 2613072.0 / 12288897, 1425312.0 / 73733382),
                           glm::dvec3(8788810.0 / 24577794, 8788810.0 / 12288897, 8788810.0 / 73733382),
                           glm::dvec3(4435075.0 / 24577794, 887015.0 / 12288897, 70074185.0 / 73733382));
const glm::dmat3 kRgbOfXyz = glm::inverse(kXyzOfRgb);
const glm::dvec3 kWhite = kXyzOfRgb * glm::dvec3(1);

/// The linear form of CIELAB (section 4.1): lightness, red to green, blue to yellow.
glm::dvec3 opponent_of_rgb(const glm::dvec3& rgb) {
    const glm::dvec3 xyz = kXyzOfRgb * rgb / kWhite;
    return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

glm::dvec3 rgb_of_opponent(const glm::dvec3& color) {
    const double y = (color.x + 16) / 116;
    return kRgbOfXyz * (glm::dvec3(y + color.y / 500, y, y - color.z / 200) * kWhite);
}

/// CIELAB with chroma scaled by lightness, for the Hunt effect (section 4.1).
glm::dvec3 hunt_lab_of_rgb(const glm::dvec3& rgb) {
    constexpr double kDelta = 6.0 / 29;
    glm::dvec3 f = kXyzOfRgb * rgb / kWhite;
    for (int i = 0; i < 3; ++i)
        f[i] = f[i] > kDelta * kDelta * kDelta ? std::cbrt(f[i]) : f[i] / (3 * kDelta * kDelta) + 4.0 / 29;
    const double lightness = 116 * f.y - 16;
    return {lightness, 0.01 * lightness * 500 * (f.x - f.y), 0.01 * lightness * 200 * (f.y - f.z)};
}

/// The HyAB distance (section 4.1).
double distance(const glm::dvec3& a, const glm::dvec3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

/// Distance to error, 0 to 1: compressed, the upper six tenths of the range into its last twentieth
/// (section 4.1).
double error_of_distance(double distance_of_colors) {
    constexpr double kExponent = 0.7, kKnee = 0.4, kErrorAtKnee = 0.95;
    static const double largest =
        std::pow(distance(hunt_lab_of_rgb({0, 1, 0}), hunt_lab_of_rgb({0, 0, 1})), kExponent);
    const double ratio = std::pow(distance_of_colors, kExponent) / largest;
    return ratio < kKnee ? ratio * kErrorAtKnee / kKnee
                         : kErrorAtKnee + (ratio - kKnee) / (1 - kKnee) * (1 - kErrorAtKnee);
}

// --- what is seen of some rows

struct PerceivedRows {
    std::array<Channel, 3> color;  ///< CIELAB, with the Hunt effect
    Channel edges, points;
};

class Viewer {
public:
    /// Rows from `first` on. The rows beyond the image's edges are as these edges are.
    PerceivedRows see(const scene::Image& image, std::size_t first, std::size_t rows) const {
        const std::array<Channel, 3> opponent = opponent_channels(image, first, rows);
        PerceivedRows perceived{filtered_colors(opponent), {0, 0}, {0, 0}};
        Channel grey = opponent[0];
        for (float& value : grey.values) value = (value + 16) / 116;
        perceived.edges = gradient(grey, features_.slope);
        perceived.points = gradient(grey, features_.bend);
        return perceived;
    }

private:
    std::array<Channel, 3> opponent_channels(const scene::Image& image, std::size_t first,
                                             std::size_t rows) const {
        const auto width = static_cast<std::size_t>(image.width), height = rows + 2 * margin_;
        std::array<Channel, 3> channels{Channel{width, height}, {width, height}, {width, height}};
        for (std::size_t y = 0; y < height; ++y) {
            const std::size_t below = std::max(first + y, margin_) - margin_;
            const std::size_t source = std::min(below, static_cast<std::size_t>(image.height) - 1);
            const std::uint8_t* pixel = image.rgba.data() + source * width * 4;
            for (std::size_t x = 0; x < width; ++x, pixel += 4) {
                const glm::dvec3 color =
                    opponent_of_rgb({linear_[pixel[0]], linear_[pixel[1]], linear_[pixel[2]]});
                for (std::size_t i = 0; i < 3; ++i)
                    channels[i].row(y)[x] = static_cast<float>(color[static_cast<int>(i)]);
            }
        }
        return channels;
    }

    std::array<Channel, 3> filtered_colors(const std::array<Channel, 3>& opponent) const {
        const std::size_t width = opponent[0].width, rows = opponent[0].height - 2 * margin_;
        std::array<Channel, 3> colors{Channel{width, rows}, {width, rows}, {width, rows}};
        for (std::size_t i = 0; i < 3; ++i)
            for (const Kernel& kernel : contrast_[i]) {
                const Channel part = filter_down(filter_across(opponent[i], kernel), kernel, margin_);
                for (std::size_t j = 0; j < part.values.size(); ++j) colors[i].values[j] += part.values[j];
            }
        for (std::size_t j = 0; j < colors[0].values.size(); ++j) {
            const glm::dvec3 rgb =
                rgb_of_opponent({colors[0].values[j], colors[1].values[j], colors[2].values[j]});
            const glm::dvec3 lab = hunt_lab_of_rgb(glm::clamp(rgb, 0.0, 1.0));
            for (std::size_t i = 0; i < 3; ++i)
                colors[i].values[j] = static_cast<float>(lab[static_cast<int>(i)]);
        }
        return colors;
    }

    /// Length of the vector of `derivative` along both axes, each smoothed along the other.
    Channel gradient(const Channel& grey, const Kernel& derivative) const {
        Channel across = filter_down(filter_across(grey, derivative), features_.smooth, margin_);
        const Channel down = filter_down(filter_across(grey, features_.smooth), derivative, margin_);
        for (std::size_t j = 0; j < across.values.size(); ++j)
            across.values[j] = std::hypot(across.values[j], down.values[j]);
        return across;
    }

    static std::array<double, 256> linear_values() {
        std::array<double, 256> values{};
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = linear_of_srgb(static_cast<double>(i) / 255);
        return values;
    }

    const std::array<double, 256> linear_ = linear_values();
    const std::array<std::vector<Kernel>, 3> contrast_ = {
        contrast_filter(kLightness), contrast_filter(kRedGreen), contrast_filter(kBlueYellow)};
    const FeatureFilter features_ = feature_filter();
    const std::size_t margin_ =
        std::max(static_cast<std::size_t>(contrast_radius()), features_.smooth.size() / 2);
};

/// Colour difference, raised where features differ (sections 4.2 and 4.3).
double flip_error(const PerceivedRows& a, const PerceivedRows& b, std::size_t i) {
    const auto color = [&](const PerceivedRows& perceived) {
        return glm::dvec3(perceived.color[0].values[i], perceived.color[1].values[i],
                          perceived.color[2].values[i]);
    };
    const double color_error = error_of_distance(distance(color(a), color(b)));
    const double edges = std::abs(a.edges.values[i] - b.edges.values[i]);
    const double points = std::abs(a.points.values[i] - b.points.values[i]);
    const double feature_error = std::sqrt(std::max(edges, points) / std::numbers::sqrt2);
    return std::pow(color_error, 1 - feature_error);
}

}  // namespace

std::vector<float> flip(const scene::Image& a, const scene::Image& b) {
    if (a.width != b.width || a.height != b.height)
        throw std::invalid_argument("images of different sizes cannot be compared");
    const Viewer viewer;
    const auto height = static_cast<std::size_t>(a.height);
    std::vector<float> errors;
    errors.reserve(a.rgba.size() / 4);
    for (std::size_t first = 0; first < height; first += kBand) {
        const std::size_t rows = std::min(kBand, height - first);
        const PerceivedRows seen_a = viewer.see(a, first, rows), seen_b = viewer.see(b, first, rows);
        for (std::size_t i = 0; i < seen_a.edges.values.size(); ++i)
            errors.push_back(static_cast<float>(flip_error(seen_a, seen_b, i)));
    }
    return errors;
}

FlipSummary summary_of(std::vector<float> errors) {
    FlipSummary summary;
    if (errors.empty()) return summary;
    std::sort(errors.begin(), errors.end());
    const double sum = std::accumulate(errors.begin(), errors.end(), 0.0);
    const auto percentile = [&](double part) {
        double below = 0;
        for (const float error : errors)
            if (below += error; below > part * sum) return double{error};
        return 0.0;  // all are
    };
    summary.mean = sum / static_cast<double>(errors.size());
    summary.weighted_median = percentile(0.5);
    summary.first_weighted_quartile = percentile(0.25);
    summary.third_weighted_quartile = percentile(0.75);
    summary.min = errors.front();
    summary.max = errors.back();
    return summary;
}

scene::Image grey_map(const std::vector<float>& errors, int width, int height) {
    scene::Image map;
    map.resize(width, height);
    for (std::size_t i = 0; i < errors.size(); ++i) {
        std::fill_n(map.rgba.begin() + static_cast<std::ptrdiff_t>(i * 4), 3,
                    static_cast<std::uint8_t>(std::lround(errors[i] * 255)));
        map.rgba[i * 4 + 3] = 255;
    }
    return map;
}

}  // namespace vrut::compare
