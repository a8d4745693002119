#include "json_reader.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace vrut::protocol {

Json parse_strictly(std::string_view text, int max_depth) {
    if (const auto nul = text.find('\0'); nul != std::string_view::npos)  // to the parser the end of the text
        throw BadJson{error_code::bad_message,
                      "the message is not JSON: error at byte " + std::to_string(nul + 1)};
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

/// The length is out of range; another type than numbers is wrong.
void check_count(const Json& value, std::string_view what, std::size_t count) {
    if (!value.is_array()) wrong_type(what, "an array of numbers");
    if (value.size() != count) out_of_range(what, "an array of " + std::to_string(count) + " numbers");
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

std::size_t read_word(const Json& value, std::string_view what, std::span<const std::string_view> words) {
    if (!value.is_string()) wrong_type(what, "a string");
    const auto& text = value.get_ref<const std::string&>();
    std::string list;
    std::size_t place = 0;
    for (std::string_view word : words) {
        if (text == word) return place;
        list += (place == 0 ? "" : ", ") + std::string(word);
        ++place;
    }
    out_of_range(what, (words.size() > 1 ? "one of " : "") + list);
}

void read_numbers(const Json& value, std::string_view what, double min, double max,
                  std::span<double> numbers) {
    check_count(value, what, numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = read_number(value[i], what, min, max);
}

glm::dmat4 read_matrix(const Json& value, std::string_view what, double max) {
    check_count(value, what, 16);
    glm::dmat4 matrix;
    for (std::size_t i = 0; i < 16; ++i)
        matrix[static_cast<glm::length_t>(i % 4)][static_cast<glm::length_t>(i / 4)] =
            read_number(value[i], what, -max, max);
    return matrix;
}

const Json& read_array(const Json& value, std::string_view what, std::size_t min, std::size_t max) {
    if (!value.is_array()) wrong_type(what, "an array");
    if (value.size() < min || value.size() > max)
        out_of_range(what, "an array of " + std::to_string(min) + " to " + std::to_string(max) + " elements");
    return value;
}

const Json& read_object(const Json& value, std::string_view what) {
    if (!value.is_object()) wrong_type(what, "an object");
    return value;
}

Json to_json(const glm::dmat4& matrix) {
    Json numbers = Json::array();
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) numbers.push_back(matrix[column][row]);
    return numbers;
}

std::string excerpt(std::string_view text) {
    constexpr std::size_t kLongest = 40;
    std::size_t end = std::min(text.size(), kLongest);
    while (end > 0 && end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80)
        --end;  // not inside a character
    std::string result(text.substr(0, end));
    for (char& c : result)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
    return end < text.size() ? result + "…" : result;
}

}  // namespace vrut::protocol
