#include "report/report.hpp"
#include "report/text.hpp"

namespace vrut::server::report {

namespace {

constexpr const char* kByteOrderMark = "\xEF\xBB\xBF";
constexpr const char* kNewLine = "\r\n";

std::string quoted(const std::string& cell) {
    if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
    std::string text = "\"";
    for (const char c : cell) text.append(c == '"' ? 2 : 1, c);
    return text + '"';
}

/// Of what somebody wrote: with an apostrophe where it would be a formula.
std::string text_cell(const std::string& text) {
    const bool computes = !text.empty() && std::string("=+-@\t\r").find(text.front()) != std::string::npos;
    return quoted(computes ? "'" + text : text);
}

std::string row(const std::string& name, const protocol::Marker& note) {
    std::string row =
        text_cell(name) + ',' + text_cell(note.text) + ',' + text_cell(note.author.value_or(""));
    row += ',' + (note.time ? iso_time(*note.time) : "") + ',' + (note.done ? "true" : "false");
    for (int axis = 0; axis < 3; ++axis) row += ',' + shortest(note.point[axis]);
    return row + ',' + (note.node ? std::to_string(*note.node) : "") + kNewLine;
}

}  // namespace

std::string csv(const protocol::ReportedState& state) {
    std::string text = kByteOrderMark;
    text.append("name,text,author,time,done,x,y,z,node").append(kNewLine);
    for (const auto& [name, note] : state.notes) text += row(name, note);
    return text;
}

}  // namespace vrut::server::report
