#include "report/report.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/html.hpp"
#include "report/text.hpp"

namespace vrut::server::report {

using base::escaped;
using protocol::MeasureKind;
using protocol::OtherView;
using protocol::ReportedState;
using protocol::UnitState;

namespace {

OtherView view_of_note(const protocol::Pose& pose) { return {protocol::overlay_of(pose), {}}; }

/// Of one that has no limit.
std::vector<OtherView> all_pictures(const ReportedState& state) {
    std::vector<OtherView> all;
    all.reserve(state.notes.size() + state.cues.size() + state.views.size());
    for (const auto& [name, note] : state.notes)
        if (note.view) all.push_back(view_of_note(*note.view));
    for (const ReportedState::Cue& cue : state.cues) all.push_back({{}, cue.name});
    for (const ReportedState::View& view : state.views)
        if (view.camera) all.push_back({*view.camera, {}});
    return all;
}

struct ShownUnit {
    const char* name;
    double metres;
};
ShownUnit shown_unit(UnitState::Shown shown) {
    switch (shown) {
        case UnitState::Shown::mm:
            return {"mm", 0.001};
        case UnitState::Shown::cm:
            return {"cm", 0.01};
        case UnitState::Shown::m:
            return {"m", 1};
        case UnitState::Shown::in:
            return {"in", 0.0254};
    }
    return {"m", 1};
}

/// Metres to which a length of so many metres is shown: a gap to 0.01 mm, what is larger less exactly.
double exactness(double size) {
    if (size == 0) return 1;
    if (size < 1e-5) return 1e-7;
    if (size < 0.1) return 1e-5;
    if (size < 1) return 1e-4;
    return size < 100 ? 1e-3 : 1e-2;
}

/// `whole`: the length that it is a part of, with as many digits.
std::string length_words(double value, double whole, const UnitState& unit) {
    const ShownUnit shown = shown_unit(unit.shown);
    const double places = std::log10(shown.metres / exactness(std::abs(whole * unit.metres)));
    const int digits = std::max(static_cast<int>(std::floor(places + 1e-9)), 0);
    const double scale = std::pow(10, digits);
    // Not the minus of a zero.
    const double rounded = std::round(value * unit.metres / shown.metres * scale) / scale + 0.0;
    return fixed(rounded, digits) + " " + shown.name;
}

const char* kind_words(MeasureKind kind) {
    switch (kind) {
        case MeasureKind::distance:
            return "Distance";
        case MeasureKind::parallel:
            return "Parallel distance";
        case MeasureKind::angle:
            return "Angle";
        case MeasureKind::radius:
            return "Radius";
        case MeasureKind::length:
            return "Edge length";
    }
    return "";
}

/// Gives the pictures in their order.
class Figures {
public:
    Figures(const std::vector<Picture>& pictures, std::size_t wanted)
        : pictures_(pictures), left_out_(wanted - std::min(wanted, pictures.size())) {}

