#include <doctest/doctest.h>

#include <filesystem>

#include "measure/charts.hpp"
#include "measure/page.hpp"
#include "measure/plot.hpp"
#include "measure/rows.hpp"
#include "temporary_folder.hpp"

using namespace vrut;
using namespace vrut::server::measure;

namespace {

Row row(const std::string& scene, double scale) {
    Row row;
    row.chart = "modes";
    row.scene = scene;
    row.sha256 = "ab";
    row.renderer = "EGL device 0: a \"card\", new";
    row.machine = "a processor, 2 threads";
    row.version = "1.2.3";
    row.mode = "realistic";
    row.width = 64;
    row.height = 48;
    row.frames = 3;
    row.setting.scale = scale;
    row.setting.methods = {plan::Methods::Lighting::vertex, plan::Methods::Transparency::per_pixel_lists,
                           plan::Methods::TextureFilter::anisotropic};
    row.cost.triangles = 12;
    row.cost.ms = {1.5, 1.25, 1, 2};
    row.cost.bytes = {100, 101, 99, 120};
    row.error = Error{{0.25, 0.5, 0.125, 0.75}, 9};
    return row;
}

Plot plot_of(const std::string& title) {
    Series points{Series::Look::point, title, {{1, 0.1, {}, {}, title}, {3, 0, {}, {}, "exact"}}};
    Plot plot{"a-chart", title, title, "error", {points}, 0.01};
    return plot;
}

}  // namespace

TEST_CASE("a line of comma-separated values is read as it was written") {
    const std::vector<std::string> fields{"plain", "", "with, comma", "with \"quotes\"", ","};
    CHECK(fields_of(line_of(fields)) == fields);
    CHECK_FALSE(fields_of("a,\"b").has_value());
}

TEST_CASE("a row is read as it was written") {
    Row written = row("car, \"red\"\nestate", 0.35);
    const auto read = row_of(line_of(written));
    REQUIRE(read.has_value());
    CHECK(read->scene == "car, \"red\" estate");  // on one line
    CHECK(read->machine == written.machine);
    CHECK(read->setting == written.setting);
    CHECK(read->cost.ms.p95 == 2);
    CHECK(read->cost.bytes.median == 101);
    CHECK(read->error.value().flip.p5 == 0.125);
    CHECK(read->error.value().maximum == 9);
    CHECK_FALSE(read->wrong.has_value());
    written.error.reset();
    written.wrong = 0.5;
    const auto other = row_of(line_of(written));
    REQUIRE(other.has_value());
    CHECK_FALSE(other->error.has_value());
    CHECK(other->wrong == 0.5);
    CHECK_FALSE(row_of("1,2,3").has_value());
    CHECK_FALSE(row_of(header_line()).has_value());
}

TEST_CASE("what is in the file is not measured again, but for a last line that is torn") {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "rows.csv";
    {
        Rows rows(path);
        rows.add(row("car", 1));
        rows.add(row("car", 0.5));
    }
    const std::string whole = folder.read("rows.csv");
    CHECK(whole == header_line() + "\n" + line_of(row("car", 1)) + "\n" + line_of(row("car", 0.5)) + "\n");
    folder.write("rows.csv", whole.substr(0, whole.size() - 8));
    {
        Rows rows(path);
        CHECK(rows.has(row("car", 1)));
        CHECK_FALSE(rows.has(row("car", 0.5)));
        CHECK_FALSE(rows.has(row("other", 1)));
        Row elsewhere = row("car", 1);
        elsewhere.machine = "another";
        CHECK_FALSE(rows.has(elsewhere));
        rows.add(row("car", 0.5));
    }
    CHECK(folder.read("rows.csv") == whole);
    folder.write("rows.csv", header_line().substr(0, 7));
    CHECK_FALSE(Rows(path).has(row("car", 1)));
    CHECK(folder.read("rows.csv") == header_line() + "\n");
}

TEST_CASE("a row without what its chart shows is measured again, and not shown") {
    Row unjudged = row("car", 1), unasked = row("car", 1), time = row("car", 1);
    unjudged.error.reset();
    unasked.chart = "picking";
    time.chart = "pixels";
    time.error.reset();
    CHECK(rows_for({unjudged, unasked, time}, "modes").empty());
    CHECK(rows_for({unjudged, unasked, time}, "picking").empty());
    CHECK(rows_for({unjudged, unasked, time}, "pixels").size() == 1);
    CHECK(levels_from({unjudged}).empty());
    const TemporaryFolder folder;
    const std::filesystem::path path =
        folder.write("rows.csv", header_line() + "\n" + line_of(unjudged) + "\n" + line_of(unasked) + "\n");
    Rows(path).add(row("car", 1));
    const Rows rows(path);
    REQUIRE(rows.find(row("car", 1)) != nullptr);
    CHECK(rows.find(row("car", 1))->error.has_value());
    CHECK_FALSE(rows.has(unasked));
}

TEST_CASE("a file of something else, or none that can be written, is told") {
    const TemporaryFolder folder;
    CHECK_THROWS(Rows(folder.write("notes.csv", "my notes")));
    CHECK(folder.read("notes.csv") == "my notes");
    CHECK_THROWS(Rows(folder.write("empty.csv", "\n")));
    CHECK_THROWS(Rows(folder.write("older.csv", "chart,scene\n")));  // fewer columns
    CHECK_THROWS(Rows(folder.path() / "nowhere" / "rows.csv"));
}

