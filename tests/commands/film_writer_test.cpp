// The file of a film: what a player makes of it, and what is left where it cannot be written.
#include "commands/film_writer.hpp"

#include <doctest/doctest.h>
#include <malloc.h>

#include <array>
#include <cstdlib>
#include <stdexcept>

#include "commands/image_output.hpp"
#include "decoded_film.hpp"
#include "full_disk.hpp"
#include "temporary_folder.hpp"

using namespace vrut;
using namespace vrut::server::commands;
using namespace vrut::test;
namespace fs = std::filesystem;

#ifdef __clang__
#pragma clang diagnostic ignored "-Wreserved-identifier"  // the name is the sanitizer's
#endif
/// libavcodec 59 does not free the parameters of a libx264 that does not take a size.
extern "C" const char* __lsan_default_suppressions() { return "leak:libx264"; }

namespace {

constexpr int kWidth = 64, kHeight = 48;
constexpr int kPatternWidth = 320, kPatternHeight = 180;
constexpr int kTolerance = 2;  // of 255
using Rgb = std::array<std::uint8_t, 3>;

/// One colour below, another above.
scene::Image two_colors(const Rgb& below, const Rgb& above) {
    scene::Image image;
    image.resize(kWidth, kHeight);
    const std::size_t half = image.rgba.size() / 2;
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] = i % 4 == 3 ? 255 : (i < half ? below : above).at(i % 4);
    return image;
}

/// Noise that no encoder makes small.
scene::Image noise(unsigned seed) {
    scene::Image image;
    image.resize(kWidth, kHeight);
    for (std::uint8_t& byte : image.rgba) {
        seed = seed * 1664525 + 1013904223;
        byte = static_cast<std::uint8_t>(seed >> 24);
    }
    return image;
}

/// A pattern that moves.
scene::Image pattern(unsigned step) {
    scene::Image image;
    image.resize(kPatternWidth, kPatternHeight);
    for (unsigned i = 0; i < image.rgba.size(); ++i) {
        const unsigned x = i / 4 % kPatternWidth, y = i / 4 / kPatternWidth;
        image.rgba[i] = static_cast<std::uint8_t>(((x * 3 + y * 5 + step * 7) ^ (x * y / 50)) % 200);
    }
    return image;
}

void write_film(const fs::path& path, unsigned images) {
    FilmWriter film(path, kWidth, kHeight, 25);
    for (unsigned i = 0; i < images; ++i) film.add(noise(i));
    film.finish();
}

/// The sentence that `act` throws.
template <class Act>
std::string error_of(Act act) {
    try {
        act();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "nothing";
}

std::size_t files_in(const TemporaryFolder& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder.path()), {}));
}

void check_color(const scene::Image& image, int row, const Rgb& expected) {
    const std::size_t pixel = 4 * (static_cast<std::size_t>(row) * kWidth + kWidth / 2);
    for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(image.rgba[pixel + k] - expected.at(k)) <= kTolerance);
}

}  // namespace

TEST_CASE("a film shows the colours of its images, the right way up") {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "a.mp4";
    const std::array<std::pair<Rgb, Rgb>, 4> patches{{{{128, 128, 128}, {200, 20, 30}},
                                                      {{0, 0, 0}, {255, 255, 255}},
                                                      {{20, 180, 40}, {30, 40, 220}},
                                                      {{12, 12, 12}, {240, 200, 10}}}};
    {
        FilmWriter film(path, kWidth, kHeight, 24);
        for (const auto& patch : patches) film.add(two_colors(patch.first, patch.second));
        film.finish();
    }
    const DecodedFilm film = decode_film(path);
    CHECK(film.codec == "h264");
    CHECK(film.is_bt709);
    CHECK(film.has_limited_range);
    CHECK(film.images_per_second == 24);
    CHECK(film.seconds == doctest::Approx(4 / 24.0).epsilon(0.001));
    REQUIRE(film.images.size() == patches.size());
    for (std::size_t i = 0; i < patches.size(); ++i) {
        CAPTURE(i);
        REQUIRE(film.images[i].width == kWidth);
        REQUIRE(film.images[i].height == kHeight);
        check_color(film.images[i], kHeight / 4, patches.at(i).first);
        check_color(film.images[i], 3 * kHeight / 4, patches.at(i).second);
    }
}

