// What sections take: draws frames of a turning scene without one, with one and with six, standing and
// moving, in turns, and prints medians.
//   bench_sections SCENE WIDTH HEIGHT ROUNDS
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "mesh/detail_levels.hpp"
#include "navigation/camera_moves.hpp"
#include "renderer/renderer.hpp"
#include "room/room.hpp"
#include "scenes/library.hpp"

using namespace vrut;

namespace {

using Clock = std::chrono::steady_clock;

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

struct Case {
    std::string name;
    std::vector<glm::dvec3> normals;
    bool caps = true, moving = false;
    std::vector<double> ms = {};
};

std::vector<scene::ClipPlane> planes_of(const Case& one, const math::Bounds& bounds, int round) {
    std::vector<scene::ClipPlane> planes;
    const double shift = one.moving ? 0.2 * bounds.radius() * (round % 20 - 10) / 10 : 0;
    for (const glm::dvec3& normal : one.normals) {
        const double reach = glm::dot(glm::abs(normal), bounds.half_extent());
        const double out = one.normals.size() > 1 ? 0.6 * reach : 0;
        planes.push_back({normal, glm::dot(normal, bounds.center()) + out + shift, one.caps});
    }
    return planes;
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 5) return std::cerr << "usage: bench_sections SCENE WIDTH HEIGHT ROUNDS\n", 2;
    auto loaded = server::scenes::load_scene(arguments[1], arguments[1]);
    if (!loaded) return std::cerr << loaded.error() << '\n', 1;
    plan::View view = server::room::Room(*std::move(loaded), {}).visible();
    view.width = std::stoi(arguments[2]);
    view.height = std::stoi(arguments[3]);
    view.levels = std::make_shared<mesh::DetailLevels>(view.scene->scene);
    view.levels->wait_until_examined();
    const std::vector<glm::dvec3> one{{1, 0, 0}},
        six{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<Case> cases{{"none", {}},
                            {"one", one},
                            {"one, no caps", one, false},
                            {"one, moving", one, true, true},
                            {"six", six},
                            {"six, moving", six, true, true}};
    renderer::Renderer renderer;
    for (int round = 0; round < std::stoi(arguments[4]); ++round) {
        view.camera = navigation::rotated(view.camera, 1, 0, true);
        for (Case& each : cases) {
            view.clip_planes = planes_of(each, view.scene->bounds, round);
            plan::RenderJob job(view);
            const Clock::time_point start = Clock::now();
            while (!renderer.step(job)) {
            }
            const double ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
            if (round > 0) each.ms.push_back(ms);  // the first compiles programs
        }
    }
    for (const Case& each : cases)
        std::printf("%-13s %7.2f ms, %.2f of none\n", each.name.c_str(), median(each.ms),
                    median(each.ms) / median(cases[0].ms));
}
