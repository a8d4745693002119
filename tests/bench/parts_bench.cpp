// How the time of an image grows with the number of parts that hold the same triangles. Fails where the most
// parts take more than kMostTimes as long as the fewest.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <vector>

#include "renderer/renderer.hpp"
#include "shapes.hpp"

using namespace vrut;

namespace {

constexpr int kBoxes = 20'000, kMaterials = 20, kRounds = 2, kImages = 20;
constexpr double kMostTimes = 1.5;

double milliseconds_of(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) / 1e6;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// Adds a box around a place.
void add_box(scene::Geometry& geometry, const glm::dvec3& place) {
    scene::Geometry added = box(glm::dvec3(0.25));
    const auto first = static_cast<unsigned>(geometry.positions.size());
    for (const glm::dvec3& position : added.positions) {
        geometry.positions.push_back(position + place);
        geometry.bounds.add(geometry.positions.back());
    }
    for (const glm::uvec3& triangle : added.triangles) geometry.triangles.push_back(triangle + first);
}

/// Boxes in a grid, in so many parts of neighbours whose materials take turns.
std::shared_ptr<const scene::PlacedScene> boxes(int parts) {
    const int side = static_cast<int>(std::ceil(std::cbrt(kBoxes)));
    scene::SceneParts result;
    for (int i = 0; i < kMaterials; ++i) {
        const double shade = (i + 1.0) / kMaterials;
        result.materials.push_back(material_of({shade, 0.5, 1 - shade}, glm::dvec3(0.3), 20));
    }
    for (int i = 0; i < kBoxes; ++i) {
        const scene::Index part = i / (kBoxes / parts);
        if (part == static_cast<scene::Index>(result.geometries.size())) {
            result.geometries.emplace_back();
            result.nodes.push_back({scene::Node{part + 1,
                                                {},
                                                scene::NodeType::geometry,
                                                scene::kNone,
                                                {},
                                                true,
                                                glm::dmat4(1),
                                                scene::GeometryData{part, part % kMaterials}},
                                    0});
        }
        add_box(result.geometries.back(),
                glm::dvec3(i % side, i / side % side, i / side / side) - 0.5 * side);
    }
    return std::make_shared<scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(result))));
}

struct Times {
    std::vector<double> wall_ms, cpu_ms;
    int draws = 0;
};

void measure(const std::shared_ptr<const scene::PlacedScene>& scene, Times& times) {
    plan::View view;
    view.scene = scene;
    view.width = 640;
    view.height = 480;
    renderer::Renderer renderer;
    scene::Image image;
    plan::FrameStats stats;
    for (int i = -2; i < kImages; ++i) {
        const double turn = 0.1 * i;
        view.camera.eye = 55.0 * glm::dvec3(std::cos(turn), 0.4, std::sin(turn));
        view.camera = scene::with_orthogonal_up(view.camera);
        const double wall = milliseconds_of(CLOCK_MONOTONIC), cpu = milliseconds_of(CLOCK_PROCESS_CPUTIME_ID);
        renderer.render(view, image, stats);
        times.draws = stats.draws;
        if (i < 0) continue;
        times.wall_ms.push_back(milliseconds_of(CLOCK_MONOTONIC) - wall);
        times.cpu_ms.push_back(milliseconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu);
    }
}

}  // namespace

int main() {
    const std::vector<int> counts{200, 2'000, 20'000};
    std::vector<std::shared_ptr<const scene::PlacedScene>> scenes;
    for (const int count : counts) scenes.push_back(boxes(count));
    std::vector<Times> times(counts.size());
    for (int round = 0; round < kRounds; ++round)
        for (std::size_t i = 0; i < counts.size(); ++i) measure(scenes[i], times[i]);
    const double least = median(times[0].cpu_ms);
    for (std::size_t i = 0; i < counts.size(); ++i)
        std::printf("%6d parts: %6.1f ms, %6.1f ms of the processor (%.2f times), %d draws\n", counts[i],
                    median(times[i].wall_ms), median(times[i].cpu_ms), median(times[i].cpu_ms) / least,
                    times[i].draws);
    return median(times.back().cpu_ms) <= kMostTimes * least ? 0 : 1;
}
