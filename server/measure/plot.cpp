#include "measure/plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>

namespace vrut::server::measure {

namespace {

// Okabe and Ito's colours, which eyes tell apart that take red for green.
constexpr std::array kColors{"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"};
constexpr const char *kGrey = "#A0A0A0", *kRing = "#D55E00";

struct Range {
    double low = std::numeric_limits<double>::infinity(), high = 0;

    void add(double value) {
        if (!(value > 0)) return;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    /// With some air around what lies in it; 1 to 10 where that is nothing.
    void widen() {
        if (high == 0) low = 1, high = 10;
        const double air = std::max(1.12, std::pow(high / low, 0.06));
        low /= air;
        high *= air;
    }
};

struct PlotFrame {
    Range x, y;
};

PlotFrame frame_of(const Plot& plot) {
    PlotFrame frame;
    for (const Series& series : plot.series)
        for (const Mark& mark : series.marks) {
            if (series.look == Series::Look::stairs) continue;
            frame.x.add(mark.x);
            frame.y.add(mark.y);
            if (mark.x_spread) frame.x.add(mark.x_spread->p5), frame.x.add(mark.x_spread->p95);
            if (mark.y_spread) frame.y.add(mark.y_spread->p5), frame.y.add(mark.y_spread->p95);
        }
    if (plot.floor) frame.y.add(*plot.floor);
    frame.x.widen();
    frame.y.widen();
    return frame;
}

bool has_spreads(const Series& series) {
    return std::any_of(series.marks.begin(), series.marks.end(),
                       [](const Mark& mark) { return mark.x_spread || mark.y_spread; });
}

/// A word or a point in the chart, 0 to 1 across and up.
struct Box {
    double left, right, bottom, top;

    bool meets(const Box& other) const {
        return left < other.right && other.left < right && bottom < other.top && other.bottom < top;
    }
};

/// Where a word may stand beside its point: the nearest first, then farther above and below.
std::vector<Box> places_beside(double x, double y, std::size_t letters) {
    constexpr double kLetter = 0.0105, kHeight = 0.042, kGap = 0.014;
    const double width = kLetter * static_cast<double>(letters);
    std::vector<Box> places;
    for (const double shift : {0.03, -0.03, 0.0, 0.075, -0.075, 0.12, -0.12})
        for (const double left : {x + kGap, x - kGap - width})
            places.push_back({left, left + width, y + shift - kHeight / 2, y + shift + kHeight / 2});
    return places;
}

/// Words beside points, where they meet neither one another nor other points.
void write_labels(std::ostream& out, const Plot& plot, const PlotFrame& frame) {
    constexpr double kPoint = 0.008;
    const auto part = [](const Range& range, double value) {
        return std::log(std::max(value, range.low) / range.low) / std::log(range.high / range.low);
    };
    const auto x_of = [&](const Mark& mark) { return part(frame.x, mark.x); };
    const auto y_of = [&](const Mark& mark) {
        return part(frame.y, std::max(mark.y, plot.floor.value_or(frame.y.low)));
    };
    std::vector<Box> taken;
    for (const Series& series : plot.series)
        for (const Mark& mark : series.marks)
            if (series.look != Series::Look::stairs)
                taken.push_back(
                    {x_of(mark) - kPoint, x_of(mark) + kPoint, y_of(mark) - kPoint, y_of(mark) + kPoint});
    const Box chart{0, 1, 0, 1.02};
    for (const Series& series : plot.series)
        for (const Mark& mark : series.marks) {
            if (mark.label.empty()) continue;
            const std::vector<Box> places = places_beside(x_of(mark), y_of(mark), mark.label.size());
            const auto is_free = [&](const Box& place) {
                return place.left > chart.left && place.right < chart.right && place.bottom > chart.bottom &&
                       place.top < chart.top &&
                       std::none_of(taken.begin(), taken.end(),
                                    [&](const Box& other) { return place.meets(other); });
            };
            const auto found = std::find_if(places.begin(), places.end(), is_free);
            const Box& place = found == places.end() ? places[x_of(mark) > 0.75 ? 1 : 0] : *found;
            taken.push_back(place);
            const bool at_left = place.left < x_of(mark);
            out << "set label " << quoted(mark.label) << " at graph " << (at_left ? place.right : place.left)
                << ',' << (place.bottom + place.top) / 2 << (at_left ? " right" : " left")
                << " font ',11' tc rgb '#303030' front\n";
        }
}

/// Points and their whiskers as a block of lines: x y x5 x95 y5 y95.
void write_data(std::ostream& out, const Plot& plot, const PlotFrame& frame) {
    const double lowest = plot.floor.value_or(frame.y.low);
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
        out << "$d" << i << " << EOD\n";
        for (const Mark& mark : plot.series[i].marks) {
            const Spread x = mark.x_spread.value_or(Spread{mark.x, mark.x, mark.x, mark.x});
            const Spread y = mark.y_spread.value_or(Spread{mark.y, mark.y, mark.y, mark.y});
            out << std::clamp(mark.x, plot.linear_x ? 0 : frame.x.low, frame.x.high) << ' '
                << std::clamp(mark.y, lowest, frame.y.high);
            for (const double value : {x.p5, x.p95}) out << ' ' << std::max(value, frame.x.low);
            for (const double value : {y.p5, y.p95}) out << ' ' << std::max(value, lowest);
            out << '\n';
        }
        out << "EOD\n";
    }
}

std::string color_of(const Series& series) {
    if (series.look == Series::Look::dominated) return kGrey;
    if (series.look == Series::Look::ring) return kRing;
    return kColors.at(static_cast<std::size_t>(series.color) % kColors.size());
}

std::string style_of(const Series& series) {
    switch (series.look) {
        case Series::Look::point:
            return "with points pt 7 ps 0.55";
        case Series::Look::dominated:
            return "with points pt 7 ps 0.35";
        case Series::Look::ring:
            return "with points pt 6 ps 1.3 lw 2";
        case Series::Look::stairs:
            return "with lines lw 1.6";
        case Series::Look::line:
            return "with linespoints pt 7 ps 0.55 lw 1.6";
        case Series::Look::rule:
            return "with lines lw 1.2 dt 2";
    }
    return {};
}

void write_series(std::ostream& out, const Plot& plot) {
    const char* separator = "plot ";
    const auto add = [&](std::size_t i, const std::string& columns, const std::string& style,
                         const std::string& title) {
        out << separator << "$d" << i << " using " << columns << ' ' << style
            << (title.empty() ? " notitle" : " title " + quoted(title));
        separator = ", \\\n  ";
    };
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const Series& series = plot.series[i];
        const std::string color = " lc rgb '" + color_of(series) + "'";
        if (has_spreads(series)) add(i, "1:2:3:4:5:6", "with xyerrorbars pt 0 lw 0.7" + color, "");
    }
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const Series& series = plot.series[i];
        add(i, "1:2", style_of(series) + " lc rgb '" + color_of(series) + "'", series.title);
    }
    out << '\n';
}

