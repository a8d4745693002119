#include "charts/glass_charts.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "commands/session_scenes.hpp"
#include "measure/charts.hpp"
#include "measure/glass.hpp"
#include "measure/page.hpp"
#include "measure/plot.hpp"
#include "measure/rows.hpp"
#include "observe/log.hpp"
#include "observe/progress.hpp"
#include "room/replay.hpp"
#include "scenes/level_store.hpp"

namespace vrut::server::commands {

namespace fs = std::filesystem;
using namespace measure;

namespace {

/// What is to be seen in a session at each refresh.
struct Session {
    std::string name, sha256;
    std::vector<plan::View> states;
};

constexpr auto kLongest = std::chrono::hours(1);
constexpr std::size_t kWarp = 2;  // of kPredictions

/// Takes down what is to be seen, in images of the view's shape that fit into a size.
class Recorder {
public:
    Recorder(std::string name, int width, int height)
        : name_(std::move(name)), width_(width), height_(height) {}

    /// Throws std::runtime_error where the session is too long.
    void record(room::Room& room, room::SessionTime until) {
        if (until > kLongest)
            throw std::runtime_error(name_ + ": the session is longer than an hour: cut its log");
        using Milliseconds = std::chrono::duration<double, std::milli>;
        for (;;) {
            const auto at = std::chrono::duration_cast<room::SessionTime>(
                Milliseconds(1000 * static_cast<double>(states.size()) / kRefreshesPerSecond));
            if (at > until) return;
            room.advance(at);
            states.push_back(state_of(room));
        }
    }

    std::vector<plan::View> states;

private:
    plan::View state_of(const room::Room& room) {
        plan::View view = room.visible();
        const protocol::Resize size = room.view_size();
        const double scale = std::min({1.0, width_ / size.width, height_ / size.height});
        view.width = std::max(1, static_cast<int>(std::lround(scale * size.width)));
        view.height = std::max(1, static_cast<int>(std::lround(scale * size.height)));
        if (view.scene->scene != scene_) {
            scene_ = view.scene->scene;
            levels_ = detail_levels_of(view.scene);
        }
        view.levels = levels_;
        return view;
    }

