#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <random>
#include <stdexcept>

#include "compare/difference.hpp"
#include "compare/flip.hpp"
#include "io/image/image_file.hpp"
#include "needs_folder.hpp"

using namespace vrut;

namespace {

scene::Image flat(int width, int height, int red, int green, int blue, int alpha = 255) {
    scene::Image image;
    image.resize(width, height);
    const int color[] = {red, green, blue, alpha};
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] = static_cast<std::uint8_t>(color[i % 4]);
    return image;
}

scene::Image noise(int width, int height, unsigned seed) {
    scene::Image image = flat(width, height, 0, 0, 0);
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        if (i % 4 != 3) image.rgba[i] = static_cast<std::uint8_t>(random() % 256);
    return image;
}

scene::Image turned(const scene::Image& image) {
    scene::Image result = image;
    const std::size_t pixels = image.rgba.size() / 4;
    for (std::size_t i = 0; i < pixels; ++i)
        std::copy_n(image.rgba.begin() + static_cast<std::ptrdiff_t>(i * 4), 4,
                    result.rgba.begin() + static_cast<std::ptrdiff_t>((pixels - 1 - i) * 4));
    return result;
}

void agrees(double value, double with, double within) {
    CHECK_MESSAGE(std::abs(value - with) <= within, value, " against ", with);
}

}  // namespace

TEST_CASE("the difference of pictures is told in steps of 1/255") {
    scene::Image a = flat(4, 5, 100, 100, 100), b = a;
    CHECK(compare::difference(a, b).maximum() == 0);
    CHECK(compare::difference(a, b).rms() == 0);
    CHECK(compare::difference(a, b).psnr() == std::numeric_limits<double>::infinity());
    CHECK(compare::difference(a, b).share_above(0) == 0);
    CHECK(compare::difference(a, b).count() == 20);

    b.rgba[0] = 103;   // 3 off
    b.rgba[5] = 96;    // 4 off
    b.rgba[6] = 109;   // 9 off
    b.rgba[11] = 0;    // alpha
    b.rgba[12] = 102;  // 2 off
    const compare::Difference found = compare::difference(a, b);
    CHECK(found.maximum() == 9);
    CHECK(found.rms() == doctest::Approx(std::sqrt((9 + 16 + 81 + 4) / 60.0)));
    CHECK(found.psnr() == doctest::Approx(10 * std::log10(255 * 255 / ((9 + 16 + 81 + 4) / 60.0))));
    CHECK(found.share_above(1) == doctest::Approx(3.0 / 20));
    CHECK(found.share_above(2) == doctest::Approx(2.0 / 20));
    CHECK(found.share_above(8) == doctest::Approx(1.0 / 20));
    CHECK(found.share_above(9) == 0);
    CHECK(found.share_above(255) == 0);
    CHECK(compare::difference(b, a).sum_of_squares == found.sum_of_squares);
    CHECK(compare::difference(flat(1, 1, 0, 0, 0), flat(1, 1, 255, 255, 255)).maximum() == 255);
    CHECK(compare::difference(flat(1, 1, 0, 0, 0), flat(1, 1, 255, 255, 255)).psnr() == doctest::Approx(0));

    std::vector<bool> counts(20);
    counts[0] = counts[7] = true;
    CHECK(compare::difference(a, b, counts).count() == 2);
    CHECK(compare::difference(a, b, counts).maximum() == 3);
    CHECK(compare::difference(a, b, std::vector<bool>(20)).rms() == 0);
    CHECK_THROWS_AS(compare::difference(a, flat(5, 4, 0, 0, 0)), std::invalid_argument);
    CHECK_THROWS_AS(compare::difference(a, b, std::vector<bool>(19)), std::invalid_argument);
}

TEST_CASE("interior pixels have eight neighbours of their own node") {
    std::vector<scene::Index> nodes(std::size_t{7} * 5, 4);
    nodes[1 * 7 + 4] = scene::kNone;
    const std::vector<bool> interior = compare::interior_pixels(nodes, 7, 5);
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 7; ++x) {
            CAPTURE(x);
            CAPTURE(y);
            const bool whole = x > 0 && x < 6 && y > 0 && y < 4;
            const bool other_near = std::abs(x - 4) <= 1 && std::abs(y - 1) <= 1;
            CHECK(interior[static_cast<std::size_t>(y * 7 + x)] == (whole && !other_near));
        }
    CHECK(compare::interior_pixels(std::vector<scene::Index>(8), 8, 1) == std::vector<bool>(8));
}

TEST_CASE("FLIP of equal pictures is 0, whatever their alpha") {
    scene::Image a = noise(40, 70, 1), b = a;
    for (std::size_t i = 3; i < b.rgba.size(); i += 4) b.rgba[i] = 7;
    for (const float error : compare::flip(a, b)) CHECK(error == 0);
    CHECK_THROWS_AS(compare::flip(a, noise(41, 70, 1)), std::invalid_argument);
}

