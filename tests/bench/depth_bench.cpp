// What depth for a warp takes: draws frames of a turning scene with and without it, in turns, as a server
// draws and encodes them while the camera moves, and prints medians.
//   bench_depth SCENE WIDTH HEIGHT ROUNDS
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <numbers>
#include <vector>

#include "engine/images.hpp"
#include "navigation/camera_moves.hpp"
#include "renderer/renderer.hpp"
#include "room/room.hpp"
#include "scenes/library.hpp"

using namespace vrut;

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

struct Costs {
    std::vector<double> draw_ms, cpu_ms, read_ms, encode_ms, bytes, depth_encode_ms, depth_bytes, blocks;
};

}  // namespace

int main(int count, char** arguments) {
    if (count != 5) return std::cerr << "usage: bench_depth SCENE WIDTH HEIGHT ROUNDS\n", 2;
    auto scene = server::scenes::load_scene(arguments[1], arguments[1]);
    if (!scene) return std::cerr << scene.error() << '\n', 1;
    plan::View view = server::room::Room(*std::move(scene), {}).visible();
    view.width = std::stoi(arguments[2]);
    view.height = std::stoi(arguments[3]);
    renderer::Renderer renderer;
    server::engine::JpegEncoder encoder;
    warp::BlockChoice blocks;
    Costs without, with;
    for (int round = 0; round < std::stoi(arguments[4]); ++round)
        for (const bool depth : {false, true}) {
            Costs& costs = depth ? with : without;
            view.camera = navigation::rotated(view.camera, 1, 0, true);
            plan::RenderJob job(view);
            job.output = plan::RenderJob::Output::ycbcr_420;
            if (depth) job.depth_size = warp::depth_map_size(view.width, view.height, blocks.pixels());
            Clock::time_point start = Clock::now();
            const auto cpu_start = std::clock();
            while (!renderer.step(job)) {
            }
            costs.draw_ms.push_back(milliseconds_since(start));
            costs.cpu_ms.push_back(static_cast<double>(std::clock() - cpu_start) * 1e3 / CLOCKS_PER_SEC);
            costs.read_ms.push_back(job.stats.readback_ms);
            start = Clock::now();
            const std::size_t bytes = job.planes.bytes.empty() ? encoder.encode(job.image, 75, true).size()
                                                               : encoder.encode(job.planes, 75).size();
            costs.encode_ms.push_back(milliseconds_since(start));
            costs.bytes.push_back(static_cast<double>(bytes));
            if (!depth) continue;
            start = Clock::now();
            const std::size_t map_bytes = warp::encode(job.depth).size();
            costs.depth_encode_ms.push_back(milliseconds_since(start));
            costs.depth_bytes.push_back(static_cast<double>(map_bytes));
            costs.blocks.push_back(job.depth.columns * job.depth.rows);
            blocks.took(map_bytes, bytes);
        }
    // Of a frame with depth than of the one before, without.
    const auto more = [&](auto of) {
        std::vector<double> pairs;
        for (std::size_t i = 0; i < with.draw_ms.size(); ++i)
            pairs.push_back((with.*of)[i] - (without.*of)[i]);
        return median(pairs);
    };
    std::printf(
        "depth takes %.2f ms of drawing (%.2f of them reading; %.2f of all CPUs) and %.2f of encoding\n",
        more(&Costs::draw_ms), more(&Costs::read_ms), more(&Costs::cpu_ms), median(with.depth_encode_ms));
    std::printf(
        "draw %.2f ms, with depth %.2f; of it read %.2f ms, with depth %.2f; JPEG %.2f ms, %.0f bytes\n",
        median(without.draw_ms), median(with.draw_ms), median(without.read_ms), median(with.read_ms),
        median(without.encode_ms), median(without.bytes));
    std::printf("map %.0f blocks, %.2f ms, %.0f bytes (%.1f %%)\n", median(with.blocks),
                median(with.depth_encode_ms), median(with.depth_bytes),
                100 * median(with.depth_bytes) / median(with.bytes));
}