    std::string name_;
    int width_, height_;
    std::shared_ptr<const scene::Scene> scene_;
    std::shared_ptr<const mesh::DetailLevels> levels_;  // of that scene
};

Session session_of(const fs::path& file, const ChartArguments& arguments) {
    const auto log = room::read_event_log(std::ifstream(file), file.string());
    if (!log) throw std::runtime_error(log.error());
    if (!log->cut.empty()) observe::log_warning("log_cut_off", {{"reason", log->cut}});
    Recorder recorder(file.string(), arguments.width, arguments.height);
    room::ReplayWatcher watcher;
    watcher.before_line = [&](room::SessionTime at, room::Room& room) { recorder.record(room, at); };
    SessionScenes scenes(file, arguments.scenes.empty() ? fs::path() : arguments.scenes.front(),
                         arguments.read);
    auto room = room::replay(
        *log,
        [&](const auto& name, const auto& sha256, auto up_axis) {
            return scenes.find(name, sha256, up_axis);
        },
        watcher);
    if (!room) throw std::runtime_error(file.string() + ": " + room.error());
    // Its end, and the half second in which the last frames come.
    constexpr auto kAfter = std::chrono::milliseconds(500);
    recorder.record(*room, room->time() + kAfter);
    return {file.stem().string(), log->header.scene_sha256, std::move(recorder.states)};
}

std::vector<SimulatedLink> links_of(const ChartArguments& arguments) {
    if (arguments.links.empty()) return usual_links();
    std::vector<SimulatedLink> links;
    for (const std::string& text : arguments.links) {
        auto link = parse_link(text);
        if (!link)
            throw std::invalid_argument("--link: " + link.error() + "; see 'vrut-preview chart --help'");
        links.push_back(*std::move(link));
    }
    return links;
}

Plot time_plot(const Session& session, const SimulatedLink& link, const GlassErrors& errors, int every,
               const std::string& slug) {
    Plot plot;
    plot.file = "glass-" + slug;
    plot.title = "Error at the glass: " + session.name + ", " + link.name;
    plot.x_label = "seconds";
    plot.y_label = "mean FLIP";
    plot.linear_x = true;
    for (std::size_t i = 0; i < kPredictions.size(); ++i) {
        Series series{Series::Look::line, kPredictions.at(i), {}, static_cast<int>(i)};
        for (std::size_t k = 0; k < errors.errors.at(i).size(); ++k)
            series.marks.push_back(
                {static_cast<double>(k) * every / kRefreshesPerSecond, errors.errors.at(i)[k], {}, {}});
        plot.series.push_back(std::move(series));
    }
    return plot;
}

/// A level, and whether another beats it in all of time, bytes and error.
struct LevelAtGlass {
    std::string name;
    double ms = 0, bytes = 0, error = 0;
    bool is_beaten = false;
};

std::vector<LevelAtGlass> levels_at_glass(const GlassErrors& errors) {
    std::vector<LevelAtGlass> levels;
    for (const GlassErrors::OfLevel& level : errors.levels)
        levels.push_back({name_of(level.setting), level.ms, level.bytes, spread_of(level.errors).mean});
    for (LevelAtGlass& level : levels)
        level.is_beaten = std::ranges::any_of(levels, [&](const LevelAtGlass& other) {
            return beats(std::array{other.ms, other.bytes, other.error},
                         std::array{level.ms, level.bytes, level.error});
        });
    return levels;
}

/// Against the round trip, a line for each prediction.
Plot links_plot(const std::vector<SimulatedLink>& links,
                const std::vector<std::vector<GlassErrors>>& of_sessions) {
    Plot plot;
    plot.file = "glass-links";
    plot.title = "Error at the glass against the link";
    plot.x_label = "round trip, ms";
    plot.y_label = "mean FLIP over sessions, p5 to p95 of their refreshes";
    for (std::size_t i = 0; i < kPredictions.size(); ++i) {
        Series series{Series::Look::line, kPredictions.at(i), {}, static_cast<int>(i)};
        for (std::size_t l = 0; l < links.size(); ++l) {
            std::vector<double> all;
            for (const auto& of_links : of_sessions)
                all.insert(all.end(), of_links[l].errors.at(i).begin(), of_links[l].errors.at(i).end());
            const Spread spread = spread_of(std::move(all));
            series.marks.push_back({std::max(links[l].round_trip_ms, 1.0), spread.mean, {}, spread});
        }
        plot.series.push_back(std::move(series));
    }
    return plot;
}

/// By the levels of each session: time, error and, beside each, its bytes; what another level beats in all of
/// them; and what the server chooses, on average.
Plot levels_plot(const std::vector<Session>& sessions, const SimulatedLink& link,
                 const std::vector<GlassErrors>& of_sessions, const std::string& slug) {
    Plot plot;
    plot.file = "glass-levels-" + slug;
    plot.title = "Error at the glass against the level: " + link.name;
    plot.subtitle = "beside each level: kB a frame; chosen: the server's levels, on average";
    plot.x_label = "ms a frame";
    plot.y_label = "mean FLIP";
    Series beaten{Series::Look::dominated, "beaten", {}};
    Series chosen{Series::Look::ring, "chosen", {}};
    for (std::size_t s = 0; s < sessions.size(); ++s) {
        Series series{Series::Look::line, sessions[s].name, {}, static_cast<int>(s)};
        for (const LevelAtGlass& level : levels_at_glass(of_sessions[s])) {
            const bool is_first = s == 0;  // their bytes are the same
            series.marks.push_back({level.ms,
                                    level.error,
                                    {},
                                    {},
                                    is_first ? short_number(level.bytes / 1000) + " kB" : std::string()});
            if (level.is_beaten) beaten.marks.push_back({level.ms, level.error, {}, {}});
        }
        plot.series.push_back(std::move(series));
        const GlassErrors::Delivered& warped = of_sessions[s].delivered[kWarp];
        if (warped.moving > 0)
            chosen.marks.push_back(
                {warped.moving_ms / warped.moving, spread_of(of_sessions[s].errors[kWarp]).mean, {}, {}});
    }
    for (Series* series : {&beaten, &chosen})
        if (!series->marks.empty()) plot.series.push_back(std::move(*series));
    return plot;
}

std::string text_of(double value, int digits) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

/// Prints the results as they come, and collects them for files.
struct Tables {
    using Line = std::vector<std::string>;

