#include "io/image/image_file.hpp"

#include <doctest/doctest.h>
#include <sys/resource.h>
#include <webp/encode.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include "contains.hpp"
#include "environment_variable.hpp"
#include "image_bytes.hpp"
#include "temporary_folder.hpp"

using namespace vrut;

namespace {

using Pixel = std::array<int, 4>;

/// Column and row from the top left, as files count.
Pixel pixel(const scene::Image& image, int x, int y) {
    const auto at = static_cast<std::size_t>((image.height - 1 - y) * image.width + x) * 4;
    return {image.rgba[at], image.rgba[at + 1], image.rgba[at + 2], image.rgba[at + 3]};
}

scene::Image decode_well(const std::string& bytes) {
    auto image = io::decode_image(bytes);
    REQUIRE_MESSAGE(image, image.error());
    return *std::move(image);
}

std::string refusal(const std::string& bytes) {
    const auto image = io::decode_image(bytes);
    REQUIRE_FALSE(image);
    return image.error();
}

std::string little_endian(std::uint64_t value, int bytes) {
    std::string text;
    for (; bytes > 0; --bytes, value >>= 8) text += static_cast<char>(value & 0xFF);
    return text;
}

// Two rows of two pixels: red and green above blue and brown. The alpha of brown is 128.

std::string webp_bytes() {
    const std::uint8_t rgba[] = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 200, 100, 50, 128};
    std::uint8_t* data = nullptr;
    const std::size_t size = WebPEncodeLosslessRGBA(rgba, 2, 2, 8, &data);
    std::string bytes(reinterpret_cast<char*>(data), size);
    WebPFree(data);
    return bytes;
}

std::string tiff_bytes() {
    const std::string pixels(
        "\xFF\0\0\xFF"
        "\0\xFF\0\xFF"
        "\0\0\xFF\xFF"
        "\xC8\x64\x32\x80",
        16);
    std::string file = "II" + little_endian(42, 2) + little_endian(8, 4), entries;
    unsigned count = 0;
    const auto add = [&](unsigned tag, unsigned type, unsigned values, std::uint64_t value) {
        entries += little_endian(tag, 2) + little_endian(type, 2) + little_endian(values, 4) +
                   little_endian(value, 4);
        ++count;
    };
    constexpr unsigned kShort = 3, kLong = 4, kEntries = 11;
    const std::uint64_t behind = 8 + 2 + 12 * kEntries + 4;
    add(256, kLong, 1, 2);              // width
    add(257, kLong, 1, 2);              // length
    add(258, kShort, 4, behind);        // bits of each sample
    add(259, kShort, 1, 1);             // not compressed
    add(262, kShort, 1, 2);             // RGB
    add(273, kLong, 1, behind + 8);     // the strip
    add(277, kShort, 1, 4);             // samples
    add(278, kLong, 1, 2);              // rows of the strip
    add(279, kLong, 1, pixels.size());  // bytes of the strip
    add(284, kShort, 1, 1);             // samples side by side
    add(338, kShort, 1, 2);             // the fourth is alpha
    REQUIRE(count == kEntries);
    file += little_endian(kEntries, 2) + entries + little_endian(0, 4);
    for (int i = 0; i < 4; ++i) file += little_endian(8, 2);
    return file + pixels;
}

std::string bmp_bytes() {
    const std::string rows(
        "\xFF\0\0"
        "\x32\x64\xC8"
        "\0\0"
        "\0\0\xFF"
        "\0\xFF\0"
        "\0\0",
        16);  // from below, BGR
    return "BM" + little_endian(54 + rows.size(), 4) + little_endian(0, 4) + little_endian(54, 4) +
           little_endian(40, 4) + little_endian(2, 4) + little_endian(2, 4) + little_endian(1, 2) +
           little_endian(24, 2) + little_endian(0, 4) + little_endian(rows.size(), 4) +
           std::string(16, '\0') + rows;
}

