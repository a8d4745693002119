#include "measure/charts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "engine/frame_quality.hpp"
#include "measure/calibrate.hpp"
#include "measure/experiments.hpp"

namespace vrut::server::measure {

namespace {

constexpr const char* kFlipAxis = "FLIP error (lower is better, log)";
constexpr const char* kMaximumAxis = "largest error, of 255 (lower is better, log)";
constexpr const char* kTimeAxis = "ms a frame: draw, read back, encode (left is better, log)";
constexpr const char* kBytesAxis = "bytes a frame (left is better, log)";

using Chosen = std::function<bool(const Row&)>;
using Labels = std::function<std::string(const Row&)>;

/// What a chart shows of a row along one axis.
struct Axis {
    const char* label;
    double (*value)(const Row&);
    const Spread* (*spread)(const Row&);
};

const Axis kTime{kTimeAxis, [](const Row& row) { return row.cost.ms.median; },
                 [](const Row& row) { return &row.cost.ms; }};
const Axis kBytes{kBytesAxis, [](const Row& row) { return row.cost.bytes.median; },
                  [](const Row& row) { return &row.cost.bytes; }};
const Axis kFlip{kFlipAxis, [](const Row& row) { return row.error.value().flip.mean; },
                 [](const Row& row) -> const Spread* { return &row.error.value().flip; }};
const Axis kMaximum{kMaximumAxis,
                    [](const Row& row) { return static_cast<double>(row.error.value().maximum); },
                    [](const Row&) -> const Spread* { return nullptr; }};

Mark mark_of(const Row& row, const Axis& x, const Axis& y, const std::string& label) {
    Mark mark{x.value(row), y.value(row), {}, {}, label};
    if (const Spread* spread = x.spread(row)) mark.x_spread = *spread;
    if (const Spread* spread = y.spread(row)) mark.y_spread = *spread;
    return mark;
}

/// Points and the front of them; the chosen ones ringed.
Plot tradeoff_plot(const std::vector<Row>& rows, const Axis& x, const Axis& y, const Chosen& chosen,
                   const Labels& labels) {
    std::vector<Tradeoff> points;
    double dearest = 0, worst = 0;
    for (const Row& row : rows) {
        points.push_back({x.value(row), y.value(row)});
        dearest = std::max(dearest, 100 * points.back().cost);
        worst = std::max(worst, 100 * points.back().error);
    }
    Series dominated{Series::Look::dominated, "beaten by another", {}};
    Series best{Series::Look::point, "the front: beaten by none", {}};
    Series ring{Series::Look::ring, "chosen", {}};
    Series stairs{Series::Look::stairs, "", {}};
    const std::vector<std::size_t> kept = front(points);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const bool in_front = std::find(kept.begin(), kept.end(), i) != kept.end();
        (in_front ? best : dominated).marks.push_back(mark_of(rows[i], x, y, labels ? labels(rows[i]) : ""));
        if (chosen(rows[i])) ring.marks.push_back({points[i].cost, points[i].error, {}, {}, ""});
    }
    Plot plot;
    for (const Tradeoff& corner : staircase(points, worst, dearest))
        stairs.marks.push_back({corner.cost, corner.error, {}, {}, ""});
    for (const Series* series : {&stairs, &dominated, &best, &ring})
        if (!series->marks.empty()) plot.series.push_back(*series);
    plot.x_label = x.label;
    plot.y_label = y.label;
    if (std::any_of(points.begin(), points.end(), [](const Tradeoff& point) { return point.error == 0; }))
        plot.floor = floor_of(points);
    return plot;
}

/// Whiskers of hundreds of points would hide them: those of the front are enough.
void thin_whiskers(Plot& plot) {
    for (Series& series : plot.series)
        if (series.look == Series::Look::dominated && series.marks.size() > 12)
            for (Mark& mark : series.marks) mark.x_spread.reset(), mark.y_spread.reset();
}

/// Of pictures that move.
std::vector<Setting> level_settings(const SceneRows& scene) {
    std::vector<Setting> settings;
    for (const protocol::Level& level : scene.levels.levels)
        if (level.quality.level == protocol::Quality::Level::moving)
            settings.push_back(setting_of(level.quality));
    return settings;
}

std::string size_text(int width, int height) {
    return std::to_string(width) + " x " + std::to_string(height);
}

/// Returns true if the server's table is of pictures of another size than the rows of chart "modes".
bool is_of_other_size(const SceneRows& scene) {
    const std::vector<Row> rows = rows_for(scene.rows, "modes");
    return scene.stored && !rows.empty() &&
           (rows.front().width != scene.levels.width || rows.front().height != scene.levels.height);
}

std::string ring_title(const SceneRows& scene) {
    if (!scene.stored) return "what `chart --calibrate` would choose here";
    if (!is_of_other_size(scene)) return "in the server's table";
    return "in the server's table, of " + size_text(scene.levels.width, scene.levels.height);
}

std::string ring_sentence(const SceneRows& scene) {
    const std::string lines = " Wireframe and stylized pictures are always sent in full colour (4:4:4).";
    if (!scene.stored)
        return "Ringed: what `chart --calibrate` would choose from these points. Nothing is kept for this "
               "scene and renderer, so that the server draws with its built-in levels." +
               lines;
    return "Ringed: the server's table for this scene and renderer, measured with realistic pictures of " +
           size_text(scene.levels.width, scene.levels.height) + " pixels" +
           (is_of_other_size(scene) ? ", another size than here." : ".") + lines;
}

Section modes_section(const SceneRows& scene) {
    Section section{scene.name + ": speed against accuracy", {}, {}};
    for (const Mode& mode : kModes) {
        const std::vector<Row> rows = rows_for(scene.rows, "modes", mode.name);
        // The table is measured in the realistic mode, and used in all.
        std::vector<Setting> levels = level_settings(scene);
        if (has_thin_lines(mode)) levels = in_full_colour(levels);
        const Chosen chosen = [&](const Row& row) {
            return std::find(levels.begin(), levels.end(), row.setting) != levels.end();
        };
        for (const Axis* y : {&kFlip, &kMaximum})
            for (const Axis* x : {&kTime, &kBytes}) {
                Plot plot = tradeoff_plot(rows, *x, *y, chosen, {});
                thin_whiskers(plot);
                for (Series& series : plot.series)
                    if (series.look == Series::Look::ring) series.title = ring_title(scene);
                std::string name = std::string(mode.name) + (x == &kTime ? " time" : " bytes") +
                                   (y == &kFlip ? "" : " maximum");
                std::replace(name.begin(), name.end(), ' ', '-');
                plot.file = scene.slug + "-" + name;
                plot.title = scene.name + ", " + mode.name;
                section.plots.push_back(std::move(plot));
            }
    }
    section.sentences = {
        "One point a setting: scale, samples, detail and JPEG together. Less is better of both, so that the "
        "best lie to the left and below. Whiskers go from the 5th to the 95th percentile: of the frames of "
        "one orbit across, of the judged pictures up. The judge is a picture of " +
            std::to_string(kJudgeSamples) + " samples a pixel, of every triangle, not encoded.",
        ring_sentence(scene)};
    Section::Table table{{"level", "ms", "kB", "FLIP", "why"}, {}};
    for (const protocol::Level& level : scene.levels.levels) {
        table.rows.push_back({name_of(setting_of(level.quality)), short_number(level.ms),
                              short_number(level.bytes / 1000), short_number(level.quality.error.value_or(0)),
                              level.reason});
    }
    section.tables.push_back(std::move(table));
    return section;
}

std::string error_text(const Row& row, bool is_judge) {
    if (is_judge) return " and is the judge";
    return " at a FLIP error of " + short_number(row.error.value().flip.mean) + " (maximum " +
           std::to_string(row.error.value().maximum) + ")";
}

/// How the chosen of two settings stands beside the other, told with the numbers.
std::string comparison(const Row& own, bool is_judge, const Row& beside) {
    return "Here it takes " + short_number(own.cost.ms.median) + " ms" + error_text(own, is_judge) +
           "; the other " + short_number(beside.cost.ms.median) + " ms" + error_text(beside, false) + ".";
}

std::string encoding_text(const Setting& setting) {
    return std::to_string(setting.jpeg_quality) + (setting.subsampled ? " 4:2:0" : " 4:4:4");
}

struct MethodChart {
    const char *chart, *title;
    std::string why;
    const Axis& x;
    Labels labels;
    Chosen chosen;
};

const Row* find(const std::vector<Row>& rows, const Chosen& wanted) {
    const auto found = std::find_if(rows.begin(), rows.end(), wanted);
    return found == rows.end() ? nullptr : &*found;
}

std::string transparency_label(const Row& row) {
    using Transparency = plan::Methods::Transparency;
    switch (row.setting.methods.transparency) {
        case Transparency::sorted:
            return "sorted by parts";
        case Transparency::per_pixel_lists:
            return "all by lists at each pixel";
        case Transparency::exact:
            break;
    }
    return "right at each pixel";
}

std::string texture_filter_label(const Row& row) {
    using TextureFilter = plan::Methods::TextureFilter;
    return row.setting.methods.texture_filter == TextureFilter::trilinear ? "trilinear" : "anisotropic";
}

/// Returns true if another picture than that of the most accurate setting judges a chart's.
bool is_judged_from_outside(const SceneRows& scene, std::string_view chart) {
    return scene.traced || chart == "antialiasing" || chart == "texture-filter";
}

std::vector<MethodChart> method_charts(const SceneRows& scene) {
    const std::vector<Setting> levels = level_settings(scene);
    const bool smooth =
        std::any_of(levels.begin(), levels.end(), [](const Setting& setting) { return setting.detail > 0; });
    const std::string moving = scene.stored
                                   ? "what the server's table has for the picture while things move"
                                   : "what `chart --calibrate` would choose here for the picture while "
                                     "things move";
    std::vector<Setting> sent = levels;
    sent.push_back(setting_of(engine::kRefined));
    return {
        {"transparency", "transparency",
         "Ringed: glass that is right at each pixel, by lists only where no order is. Sorted by parts it is "
         "wrong "
         "wherever panes cross.",
         kTime, transparency_label, [](const Row& row) { return row.setting.methods == plan::Methods{}; }},
        {"lighting", "lighting",
         "Ringed: Phong's equation at each pixel. At vertices alone highlights of large triangles are lost.",
         kTime,
         [](const Row& row) {
             return row.setting.methods.light == plan::Methods::Lighting::pixel ? "at each pixel"
                                                                                : "at vertices";
         },
         [](const Row& row) { return row.setting.methods == plan::Methods{}; }},
        {"texture-filter", "texture filter",
         "Ringed: trilinear. Anisotropic, textures seen aslant keep their detail along the other side of the "
         "pixel.",
         kTime, texture_filter_label, [](const Row& row) { return row.setting.methods == plan::Methods{}; }},
        {"detail", "level of detail",
         "Ringed: " + (smooth ? moving + ", and " : std::string()) +
             "every triangle, for the picture at rest.",
         kTime,
         [](const Row& row) {
             return row.setting.detail == 0 ? "every triangle" : short_number(row.setting.detail) + " px";
         },
         [levels](const Row& row) {
             return row.setting.detail == 0 ||
                    std::any_of(levels.begin(), levels.end(),
                                [&](const Setting& setting) { return setting.detail == row.setting.detail; });
         }},
        {"antialiasing", "samples a pixel",
         "Ringed: one sample while things move; " + std::to_string(samples_of(engine::Refinement::better)) +
             " and then " + std::to_string(samples_of(engine::Refinement::sharp)) + " once they rest.",
         kTime, [](const Row& row) { return std::to_string(row.setting.samples); },
         [](const Row& row) {
             return row.setting.samples == samples_of(engine::Refinement::first) ||
                    row.setting.samples == samples_of(engine::Refinement::better) ||
                    row.setting.samples == samples_of(engine::Refinement::sharp);
         }},
        {"jpeg", "JPEG",
         "Ringed: " + moving + ", and JPEG " + encoding_text(setting_of(engine::kRefined)) +
             " for the picture at rest.",
         kBytes, [](const Row& row) { return encoding_text(row.setting); },
         [sent](const Row& row) {
             return std::any_of(sent.begin(), sent.end(), [&](const Setting& setting) {
                 return encoding_text(setting) == encoding_text(row.setting);
             });
         }},
    };
}

/// What the pictures of a chart were judged by.
std::string judge_sentence(const SceneRows& scene, const std::string& chart) {
    if (chart == "antialiasing")
        return "The judge is a picture of " + std::to_string(kJudgeSamples) + " samples a pixel.";
    if (chart == "texture-filter")
        return "The judge is the mean of " + std::to_string(kFinerPixels * kFinerPixels) +
               " finer pixels for each.";
    if (scene.traced) return "The judge is the reference, which follows rays in double precision.";
    return "The judge is the same picture with every triangle, light and glass right at each pixel, not "
           "encoded.";
}

/// Returns true if the setting is what others are judged by, so that no error of its own is known.
bool is_judge(const SceneRows& scene, const Row& row) {
    const Setting& setting = row.setting;
    return !is_judged_from_outside(scene, row.chart) && setting.samples == 1 && setting.detail == 0 &&
           setting.methods == plan::Methods{} && setting.jpeg_quality == 0;
}

Plot picking_plot(const SceneRows& scene, std::vector<std::string>& sentences) {
    static const Axis time{"ms a pick (left is better, log)",
                           [](const Row& row) { return row.cost.ms.median; },
                           [](const Row& row) { return &row.cost.ms; }};
    static const Axis wrong{"wrong answers (lower is better, log)",
                            [](const Row& row) { return row.wrong.value_or(0); },
                            [](const Row&) -> const Spread* { return nullptr; }};
    const std::vector<Row> rows = rows_for(scene.rows, "picking");
    const Chosen chosen = [](const Row& row) { return row.method == kPickings[0]; };
    Plot plot = tradeoff_plot(rows, time, wrong, chosen, [](const Row& row) {
        return row.method == kPickings.back() ? row.method + ", the judge" : row.method;
    });
    plot.file = scene.slug + "-picking";
    plot.title = scene.name + ", picking";
    const Row* ray = find(rows, chosen);
    const Row* ids = find(rows, [](const Row& row) { return row.method == kPickings[1]; });
    if (ray && ids)
        sentences.push_back(
            "Picking. Ringed: a ray in double, bounds first: " + short_number(ray->wrong.value() * 100) +
            " % of its answers differ from those of asking every triangle, in " +
            short_number(ray->cost.ms.median) + " ms. A picture of ids takes " +
            short_number(ids->cost.ms.median) + " ms for each new view, is wrong for " +
            short_number(ids->wrong.value() * 100) + " % of the points, and tells no point in space.");
    return plot;
}

Section methods_section(const SceneRows& scene) {
    Section section{scene.name + ": one thing at a time", {}, {}};
    for (const MethodChart& chart : method_charts(scene)) {
        const std::vector<Row> rows = rows_for(scene.rows, chart.chart);
        if (rows.empty()) continue;
        Plot plot = tradeoff_plot(rows, chart.x, kFlip, chart.chosen, chart.labels);
        plot.file = scene.slug + "-" + chart.chart;
        plot.title = scene.name + ", " + chart.title;
        if (!scene.traced) plot.floor_name = "the judge";
        section.plots.push_back(std::move(plot));
        std::string title = chart.title;
        title[0] = static_cast<char>(std::toupper(title[0]));
        std::string sentence = title + ". " + chart.why + " " + judge_sentence(scene, chart.chart);
        const Row* own = find(rows, chart.chosen);
        const Row* other = find(rows, [&](const Row& row) { return !chart.chosen(row); });
        if (rows.size() == 2 && own && other)
            sentence += " " + comparison(*own, is_judge(scene, *own), *other);
        section.sentences.push_back(sentence);
    }
    section.plots.push_back(picking_plot(scene, section.sentences));
    return section;
}

}  // namespace