TEST_CASE("names are text to gnuplot, whatever they hold") {
    CHECK(quoted("it's") == "'it''s'");
    CHECK(quoted("a\nset output '|rm'") == "'a set output ''|rm'''");
    const std::string script = script_of(plot_of("x'\n!echo `id` \\ \"$d0\" {/Bold _^"), "/tmp/o'ut.svg");
    CHECK(script.find("\n!") == std::string::npos);
    CHECK(script.find("set title 'x'' !echo `id` \\ \"$d0\" {/Bold _^'") != std::string::npos);
    CHECK(script.find("set output '/tmp/o''ut.svg'") != std::string::npos);
    CHECK(script.find("noenhanced") != std::string::npos);
    CHECK(script.find("('exact' 0.01)") != std::string::npos);
}

TEST_CASE("an axis of time begins at 0 and reaches to the last mark") {
    Plot plot;
    plot.linear_x = true;
    plot.series.push_back({Series::Look::line, "", {{0, 0.02, {}, {}}, {3, 0.3, {}, {}}}});
    const std::string script = script_of(plot, "/tmp/out.svg");
    CHECK(script.find("set logscale y\n") != std::string::npos);
    CHECK(script.find("set xrange [0:3.") != std::string::npos);
    CHECK(script.find("\n0 0.02 ") != std::string::npos);
    CHECK(script.find("\n3 0.3 ") != std::string::npos);
}

TEST_CASE("file names of charts are plain, and each its own") {
    std::vector<std::string> taken;
    CHECK(slug_of("Car 20k", taken) == "car-20k");
    CHECK(slug_of("../../car|20k ", taken) == "car-20k-2");
    CHECK(slug_of("škoda", taken) == "koda");
    CHECK(slug_of("...", taken) == "scene");
    CHECK(slug_of(std::string(300, 'a'), taken).size() == 60);
}

TEST_CASE("a page escapes what it is given, keeps ids apart and names no address") {
    const std::string svg =
        "<?xml version=\"1.0\"?>\n<svg viewBox=\"0 0 9 9\" xmlns=\"http://www.w3.org/2000/svg\" "
        "xmlns:xlink=\"http://www.w3.org/1999/xlink\"><title>a</title><defs><circle id='gpPt5'/></defs>"
        "<g id=\"gnuplot_canvas\"><use xlink:href='#gpPt5'/></g></svg>\n";
    Section section{"<b> & co", {"a \"sentence\""}, {plot_of("1"), plot_of("2")}};
    section.plots[1].file = "other";
    section.tables.push_back({{"head"}, {{"<script>"}}});
    const std::string page = page_of({"Title", {"a machine"}}, {section}, {svg, svg});
    CHECK(page.find("http") == std::string::npos);
    CHECK(page.find("<b>") == std::string::npos);
    CHECK(page.find("<script>") == std::string::npos);
    CHECK(page.find("&lt;b&gt; &amp; co") != std::string::npos);
    CHECK(page.find("id='a-chart-gpPt5'") != std::string::npos);
    CHECK(page.find("href='#other-gpPt5'") != std::string::npos);
    CHECK(page.find("gnuplot_canvas") == std::string::npos);
}

TEST_CASE("rings tell whose choice they are, and are around what is sent") {
    Row lines = row("car", 0.5);
    lines.mode = "stylized wireframe";
    lines.setting.methods = {};
    lines.setting.subsampled = false;
    SceneRows scene{"Car", "car", false, {lines}, {}};
    scene.levels.width = 1280;
    scene.levels.height = 720;
    vrut::protocol::Quality level = quality_of(lines.setting);
    level.subsampling = vrut::protocol::Quality::Subsampling::yuv420;
    scene.levels.levels = {{level, 1, 1, ""}};
    const auto ring_of = [&] {
        const std::vector<Section> sections = sections_of({scene}, {});
        for (const Plot& plot : sections.front().plots)
            for (const Series& series : plot.series)
                if (series.look == Series::Look::ring) return series.title;
        return std::string("none");
    };
    CHECK(ring_of() == "what `chart --calibrate` would choose here");
    scene.stored = true;
    CHECK(ring_of() == "in the server's table, of 1280 x 720");
    scene.levels.width = 64;
    scene.levels.height = 48;
    CHECK(ring_of() == "in the server's table");
    scene.levels.levels.front().quality.level = vrut::protocol::Quality::Level::still;
    CHECK(ring_of() == "none");
}

TEST_CASE("of a judge no error is told") {
    Row exact = row("car", 1), vertex = row("car", 1);
    exact.chart = vertex.chart = "lighting";
    exact.setting = {.jpeg_quality = 0};
    vertex.setting.jpeg_quality = 0;
    exact.error = Error{};
    const auto sentence_of = [&](bool traced) {
        return sections_of({{"Car", "car", traced, {vertex, exact}, {}}}, {}).at(1).sentences.front();
    };
    CHECK(sentence_of(false).find("ms and is the judge; the other") != std::string::npos);
    CHECK(sentence_of(true).find("at a FLIP error of 0 ") != std::string::npos);
    for (const Setting& setting : sample_counts()) CHECK(setting.samples < 64);
}