std::string gif_bytes() {
    const std::string palette(
        "\xFF\0\0"
        "\0\xFF\0"
        "\0\0\xFF"
        "\xC8\x64\x32",
        12);
    // Of LZW the codes 4 (clear), 0, 1, 2 in three bits each; then 3 and 5 (end) in four.
    std::uint64_t codes = 0;
    int at = 0;
    const std::pair<unsigned, int> kCodes[] = {{4, 3}, {0, 3}, {1, 3}, {2, 3}, {3, 4}, {5, 4}};
    for (const auto& [code, bits] : kCodes) {
        codes |= std::uint64_t{code} << at;
        at += bits;
    }
    const std::string screen = little_endian(2, 2) + little_endian(2, 2) + std::string("\x81\0\0", 3);
    const std::string image =
        "," + little_endian(0, 4) + little_endian(2, 2) + little_endian(2, 2) + std::string(1, '\0');
    return "GIF89a" + screen + palette + image + "\x02\x03" + little_endian(codes, 3) + std::string(1, '\0') +
           ";";
}

std::string tga_bytes(bool runs) {
    const std::string header = std::string("\0\0", 2) + (runs ? "\x0A" : "\x02") + std::string(9, '\0') +
                               little_endian(2, 2) + little_endian(2, 2) + "\x20\x08";
    const std::string top(
        "\0\0\xFF\xFF"
        "\0\xFF\0\xFF",
        8);  // BGRA
    const std::string bottom(
        "\xFF\0\0\xFF"
        "\x32\x64\xC8\x80",
        8);
    return header + (runs ? "\x03" : "") + bottom + top;
}

std::vector<std::pair<std::string, std::string>> other_files() {
    return {{"WebP", webp_bytes()}, {"TIFF", tiff_bytes()},    {"BMP", bmp_bytes()},
            {"GIF", gif_bytes()},   {"TGA", tga_bytes(false)}, {"TGA, runs", tga_bytes(true)}};
}

constexpr int kWidth = 13, kHeight = 9;
const std::vector<png_color> kPalette = {{10, 20, 30}, {200, 100, 50}, {0, 255, 1}, {77, 78, 79}};

struct Kind {
    const char* name;
    int color_type, depth, channels;
    bool key;
};
constexpr Kind kKinds[] = {
    {"grey 1", PNG_COLOR_TYPE_GRAY, 1, 1, false},
    {"grey 2", PNG_COLOR_TYPE_GRAY, 2, 1, false},
    {"grey 4", PNG_COLOR_TYPE_GRAY, 4, 1, false},
    {"grey 8", PNG_COLOR_TYPE_GRAY, 8, 1, false},
    {"grey 16", PNG_COLOR_TYPE_GRAY, 16, 1, false},
    {"grey 2 key", PNG_COLOR_TYPE_GRAY, 2, 1, true},
    {"grey 16 key", PNG_COLOR_TYPE_GRAY, 16, 1, true},
    {"grey alpha 8", PNG_COLOR_TYPE_GRAY_ALPHA, 8, 2, false},
    {"grey alpha 16", PNG_COLOR_TYPE_GRAY_ALPHA, 16, 2, false},
    {"palette 2", PNG_COLOR_TYPE_PALETTE, 2, 1, false},
    {"palette 4", PNG_COLOR_TYPE_PALETTE, 4, 1, false},
    {"palette 8", PNG_COLOR_TYPE_PALETTE, 8, 1, false},
    {"palette 8 alpha", PNG_COLOR_TYPE_PALETTE, 8, 1, true},
    {"rgb 8", PNG_COLOR_TYPE_RGB, 8, 3, false},
    {"rgb 16", PNG_COLOR_TYPE_RGB, 16, 3, false},
    {"rgb 8 key", PNG_COLOR_TYPE_RGB, 8, 3, true},
    {"rgb 16 key", PNG_COLOR_TYPE_RGB, 16, 3, true},
    {"rgba 8", PNG_COLOR_TYPE_RGBA, 8, 4, false},
    {"rgba 16", PNG_COLOR_TYPE_RGBA, 16, 4, false},
};

bool is_palette(const Kind& kind) { return kind.color_type == PNG_COLOR_TYPE_PALETTE; }

