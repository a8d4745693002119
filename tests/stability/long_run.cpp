// A study of what piles up.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <future>
#include <limits>

#include "navigation/camera_moves.hpp"
#include "observe/process_usage.hpp"
#include "pictures.hpp"
#include "shapes.hpp"
#include "study.hpp"

namespace vrut::stability {

namespace {

std::vector<double> pictures_of(Form form) {
    return form == Form::whole ? std::vector{1e2, 1e3, 1e4, 1e5} : std::vector{1e2, 1e3};
}

/// A view that turns, of balls.
struct Turning {
    explicit Turning(const Laboratory& the_laboratory) : laboratory(the_laboratory) {
        std::vector<Part> parts;
        for (int i = 0; i < 8; ++i) {
            const int row = i / 4;
            scene::Material material = material_of(glm::dvec3(0.2 + 0.1 * i, 0.5, 0.4), glm::dvec3(0.4), 20);
            parts.push_back(
                {scene::Id(i + 1), sphere(0.5, 16), material, moved_by({i % 4 - 1.5, row - 0.5, 0.2 * i})});
        }
        view = looking(scene_of(parts), {0, 1, 6});
        view.width = 128;
        view.height = 96;
    }
    /// Draws the next picture; its processor time in ms, since what other programs do does not count.
    double next() {
        view.camera = navigation::rotated(view.camera, 3, 0.1, true);
        const std::clock_t before = std::clock();
        laboratory.renderer.render(view, image, stats);
        return 1000.0 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    }

    const Laboratory& laboratory;
    plan::View view;
    scene::Image image;
    plan::FrameStats stats;
};

constexpr int kWarmUp = 50;  // pictures
constexpr int kTimed = 50;   // pictures, the least of whose times counts: other programs may disturb some
constexpr int kRounds = 3;

double least_of_next(Turning& turning) {
    double least = turning.next();
    for (int i = 1; i < kTimed; ++i) least = std::min(least, turning.next());
    return least;
}

/// In a thread of its own, since a thread has one context.
template <class Measure>
auto with_new_renderer(Form form, const Measure& measure) {
    return std::async(std::launch::async,
                      [&] {
                          renderer::Renderer renderer;
                          const Laboratory laboratory{renderer, form};
                          Turning turning(laboratory);
                          for (int i = 0; i < kWarmUp; ++i) turning.next();
                          return measure(turning);
                      })
        .get();
}

}  // namespace

Study long_runs(const Laboratory& laboratory) {
    Study study{"long-run", "Pictures one after the other", "pictures",
                "processor time of a picture / of a renderer just made"};
    study.bound = 2;  // processor times vary by some 20 % of themselves; what slows goes on to
    study.method.title = "a scene that turns, drawn on and on";
    study.explanation = "A picture leaves nothing behind that the next one has to look at.";
    study.cost = "None.";
    const Form form = laboratory.form;
    study.method.points = with_new_renderer(form, [form](Turning& turning) {
        std::vector<Curve::Point> points;
        int drawn = 0;
        for (const double pictures : pictures_of(form)) {
            for (; drawn < pictures; ++drawn) turning.next();
            // In turns, since what else this machine does disturbs both.
            double aged = std::numeric_limits<double>::infinity(), fresh = aged;
            for (int round = 0; round < kRounds; ++round) {
                fresh = std::min(fresh, with_new_renderer(form, least_of_next));
                aged = std::min(aged, least_of_next(turning));
            }
            points.push_back({pictures, is_plain(turning.image) ? kNothing : aged / fresh});
        }
        return points;
    });
    return study;
}

Study memory_of_long_runs(const Laboratory& laboratory) {
    Study study{"long-run-memory", "Memory over many pictures", "pictures",
                "megabytes that the process has grown by"};
    study.bound = 4;
    study.method.title = "a scene that turns, drawn on and on";
    study.explanation =
        "Buffers are of the view's size and made once; a picture is read into the one before it.";
    study.cost = "None.";
    Turning turning(laboratory);
    for (int i = 0; i < kWarmUp; ++i) turning.next();
    const double before = static_cast<double>(server::observe::process_usage().resident_bytes);
    int drawn = 0;
    for (const double pictures : pictures_of(laboratory.form)) {
        for (; drawn < pictures; ++drawn) turning.next();
        const double now = static_cast<double>(server::observe::process_usage().resident_bytes);
        study.method.points.push_back(
            {pictures, is_plain(turning.image) ? kNothing : std::max(0.0, now - before) / 1e6});
    }
    return study;
}

}  // namespace vrut::stability
