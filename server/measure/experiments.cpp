#include "measure/experiments.hpp"

#include <algorithm>
#include <cmath>

#include "reference/reference.hpp"

namespace vrut::server::measure {

namespace {

constexpr std::uint64_t kTracedTriangles = 20'000;  // the reference draws them in no time

PartDone part_of(const PartDone& done, double from, double to) {
    return [&done, from, to](double fraction) {
        if (done) done(std::lerp(from, to, fraction));
    };
}

std::vector<Setting> only(double scale, double detail) {
    Setting setting;
    setting.scale = scale;
    setting.detail = detail;
    setting.jpeg_quality = 0;
    return {setting};
}

}  // namespace

plan::View in_mode(plan::View view, const Mode& mode) {
    view.mode = mode.mode;
    view.wireframe = mode.wireframe;
    return view;
}

bool has_thin_lines(const Mode& mode) { return mode.wireframe || mode.mode == plan::DrawMode::stylized; }

bool is_traced(const Subject& subject) {
    return subject.home.scene->scene->triangle_count() <= kTracedTriangles;
}

std::vector<Experiment> experiments_of(const Subject& subject, int frames) {
    using Judge = Experiment::Judge;
    const bool levels = has_levels(subject.home);
    std::vector<Experiment> list;
    const auto add = [&](const char* chart, const Mode& mode, std::vector<Setting> settings, Judge judge,
                         int count) {
        list.push_back({chart, {}, subject, mode, std::move(settings), judge, count});
    };
    for (const Mode& mode : kModes) {
        add("table-7-1", mode, only(1, 0), Judge::none, kTableFrames);
        add("modes", mode, has_thin_lines(mode) ? in_full_colour(candidates(levels)) : product(levels),
            Judge::many_samples, frames);
    }
    const Mode& realistic = kModes.front();
    if (levels) add("detail", realistic, details(), Judge::same_samples, frames);
    add("antialiasing", realistic, sample_counts(), Judge::many_samples, frames);
    add("lighting", realistic, lights(), Judge::same_samples, frames);
    add("transparency", realistic, transparencies(), Judge::same_samples, frames);
    if (!subject.home.scene->scene->textures().empty())
        add("texture-filter", realistic, texture_filters(), Judge::finer_pixels, frames);
    add("jpeg", realistic, encodings(), Judge::same_samples, frames);
    add("sections", realistic, clip_plane_counts(), Judge::none, frames);
    return list;
}

std::vector<Experiment> sizes_of(const Subject& subject, int frames) {
    std::vector<Experiment> list;
    for (const auto& [width, height] : {std::pair(640, 360), {1280, 720}, {1920, 1080}, {2160, 1620}}) {
        Experiment experiment{"pixels", {}, subject, kModes[0], only(1, 0), Experiment::Judge::none, frames};
        experiment.subject.home.width = width;
        experiment.subject.home.height = height;
        list.push_back(experiment);
    }
    return list;
}

bool Laboratory::is_done(const Experiment& experiment) const {
    return std::all_of(experiment.settings.begin(), experiment.settings.end(),
                       [&](const Setting& setting) { return rows_.has(row_of(experiment, setting)); });
}

Row Laboratory::row_of(const Experiment& experiment, const Setting& setting) const {
    const Subject& subject = experiment.subject;
    Row row;
    row.chart = experiment.chart;
    row.scene = subject.name;
    row.sha256 = subject.sha256;
    row.renderer = renderer_.description();
    row.machine = machine_;
    row.version = version_;
    row.mode = experiment.mode.name;
    row.width = subject.home.width;
    row.height = subject.home.height;
    row.frames = experiment.frames;
    row.setting = setting;
    row.method = experiment.method;
    return row;
}

scene::Image Laboratory::judge(const Experiment& experiment, const plan::View& view) {
    using Judge = Experiment::Judge;
    if (experiment.judge == Judge::many_samples) return studio_.exact_picture(view, kJudgeSamples);
    if (experiment.judge == Judge::finer_pixels) {
        plan::View finer = view;
        finer.width *= kFinerPixels;
        finer.height *= kFinerPixels;
        scene::Image image = studio_.exact_picture(finer, 1);
        while (image.width > view.width) image = resized(image, image.width / 2, image.height / 2);
        return image;
    }
    return is_traced(experiment.subject) ? reference::image_of(reference::trace(view_with(view, {})))
                                         : studio_.exact_picture(view, 1);
}

std::vector<scene::Image> Laboratory::judges(const Experiment& experiment, std::span<const plan::View> views,
                                             const PartDone& done) {
    std::vector<scene::Image> judges;
    for (const plan::View& view : views) {
        judges.push_back(judge(experiment, view));
        if (done) done(static_cast<double>(judges.size()) / static_cast<double>(views.size()));
    }
    return judges;
}

void Laboratory::run(const Experiment& experiment, const PartDone& done) {
    std::vector<Setting> settings;
    for (const Setting& setting : experiment.settings)
        if (!rows_.has(row_of(experiment, setting))) settings.push_back(setting);
    if (settings.empty()) return;
    const plan::View home = in_mode(experiment.subject.home, experiment.mode);
    const bool judged = experiment.judge != Experiment::Judge::none;
    const std::vector<Cost> costs =
        studio_.costs(home, settings, experiment.frames, part_of(done, 0, judged ? 0.4 : 1));
    std::vector<Error> errors;
    if (judged) {
        const std::vector<plan::View> views = judged_views(home, kJudgedViews);
        const std::vector<scene::Image> truth = judges(experiment, views, part_of(done, 0.4, 0.5));
        errors = studio_.errors(views, settings, truth, part_of(done, 0.5, 1));
    }
    for (std::size_t i = 0; i < settings.size(); ++i) {
        Row row = row_of(experiment, settings[i]);
        row.cost = costs[i];
        if (judged) row.error = errors[i];
        rows_.add(row);
    }
}

}  // namespace vrut::server::measure