TEST_CASE("the same images give the same bytes, and one image is a film") {
    const TemporaryFolder folder;
    write_film(folder.path() / "a.mp4", 40);
    write_film(folder.path() / "b.mp4", 40);
    CHECK(folder.read("a.mp4") == folder.read("b.mp4"));
    CHECK(decode_film(folder.path() / "a.mp4").images.size() == 40);
    write_film(folder.path() / "a.mp4", 1);
    const DecodedFilm one = decode_film(folder.path() / "a.mp4");
    CHECK(one.images.size() == 1);
    CHECK(one.seconds == doctest::Approx(1 / 25.0).epsilon(0.001));
    CHECK(files_in(folder) == 2);
}

TEST_CASE("what memory held before does not change a film") {
    const TemporaryFolder folder;
    for (const int before : {0, 85}) {
        mallopt(M_PERTURB, before);
        FilmWriter film(folder.path() / (std::to_string(before) + ".mp4"), kPatternWidth, kPatternHeight, 30);
        for (unsigned i = 0; i < 4; ++i) film.add(pattern(i));
        film.finish();
    }
    mallopt(M_PERTURB, 0);
    CHECK(folder.read("0.mp4") == folder.read("85.mp4"));
}

TEST_CASE("a colon in a film's name is a colon") {
    const TemporaryFolder folder;
    const fs::path before = fs::current_path();
    fs::current_path(folder.path());
    CHECK(error_of([] { write_film("http:a.mp4", 2); }) == "nothing");
    fs::current_path(before);
    CHECK(decode_film(folder.path() / "http:a.mp4").images.size() == 2);
}

TEST_CASE("a film that is not finished leaves nothing, and the old one as it was") {
    const TemporaryFolder folder;
    const fs::path path = folder.write("a.mp4", "old");
    {
        FilmWriter film(path, kWidth, kHeight, 25);
        for (unsigned i = 0; i < 100; ++i) film.add(noise(i));
        CHECK(files_in(folder) == 2);
    }
    CHECK(files_in(folder) == 1);
    CHECK(folder.read("a.mp4") == "old");
}

TEST_CASE("what cannot be written is a sentence, and nothing is left") {
    const TemporaryFolder folder;
    const fs::path path = folder.write("a.mp4", "old");
    {
        const FullDisk full(20'000);
        CHECK(error_of([&] { write_film(path, 100); }) ==
              path.string() + " cannot be written: File too large");
    }
    CHECK(folder.read("a.mp4") == "old");
    const fs::path nowhere = folder.path() / "none/a.mp4";
    CHECK(error_of([&] { write_film(nowhere, 1); }) ==
          nowhere.string() + " cannot be written: No such file or directory");
    CHECK(error_of([&] { FilmWriter(folder.path(), kWidth, kHeight, 25); }) ==
          folder.path().string() + " cannot be written: Is a directory");
    CHECK(files_in(folder) == 1);
}

TEST_CASE("an image of another size is a sentence") {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "a.mp4";
    FilmWriter film(path, kWidth, kHeight, 24);
    film.add(noise(1));
    scene::Image small;
    small.resize(8, 8);
    const std::string expected = path.string() + ": image 2 has 8x8 pixels, and the film 64x48";
    CHECK_THROWS_WITH_AS(film.add(small), expected.c_str(), std::runtime_error);
    film.add(noise(2));
    film.finish();
    CHECK(decode_film(path).images.size() == 2);
}

TEST_CASE("odd sizes are rejected with the next even one") {
    CHECK_NOTHROW(require_film("a.mp4", 640, 360));
    CHECK_THROWS_AS(require_film("a.mp4", 641, 360), std::invalid_argument);
    CHECK_THROWS_WITH(require_film("a.mp4", 641, 359),
                      "--size: width and height of a film are even; the next size for 641x359 is 642x360");
}

TEST_CASE("a size that no encoder takes is a sentence") {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "a.mp4";
    CHECK(error_of([&] { FilmWriter(path, 100'000, 2, 25); }) ==
          path.string() + ": no encoder takes films of 100000x2 pixels; choose another --size");
    CHECK(files_in(folder) == 0);
}