    Tables() {
        std::printf("%-24s %-16s %-16s %8s %8s %9s %7s %9s %7s\n", "session", "link", "prediction", "mean",
                    "p95", "frozen ms", "frames", "kB/frame", "depth %");
    }

    void add(const std::string& session, const std::string& link, const GlassErrors& errors) {
        for (std::size_t i = 0; i < kPredictions.size(); ++i) {
            const Spread spread = spread_of(errors.errors.at(i));
            const GlassErrors::Delivered& delivered = errors.delivered.at(i);
            std::printf("%-24s %-16s %-16s %8.4f %8.4f %9.0f %7d %9.1f %7.1f\n", session.c_str(),
                        link.c_str(), kPredictions.at(i), spread.mean, spread.p95, delivered.longest_ms,
                        delivered.frames, delivered.bytes / std::max(1, delivered.frames) / 1000,
                        100 * delivered.depth_bytes / std::max(1.0, delivered.bytes));
            csv += line_of(Line{session, link, kPredictions.at(i), text_of(spread.mean, 6),
                                text_of(spread.p95, 6), text_of(delivered.longest_ms, 1),
                                std::to_string(delivered.frames), text_of(delivered.bytes, 0),
                                text_of(delivered.depth_bytes, 0)}) +
                   "\n";
        }
        for (const LevelAtGlass& level : levels_at_glass(errors)) {
            std::printf("%-24s %-16s %8.1f ms %6.1f kB %8.4f  %s%s\n", session.c_str(), link.c_str(),
                        level.ms, level.bytes / 1000, level.error, level.name.c_str(),
                        level.is_beaten ? " (beaten)" : "");
            levels_csv +=
                line_of(Line{session, link, level.name, text_of(level.ms, 3), text_of(level.bytes, 0),
                             text_of(level.error, 6), level.is_beaten ? "yes" : "no"}) +
                "\n";
        }
        std::fflush(stdout);
    }

    std::string csv = line_of(Line{"session", "link", "prediction", "mean", "p95", "longest_ms", "frames",
                                   "bytes", "depth_bytes"}) +
                      "\n";
    std::string levels_csv =
        line_of(Line{"session", "link", "level", "ms", "bytes", "mean", "beaten"}) + "\n";
};

}  // namespace

void chart_glass(const ChartArguments& arguments) {
    const std::vector<SimulatedLink> links = links_of(arguments);
    renderer::Renderer renderer(arguments.device);
    std::vector<Session> sessions;
    for (const fs::path& file : arguments.sessions) sessions.push_back(session_of(file, arguments));

    Tables tables;
    std::vector<Plot> plots;
    std::vector<std::string> slugs;
    std::vector<std::vector<GlassErrors>> all;
    for (const Session& session : sessions) {
        const std::vector<GlassErrors> of_links = [&] {
            observe::Progress progress;
            const GlassDemand demand{scenes::levels_of(session.sha256, renderer.description()),
                                     arguments.latency_target_ms, static_cast<std::size_t>(arguments.every),
                                     arguments.each_level};
            return errors_at_glass(session.states, links, demand, renderer,
                                   [&](double part) { progress.show(part, session.name); });
        }();
        for (std::size_t l = 0; l < links.size(); ++l) {
            tables.add(session.name, links[l].name, of_links[l]);
            plots.push_back(time_plot(session, links[l], of_links[l], arguments.every,
                                      slug_of(session.name + " " + links[l].name, slugs)));
        }
        all.push_back(of_links);
    }
    if (arguments.out.empty()) return;
    plots.push_back(links_plot(links, all));
    write_text(arguments.out / "glass.csv", tables.csv);
    if (arguments.each_level) {
        write_text(arguments.out / "glass-levels.csv", tables.levels_csv);
        for (std::size_t l = 0; l < links.size(); ++l) {
            std::vector<GlassErrors> of_link;
            of_link.reserve(all.size());
            for (const auto& of_links : all) of_link.push_back(of_links[l]);
            plots.push_back(levels_plot(sessions, links[l], of_link, slug_of(links[l].name, slugs)));
        }
    }
    draw(plots, arguments.out);
}

}  // namespace vrut::server::commands
