// A recorded session ends at the picture that was looked at when it was kept. VRUT_RENEW=1 keeps a new one.
#include <doctest/doctest.h>
#include <png.h>

#include <cmath>
#include <cstdlib>

#include "base/files.hpp"
#include "engine/images.hpp"
#include "recorded_session.hpp"
#include "renderer/renderer.hpp"

using namespace vrut;
using namespace vrut::server::base;
using namespace vrut::server::room;
using namespace vrut::test;

namespace {

constexpr int kWidth = 320, kHeight = 200;

scene::Image drawn_end() {
    auto room = replay(read_session(), find_scene);
    REQUIRE_MESSAGE(room, room.error());
    plan::View view = room->visible();
    view.width = kWidth;
    view.height = kHeight;
    view.samples = 4;
    renderer::Renderer renderer({}, true);
    scene::Image image;
    plan::FrameStats stats;
    renderer.render(view, image, stats);
    for (const std::string& message : renderer.take_messages()) FAIL_CHECK(message);
    return image;
}

/// Rows from the bottom up, as the renderer's.
scene::Image read_picture(const std::filesystem::path& file) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    REQUIRE_MESSAGE(png_image_begin_read_from_file(&png, file.c_str()), png.message);
    png.format = PNG_FORMAT_RGBA;
    scene::Image image;
    image.resize(static_cast<int>(png.width), static_cast<int>(png.height));
    const auto bottom_up = -static_cast<png_int_32>(png.width * 4);
    REQUIRE_MESSAGE(png_image_finish_read(&png, nullptr, image.rgba.data(), bottom_up, nullptr), png.message);
    return image;
}

}  // namespace

TEST_CASE("the session ends at its picture") {
    const scene::Image image = drawn_end();
    const std::filesystem::path file = session_file(".png");
    if (std::getenv("VRUT_RENEW")) {
        write_file(file, io::encode_png(image));
        MESSAGE("look at " << file.string());
        return;
    }
    const scene::Image expected = read_picture(file);
    REQUIRE(expected.width == kWidth);
    REQUIRE(expected.height == kHeight);
    int far_off = 0;
    double sum = 0;
    for (std::size_t pixel = 0; pixel < image.rgba.size(); pixel += 4) {
        int worst = 0;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const int off = std::abs(image.rgba[pixel + channel] - expected.rgba[pixel + channel]);
            worst = std::max(worst, off);
            sum += off > 1 ? off : 0;
        }
        far_off += worst > 8;
    }
    // Drivers differ in which side of an edge a sample falls on, and in how they round halves.
    CHECK(far_off <= kWidth * kHeight / 200);
    CHECK(sum / (3.0 * kWidth * kHeight) < 0.1);
}
