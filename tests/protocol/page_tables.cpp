#include "page_tables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "message_table.hpp"

namespace page_tables {

using nlohmann::json;

namespace {

const std::string kBegin = "<!-- Members of ", kBeginRest = ", written by test_protocol. -->\n";
const std::string kEnd = "<!-- End of members. -->\n";

// --- numbers

std::string superscript(int exponent) {
    static const std::vector<std::string> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text = exponent < 0 ? "⁻" : "";
    for (const char digit : std::to_string(std::abs(exponent)))
        text += digits[static_cast<std::size_t>(digit - '0')];
    return text;
}

std::string with_commas(std::string digits) {
    if (digits.size() > 4)
        for (std::size_t i = digits.size() - 3; i > 0 && i<digits.size(); i = i> 3 ? i - 3 : 0)
            digits.insert(i, ",");
    return digits;
}

/// Far numbers as powers of two, less one, or of ten.
std::string number(double value) {
    if (value < 0) return "−" + number(-value);
    if (value == 0) return "0";
    for (const int bits : {31, 32, 53})
        if (value == std::exp2(bits) - 1) return "2" + superscript(bits) + "−1";
    const double exponent = std::round(std::log10(value));
    if ((value >= 1e6 || value <= 1e-3) && std::abs(std::pow(10, exponent) / value - 1) < 1e-12)
        return "10" + superscript(static_cast<int>(exponent));
    if (value == std::floor(value)) return with_commas(std::to_string(static_cast<std::int64_t>(value)));
    std::ostringstream text;
    text << value;
    return text.str();
}

std::string range(double min, double max) {
    const double any = std::numeric_limits<double>::max();
    if (max == any) return min == 0 ? ", 0 or more" : "";
    const bool is_difference = number(max).find("−1") != std::string::npos;
    if (min == -max) return ", ±" + (is_difference ? "(" + number(max) + ")" : number(max));
    if (min == max) return ", " + number(min);
    return ", " + number(min) + " to " + number(max);
}

std::string range_of(const json& schema) {
    return range(schema.at("minimum").get<double>(), schema.at("maximum").get<double>());
}

// --- types

/// Where the definitions stand that others refer to.
std::string reference(const std::string& name) {
    static const std::map<std::string, std::string> places{
        {"camera", "[camera](STATE.md#camera)"},
        {"cameraOverlay", "[camera members](CLIENT_MESSAGES.md#camera-members)"},
        {"clientMessage", "[client message](CLIENT_MESSAGES.md)"},
        {"cueList", "[list of cues](CUES.md#as-a-file)"},
        {"cues", "[cues](STATE.md#cues)"},
        {"feature", "[feature](STATE.md#features)"},
        {"notice", "[notice](STATE.md#notices)"},
        {"quality", "[quality](FRAMES.md#quality)"},
        {"stateDocument", "[state document](STATE.md)"},
        {"statePatch", "[patch](STATE.md#patches)"},
        {"view", "[size](CLIENT_MESSAGES.md#resize)"},
    };
    return places.at(name.substr(name.rfind('/') + 1));
}

std::string quoted(const json& value) {
    return "`" + (value.is_string() ? value.get<std::string>() : value.dump()) + "`";
}

std::string one_of(const json& words) {
    constexpr std::size_t kMostInACell = 6;  // longer lists have tables of their own
    if (words.size() > kMostInACell) return "word";
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i)
        text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + quoted(words[i]);
    return text;
}

std::string type_of(const json& schema);

std::string array_type(const json& schema) {
    const json& item = schema.at("items");
    const auto least = schema.at("minItems").get<std::int64_t>(),
               most = schema.at("maxItems").get<std::int64_t>();
    if (least == 16 && most == 16) return "matrix" + range_of(item);
    if (least == most) return std::to_string(least) + " numbers" + range_of(item);
    const std::string of = item.contains("properties") ? "objects" : type_of(item);
    if (most == vrut::protocol::kMaxInteger) return "list of " + of;
    return "list of " + of +
           (least == 0 ? ", at most " + number(static_cast<double>(most))
                       : range(static_cast<double>(least), static_cast<double>(most)));
}

std::string type_of(const json& schema) {
    if (schema.contains("$ref")) return reference(schema["$ref"]);
    if (schema.contains("const")) return quoted(schema["const"]);
    if (schema.contains("enum")) return one_of(schema["enum"]);
    const std::string type = schema.at("type");
    if (type == "array") return array_type(schema);
    if (type == "integer" || type == "number") return type + range_of(schema);
    if (type == "object" && schema.contains("additionalProperties")) {
        const json& of = schema["additionalProperties"];
        const std::string one = of.contains("properties") ? "objects" : type_of(of);
        return "map of " + (one.starts_with("map ") ? "maps " + one.substr(4) : one);
    }
    if (type != "string") return type;
    const auto longest = schema.at("maxLength").get<std::uint64_t>();
    if (longest == std::numeric_limits<std::uint32_t>::max()) return "text";
    return "text, at most " + number(static_cast<double>(longest)) + " bytes";
}

// --- tables

std::string shown(const json& value) {
    if (value.is_number()) return number(value.get<double>());
    if (!value.is_array()) return quoted(value);
    std::string text;
    for (const json& part : value) text += (text.empty() ? "[" : ", ") + shown(part);
    return text + "]";
}

std::string presence(const std::string& name, const json& schema, const json& required) {
    std::string text = "optional";
    if (std::find(required.begin(), required.end(), name) != required.end()) text = "required";
    if (schema.contains("default")) {
        text = "default " + shown(schema["default"]);
    }
    return text + (schema.value("readOnly", false) ? ", read-only" : "");
}

/// Those that must be there first, in the order in which the sources describe them.
std::vector<std::string> in_order(const json& object) {
    std::vector<std::string> names = object.value("required", json::array());
    for (const auto& [name, schema] : object.at("properties").items()) {
        static_cast<void>(schema);
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    return names;
}

struct Table {
    std::string rows;
    std::vector<std::string> left_out;
    bool nested = true;

    void add_members(const json& object, const std::string& prefix) {
        for (const std::string& name : in_order(object)) {
            if (prefix.empty() && std::find(left_out.begin(), left_out.end(), name) != left_out.end())
                continue;
            const json& schema = object.at("properties").at(name);
            rows += "| `" + prefix + name + "` | " + type_of(schema) + " | " +
                    presence(name, schema, object.value("required", json::array())) + " | " +
                    schema.value("description", "") + " |\n";
            if (nested) add_inner(schema, prefix + name);
        }
    }
    /// What is inside of a member, or of each of a list or a map.
    void add_inner(const json& schema, const std::string& path) {
        if (schema.contains("properties")) add_members(schema, path.empty() ? "" : path + ".");
        if (schema.contains("items")) add_inner(schema["items"], path + "[]");
        if (schema.contains("additionalProperties"))
            add_inner(schema["additionalProperties"], path.empty() ? "*" : path + ".*");
    }
};

/// Who may send a client message.
std::string senders(const vrut::protocol::MessageTraits& traits) {
    using vrut::protocol::Role;
    using vrut::protocol::Steers;
    std::string roles;
    for (const Role role : {Role::control, Role::view, Role::host})
        if (may(role, traits.right))
            roles += std::string(roles.empty() ? "`" : ", `") + vrut::protocol::name_of(role) + "`";
    static const std::map<Steers, std::string> needs{
        {Steers::no, "no"}, {Steers::yes, "yes"}, {Steers::by_content, "see below"}};
    return "Roles: " + roles + ". Needs control: " + needs.at(traits.steers) +
           ". In an event log: " + (traits.recorded ? "yes" : "no") + ".\n\n";
}

const json& schema_at(const std::string& name, const json& definitions) {
    const std::size_t dot = name.find('.');
    const json& definition = definitions.at(name.substr(0, dot));
    const json& schema =
        dot == std::string::npos ? definition : definition.at("properties").at(name.substr(dot + 1));
    return schema;
}

}  // namespace

std::string region(const std::string& name, const json& definitions) {
    const json& schema = schema_at(name, definitions);
    std::string text;
    // The sections of the state have tables of their own.
    Table table{"", {"type", "event"}, name != "stateDocument"};
    for (const auto& [traits, prototype] : vrut::protocol::client_message_types()) {
        const json type = schema.value(json::json_pointer("/properties/type/const"), "");
        if (!name.starts_with("client") || type != traits.type) continue;
        text = senders(traits);
        table.left_out.push_back("id");
    }
    table.add_inner(schema, "");
    if (table.rows.empty()) return text + "It has no members of its own.\n";
    return text + "| member | type and range | presence | meaning |\n|---|---|---|---|\n" + table.rows;
}

std::string filled(std::string page, const json& definitions) {
    for (std::size_t at = page.find(kBegin); at != std::string::npos; at = page.find(kBegin, at + 1)) {
        const std::size_t name = at + kBegin.size(), name_end = page.find(kBeginRest, name);
        const std::size_t begin = name_end + kBeginRest.size(), end = page.find(kEnd, begin);
        if (name_end == std::string::npos || end == std::string::npos || page.find(kBegin, begin) < end)
            throw std::runtime_error("a region lacks its end: " + page.substr(at, 80));
        page.replace(begin, end - begin,
                     "\n" + region(page.substr(name, name_end - name), definitions) + "\n");
    }
    return page;
}

}  // namespace page_tables