/// Different at each place; row 0 and row 1 differ in 16 bits by less than 8 bits can tell.
unsigned sample(const Kind& kind, int x, int y, int channel) {
    const auto n = static_cast<unsigned>(x * 37 + (y / 2) * 101 + channel * 59);
    if (is_palette(kind)) return n % 4;
    if (kind.depth == 16) return n * 257 % 65536 + static_cast<unsigned>(y % 2);
    return (n + static_cast<unsigned>(y % 2)) % (1U << kind.depth);
}

Pixel expected(const Kind& kind, int x, int y) {
    std::array<unsigned, 4> v{};
    for (int c = 0; c < kind.channels; ++c) v[static_cast<std::size_t>(c)] = sample(kind, x, y, c);
    if (is_palette(kind)) {
        const png_color& color = kPalette[v[0]];
        return {color.red, color.green, color.blue, kind.key && v[0] == 1 ? 40 : 255};
    }
    const auto byte = [&](unsigned value) {
        return static_cast<int>(std::lround(value * 255.0 / ((1U << kind.depth) - 1)));
    };
    bool is_key = kind.key;
    for (int c = 0; c < kind.channels; ++c)
        is_key = is_key && v[static_cast<std::size_t>(c)] == sample(kind, 2, 4, c);
    const bool alpha = (kind.color_type & PNG_COLOR_MASK_ALPHA) != 0;
    const int a = alpha ? byte(v[static_cast<std::size_t>(kind.channels - 1)]) : is_key ? 0 : 255;
    if (kind.channels < 3) return {byte(v[0]), byte(v[0]), byte(v[0]), a};
    return {byte(v[0]), byte(v[1]), byte(v[2]), a};
}

std::string file_of(const Kind& kind, bool interlaced) {
    PngFile file{.width = kWidth,
                 .height = kHeight,
                 .color_type = kind.color_type,
                 .depth = kind.depth,
                 .interlaced = interlaced};
    for (int y = 0; y < kHeight; ++y) {
        std::vector<std::uint8_t> row(
            static_cast<std::size_t>((kWidth * kind.channels * kind.depth + 7) / 8));
        for (int i = 0; i < kWidth * kind.channels; ++i) {
            const unsigned value = sample(kind, i / kind.channels, y, i % kind.channels);
            for (int bit = 0; bit < kind.depth; ++bit) {
                const int to = i * kind.depth + bit;
                const unsigned one = value >> (kind.depth - 1 - bit) & 1;
                row[static_cast<std::size_t>(to / 8)] |= static_cast<std::uint8_t>(one << (7 - to % 8));
            }
        }
        file.rows.push_back(row);
    }
    png_color_16 key{};
    if (is_palette(kind)) {
        file.palette = kPalette;
        if (kind.key) file.palette_alpha = {255, 40};
    } else if (kind.key) {
        key.red = key.gray = static_cast<png_uint_16>(sample(kind, 2, 4, 0));
        key.green = static_cast<png_uint_16>(sample(kind, 2, 4, 1));
        key.blue = static_cast<png_uint_16>(sample(kind, 2, 4, 2));
        file.key = &key;
    }
    return png_bytes(file);
}

void put_big_endian(std::string& bytes, std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i) & 0xFF);
}

/// A PNG that claims this size and holds next to nothing.
std::string claiming_png(std::uint32_t width, std::uint32_t height) {
    std::string bytes = flat_png(1, 1, {1, 2, 3, 4});
    put_big_endian(bytes, 16, width);
    put_big_endian(bytes, 20, height);
    const auto* header = reinterpret_cast<const Bytef*>(bytes.data()) + 12;
    put_big_endian(bytes, 29, static_cast<std::uint32_t>(crc32(0, header, 17)));
    return bytes;
}

std::string big_endian(std::uint32_t value) {
    std::string bytes(4, '\0');
    put_big_endian(bytes, 0, value);
    return bytes;
}

std::string png_chunk(const std::string& kind, const std::string& data) {
    const std::string body = kind + data;
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    return big_endian(static_cast<std::uint32_t>(data.size())) + body +
           big_endian(static_cast<std::uint32_t>(sum));
}

