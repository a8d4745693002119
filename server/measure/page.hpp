#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "measure/charts.hpp"

namespace vrut::server::measure {

/// What a page says at its head.
struct PageHead {
    std::string title;
    std::vector<std::string> sentences;  ///< of the machine, the renderer, the version
};

/// An SVG file of gnuplot's as a part of a page: its ids begin with `name`, and it names no address.
std::string inlined(std::string svg, const std::string& name);

/// Draws the sections' plots beside the page, and writes it. Throws std::runtime_error.
void write_page(const std::filesystem::path& page, const PageHead& head,
                const std::vector<Section>& sections);
/// Throws std::runtime_error.
void write_text(const std::filesystem::path& path, const std::string& text);

/// One HTML page that needs nothing else; `svgs` has the drawn chart of each of the sections' plots, one
/// after the other.
std::string page_of(const PageHead& head, const std::vector<Section>& sections,
                    const std::vector<std::string>& svgs);

}  // namespace vrut::server::measure
