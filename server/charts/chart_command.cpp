#include <csignal>
#include <iostream>
#include <stdexcept>

#include "charts/glass_charts.hpp"
#include "commands/commands.hpp"
#include "measure/calibrate.hpp"
#include "measure/charts.hpp"
#include "measure/experiments.hpp"
#include "measure/machine.hpp"
#include "measure/page.hpp"
#include "navigation/camera_moves.hpp"
#include "observe/log.hpp"
#include "observe/progress.hpp"
#include "room/scene_state.hpp"
#include "scenes/level_store.hpp"
#include "scenes/library.hpp"

namespace vrut::server::commands {

namespace fs = std::filesystem;
using namespace measure;

namespace {

constexpr int kLargestSide = 8192;

void require_size(const ChartArguments& arguments, const renderer::Renderer& renderer) {
    const int most = std::min(kLargestSide, renderer.max_size());
    if (std::max(arguments.width, arguments.height) > most)
        throw std::runtime_error("--size: expected at most " + std::to_string(most) +
                                 " pixels a side, found " + std::to_string(arguments.width) + "x" +
                                 std::to_string(arguments.height));
}

Subject subject_of(const fs::path& path, const ChartArguments& arguments, observe::Progress& progress) {
    const auto loading = [&](double part) { progress.show(part, path.filename().string() + ", loading"); };
    auto scene = scenes::load_scene(path, path.stem().string(), loading, {{}, arguments.read});
    if (!scene) throw std::runtime_error(scene.error());
    const double aspect = static_cast<double>(arguments.width) / arguments.height;
    Subject subject{scene->name, scene->sha256,
                    room::view_of(room::starting_state(*scene, aspect), scene->placed)};
    progress.show(0, subject.name + ", making levels of detail");
    subject.home.levels = detail_levels_of(scene->placed);
    subject.home.width = arguments.width;
    subject.home.height = arguments.height;
    return subject;
}

std::vector<Experiment> triangle_experiments(const ChartArguments& arguments, observe::Progress& progress) {
    std::vector<Experiment> list;
    for (const std::uint64_t count : triangle_counts(arguments.most_triangles)) {
        progress.show(0, "making a scene of " + std::to_string(count) + " triangles");
        Experiment experiment;
        experiment.chart = "triangles";
        experiment.method = std::to_string(count) + " every triangle";
        plan::View& home = experiment.subject.home;
        experiment.subject.name = "rings";
        home.scene = rings(count);
        home.levels = detail_levels_of(home.scene);
        home.width = arguments.width;
        home.height = arguments.height;
        home.camera = navigation::home_camera(navigation::fit_target(home.scene->bounds),
                                              static_cast<double>(home.width) / home.height);
        experiment.frames = arguments.frames;
        experiment.settings = {{.jpeg_quality = 0}};
        list.push_back(experiment);
        if (!has_levels(home)) continue;
        experiment.method = std::to_string(count) + " detail 0.5";
        experiment.settings = {{.detail = 0.5, .jpeg_quality = 0}};
        list.push_back(experiment);
    }
    return list;
}

/// The whole run: what there is to measure, and how far it is.
class Run {
public:
    Run(const ChartArguments& arguments, renderer::Renderer& renderer, Rows& rows)
        : laboratory_(renderer, rows, VRUT_VERSION, machine()), rows_(rows) {
        observe::Progress progress;
        for (const fs::path& scene : arguments.scenes) {
            Subject subject = subject_of(scene, arguments, progress);
            for (const Subject& other : subjects_)
                if (other.sha256 == subject.sha256)
                    throw std::runtime_error(scene.string() + ": this is the scene " + other.name +
                                             ", too: name it once");
            for (auto& list :
                 {experiments_of(subject, arguments.frames), sizes_of(subject, arguments.frames)})
                experiments_.insert(experiments_.end(), list.begin(), list.end());
            subjects_.push_back(std::move(subject));
        }
        const auto triangles = triangle_experiments(arguments, progress);
        experiments_.insert(experiments_.end(), triangles.begin(), triangles.end());
    }

    void measure() {
        observe::Progress progress;
        double all = 0, before = 0;
        for (const Experiment& experiment : experiments_) all += weight(experiment);
        all += kPickingWeight * static_cast<double>(subjects_.size());
        const auto run = [&](double weight, const std::string& what, const auto& task) {
            task([&](double part) { progress.show((before + weight * part) / all, what); });
            before += weight;
        };
        for (const Experiment& experiment : experiments_)
            if (!laboratory_.is_done(experiment))
                run(weight(experiment), name_of(experiment),
                    [&](const PartDone& done) { laboratory_.run(experiment, done); });
            else
                before += weight(experiment);
        for (const Subject& subject : subjects_)
            run(kPickingWeight, subject.name + ", picking",
                [&](const PartDone& done) { laboratory_.run_picking(subject, done); });
    }

    std::vector<SceneRows> scenes() const {
        std::vector<SceneRows> scenes;
        std::vector<std::string> slugs;
        for (const Subject& subject : subjects_) {
            SceneRows scene{subject.name, slug_of(subject.name, slugs), is_traced(subject), {}, {}};
            for (const Experiment& experiment : experiments_)
                if (experiment.subject.sha256 == subject.sha256) add(scene.rows, experiment);
            for (const Row& row : laboratory_.picking_rows(subject)) add(scene.rows, row);
            const auto kept = scenes::stored_levels(subject.sha256, laboratory_.renderer());
            scene.stored = kept.has_value();
            if (kept)
                scene.levels = *kept;
            else
                scene.levels.levels = levels_from(scene.rows);
            scenes.push_back(std::move(scene));
        }
        return scenes;
    }