/// Of two titles each: more rows take room below the picture.
int legend_rows(const Plot& plot) {
    const auto has_title = [](const Series& series) { return !series.title.empty(); };
    return static_cast<int>(std::ranges::count_if(plot.series, has_title) + 1) / 2;
}

}  // namespace

std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) {
        if (c == '\'') result += '\'';
        result += static_cast<unsigned char>(c) < ' ' || c == 127 ? ' ' : c;
    }
    return result + "'";
}

std::string script_of(const Plot& plot, const std::filesystem::path& output) {
    const PlotFrame frame = frame_of(plot);
    std::string name = plot.file;
    std::replace(name.begin(), name.end(), '-', '_');  // which is all that gnuplot takes in names
    std::ostringstream out;
    out.precision(9);
    out << "reset session\n"
           "set encoding utf8\n"
           "set terminal svg size 720,480 dynamic noenhanced rounded background '#ffffff' font "
           "'sans-serif,13' name "
        << quoted(name) << "\nset output " << quoted(output.string()) << "\nset title " << quoted(plot.title)
        << " font ',15' offset 0,0.9\nset label " << quoted(plot.subtitle)
        << " at graph 0.5,1.05 center font ',10' tc rgb '#606060'"
        << "\nset xlabel " << quoted(plot.x_label) << "\nset ylabel " << quoted(plot.y_label)
        << "\nset logscale " << (plot.linear_x ? "y" : "xy")
        << "\n"
           "set border 3 lc rgb '#606060'\n"
           "set tics nomirror textcolor rgb '#303030'\n"
           "set grid xtics ytics lc rgb '#e4e4e4' lw 0.7\n"
           "set errorbars 0.4\n"
           "set key at screen 0.5,0.02 center bottom horizontal Left reverse samplen 1.2 width -1\n"
           "set lmargin 11\nset rmargin 4\nset tmargin 4.5\nset bmargin "
        << 6.8 + 1.4 * static_cast<double>(std::max(legend_rows(plot), 3) - 3) << "\nset xrange ["
        << (plot.linear_x ? 0 : frame.x.low) << ':' << frame.x.high << "]\n"
        << "set yrange [" << frame.y.low << ':' << frame.y.high << "]\n";
    // Within a decade or two, its tenths have no tics of their own: these do.
    for (const auto& [axis, range] : {std::pair("x", frame.x), std::pair("y", frame.y)}) {
        out << "set " << axis << "tics format '" << (range.high > 1e6 ? "%.0s%c" : "%g") << "'\n";  // 2M
        if (range.high / range.low > 150 || (plot.linear_x && *axis == 'x')) continue;
        const char* separator = " (";
        out << "set " << axis << "tics";
        const double first = std::pow(10, std::floor(std::log10(range.low)));
        const std::vector<double> steps = range.high / range.low > 6
                                              ? std::vector<double>{1, 2, 3, 5}
                                              : std::vector<double>{1, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8};
        for (double decade = first; decade <= range.high; decade *= 10)
            for (const double step : steps) {
                out << separator << decade * step;
                separator = ", ";
            }
        out << ")\n";
    }
    if (plot.floor) out << "set ytics add (" << quoted(plot.floor_name) << " " << *plot.floor << ")\n";
    write_labels(out, plot, frame);
    write_data(out, plot, frame);
    write_series(out, plot);
    out << "unset output\n";
    return out.str();
}

namespace {

/// gnuplot's status, given what it reads. No name or path is part of the command.
int run_gnuplot(const char* command, const std::string& script) {
    std::signal(SIGPIPE, SIG_IGN);  // what becomes of it its status tells
    std::FILE* pipe = popen(command, "w");
    if (!pipe) return -1;
    std::fwrite(script.data(), 1, script.size(), pipe);
    return pclose(pipe);
}

}  // namespace

void require_gnuplot() {
    if (run_gnuplot("gnuplot --version >/dev/null 2>&1", "") != 0)
        throw std::runtime_error(
            "charts are drawn by gnuplot, which is not here: install it (Debian: apt install gnuplot-nox)");
}

void draw(const std::vector<Plot>& plots, const std::filesystem::path& folder) {
    std::string script;
    for (const Plot& plot : plots)
        script += script_of(plot, std::filesystem::absolute(folder / (plot.file + ".svg")));
    if (run_gnuplot("gnuplot -", script) != 0)
        throw std::runtime_error("gnuplot could not draw the charts into " + folder.string());
}

}  // namespace vrut::server::measure
