// What strips are worth in JPEG: encodes views of a scene as a whole and in strips, in turns, while the
// machine is idle and while a renderer draws the scene without a pause. Drawn frames a second tell what the
// strips take from drawing.
//   bench_jpeg SCENE ROUNDS
#include <turbojpeg.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <thread>
#include <vector>

#include "engine/images.hpp"
#include "measure/measure.hpp"
#include "renderer/renderer.hpp"
#include "room/room.hpp"
#include "scenes/library.hpp"

using namespace vrut;

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Encodes an image as one strip.
class WholeEncoder {
public:
    WholeEncoder() : handle_(tjInitCompress()) {}
    ~WholeEncoder() { tjDestroy(handle_); }
    WholeEncoder(const WholeEncoder&) = delete;
    WholeEncoder& operator=(const WholeEncoder&) = delete;

    std::vector<std::uint8_t> encode(const scene::Image& image, int quality, bool subsampled) {
        const int sampling = subsampled ? TJSAMP_420 : TJSAMP_444;
        scratch_.resize(tjBufSize(image.width, image.height, sampling));
        unsigned char* out = scratch_.data();
        unsigned long size = scratch_.size();
        if (tjCompress2(handle_, image.rgba.data(), image.width, 0, image.height, TJPF_RGBA, &out, &size,
                        sampling, quality, TJFLAG_BOTTOMUP | TJFLAG_NOREALLOC) != 0)
            throw std::runtime_error(tjGetErrorStr2(handle_));
        return {out, out + size};
    }

private:
    tjhandle handle_;
    std::vector<std::uint8_t> scratch_;
};

plan::View home_view(const std::string& file, int width, int height) {
    auto scene = server::scenes::load_scene(file, file);
    if (!scene) throw std::runtime_error(scene.error());
    plan::View view = server::room::Room(*std::move(scene), {}).visible();
    view.width = width;
    view.height = height;
    return view;
}

/// Draws one frame after the other on a thread of its own.
class Drawing {
public:
    explicit Drawing(const plan::View& home)
        : thread_([this, home](const std::stop_token& stop) {
              renderer::Renderer renderer;
              scene::Image image;
              plan::FrameStats stats;
              for (int step = 0; !stop.stop_requested(); ++step) {
                  renderer.render(server::measure::on_orbit(home, step, 120), image, stats);
                  ++frames_;
              }
          }) {
        while (frames_ < 10) std::this_thread::yield();
    }
    int frames() const { return frames_; }

private:
    std::atomic<int> frames_ = 0;
    std::jthread thread_;
};

struct Series {
    std::vector<double> ms;
    double bytes = 0, drawn = 0, seconds = 0;
};

template <class Encoder>
void measure(Encoder& encoder, const scene::Image& image, int quality, bool subsampled,
             const Drawing* drawing, Series& series) {
    constexpr int kImages = 20;  // before it is the other encoder's turn
    const auto begin = Clock::now();
    const int drawn = drawing ? drawing->frames() : 0;
    for (int i = 0; i < kImages; ++i) {
        const auto start = Clock::now();
        series.bytes = static_cast<double>(encoder.encode(image, quality, subsampled).size());
        series.ms.push_back(milliseconds_since(start));
    }
    series.seconds += milliseconds_since(begin) / 1e3;
    if (drawing) series.drawn += drawing->frames() - drawn;
}

void compare(const plan::View& view, int quality, bool subsampled, int rounds, const Drawing* drawing) {
    scene::Image image;
    plan::FrameStats stats;
    renderer::Renderer().render(view, image, stats);
    WholeEncoder whole;
    server::engine::JpegEncoder strips;
    Series series[2];
    for (int round = 0; round < rounds; ++round) {
        measure(whole, image, quality, subsampled, drawing, series[0]);
        measure(strips, image, quality, subsampled, drawing, series[1]);
    }
    for (const Series& one : series) {
        const server::measure::Spread ms = server::measure::spread_of(one.ms);
        std::printf("%5d x %-5d %3d %s %-7s %-6s | %7.2f %7.2f %7.2f | %8.0f | %6.1f\n", view.width,
                    view.height, quality, subsampled ? "4:2:0" : "4:4:4", drawing ? "drawing" : "idle",
                    &one == series ? "whole" : "strips", ms.p5, ms.median, ms.p95, one.bytes,
                    one.drawn / one.seconds);
    }
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 3) {
        std::cerr << "usage: bench_jpeg SCENE ROUNDS\n";
        return 2;
    }
    try {
        const int rounds = std::stoi(arguments[2]);
        const plan::View small = home_view(arguments[1], 1280, 720);
        plan::View large = small, tiny = small;
        large.width = 2360;
        large.height = 1640;
        tiny.width = 640;
        tiny.height = 360;
        std::printf("%32s | %7s %7s %7s | %8s | %6s\n", "", "ms p5", "median", "p95", "bytes", "drawn/s");
        const auto all = [&](const Drawing* drawing) {
            compare(tiny, 60, true, rounds, drawing);
            compare(small, 75, true, rounds, drawing);
            compare(large, 90, false, rounds, drawing);
        };
        all(nullptr);
        const Drawing drawing(small);
        all(&drawing);
    } catch (const std::exception& error) {
        std::cerr << "bench_jpeg: " << error.what() << "\n";
        return 1;
    }
    return 0;
}
