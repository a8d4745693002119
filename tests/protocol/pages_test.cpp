#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <vector>

#include "codec.hpp"
#include "level_table.hpp"
#include "message_table.hpp"
#include "page_tables.hpp"
#include "repository_files.hpp"

using namespace vrut::protocol;
using nlohmann::json;

namespace {

const std::vector<std::string> kPages{"PROTOCOL.md",  "CLIENT_MESSAGES.md", "SERVER_MESSAGES.md",
                                      "STATE.md",     "FRAMES.md",          "NAVIGATION.md",
                                      "EVENT_LOG.md", "LEVELS.md",          "CUES.md"};

const json& schema_definitions() {
    static const json definitions = json::parse(json_schema())["$defs"];
    return definitions;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

/// What stands in backquotes.
std::set<std::string> backquoted(const std::string& text) {
    std::set<std::string> words;
    for (std::size_t begin = text.find('`'); begin != std::string::npos;) {
        const std::size_t end = text.find('`', begin + 1);
        if (end == std::string::npos) break;
        words.insert(text.substr(begin + 1, end - begin - 1));
        begin = text.find('`', end + 1);
    }
    return words;
}

/// The part of a page under the heading that begins with `heading`, up to the next one of its level.
std::string section(const std::string& page, const std::string& heading) {
    const std::size_t begin = page.find("\n" + heading);
    INFO(heading);
    REQUIRE(begin != std::string::npos);
    const std::string level = "\n" + heading.substr(0, heading.find(' ') + 1);
    return page.substr(begin, page.find(level, begin + 1) - begin);
}

/// The words of each heading that names messages, with the text below it.
std::vector<std::pair<std::set<std::string>, std::string>> message_sections(const std::string& page) {
    std::vector<std::pair<std::set<std::string>, std::string>> sections;
    for (const std::string& line : lines_of(page)) {
        if (line.starts_with("#"))
            sections.push_back({line.starts_with("### ") ? backquoted(line) : std::set<std::string>{}, ""});
        if (!sections.empty()) sections.back().second += line + "\n";
    }
    return sections;
}

/// Characters that a reader sees: a link's address is none.
std::size_t seen_length(const std::string& cell) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < cell.size(); ++i) {
        if (cell.compare(i, 2, "](") == 0) i = std::min(cell.find(')', i), cell.size() - 1);
        length += (static_cast<unsigned char>(cell[i]) & 0xC0) != 0x80;
    }
    return length;
}

void check_table(const std::string& text, const std::string& name) {
    INFO(name);
    const bool there = text.find(page_tables::region(name, schema_definitions())) != std::string::npos;
    CHECK(there);
}

}  // namespace

TEST_CASE("the tables of the pages are those of the sources") {
    for (const std::string& name : kPages) {
        const std::string path = kProtocol + name;
        check_file(path, page_tables::filled(text_of(path), schema_definitions()));
    }
}

TEST_CASE("a table says of each member its type, range and presence") {
    const std::string rows = page_tables::region("clientSwing", schema_definitions());
    CHECK(rows.find("Roles: `control`. Needs control: yes. In an event log: yes.") == 0);
    CHECK(rows.find("| `node` | integer, 0 to 2⁵³−1 | required | ") != std::string::npos);
    CHECK(rows.find("| `ms` | number, 0 to 60,000 | default 700 | ") != std::string::npos);
    CHECK(rows.find("| `open` | number, 0 to 1 | optional | ") != std::string::npos);
    CHECK(page_tables::region("stateDocument.markers", schema_definitions())
              .find("| `*.point` | 3 numbers, ±10³⁰ | required | ") != std::string::npos);
    CHECK(page_tables::region("camera", schema_definitions())
              .find("| `near` | number, 0 or more | required, read-only | ") != std::string::npos);
    CHECK(page_tables::region("clientPointermove", schema_definitions())
              .find("| `pointerId` | integer, ±(2⁵³−1) | required | ") != std::string::npos);
    CHECK(page_tables::region("serverWelcome", schema_definitions())
              .find("| `input.drags` | map of maps of text | required | ") != std::string::npos);
    CHECK(page_tables::region("clientNavigate", schema_definitions())
              .find("| `pan` | 2 numbers, ±10⁶ | default [0, 0] | ") != std::string::npos);
    CHECK_THROWS(
        page_tables::filled("<!-- Members of camera, written by test_protocol. -->\n", schema_definitions()));
}

