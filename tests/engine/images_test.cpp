#include "engine/images.hpp"

#include <doctest/doctest.h>
#include <png.h>
#include <turbojpeg.h>

#include <algorithm>

#include "base/files.hpp"
#include "frame_header.hpp"

using namespace vrut;
using namespace vrut::server::base;
using namespace vrut::server::engine;

namespace {

/// Lower half red, upper half blue.
scene::Image two_halves(int width, int height) {
    scene::Image image;
    image.resize(width, height);
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        const bool low = i < image.rgba.size() / 2;
        const std::uint8_t color[] = {static_cast<std::uint8_t>(low ? 255 : 0), 10,
                                      static_cast<std::uint8_t>(low ? 0 : 255), 255};
        std::copy(std::begin(color), std::end(color), image.rgba.begin() + static_cast<std::ptrdiff_t>(i));
    }
    return image;
}

std::vector<std::uint8_t> decode_jpeg(const std::vector<std::uint8_t>& jpeg, int& width, int& height,
                                      int& sampling) {
    tjhandle handle = tjInitDecompress();
    REQUIRE(tjDecompressHeader2(handle, const_cast<std::uint8_t*>(jpeg.data()), jpeg.size(), &width, &height,
                                &sampling) == 0);
    std::vector<std::uint8_t> rgb(std::size_t{3} * static_cast<unsigned>(width) *
                                  static_cast<unsigned>(height));
    REQUIRE(tjDecompress2(handle, jpeg.data(), jpeg.size(), rgb.data(), width, 0, height, TJPF_RGB, 0) == 0);
    tjDestroy(handle);
    return rgb;
}

}  // namespace

TEST_CASE("a PNG is exact, opaque and upright") {
    const scene::Image image = two_halves(5, 4);
    const std::vector<std::uint8_t> png = io::encode_png(image);
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_memory(&header, png.data(), png.size()));
    CHECK(header.width == 5);
    CHECK(header.height == 4);
    CHECK((header.format & PNG_FORMAT_FLAG_ALPHA) == 0);
    header.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> rgb(std::size_t{5} * 4 * 3);
    REQUIRE(png_image_finish_read(&header, nullptr, rgb.data(), 0, nullptr));
    const std::uint8_t blue[] = {0, 10, 255}, red[] = {255, 10, 0};
    CHECK(std::equal(std::begin(blue), std::end(blue), rgb.begin()));
    CHECK(std::equal(std::begin(red), std::end(red), rgb.end() - 3));
}

TEST_CASE("a JPEG is upright, sampled as asked, and stays one with a comment in it") {
    const scene::Image image = two_halves(64, 48);
    for (const bool subsampled : {false, true}) {
        std::vector<std::uint8_t> jpeg = JpegEncoder().encode(image, 90, subsampled);
        const auto comment = protocol::comment_segment("{\"frame\":1}");
        jpeg.insert(jpeg.begin() + static_cast<std::ptrdiff_t>(protocol::comment_offset(jpeg)),
                    comment.begin(), comment.end());
        int width = 0, height = 0, sampling = -1;
        const auto rgb = decode_jpeg(jpeg, width, height, sampling);
        CHECK(width == 64);
        CHECK(height == 48);
        CHECK(sampling == (subsampled ? TJSAMP_420 : TJSAMP_444));
        CHECK(rgb[2] > 240);                                 // blue at the top
        CHECK(rgb[rgb.size() - std::size_t{64} * 3] > 240);  // red at the bottom
    }
}

TEST_CASE("a picture without pixels is no JPEG, and that is said") {
    CHECK_THROWS_WITH(JpegEncoder().encode(scene::Image{}, 90, false),
                      "a picture of 0 x 0 pixels cannot be encoded as JPEG");
}

TEST_CASE("one pixel, and a line of them, can be encoded") {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 8192}, {8192, 1}}) {
        const scene::Image image = two_halves(width, height);
        CHECK(JpegEncoder().encode(image, 75, true).size() > 100);
        CHECK(io::encode_png(image).size() > 50);
    }
}

TEST_CASE("a file that cannot be written is named") {
    CHECK_THROWS_WITH(write_file("no-such-folder/picture.png", {}),
                      doctest::Contains("no-such-folder/picture.png"));
}