/// The file with more before its pixels.
std::string with_chunk(std::string png, const std::string& chunk) {
    return png.insert(png.find("IDAT") - 4, chunk);
}

std::string deflated_text(std::size_t size) {
    const std::vector<Bytef> text(size, 'a');
    uLongf length = compressBound(static_cast<uLong>(size));
    std::string bytes(length, '\0');
    compress(reinterpret_cast<Bytef*>(bytes.data()), &length, text.data(), static_cast<uLong>(size));
    bytes.resize(length);
    return bytes;
}

/// Of this process so far, in KiB.
long most_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

/// Left half red, upper right white, lower right blue.
std::vector<std::uint8_t> three_fields(int width, int height) {
    std::vector<std::uint8_t> rgb;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::uint8_t right = x < width / 2 ? 0 : 255, top = y < height / 2 ? right : 0;
            rgb.insert(rgb.end(), {x < width / 2 ? std::uint8_t{255} : top, top, right});
        }
    return rgb;
}

bool is_near(const Pixel& a, const Pixel& b) {
    for (std::size_t i = 0; i < 4; ++i)
        if (std::abs(a[i] - b[i]) > 3) return false;
    return true;
}

/// A grey progressive JPEG of one coarse scan, `count` times over.
std::string many_scans(int count) {
    const std::string file = jpeg_bytes(8, 8, std::vector<std::uint8_t>(192, 100), true, TJFLAG_PROGRESSIVE);
    const std::size_t start = file.find("\xFF\xDA");
    REQUIRE(start != std::string::npos);
    std::size_t end = start + 2 + static_cast<std::uint8_t>(file[start + 3]);
    while (file[end] != '\xFF' || file[end + 1] == '\0') ++end;
    std::string scan = file.substr(start, end - start);
    scan[9] = 0;  // its bits are the last ones: to say them again is allowed
    std::string bytes = file.substr(0, start);
    for (int i = 0; i < count; ++i) bytes += scan;
    return bytes + "\xFF\xD9";
}

}  // namespace

TEST_CASE("PNGs of every kind are read exactly, and upright") {
    for (const Kind& kind : kKinds)
        for (const bool interlaced : {false, true}) {
            CAPTURE(kind.name);
            CAPTURE(interlaced);
            const scene::Image image = decode_well(file_of(kind, interlaced));
            REQUIRE(image.width == kWidth);
            REQUIRE(image.height == kHeight);
            REQUIRE(image.rgba.size() == std::size_t{kWidth} * kHeight * 4);
            for (int y = 0; y < kHeight; ++y)
                for (int x = 0; x < kWidth; ++x) CHECK(pixel(image, x, y) == expected(kind, x, y));
        }
}

TEST_CASE("the last row of a picture is the file's first") {
    const scene::Image image =
        decode_well(png_bytes({.width = 1, .height = 2, .rows = {{1, 2, 3}, {4, 5, 6}}}));
    CHECK(image.rgba == std::vector<std::uint8_t>{4, 5, 6, 255, 1, 2, 3, 255});
}

TEST_CASE("a gamma that a PNG names changes nothing") {
    const scene::Image image =
        decode_well(png_bytes({.width = 2, .rows = {{1, 60, 128, 200, 254, 77}}, .gamma = 1 / 1.1}));
    CHECK(pixel(image, 0, 0) == Pixel{1, 60, 128, 255});
    CHECK(pixel(image, 1, 0) == Pixel{200, 254, 77, 255});
}

TEST_CASE("what a PNG says besides its pixels is not unpacked") {
    const std::string png = flat_png(2, 2, {1, 2, 3, 4});
    // Each below what libpng takes of one by itself.
    const std::string text = deflated_text(7 << 20), nothing(1, '\0');
    const std::string ztxt = png_chunk("zTXt", "k" + nothing + nothing + text);
    const std::string itxt = png_chunk("iTXt", "k" + nothing + "\1" + nothing + nothing + nothing + text);
    std::string bomb = with_chunk(png, png_chunk("iCCP", "p" + nothing + nothing + text));
    for (int i = 0; i < 10; ++i) bomb = with_chunk(with_chunk(bomb, ztxt), itxt);
    const long before = most_memory();
    CHECK(pixel(decode_well(bomb), 0, 0) == Pixel{1, 2, 3, 4});
    CHECK(most_memory() - before < 32 << 10);

    // Of an animation the first picture is taken, which other readers see too.
    const std::string control = big_endian(2) + big_endian(2) + std::string(12, '\0');
    const std::string animated = with_chunk(
        with_chunk(png, png_chunk("acTL", big_endian(2) + big_endian(0))),
        png_chunk("fcTL", big_endian(0) + control) + png_chunk("fdAT", big_endian(2) + "no picture"));
    CHECK(pixel(decode_well(animated), 1, 1) == Pixel{1, 2, 3, 4});
}

