#include "report/report.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "report/text.hpp"

using namespace vrut;
using namespace vrut::server::report;
using protocol::Marker;
using protocol::MeasureKind;
using protocol::ReportedState;

namespace {

constexpr std::int64_t kMade = 1'764'345'600'000;  // 2025-11-28 16:00 UTC

const Picture kJpeg = std::make_shared<const std::string>("\xFF\xD8jpeg");

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}
bool contains(const std::string& text, const std::string& part) { return count(text, part) > 0; }

ReportedState with_notes(int notes) {
    ReportedState state;
    state.scene = "Car";
    for (int i = 0; i < notes; ++i) {
        Marker note{{1, 2, 3}, {}, "text " + std::to_string(i)};
        note.view = vrut::protocol::Pose{};
        note.view->fov = 20 + i % 100;
        state.notes["note " + std::to_string(1000 + i)] = note;
    }
    return state;
}

std::string all_of(const ReportedState& state) {
    return html(state, std::vector<Picture>(pictures_of(state).size(), kJpeg), kMade);
}

ReportedState::Measure measure_of(MeasureKind kind, double value) { return {"m", kind, {value, {}, {}, {}}}; }

}  // namespace

TEST_CASE("a report of nothing says so, and has no empty sections") {
    ReportedState state;
    state.scene = "Car";
    const std::string text = html(state, {}, kMade);
    CHECK(contains(text, "<title>Report of Car</title>"));
    CHECK(contains(text, ">2025-11-28 16:00 UTC</time>"));
    CHECK(contains(text, "There are no notes."));
    CHECK_FALSE(contains(text, "<h2>"));
    CHECK(pictures_of(state).empty());
    CHECK(csv(state) == "\xEF\xBB\xBFname,text,author,time,done,x,y,z,node\r\n");
}

TEST_CASE("what users wrote stays text") {
    ReportedState state = with_notes(1);
    const std::string bad = "<script>alert('1' & \"2\")</script>";
    const std::string harmless = "&lt;script&gt;alert(&#39;1&#39; &amp; &quot;2&quot;)&lt;/script&gt;";
    Marker& note = state.notes.begin()->second;
    note.text = bad, note.author = bad;
    state.notes[bad] = note;
    state.scene = bad;
    state.cues = {{bad, bad}};
    state.views = {{bad, protocol::CameraOverlay{}}};
    state.measures = {{bad, MeasureKind::length, {{}, {}, {}, bad}}};
    const std::string text = all_of(state);
    CHECK_FALSE(contains(text, "<script"));
    CHECK_FALSE(contains(text, bad));
    CHECK(count(text, harmless) >= 12);
    CHECK(contains(text, "default-src 'none'"));
}

TEST_CASE("a note has its picture, text, author, time, and whether it is done") {
    ReportedState state = with_notes(2);
    Marker& first = state.notes["note 1000"];
    first.author = "iPad", first.time = kMade, first.done = true, first.text = "one\ntwo";
    const std::string text = all_of(state);
    CHECK(count(text, "src=\"data:image/jpeg;base64,/9hqcGVn\"") == 2);
    CHECK(contains(text, "one\ntwo"));
    CHECK(contains(text, "iPad"));
    CHECK(contains(text, "datetime=\"2025-11-28T16:00:00Z\""));
    CHECK(count(text, ">done<") == 1);
    CHECK(count(text, ">open<") == 1);
    CHECK_FALSE(contains(text, "http:"));
    CHECK_FALSE(contains(text, "https:"));
}

TEST_CASE("pictures are of the notes, then the cues, then the views, in the order in which they are shown") {
    ReportedState state = with_notes(2);
    state.notes["note 1000"].view.reset();  // as of a marker of before there were notes
    state.cues = {{"Arrival", "Welcome"}};
    state.views = {{"home", protocol::CameraOverlay{{}, glm::dvec3(9), {}, {}, {}, {}}}, {"unreadable", {}}};
    const auto pictures = pictures_of(state);
    REQUIRE(pictures.size() == 3);
    CHECK(pictures[0].camera.fov == 21);
    CHECK(pictures[1].cue == "Arrival");
    CHECK(pictures[2].camera.eye == glm::dvec3(9));
    const auto jpeg = [](const char* text) { return std::make_shared<const std::string>(text); };
    const std::string text = html(state, {jpeg("aaa"), jpeg("bbb"), jpeg("ccc")}, kMade);
    const std::size_t a = text.find("YWFh"), b = text.find("YmJi"), c = text.find("Y2Nj");
    CHECK(text.find("note 1001", a) < b);
    CHECK(b < text.find("Welcome"));
    CHECK(text.find("<h3>Home</h3>") > c);
    CHECK_FALSE(contains(text, "unreadable"));
}