std::string short_number(double value) {
    char text[32];
    if (value != 0 && std::abs(value) < 1e-3)
        std::snprintf(text, sizeof text, "%.1e", value);
    else if (std::abs(value) >= 100 && std::abs(value) < 1e7)
        std::snprintf(text, sizeof text, "%.0f", value);
    else
        std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

std::string slug_of(const std::string& name, std::vector<std::string>& taken) {
    std::string slug;
    for (const char c : name) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
        const bool capital = c >= 'A' && c <= 'Z';
        if (plain || capital)
            slug += capital ? static_cast<char>(c - 'A' + 'a') : c;
        else if (!slug.empty() && slug.back() != '-')
            slug += '-';
    }
    while (!slug.empty() && slug.back() == '-') slug.pop_back();
    if (slug.empty()) slug = "scene";
    const std::string wanted = slug.substr(0, 60);
    slug = wanted;
    for (int i = 2; std::find(taken.begin(), taken.end(), slug) != taken.end(); ++i)
        slug = wanted + "-" + std::to_string(i);
    taken.push_back(slug);
    return slug;
}

std::vector<Row> rows_for(const std::vector<Row>& rows, const std::string& chart, const std::string& mode) {
    std::vector<Row> found;
    for (const Row& row : rows)
        if (row.chart == chart && (mode.empty() || row.mode == mode) && is_whole(row)) found.push_back(row);
    return found;
}