TEST_CASE("JPEGs in colour and grey, of one and of several scans, are read upright") {
    for (const int flags : {0, TJFLAG_PROGRESSIVE}) {
        const scene::Image image = decode_well(jpeg_bytes(32, 16, three_fields(32, 16), false, flags));
        REQUIRE(image.width == 32);
        REQUIRE(image.height == 16);
        CHECK(is_near(pixel(image, 3, 3), {255, 0, 0, 255}));
        CHECK(is_near(pixel(image, 28, 3), {255, 255, 255, 255}));
        CHECK(is_near(pixel(image, 28, 12), {0, 0, 255, 255}));
    }
    {
        const EnvironmentVariable arithmetic("TJ_ARITHMETIC", "1");  // for the encoder
        const std::string file = jpeg_bytes(32, 16, three_fields(32, 16));
        REQUIRE(file.find("\xFF\xC9") != std::string::npos);
        CHECK(is_near(pixel(decode_well(file), 28, 12), {0, 0, 255, 255}));
    }
    const scene::Image grey = decode_well(jpeg_bytes(32, 16, three_fields(32, 16), true));
    CHECK(is_near(pixel(grey, 3, 3), {76, 76, 76, 255}));  // luma of red
    CHECK(is_near(pixel(grey, 28, 3), {255, 255, 255, 255}));
    CHECK(is_near(pixel(grey, 28, 12), {29, 29, 29, 255}));
}

TEST_CASE("a JPEG in printing colours, and what is no picture, is refused with a sentence") {
    std::string cmyk = jpeg_bytes(8, 8, std::vector<std::uint8_t>(192, 100));
    CHECK(contains(refusal("%PDF-1.7"), "none of PNG, JPEG, WebP, TIFF, BMP, GIF and TGA"));
    CHECK(contains(refusal(""), "none of PNG, JPEG, WebP, TIFF, BMP, GIF and TGA"));
    CHECK(refusal("\xABKTX 20\xBB\r\n\x1A\n") == "it is KTX2, which is not supported: save it as PNG");
    CHECK(refusal("DDS |") == "it is DDS, which is not supported: save it as PNG");

    tjhandle encoder = tjInitCompress();
    unsigned char* data = nullptr;
    unsigned long size = 0;
    const std::vector<std::uint8_t> ink(std::size_t{8} * 8 * 4, 50);
    REQUIRE(tjCompress2(encoder, ink.data(), 8, 0, 8, TJPF_CMYK, &data, &size, TJSAMP_444, 90, 0) == 0);
    CHECK(contains(refusal(std::string(reinterpret_cast<char*>(data), size)), "CMYK"));
    tjFree(data);
    tjDestroy(encoder);
}

TEST_CASE("WebP, TIFF, BMP, GIF and TGA are read upright, with their alpha") {
    for (const auto& file : other_files()) {
        const auto& [name, bytes] = file;
        CAPTURE(file.first);
        const scene::Image image = decode_well(bytes);
        REQUIRE(image.width == 2);
        REQUIRE(image.height == 2);
        const bool has_alpha = name != "BMP" && name != "GIF";
        CHECK(pixel(image, 0, 0) == Pixel{255, 0, 0, 255});
        CHECK(pixel(image, 1, 0) == Pixel{0, 255, 0, 255});
        CHECK(pixel(image, 0, 1) == Pixel{0, 0, 255, 255});
        const Pixel last = pixel(image, 1, 1);
        CHECK(last[3] == (has_alpha ? 128 : 255));
        const bool rounded = name == "TIFF";  // libtiff multiplies by alpha
        CHECK((rounded ? std::abs(last[0] - 200) <= 1 : last[0] == 200));
        CHECK((rounded ? std::abs(last[1] - 100) <= 1 : last[1] == 100));
        CHECK((rounded ? std::abs(last[2] - 50) <= 1 : last[2] == 50));
    }
}