    std::size_t left_out() const { return left_out_; }
    std::string next(const std::string& name) {
        const std::size_t at = next_++;
        if (at >= pictures_.size()) return "<p class=\"none\">The picture is left out.</p>\n";
        if (!pictures_[at]) return "<p class=\"none\">The picture cannot be drawn.</p>\n";
        return "<img alt=\"" + escaped(name) + "\" src=\"data:image/jpeg;base64," + base64(*pictures_[at]) +
               "\">\n";
    }

private:
    const std::vector<Picture>& pictures_;
    std::size_t left_out_, next_ = 0;
};

constexpr const char* kHead =
    "<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width\">\n"
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
    "style-src 'unsafe-inline'\">\n"
    "<style>\n"
    "body { max-width: 60rem; margin: 2rem auto; padding: 0 1rem; font: 1rem/1.5 system-ui, sans-serif; "
    "color: #1a1a1a; background: #fff }\n"
    "h1 { line-height: 1.2 } h2 { margin-top: 2.5rem; border-bottom: 1px solid #bbb }\n"
    "h1, h3, p, td, th { overflow-wrap: anywhere }\n"
    "section > div { display: grid; grid-template-columns: repeat(auto-fill, minmax(17rem, 1fr)); gap: "
    "1.5rem }\n"
    "article { break-inside: avoid } h3, p { margin: 0.25rem 0 }\n"
    "img { display: block; width: 100%; height: auto }\n"
    ".text { white-space: pre-wrap } .by, .none { color: #555 } .done { font-weight: bold; color: #1d6b2f } "
    ".open { font-weight: bold; color: #9a4a00 }\n"
    "table { border-collapse: collapse; width: 100% } th, td { padding: 0.25rem 0.75rem 0.25rem 0; "
    "text-align: left; vertical-align: top; border-bottom: 1px solid #ddd }\n"
    "</style>\n";

std::string time_element(std::int64_t ms) {
    const std::string iso = iso_time(ms);
    return "<time datetime=\"" + iso + "\">" + iso.substr(0, 10) + " " + iso.substr(11, 5) + " UTC</time>";
}

std::string note_article(const std::string& name, const protocol::Marker& note, Figures& figures) {
    std::string text = "<article>\n";
    if (note.view) text += figures.next(note.text.empty() ? name : note.text);
    text += "<h3>" + escaped(name) + "</h3>\n";
    if (!note.text.empty()) text += "<p class=\"text\">" + escaped(note.text) + "</p>\n";
    text += note.done ? "<p><span class=\"done\">done</span>" : "<p><span class=\"open\">open</span>";
    text += "<span class=\"by\">";
    if (note.author) text += " · " + escaped(*note.author);
    if (note.time) text += " · " + time_element(*note.time);
    return text + "</span></p>\n</article>\n";
}

/// Nothing where there is nothing in it.
std::string section(const char* title, const std::string& articles) {
    if (articles.empty()) return {};
    return std::string("<section>\n<h2>") + title + "</h2>\n<div>\n" + articles + "</div>\n</section>\n";
}

std::string notes_section(const ReportedState& state, Figures& figures) {
    std::string articles;
    for (const auto& [name, note] : state.notes) articles += note_article(name, note, figures);
    return section("Notes", articles);
}

std::string cues_section(const ReportedState& state, Figures& figures) {
    std::string articles;
    for (const auto& [name, words] : state.cues) {
        articles += "<article>\n" + figures.next(name) + "<h3>" + escaped(name) + "</h3>\n";
        if (!words.empty()) articles += "<p class=\"text\">" + escaped(words) + "</p>\n";
        articles += "</article>\n";
    }
    return section("Cues", articles);
}

std::string views_section(const ReportedState& state, Figures& figures) {
    std::string articles;
    for (const auto& [name, camera] : state.views) {
        if (!camera) continue;
        const std::string title = name == "home" ? "Home" : name;
        articles += "<article>\n" + figures.next(title) + "<h3>" + escaped(title) + "</h3>\n</article>\n";
    }
    return section("Views", articles);
}

std::string measure_row(const ReportedState::Measure& measure, const UnitState& unit) {
    const protocol::MeasuredState& measured = measure.measured;
    std::string text = "<tr><td>" + escaped(measure.name) + "</td><td>" + kind_words(measure.kind) +
                       "</td><td>" + escaped(measured.problem.value_or(value_words(measure, unit))) + "</td>";
    for (int axis = 0; axis < 3; ++axis) {
        text += "<td>";
        if (const auto& parts = measured.components)
            text += length_words((*parts)[axis], measured.value.value_or((*parts)[axis]), unit);
        text += "</td>";
    }
    return text + "</tr>\n";
}

std::string measures_section(const ReportedState& state) {
    if (state.measures.empty()) return {};
    std::string text =
        "<section>\n<h2>Measures</h2>\n<table>\n<tr><th scope=\"col\">Name</th><th scope=\"col\">Kind</th>"
        "<th scope=\"col\">Value</th><th scope=\"col\">X</th><th scope=\"col\">Y</th>"
        "<th scope=\"col\">Z</th></tr>\n";
    for (const ReportedState::Measure& measure : state.measures) text += measure_row(measure, state.unit);
    return text + "</table>\n</section>\n";
}

std::string left_out_sentence(std::size_t count) {
    if (count == 0) return {};
    return "<p>" + std::to_string(count) + (count == 1 ? " picture is" : " pictures are") +
           " left out: a report has " + std::to_string(kMostPictures) + " at most, of " +
           std::to_string(kMostPictureBytes >> 20) + " MiB.</p>\n";
}

}  // namespace

std::vector<OtherView> pictures_of(const ReportedState& state) {
    std::vector<OtherView> pictures = all_pictures(state);
    pictures.resize(std::min(pictures.size(), kMostPictures));
    return pictures;
}

std::string html(const ReportedState& state, const std::vector<Picture>& pictures, std::int64_t made) {
    Figures figures(pictures, all_pictures(state).size());
    const std::string title = "Report of " + escaped(state.scene);
    std::string text = kHead;
    text += "<title>" + title + "</title>\n<h1>" + title + "</h1>\n<p class=\"by\">Made at " +
            time_element(made) + ".</p>\n" + left_out_sentence(figures.left_out());
    if (state.notes.empty()) text += "<p>There are no notes.</p>\n";
    text += notes_section(state, figures);
    text += measures_section(state);
    text += cues_section(state, figures);
    return text + views_section(state, figures) + "</html>\n";
}

std::string iso_time(std::int64_t ms) {
    const std::chrono::sys_time<std::chrono::milliseconds> time{std::chrono::milliseconds(ms)};
    const auto day = std::chrono::floor<std::chrono::days>(time);
    const std::chrono::year_month_day date(day);
    const std::chrono::hh_mm_ss clock(std::chrono::floor<std::chrono::seconds>(time - day));
    const auto digits = [](auto number, std::size_t width) {
        const std::string text = std::to_string(number);
        return std::string(width - std::min(width, text.size()), '0') + text;
    };
    return digits(static_cast<int>(date.year()), 4) + "-" + digits(static_cast<unsigned>(date.month()), 2) +
           "-" + digits(static_cast<unsigned>(date.day()), 2) + "T" + digits(clock.hours().count(), 2) + ":" +
           digits(clock.minutes().count(), 2) + ":" + digits(clock.seconds().count(), 2) + "Z";
}

std::string value_words(const ReportedState::Measure& measure, const UnitState& unit) {
    const std::optional<double> value = measure.measured.value;
    if (!value) return {};
    return measure.kind == MeasureKind::angle ? fixed(*value, 1) + "°" : length_words(*value, *value, unit);
}

}  // namespace vrut::server::report