TEST_CASE("every message stands under a heading of its own, with its members") {
    const auto check_side = [](const char* side, const std::string& page) {
        const auto sections = message_sections(text_of(kProtocol + page));
        for (const json& reference : schema_definitions()[side]["oneOf"]) {
            const std::string name = reference["$ref"].get<std::string>().substr(8);
            const std::string type = schema_definitions()[name]["properties"]["type"]["const"];
            const auto found = std::find_if(sections.begin(), sections.end(),
                                            [&](const auto& one) { return one.first.contains(type); });
            INFO(page << " has no heading for '" << type << "'");
            REQUIRE(found != sections.end());
            check_table(found->second, name);
        }
    };
    check_side("clientMessage", "CLIENT_MESSAGES.md");
    check_side("serverMessage", "SERVER_MESSAGES.md");
}

TEST_CASE("the state document, its sections, the frame header, the event log and levels have their tables") {
    const std::string state = text_of(kProtocol + "STATE.md");
    check_table(state, "stateDocument");
    for (const auto& [name, schema] : schema_definitions()["stateDocument"]["properties"].items()) {
        const std::string part = section(state, "## `" + name + "`");
        if (name == "camera")
            check_table(part, "camera");
        else if (name == "notices")
            check_table(part, "notice");
        else
            check_table(part, "stateDocument." + name);
    }
    const std::string frames = text_of(kProtocol + "FRAMES.md");
    for (const char* name : {"frameHeader", "quality"}) check_table(frames, name);
    check_table(text_of(kProtocol + "CLIENT_MESSAGES.md"), "cameraOverlay");
    const std::string log = text_of(kProtocol + "EVENT_LOG.md");
    check_table(log, "eventLogHeader");
    for (const json& reference : schema_definitions()["eventLogLine"]["oneOf"])
        check_table(log, reference["$ref"].get<std::string>().substr(8));
    check_table(text_of(kProtocol + "LEVELS.md"), "levelTable");
    check_table(text_of(kProtocol + "CUES.md"), "cueList");
}

TEST_CASE("the pages tell every code of an error and of a notice") {
    const auto errors = backquoted(section(text_of(kProtocol + "SERVER_MESSAGES.md"), "### `error`"));
    for (const char* code : error_code::all) CHECK_MESSAGE(errors.contains(code), code);
    const auto notices = backquoted(section(text_of(kProtocol + "STATE.md"), "## `notices`"));
    for (const char* code : notice_code::all) CHECK_MESSAGE(notices.contains(code), code);
}

TEST_CASE("no cell of a page has more than 120 characters") {
    for (const std::string& page : kPages)
        for (const std::string& line : lines_of(text_of(kProtocol + page))) {
            if (!line.starts_with("|")) continue;
            std::istringstream cells(line);
            for (std::string cell; std::getline(cells, cell, '|');)
                CHECK_MESSAGE(seen_length(cell) <= 122, page << ": " << cell);
        }
}

TEST_CASE("the page's table of levels is one") {
    const std::string page = text_of(kProtocol + "LEVELS.md");
    const std::size_t begin = page.find("```json levels\n");
    REQUIRE(begin != std::string::npos);
    const std::size_t text = page.find('\n', begin) + 1;
    const auto table = parse_level_table(page.substr(text, page.find("```", text) - text));
    REQUIRE_MESSAGE(table.has_value(), table.error());
    CHECK(table->levels.size() == 2);
}
