#include "measure/page.hpp"

#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>

#include "base/files.hpp"
#include "base/html.hpp"
#include "engine/images.hpp"

namespace vrut::server::measure {

using base::escaped;

namespace {

// In the dark charts are turned to light lines on black; the hues are turned back.
constexpr std::string_view kStyle = R"(
:root { color-scheme: light dark; font: 16px/1.5 system-ui, sans-serif; }
body { margin: 0 auto; padding: 1rem; max-width: 96rem; }
h1, h2 { line-height: 1.2; }
h2 { margin-top: 2.5rem; border-top: 1px solid #8884; padding-top: 1rem; }
p { max-width: 46rem; }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 26rem), 1fr)); gap: 1rem; }
figure { margin: 0; }
svg { width: 100%; height: auto; display: block; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; margin: 1rem 0; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .25rem .75rem .25rem 0; border-bottom: 1px solid #8884; vertical-align: top; }
@media (prefers-color-scheme: dark) { svg { filter: invert(1) hue-rotate(180deg); } }
)";

void replace_all(std::string& text, std::string_view from, std::string_view to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
}

void write_table(std::ostream& out, const Section::Table& table) {
    out << "<div class=\"scroll\"><table><thead><tr>";
    for (const std::string& cell : table.head) out << "<th>" << escaped(cell) << "</th>";
    out << "</tr></thead><tbody>\n";
    for (const auto& row : table.rows) {
        out << "<tr>";
        for (const std::string& cell : row) out << "<td>" << escaped(cell) << "</td>";
        out << "</tr>\n";
    }
    out << "</tbody></table></div>\n";
}

void write_paragraphs(std::ostream& out, const std::vector<std::string>& sentences) {
    for (const std::string& sentence : sentences) out << "<p>" << escaped(sentence) << "</p>\n";
}

}  // namespace

std::string inlined(std::string svg, const std::string& name) {
    svg.erase(0, svg.find("<svg"));
    // In a page these names are known.
    replace_all(svg, " xmlns=\"http://www.w3.org/2000/svg\"", "");
    replace_all(svg, " xmlns:xlink=\"http://www.w3.org/1999/xlink\"", "");
    replace_all(svg, "xlink:href=", "href=");
    for (const char* id : {"gp", "textbox", "greybox"}) {
        replace_all(svg, std::string("id='") + id, "id='" + name + "-" + id);
        replace_all(svg, std::string("'#") + id, "'#" + name + "-" + id);
        replace_all(svg, std::string("url(#") + id, "url(#" + name + "-" + id);
    }
    replace_all(svg, "id=\"gnuplot_canvas\"", "");
    // Titles are shown where a finger or a mouse rests, and gnuplot's say nothing.
    for (std::size_t from; (from = svg.find("<title>")) != std::string::npos;)
        svg.erase(from, svg.find("</title>", from) + 8 - from);
    return svg;
}

std::string page_of(const PageHead& head, const std::vector<Section>& sections,
                    const std::vector<std::string>& svgs) {
    std::ostringstream out;
    out << "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>"
        << escaped(head.title) << "</title>\n<style>" << kStyle << "</style></head><body>\n<h1>"
        << escaped(head.title) << "</h1>\n";
    write_paragraphs(out, head.sentences);
    std::size_t next = 0;
    for (const Section& section : sections) {
        out << "<h2>" << escaped(section.title) << "</h2>\n";
        write_paragraphs(out, section.sentences);
        for (const Section::Table& table : section.tables) write_table(out, table);
        if (section.plots.empty()) continue;
        out << "<div class=\"charts\">\n";
        for (const Plot& plot : section.plots)
            out << "<figure role=\"img\" aria-label=\"" << escaped(plot.title + ": " + plot.y_label) << "\">"
                << inlined(svgs.at(next++), plot.file) << "</figure>\n";
        out << "</div>\n";
    }
    out << "</body></html>\n";
    return out.str();
}

void write_page(const std::filesystem::path& page, const PageHead& head,
                const std::vector<Section>& sections) {
    std::vector<Plot> plots;
    for (const Section& section : sections)
        plots.insert(plots.end(), section.plots.begin(), section.plots.end());
    draw(plots, page.parent_path());
    std::vector<std::string> svgs;
    svgs.reserve(plots.size());
    for (const Plot& plot : plots) {
        std::ifstream svg(page.parent_path() / (plot.file + ".svg"), std::ios::binary);
        svgs.emplace_back(std::istreambuf_iterator<char>(svg), std::istreambuf_iterator<char>());
    }
    write_text(page, page_of(head, sections, svgs));
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    base::write_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace vrut::server::measure
