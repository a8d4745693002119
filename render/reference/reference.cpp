#include "reference/reference.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "math/sample_sequence.hpp"
#include "reference/tracer.hpp"

namespace vrut::reference {

namespace {

/// The row is counted from the bottom.
void trace_row(const reference::Tracer& tracer, const plan::View& view, int row, ReferenceImage& image) {
    const int y = view.height - 1 - row;
    for (int x = 0; x < view.width; ++x) {
        const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(view.width) +
                        static_cast<std::size_t>(x);
        const glm::dvec2 center(x + 0.5, y + 0.5);
        glm::dvec3 sum(0);
        for (int i = 0; i < view.samples; ++i)
            sum += tracer.color_at(center + math::sample_offset(static_cast<std::uint32_t>(i)));
        image.color[at] = sum / static_cast<double>(view.samples);
        image.node[at] = tracer.node_at(center);
    }
}

}  // namespace

ReferenceImage trace(const plan::View& view) {
    const std::size_t pixels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
    ReferenceImage image{view.width, view.height, std::vector<glm::dvec3>(pixels),
                         std::vector<scene::Index>(pixels, scene::kNone)};
    const reference::Tracer tracer(view);
    std::atomic<int> next = 0;
    const auto work = [&] {
        for (int row = next++; row < view.height; row = next++) trace_row(tracer, view, row, image);
    };
    std::vector<std::jthread> others(std::max(std::thread::hardware_concurrency(), 1U) - 1);
    for (std::jthread& other : others) other = std::jthread(work);
    work();
    for (std::jthread& other : others) other.join();
    return image;
}

scene::Image image_of(const ReferenceImage& reference) {
    scene::Image image;
    image.resize(reference.width, reference.height);
    for (std::size_t i = 0; i < reference.color.size(); ++i) {
        for (int k = 0; k < 3; ++k)
            image.rgba[4 * i + static_cast<std::size_t>(k)] =
                static_cast<std::uint8_t>(std::floor(255 * reference.color[i][k] + 0.5));
        image.rgba[4 * i + 3] = 255;
    }
    return image;
}

}  // namespace vrut::reference