    std::vector<Row> triangles() const {
        std::vector<Row> rows;
        for (const Experiment& experiment : experiments_)
            if (experiment.chart == "triangles") add(rows, experiment);
        return rows;
    }

private:
    static constexpr double kPickingWeight = 60;

    static double weight(const Experiment& experiment) {
        return static_cast<double>(experiment.settings.size()) * experiment.frames;
    }
    static std::string name_of(const Experiment& experiment) {
        return experiment.subject.name + ", " + experiment.mode.name + ", " + experiment.chart +
               (experiment.method.empty() ? "" : " " + experiment.method);
    }
    void add(std::vector<Row>& rows, const Row& wanted) const {
        if (const Row* row = rows_.find(wanted)) rows.push_back(*row);
    }
    void add(std::vector<Row>& rows, const Experiment& experiment) const {
        for (const Setting& setting : experiment.settings) add(rows, laboratory_.row_of(experiment, setting));
    }

    Laboratory laboratory_;
    Rows& rows_;
    std::vector<Subject> subjects_;
    std::vector<Experiment> experiments_;
};

std::string csv_of(const Section::Table& table) {
    std::string text = measure::line_of(table.head) + "\n";
    for (const auto& row : table.rows) text += measure::line_of(row) + "\n";
    return text;
}

/// CSV, SVG and the page.
void write_all(const ChartArguments& arguments, const Run& run, const std::string& renderer) {
    const std::vector<SceneRows> scenes = run.scenes();
    for (const SceneRows& scene : scenes)
        write_text(arguments.out / (scene.slug + "-table-7-1.csv"), csv_of(table_7_1(scene.rows)));
    std::vector<Section> sections = sections_of(scenes, run.triangles());
    const std::string subtitle = std::to_string(arguments.width) + " x " + std::to_string(arguments.height) +
                                 " pixels, " + std::to_string(arguments.frames) + " frames a point, " +
                                 renderer;
    for (Section& section : sections)
        for (Plot& plot : section.plots) plot.subtitle = subtitle;
    const PageHead head{
        "VRUT Preview: speed against accuracy",
        {"Drawn by " + renderer + " on " + machine() + ", VRUT Preview " VRUT_VERSION ", images of " +
         std::to_string(arguments.width) + " x " + std::to_string(arguments.height) + " pixels, " +
         std::to_string(arguments.frames) + " frames a setting"}};
    write_page(arguments.out / "index.html", head, sections);
}

void print(const protocol::LevelTable& table) {
    std::cout << table.renderer << ", " << table.width << " x " << table.height << "\n";
    std::size_t longest = 0;
    for (const protocol::Level& level : table.levels)
        longest = std::max(longest, measure::name_of(setting_of(level.quality)).size());
    for (const protocol::Level& level : table.levels) {
        std::string name = measure::name_of(setting_of(level.quality));
        name.resize(longest, ' ');
        char numbers[160];
        std::snprintf(numbers, sizeof numbers, "  %8.1f ms %8.1f kB  FLIP %.4f  ", level.ms,
                      level.bytes / 1000, level.quality.error.value_or(0));
        std::cout << name << numbers << level.reason << "\n";
    }
    std::cout.flush();
}

void calibrate_scene(const ChartArguments& arguments) {
    renderer::Renderer renderer(arguments.device);
    renderer.choose_resolver();  // as a server does
    require_size(arguments, renderer);
    Subject subject;
    protocol::LevelTable table;
    {
        observe::Progress progress;
        subject = subject_of(arguments.scenes.front(), arguments, progress);
        table = calibrate(subject.home, renderer,
                          [&](double part) { progress.show(part, subject.name + ", levels"); });
    }
    table.scene = subject.sha256;
    print(table);
    observe::log_info("levels_kept", {{"file", scenes::store_levels(table).string()}});
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw std::runtime_error(folder.string() + " cannot be made: " + error.message());
}

}  // namespace

void chart_command(const ChartArguments& given) {
    ChartArguments arguments = given;
    if (!arguments.out.empty()) require_gnuplot();
    if (!arguments.sessions.empty()) {
        if (!arguments.out.empty()) make_folder(arguments.out);
        return chart_glass(arguments);
    }
    if (arguments.scenes.empty()) arguments.scenes.push_back(default_scene());
    if (arguments.calibrate) return calibrate_scene(arguments);
    for (const fs::path& scene : arguments.scenes)
        if (!fs::is_regular_file(scene)) throw std::runtime_error(scene.string() + ": there is no such file");
    renderer::Renderer renderer(arguments.device);
    renderer.choose_resolver();  // as a server does
    require_size(arguments, renderer);
    make_folder(arguments.out);
    Rows rows(arguments.out / "measurements.csv");
    Run run(arguments, renderer, rows);
    run.measure();
    write_all(arguments, run, renderer.description());
    std::cout << (arguments.out / "index.html").string() << std::endl;
}

}  // namespace vrut::server::commands
