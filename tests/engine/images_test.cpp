#include "engine/images.hpp"

#include <doctest/doctest.h>
#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <random>

#include "base/files.hpp"
#include "frame_header.hpp"
#include "io/image/image_file.hpp"
#include "planes.hpp"

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

/// Smooth colors with noise, so that every strip has low and high frequencies.
scene::Image noisy_gradient(int width, int height) {
    scene::Image image;
    image.resize(width, height);
    std::minstd_rand random;
    std::size_t at = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const int value : {x * 255 / width, y * 255 / height, (x + y) / 4, 255})
                image.rgba[at++] = static_cast<std::uint8_t>(value ^ static_cast<int>(random() >> 8 & 31));
    return image;
}

/// The whole image in one piece, as libjpeg-turbo encodes it.
std::vector<std::uint8_t> encode_without_strips(const scene::Image& image, int quality, bool subsampled) {
    tjhandle handle = tjInitCompress();
    unsigned char* data = nullptr;
    unsigned long size = 0;
    REQUIRE(tjCompress2(handle, image.rgba.data(), image.width, 0, image.height, TJPF_RGBA, &data, &size,
                        subsampled ? TJSAMP_420 : TJSAMP_444, quality, TJFLAG_BOTTOMUP) == 0);
    std::vector<std::uint8_t> jpeg(data, data + size);
    tjFree(data);
    tjDestroy(handle);
    return jpeg;
}

/// Markers RST0 to RST7 by their number, in the order in which they stand.
std::vector<int> restart_markers(const std::vector<std::uint8_t>& jpeg) {
    std::vector<int> numbers;
    for (std::size_t i = 0; i + 1 < jpeg.size(); ++i)
        if (jpeg[i] == 0xFF && jpeg[i + 1] >= 0xD0 && jpeg[i + 1] <= 0xD7) numbers.push_back(jpeg[i + 1] & 7);
    return numbers;
}

}  // namespace

TEST_CASE("planes become the JPEG that the image in RGBA becomes, but for blocks beyond its right edge") {
    JpegEncoder encoder;
    for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(16, 16), glm::ivec2(17, 15),
                                  glm::ivec2(24, 33), glm::ivec2(46, 33), glm::ivec2(1001, 701)})
        for (const bool subsampled : {false, true})
            for (const int quality : {40, 90, 100}) {
                CAPTURE(size.x);
                CAPTURE(subsampled);
                CAPTURE(quality);
                const scene::Image image = noisy_gradient(size.x, size.y);
                const auto expected = encoder.encode(image, quality, subsampled),
                           jpeg = encoder.encode(planes_of(image, subsampled), quality);
                int width = 0, height = 0, sampling = 0;
                const auto pixels = decode_jpeg(jpeg, width, height, sampling);
                CHECK(width == size.x);
                CHECK(height == size.y);
                CHECK(sampling == (subsampled ? TJSAMP_420 : TJSAMP_444));
                CHECK(pixels == decode_jpeg(expected, width, height, sampling));
                if (size.x % 16 == 0) CHECK(jpeg == expected);
            }
}

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

TEST_CASE("a JPEG of several strips decodes to the pixels of one that is encoded as a whole") {
    struct Size {
        int width = 0, height = 0;
        std::size_t strips[2] = {};  // 4:4:4, 4:2:0
    };
    const Size sizes[] = {{1, 1, {1, 1}},      {640, 192, {1, 1}},  {640, 193, {1, 2}},
                          {641, 479, {3, 3}},  {1280, 720, {8, 8}}, {1277, 961, {11, 11}},
                          {9, 16'384, {2, 2}}, {16'384, 17, {3, 2}}};
    const auto read = [](const std::vector<std::uint8_t>& jpeg) {  // fails at the decoder's first warning
        return io::decode_image({reinterpret_cast<const char*>(jpeg.data()), jpeg.size()});
    };
    JpegEncoder encoder;
    for (const Size& size : sizes) {
        const scene::Image image = noisy_gradient(size.width, size.height);
        for (const bool subsampled : {false, true})
            for (const int quality : {1, 75, 100}) {
                CAPTURE(size.width);
                CAPTURE(size.height);
                CAPTURE(subsampled);
                CAPTURE(quality);
                const std::vector<std::uint8_t> jpeg = encoder.encode(image, quality, subsampled);
                const std::vector<std::uint8_t> whole = encode_without_strips(image, quality, subsampled);
                int decoded_width = 0, decoded_height = 0, sampling = -1;
                const auto expected = decode_jpeg(whole, decoded_width, decoded_height, sampling);
                CHECK(decode_jpeg(jpeg, decoded_width, decoded_height, sampling) == expected);
                CHECK(decoded_width == size.width);
                CHECK(decoded_height == size.height);
                CHECK(sampling == (subsampled ? TJSAMP_420 : TJSAMP_444));
                const std::vector<int> markers = restart_markers(jpeg);
                CHECK(markers.size() + 1 == size.strips[subsampled ? 1 : 0]);
                for (std::size_t i = 0; i < markers.size(); ++i) CHECK(markers[i] == static_cast<int>(i % 8));
                if (markers.empty()) CHECK(jpeg == whole);
                REQUIRE(read(jpeg).has_value());
                CHECK(read(jpeg)->rgba == read(whole)->rgba);
            }
    }
}

TEST_CASE("a picture without pixels, or with a side that JPEG cannot have, is no JPEG, and that is said") {
    JpegEncoder encoder;
    CHECK_THROWS_WITH(encoder.encode(scene::Image{}, 90, false),
                      "an image of 0 x 0 pixels cannot be encoded as JPEG");
    CHECK_THROWS_WITH(encoder.encode(two_halves(3, 65'501), 90, false),
                      "an image of 3 x 65501 pixels cannot be encoded as JPEG");
    CHECK_THROWS_WITH(encoder.encode(two_halves(65'501, 3), 90, false),
                      "an image of 65501 x 3 pixels cannot be encoded as JPEG");
}

TEST_CASE("what fails in a strip fails the picture, and the encoder goes on") {
    const scene::Image image = noisy_gradient(1280, 720);
    JpegEncoder encoder;
    for (int i = 0; i < 20; ++i) {
        CHECK_THROWS_WITH(encoder.encode(image, 101, true),
                          doctest::Contains("an image cannot be encoded as JPEG: "));
        CHECK(encoder.encode(image, 75, true).size() > 1000);
    }
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