std::vector<protocol::Level> levels_from(const std::vector<Row>& rows) {
    std::vector<Setting> settings;
    std::vector<Cost> costs;
    std::vector<Error> errors;
    const std::vector<Setting> wanted = candidates(true);
    for (const Row& row : rows_for(rows, "modes", kModes.front().name)) {
        if (std::find(wanted.begin(), wanted.end(), row.setting) == wanted.end()) continue;
        settings.push_back(row.setting);
        costs.push_back(row.cost);
        errors.push_back(row.error.value());
    }
    return choose_levels(settings, costs, errors);
}

std::vector<Section> sections_of(const std::vector<SceneRows>& scenes, const std::vector<Row>& triangles) {
    std::vector<Section> sections;
    for (const SceneRows& scene : scenes) {
        sections.push_back(modes_section(scene));
        sections.push_back(methods_section(scene));
        Section table{scene.name + ": the thesis's table 7.1", {}, {}};
        table.sentences = {
            "Mean of 100 frames while orbiting, drawn and read back, not encoded; the thesis's "
            "three numbers are of Firefox, Chrome and Opera, of its own car."};
        table.tables.push_back(table_7_1(scene.rows));
        sections.push_back(std::move(table));
    }
    sections.push_back(growth_section(scenes, triangles));
    return sections;
}

}  // namespace vrut::server::measure
