// Studies of JPEG.
#include <algorithm>
#include <cmath>

#include "compare/difference.hpp"
#include "engine/images.hpp"
#include "io/image/image_file.hpp"
#include "study.hpp"

namespace vrut::stability {

namespace {

scene::Image sent(const scene::Image& image, int quality, bool subsampled) {
    server::engine::JpegEncoder encoder;
    const auto file = encoder.encode(image, quality, subsampled);
    return io::decode_image({reinterpret_cast<const char*>(file.data()), file.size()}).value();  // throws
}

template <class Color>
scene::Image picture_of(int width, int height, const Color& color) {
    scene::Image image;
    image.resize(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::dvec3 rgb = color(x, y);
            std::uint8_t* pixel =
                image.rgba.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                         static_cast<std::size_t>(x));
            for (int k = 0; k < 3; ++k) pixel[k] = static_cast<std::uint8_t>(std::lround(255 * rgb[k]));
            pixel[3] = 255;
        }
    return image;
}

}  // namespace

Study thin_saturated_lines(const Laboratory& laboratory) {
    Study study{"thin-lines", "Saturated lines in JPEG", "lines to a pixel (1 / width)",
                "pixels off by more than 64 of 255, in percent"};
    study.bound = 10;
    study.baseline.title = "colour at half the resolution (4:2:0)";
    study.method.title = "colour in full (4:4:4)";
    study.explanation =
        "Pictures with thin lines (wireframe, stylized, a selection's outline) and all pictures at rest are "
        "sent in full colour.";
    for (const double density : laboratory.chosen({0.0625, 0.125, 0.25, 0.5, 1})) {
        const int width = static_cast<int>(std::lround(1 / density));
        const scene::Image lines = picture_of(256, 256, [&](int x, int y) {
            const bool line = (x + y / 3) % (8 * width) < width;
            return line ? glm::dvec3(1, 0, 0) : glm::dvec3(0.1, 0.3, 0.9);
        });
        const auto error = [&](bool subsampled) {
            return 100 * compare::difference(sent(lines, 85, subsampled), lines).share_above(64);
        };
        study.baseline.points.push_back({density, error(true)});
        study.method.points.push_back({density, error(false)});
        server::engine::JpegEncoder encoder;
        const auto bytes = [&](bool half) {
            return static_cast<double>(encoder.encode(lines, 85, half).size());
        };
        study.cost = "Up to " + std::to_string(std::lround(100 * (bytes(false) / bytes(true) - 1))) +
                     " % more bytes, for the thinnest of these lines.";
    }
    return study;
}

Study dark_gradients(const Laboratory& laboratory) {
    Study study{"dark-gradients", "Dark gradients in JPEG", "100 / quality",
                "largest error of a channel, of 255"};
    study.bound = 4;
    study.limit = 3.3;
    study.method.title = "as sent while things move";
    study.explanation = "At rest the picture comes at quality 90, which holds the bound.";
    study.cost = "Some 100 to 200 kB for the picture at rest, once.";
    const scene::Image gradient = picture_of(256, 128, [](int x, int y) {
        return glm::dvec3(0.01, 0.012, 0.016) + 0.06 * glm::dvec3(x / 255.0, x / 255.0, y / 127.0);
    });
    for (const double inverse : laboratory.chosen({1, 1.05, 1.11, 1.33, 1.67, 2.2, 3.3}))
        study.method.points.push_back(
            {inverse, 1.0 * compare::difference(
                                sent(gradient, static_cast<int>(std::lround(100 / inverse)), true), gradient)
                                .maximum()});
    return study;
}

}  // namespace vrut::stability