TEST_CASE("FLIP of flat pictures is that of their colours") {
    // Filters leave flat colours as they are, and find no features in them. Green to blue is the range's end.
    for (const float error : compare::flip(flat(30, 3, 0, 255, 0), flat(30, 3, 0, 0, 255)))
        CHECK(error == doctest::Approx(1).epsilon(1e-5));
    // Black to white: 100 of lightness. From CIELAB of sRGB's green (87.735, -86.183, 83.180) and blue
    // (32.297, 79.188, -107.860), under the Hunt effect, the largest distance is 308.1.
    const double largest =
        87.735 - 32.297 +
        std::hypot(0.87735 * -86.183 - 0.32297 * 79.188, 0.87735 * 83.180 + 0.32297 * 107.860);
    const double ratio = std::pow(100 / largest, 0.7);
    for (const float error : compare::flip(flat(3, 130, 0, 0, 0), flat(3, 130, 255, 255, 255)))
        CHECK(error == doctest::Approx(0.95 + (ratio - 0.4) / 0.6 * 0.05).epsilon(1e-4));
    // A small step of grey: 119 has the lightness 50.03, and 120 has 50.43.
    const double lightness_119 = 116 * std::cbrt(std::pow((119 / 255.0 + 0.055) / 1.055, 2.4)) - 16;
    const double lightness_120 = 116 * std::cbrt(std::pow((120 / 255.0 + 0.055) / 1.055, 2.4)) - 16;
    const double step = std::pow((lightness_120 - lightness_119) / largest, 0.7) * 0.95 / 0.4;
    for (const float error : compare::flip(flat(1, 1, 119, 119, 119), flat(1, 1, 120, 120, 120)))
        CHECK(error == doctest::Approx(step).epsilon(1e-3));
}

TEST_CASE("FLIP is symmetric, stays in its range, and turns with the pictures") {
    const scene::Image a = noise(50, 150, 1), b = noise(50, 150, 2);
    const std::vector<float> there = compare::flip(a, b);
    CHECK(there == compare::flip(b, a));
    REQUIRE(there.size() == 50 * 150);
    std::vector<float> upside_down = compare::flip(turned(a), turned(b));
    for (std::size_t i = 0; i < there.size(); ++i) {
        CHECK(there[i] > 0);
        CHECK(there[i] <= 1);
        CHECK(upside_down[there.size() - 1 - i] == doctest::Approx(there[i]).epsilon(1e-4));
    }
}

TEST_CASE("a pixel apart is seen where it is, and around it, and not far away") {
    const int width = 61, height = 141;
    const scene::Image a = flat(width, height, 90, 90, 90);
    scene::Image b = a;
    const int x = 20, y = 64;  // first row of a band
    b.rgba[4 * static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           4 * static_cast<std::size_t>(x)] = 255;
    const std::vector<float> errors = compare::flip(a, b);
    const auto at = [&](int to_x, int to_y) {
        return errors[static_cast<std::size_t>(to_y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(to_x)];
    };
    CHECK(at(x, y) > 0.1F);
    CHECK(at(x, y - 1) == doctest::Approx(at(x, y + 1)).epsilon(1e-4));
    CHECK(at(x - 1, y) == doctest::Approx(at(x, y - 1)).epsilon(1e-4));
    for (const auto& [to_x, to_y] : {std::pair{x + 11, y}, {x - 11, y}, {x, y + 11}, {x, y - 11}})
        CHECK(at(to_x, to_y) == 0);
}

TEST_CASE("what FLIP's values come to") {
    // Sum 10: of the weight, 1 is at 1, 2 at 2, 3 at 3, 4 at 4.
    const compare::FlipSummary summary = compare::summary_of({4, 0, 2, 1, 3, 0});
    CHECK(summary.mean == doctest::Approx(10.0 / 6));
    CHECK(summary.first_weighted_quartile == 2);
    CHECK(summary.weighted_median == 3);
    CHECK(summary.third_weighted_quartile == 4);
    CHECK(summary.min == 0);
    CHECK(summary.max == 4);
    const compare::FlipSummary none = compare::summary_of({0, 0});
    CHECK(none.weighted_median == 0);
    CHECK(none.max == 0);
    CHECK(compare::grey_map({0, 0.5F, 1}, 3, 1).rgba ==
          std::vector<std::uint8_t>{0, 0, 0, 255, 128, 128, 128, 255, 255, 255, 255, 255});
}

// VRUT_TEST_FLIP is set by .ci/run where its pictures lie beside the checkout.
TEST_CASE("FLIP agrees with the published implementation" * NeedsFolder{"VRUT_TEST_FLIP"}) {
    const std::filesystem::path folder = folder_of("VRUT_TEST_FLIP");
    struct Known {
        const char* name;
        double mean, median, first_quartile, third_quartile, max;
    };
    constexpr Known kKnown[] = {{"jpeg50.png", 0.073005, 0.088941, 0.055897, 0.166016, 0.654281},
                                {"half.png", 0.046839, 0.128349, 0.052044, 0.225426, 0.749618},
                                {"shifted.png", 0.045424, 0.130251, 0.071056, 0.231551, 0.890076},
                                {"reference.png", 0, 0, 0, 0, 0}};
    const auto reference = io::read_image_file(folder / "reference.png");
    REQUIRE(reference);
    for (const Known& known : kKnown) {
        CAPTURE(known.name);
        const auto test = io::read_image_file(folder / known.name);
        REQUIRE(test);
        const std::vector<float> errors = compare::flip(*reference, *test);
        const compare::FlipSummary found = compare::summary_of(errors);
        // The published values were added up in single precision, from the top row down.
        float sum = 0;
        for (int y = test->height; y-- > 0;)
            for (int x = 0; x < test->width; ++x)
                sum += errors[static_cast<std::size_t>(y) * static_cast<std::size_t>(test->width) +
                              static_cast<std::size_t>(x)];
        agrees(sum / static_cast<float>(errors.size()), known.mean, 1e-6);
        agrees(found.mean, known.mean, 1e-4);
        agrees(found.weighted_median, known.median, 1e-4);
        agrees(found.first_weighted_quartile, known.first_quartile, 1e-4);
        agrees(found.third_weighted_quartile, known.third_quartile, 1e-4);
        agrees(found.max, known.max, 1e-5);
        agrees(found.min, 0, 0);
    }
}
