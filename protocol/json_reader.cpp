#include "json_reader.hpp"

#include <cmath>
#include <set>
#include <vector>

namespace vrut::protocol {

Json parse_strictly(std::string_view text, int max_depth) {
    std::vector<std::set<std::string>> members;  // of the objects that are open
    int depth = 0;
    const auto look = [&](int, Json::parse_event_t event, Json& parsed) {
        using Event = Json::parse_event_t;
        if (event == Event::object_start || event == Event::array_start) {
            if (++depth > max_depth)
                throw BadJson{error_code::bad_message,
                              "the message is nested deeper than " + std::to_string(max_depth) + " levels"};
            if (event == Event::object_start) members.emplace_back();
        } else if (event == Event::object_end || event == Event::array_end) {
            --depth;
            if (event == Event::object_end) members.pop_back();
        } else if (event == Event::key) {
            const auto& name = parsed.get_ref<const std::string&>();
            if (!members.back().insert(name).second)
                throw BadJson{error_code::bad_message,
                              "member '" + excerpt(name) + "' stands twice in one object"};
        }
        return true;
    };
    try {
        return Json::parse(text, look);
    } catch (const Json::parse_error& error) {
        throw BadJson{error_code::bad_message,
                      "the message is not JSON: error at byte " + std::to_string(error.byte)};
    } catch (const Json::out_of_range&) {
        throw BadJson{error_code::out_of_range, "the message holds a number beyond the range of double"};
    }
}

std::string dump(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

namespace {

[[noreturn]] void wrong_type(std::string_view what, const char* expected) {
    throw BadJson{error_code::bad_message, "'" + std::string(what) + "' must be " + expected};
}

[[noreturn]] void out_of_range(std::string_view what, const std::string& expected) {
    throw BadJson{error_code::out_of_range, "'" + std::string(what) + "' must be " + expected};
}

template <class Vector>
Vector read_vector(const Json& value, std::string_view what, double min, double max) {
    constexpr auto kLength = static_cast<std::size_t>(Vector::length());
    if (!value.is_array()) wrong_type(what, "an array of numbers");
    if (value.size() != kLength) out_of_range(what, "an array of " + std::to_string(kLength) + " numbers");
    Vector result{};
    for (std::size_t i = 0; i < kLength; ++i)
        result[static_cast<glm::length_t>(i)] = read_number(value[i], what, min, max);
    return result;
}

}  // namespace

double read_number(const Json& value, std::string_view what, double min, double max) {
    if (!value.is_number()) wrong_type(what, "a number");
    const double number = value.get<double>();
    if (!(number >= min && number <= max))
        out_of_range(what, "a number from " + Json(min).dump() + " to " + Json(max).dump());
    return number;
}

std::int64_t read_integer(const Json& value, std::string_view what, std::int64_t min, std::int64_t max) {
    if (!value.is_number()) wrong_type(what, "a number");
    const double number = value.get<double>();
    if (number != std::floor(number) || number < static_cast<double>(min) ||
        number > static_cast<double>(max))
        out_of_range(what, "an integer from " + std::to_string(min) + " to " + std::to_string(max));
    return static_cast<std::int64_t>(number);
}

bool read_bool(const Json& value, std::string_view what) {
    if (!value.is_boolean()) wrong_type(what, "true or false");
    return value.get<bool>();
}

std::string read_string(const Json& value, std::string_view what, std::size_t max_length) {
    if (!value.is_string()) wrong_type(what, "a string");
    const auto& text = value.get_ref<const std::string&>();
    if (text.size() > max_length)
        out_of_range(what, "a string of at most " + std::to_string(max_length) + " bytes");
    return text;
}

std::size_t read_word(const Json& value, std::string_view what,
                      std::initializer_list<std::string_view> words) {
    if (!value.is_string()) wrong_type(what, "a string");
    const auto& text = value.get_ref<const std::string&>();
    std::string list;
    std::size_t place = 0;
    for (std::string_view word : words) {
        if (text == word) return place;
        list += (place == 0 ? "" : ", ") + std::string(word);
        ++place;
    }
    out_of_range(what, "one of " + list);
}

glm::dvec2 read_vec2(const Json& value, std::string_view what, double min, double max) {
    return read_vector<glm::dvec2>(value, what, min, max);
}

glm::dvec3 read_vec3(const Json& value, std::string_view what, double min, double max) {
    return read_vector<glm::dvec3>(value, what, min, max);
}

glm::dvec4 read_vec4(const Json& value, std::string_view what, double min, double max) {
    return read_vector<glm::dvec4>(value, what, min, max);
}

const Json& read_object(const Json& value, std::string_view what) {
    if (!value.is_object()) wrong_type(what, "an object");
    return value;
}

Json to_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
Json to_json(const glm::dvec4& v) { return {v.x, v.y, v.z, v.w}; }
Json to_json(const glm::dmat4& matrix) {
    Json numbers = Json::array();
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) numbers.push_back(matrix[column][row]);
    return numbers;
}

std::string excerpt(std::string_view text) {
    constexpr std::size_t kLongest = 40;
    if (text.size() <= kLongest) return std::string(text);
    std::size_t end = kLongest;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80)
        --end;  // not inside a character
    return std::string(text.substr(0, end)) + "…";
}

}  // namespace vrut::protocol