TEST_CASE("the sizes of these are judged from their headers, too") {
    for (const auto& file : other_files()) {
        CAPTURE(file.first);
        CHECK(contains(io::decode_image(file.second, 3).error(), "2 x 2 pixels, but at most 3"));
    }
}

TEST_CASE("the size is judged from the header") {
    CHECK(io::decode_image(flat_png(16384, 16, {9, 8, 7, 6})));
    for (const auto& [width, height] : {std::pair{16385U, 1U}, {1U, 16385U}, {900000U, 900000U}}) {
        const std::string why = refusal(claiming_png(width, height));
        CHECK_MESSAGE(contains(why, std::to_string(width) + " x " + std::to_string(height)), why);
        CHECK_MESSAGE(contains(why, "16384"), why);
    }
    const std::string many = refusal(claiming_png(16384, 4097));
    CHECK_MESSAGE(contains(many, "67108864"), many);
    CHECK_FALSE(contains(refusal(claiming_png(16384, 4096)), "67108864"));
    const auto limited = io::decode_image(flat_png(4, 4, {1, 2, 3, 4}), 15);
    REQUIRE_FALSE(limited);
    CHECK(contains(limited.error(), "15"));
    CHECK(io::decode_image(flat_png(4, 4, {1, 2, 3, 4}), 16));

    std::string jpeg = jpeg_bytes(8, 8, std::vector<std::uint8_t>(192, 100));
    const std::size_t frame = jpeg.find("\xFF\xC0");
    REQUIRE(frame != std::string::npos);
    for (std::size_t i = 5; i < 9; ++i) jpeg[frame + i] = '\xF0';
    CHECK(contains(refusal(jpeg), "61680 x 61680"));
}

TEST_CASE("a progressive JPEG has at most 500 scans") {
    CHECK(is_near(pixel(decode_well(many_scans(1)), 4, 4), pixel(decode_well(many_scans(400)), 4, 4)));
    const std::string why = refusal(many_scans(600));
    CHECK_MESSAGE(contains(why, "500 scans"), why);
}

TEST_CASE("files that are cut short are refused, and changed ones do no harm") {
    std::vector<std::string> files;
    for (const Kind& kind : kKinds) files.push_back(file_of(kind, files.size() % 2 == 1));
    files.push_back(jpeg_bytes(32, 16, three_fields(32, 16)));
    files.push_back(jpeg_bytes(32, 16, three_fields(32, 16), true, TJFLAG_PROGRESSIVE));
    for (const auto& [name, bytes] : other_files())
        files.push_back(name == "GIF" ? bytes.substr(0, bytes.size() - 1) : bytes);
    for (const std::string& file : files)
        for (std::size_t at = 0; at < file.size(); at += at < 20 ? 1 : 7) {
            CAPTURE(at);
            CHECK_FALSE(refusal(file.substr(0, at)).empty());
            std::string changed = file;
            changed[at] = static_cast<char>(~changed[at]);
            (void)io::decode_image(changed);
        }
    CHECK(contains(refusal(files[0].substr(0, files[0].size() - 1)), "too early"));
}

TEST_CASE("a picture is read from a file whatever its ending") {
    const TemporaryFolder folder;
    const auto path = folder.write("picture.jpg", flat_png(2, 1, {1, 2, 3, 4}));
    const auto image = io::read_image_file(path);
    REQUIRE(image);
    CHECK(image->rgba == std::vector<std::uint8_t>{1, 2, 3, 4, 1, 2, 3, 4});
    CHECK(io::read_image_file(folder.path() / "none.png").error() == "there is no such file");
    CHECK(io::read_image_file(folder.path()).error() == "it is not a regular file");
}
