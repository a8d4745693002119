// Studies of frames that are warped by their depth until the next one comes.
#include <numeric>

#include "compare/flip.hpp"
#include "navigation/camera_moves.hpp"
#include "pictures.hpp"
#include "shapes.hpp"
#include "warp/warp.hpp"

namespace vrut::stability {

namespace {

constexpr double kBlock = 4;  // pixels, as at a good link

double mean_flip(const scene::Image& image, const scene::Image& right) {
    const std::vector<float> values = compare::flip(image, right);
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The errors of a frame of `before`, warped to the camera of `now` and as it is.
void measure(const Laboratory& laboratory, double parameter, const plan::View& before, const plan::View& now,
             Study& study) {
    plan::RenderJob job(before);
    job.depth_size = warp::depth_map_size(before.width, before.height, kBlock);
    while (!laboratory.renderer.step(job)) {
    }
    const scene::Image truth = drawn(laboratory, now);
    const scene::Image warped =
        warp::warped(job.image, job.depth, before.camera, now.camera, warp::Background::stays);
    study.method.points.push_back({parameter, 100 * mean_flip(warped, truth)});
    study.baseline.points.push_back({parameter, 100 * mean_flip(job.image, truth)});
}

plan::View turned(plan::View view, double degrees) {
    view.camera = navigation::rotated(view.camera, degrees, 0, true);
    return view;
}

/// Something like a car on a floor: no part hides much of another.
std::vector<Part> body() {
    return {{1, box({1.2, 0.3, 0.5}), material_of({0.7, 0.1, 0.1})},
            {2, box({0.6, 0.25, 0.45}), material_of({0.2, 0.2, 0.25}), moved_by({0.1, 0.5, 0})},
            {3, sphere(0.25, 16), material_of({0.1, 0.1, 0.1}), moved_by({-0.7, -0.35, 0.45})},
            {4, sphere(0.25, 16), material_of({0.1, 0.1, 0.1}), moved_by({0.7, -0.35, 0.45})},
            {5, quad(3), material_of({0.5, 0.5, 0.45}), moved_by({0, -0.6, 0}) * turned_by(-90, {1, 0, 0})}};
}

plan::View looking_at(const std::vector<Part>& parts) {
    plan::View view = looking(scene_of(parts), {1.2, 1.2, 3});
    view.width = 480;
    view.height = 320;
    return view;
}

Study study_of(const char* file, const char* title, const char* parameter, double bound) {
    Study study{file, title, parameter, "mean FLIP, in percent"};
    study.bound = bound;
    study.method.title = "the last frame, warped by its depth";
    study.baseline.title = "the last frame as it is";
    return study;
}

/// Of a turn about the middle.
void measure_turns(const Laboratory& laboratory, const plan::View& view, const std::vector<double>& degrees,
                   Study& study) {
    for (const double by : laboratory.chosen(degrees)) measure(laboratory, by, view, turned(view, by), study);
}

}  // namespace

Study warped_turns(const Laboratory& laboratory) {
    Study study = study_of("warped-turns", "A turn before the next frame comes", "degrees", 16);
    study.limit = 35;
    study.explanation =
        "What a surface hid and light that changes are not known. The page warps as far as 20 degrees, and "
        "lags behind more and more beyond, up to 35.";
    measure_turns(laboratory, looking_at(body()), {1, 2, 5, 10, 15, 20, 25, 35, 50, 70, 90}, study);
    return study;
}

Study warped_looks(const Laboratory& laboratory) {
    Study study = study_of("warped-looks", "A look aside before the next frame comes", "degrees", 36);
    study.explanation = "Beside the frame its side goes on.";
    const plan::View view = looking_at(body());
    for (const double by : laboratory.chosen({1, 2, 5, 10, 15, 20, 25, 35, 50})) {
        plan::View now = view;
        now.camera = navigation::looked_around(view.camera, by, 0, true);
        measure(laboratory, by, view, now, study);
    }
    return study;
}

Study warped_zooms(const Laboratory& laboratory) {
    Study study = study_of("warped-zooms", "Coming nearer before the next frame comes", "times as near", 32);
    study.explanation = "It is as blurred as the frame is coarse.";
    const plan::View view = looking_at(body());
    for (const double factor : laboratory.chosen({1.02, 1.1, 1.25, 1.5, 2, 3, 4, 6})) {
        plan::View now = view;
        now.camera = navigation::zoomed(view.camera, factor, 3);
        measure(laboratory, factor, view, now, study);
    }
    return study;
}

Study warped_glass(const Laboratory& laboratory) {
    Study study = study_of("warped-glass", "A turn, seen through glass", "degrees", 23);
    study.limit = 50;
    study.explanation =
        "What is seen through glass that is at least half opaque moves as the glass does, what is seen "
        "through "
        "clearer glass by its own depth.";
    std::vector<Part> parts = body();
    scene::Material glass = material_of({0.3, 0.5, 0.6});
    glass.diffuse.a = 0.3;
    parts.push_back({9, quad(1.4), glass, moved_by({0, 0.4, 1.2})});
    measure_turns(laboratory, looking_at(parts), {1, 2, 5, 10, 20, 35, 50}, study);
    return study;
}

Study warped_mirrors(const Laboratory& laboratory) {
    Study study = study_of("warped-mirrors", "A turn, seen in a mirror", "degrees", 28);
    study.limit = 50;
    study.explanation = "What is seen in a mirror moves as if it were painted on it.";
    std::vector<Part> parts = body();
    scene::Material mirror = material_of({0.1, 0.1, 0.1});
    mirror.reflectivity = 0.9;
    parts.push_back({9, quad(2.5), mirror, moved_by({0, 0, -1.2})});
    measure_turns(laboratory, looking_at(parts), {1, 2, 5, 10, 20, 35, 50}, study);
    return study;
}

Study warped_highlights(const Laboratory& laboratory) {
    Study study = study_of("warped-highlights", "A turn of shining spheres", "degrees", 16);
    study.explanation = "Highlights stay on the surface until the next frame comes.";
    std::vector<Part> parts;
    for (int i = 0; i < 5; ++i)
        parts.push_back({i + 1, sphere(0.35, 24), material_of({0.3, 0.1, 0.1}, {1, 1, 1}, 60),
                         moved_by({0.8 * (i - 2), 0, 0.4 * (i % 2)})});
    measure_turns(laboratory, looking_at(parts), {1, 2, 5, 10, 20, 35, 50}, study);
    return study;
}

Study warped_bars(const Laboratory& laboratory) {
    Study study = study_of("warped-bars", "A turn of thin bars", "1 / width in pixels", 13);
    study.explanation = "Bars thinner than a part of a block are lost in places.";
    for (const double inverse : laboratory.chosen({0.05, 0.1, 0.2, 0.33, 0.5, 1, 2})) {
        std::vector<Part> parts{{1, quad(4), material_of({0.6, 0.6, 0.5}), moved_by({0, 0, -1.5})}};
        const double half = 0.5 * 0.02 / inverse;  // about 50 pixels to a unit
        for (int i = 0; i < 9; ++i)
            parts.push_back({i + 2, box({half, 1.2, half}), material_of({0.1, 0.1, 0.6}),
                             moved_by({0.45 * (i - 4), 0, 0.5})});
        const plan::View view = looking_at(parts);
        measure(laboratory, inverse, view, turned(view, 5), study);
    }
    return study;
}

Study warped_edges(const Laboratory& laboratory) {
    Study study = study_of("warped-edges", "What a near wall hid comes into view", "degrees", 42);
    study.explanation = "It is taken to look like what is beside it.";
    std::vector<Part> parts{{1, box({0.5, 0.7, 0.05}), material_of({0.7, 0.6, 0.1}), moved_by({0, 0, 1.2})}};
    for (int i = 0; i < 25; ++i)
        parts.push_back({i + 2, box({0.25, 0.25, 0.25}),
                         material_of({0.2 * (i % 5), 0.8 - 0.15 * (i / 5), 0.5}),
                         moved_by({0.8 * (i % 5 - 2), 0.8 * (i / 5 - 2), -2})});
    measure_turns(laboratory, looking_at(parts), {1, 2, 5, 10, 20, 35, 50}, study);
    return study;
}

Study warped_parts(const Laboratory& laboratory) {
    Study study = study_of("warped-parts", "A door opens while the camera turns by 5 degrees",
                           "degrees of the door", 12);
    study.explanation = "The door waits for the next frame, wherever the camera turns.";
    const auto with_door = [](double degrees) {
        std::vector<Part> parts = body();
        parts.push_back({9, box({0.4, 0.3, 0.02}), material_of({0.1, 0.4, 0.7}),
                         moved_by({-0.4, 0, 0.55}) * turned_by(-degrees, {0, 1, 0}) * moved_by({0.4, 0, 0})});
        return looking_at(parts);
    };
    for (const double degrees : laboratory.chosen({1, 5, 15, 30, 60, 90}))
        measure(laboratory, degrees, with_door(0), turned(with_door(degrees), 5), study);
    return study;
}

}  // namespace vrut::stability
