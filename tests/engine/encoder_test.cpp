#include "engine/encoder.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <future>
#include <random>

#include "messages.hpp"

using namespace vrut;
using namespace vrut::server;
using namespace vrut::server::engine;

namespace {

/// Which hardly any encoder makes smaller. It repeats itself.
scene::Image noise(int width, int height) {
    scene::Image image;
    image.resize(width, height);
    const auto piece = image.rgba.begin() + (1 << 20);
    std::generate(image.rgba.begin(), piece, [random = std::minstd_rand()]() mutable {
        return static_cast<std::uint8_t>(random() >> 8);
    });
    for (auto at = piece; at != image.rgba.end();)
        at = std::copy_n(image.rgba.begin(), std::min<std::ptrdiff_t>(1 << 20, image.rgba.end() - at), at);
    return image;
}

}  // namespace

TEST_CASE("a picture longer than a message may be fails, and leaves nothing behind") {
    observe::Metrics metrics;
    std::promise<std::size_t> encoded;  // bytes
    std::promise<std::string> failed;
    {
        Encoder encoder(
            metrics, [&](const auto& picture) { encoded.set_value(picture->file.size()); }, [] {},
            [&](const Picture&, std::string why) { failed.set_value(std::move(why)); });
        const auto offer = [&](int width, int height) {
            Picture picture;
            picture.header.quality.jpeg_quality = 100;
            picture.header.quality.subsampling = protocol::Quality::Subsampling::yuv444;
            encoder.offer(std::move(picture), noise(width, height));
        };
        offer(1024, 1024);
        const std::size_t bytes = encoded.get_future().get();
        REQUIRE(bytes > 2 << 20);
        // As many of them as make a file longer than a message by a tenth.
        const auto pieces = protocol::kMaxServerMessageBytes / bytes * 11 / 10 + 1;
        offer(1024, static_cast<int>(1024 * pieces));
        CHECK(failed.get_future().get().find("more than a message of this server may") != std::string::npos);
    }
    CHECK(metrics.bytes_held == 0);
    CHECK(metrics.pictures_held == 0);
}