TEST_CASE("there is a bound of pictures, and the report says how many it leaves out") {
    const ReportedState state = with_notes(256);
    CHECK(pictures_of(state).size() == kMostPictures);
    const std::string text = all_of(state);
    CHECK(count(text, "<article>") == 256);
    CHECK(count(text, "<img") == 60);
    CHECK(contains(text, "196 pictures are left out: a report has 60 at most"));
    CHECK(count(csv(state), "\r\n") == 257);
    CHECK(contains(html(with_notes(2), {kJpeg}, kMade), "1 picture is left out"));
    const std::string failed = html(with_notes(2), {kJpeg, nullptr}, kMade);
    CHECK(count(failed, "cannot be drawn") == 1);
    CHECK_FALSE(contains(failed, "left out"));
}

TEST_CASE("measures have values in the unit that is shown, as on the page") {
    const auto words = [](MeasureKind kind, double value, double metres,
                          protocol::UnitState::Shown shown = protocol::UnitState::Shown::mm) {
        return value_words(measure_of(kind, value), {metres, shown});
    };
    CHECK(words(MeasureKind::distance, 3.456, 0.001) == "3.46 mm");
    CHECK(words(MeasureKind::distance, 1234.5, 0.001) == "1235 mm");
    CHECK(words(MeasureKind::radius, 0.5, 1) == "500.0 mm");
    CHECK(words(MeasureKind::length, 0.5, 1, protocol::UnitState::Shown::m) == "0.5000 m");
    CHECK(words(MeasureKind::length, 2.54, 0.01, protocol::UnitState::Shown::in) == "1.000 in");
    CHECK(words(MeasureKind::angle, 89.96, 1) == "90.0°");
    CHECK(words(MeasureKind::distance, 0, 1) == "0 mm");
    ReportedState state;
    state.measures = {{"Gap", MeasureKind::distance, {5.0, glm::dvec3(3, -4, -0.0), {}, {}}},
                      {"Lost", MeasureKind::radius, {{}, {}, {}, "the node 4 is hidden"}}};
    const std::string text = html(state, {}, kMade);
    CHECK(contains(text,
                   "<td>Gap</td><td>Distance</td><td>5.00 mm</td><td>3.00 mm</td><td>-4.00 mm</td>"
                   "<td>0.00 mm</td>"));
    CHECK(contains(text, "<td>the node 4 is hidden</td>"));
}

TEST_CASE("a table of notes is read by RFC 4180, and computes nothing") {
    ReportedState state;
    Marker note{{1.5, -2, 1e-7}, 7, "a \"gap\", wide\nand deep", "=1+1", kMade, {}, true};
    state.notes["a"] = note;
    note = {{0, 0, 0}, {}, "@x"};
    state.notes["-b"] = note;
    CHECK(csv(state) ==
          "\xEF\xBB\xBFname,text,author,time,done,x,y,z,node\r\n"
          "'-b,'@x,,,false,0,0,0,\r\n"
          "a,\"a \"\"gap\"\", wide\nand deep\",'=1+1,2025-11-28T16:00:00Z,true,1.5,-2,1e-07,7\r\n");
    for (const char* text : {"=a", "+a", "-a", "@a", "\ta"}) {
        state.notes = {{"n", {{0, 0, 0}, {}, text}}};
        CAPTURE(text);
        CHECK(contains(csv(state), "'" + std::string(text)));
    }
}

TEST_CASE("times are of ISO 8601") {
    CHECK(iso_time(0) == "1970-01-01T00:00:00Z");
    CHECK(iso_time(951'782'399'999) == "2000-02-28T23:59:59Z");
    CHECK(iso_time(951'782'400'000) == "2000-02-29T00:00:00Z");
    CHECK(iso_time(protocol::kLatestDate) == "9999-12-31T23:59:59Z");
}

TEST_CASE("base64 is that of RFC 4648") {
    CHECK(base64("") == "");
    CHECK(base64("f") == "Zg==");
    CHECK(base64("fo") == "Zm8=");
    CHECK(base64("foobar") == "Zm9vYmFy");
    CHECK(base64(std::string("\0\xFF\x10", 3)) == "AP8Q");
}
