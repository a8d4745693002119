#pragma once

#include <glm/glm.hpp>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "messages.hpp"

/// Reading JSON from outside: strict where nlohmann-json is lenient. For protocol's own .cpp files.
namespace vrut::protocol {

using Json = nlohmann::json;

/// Thrown inside protocol only, and turned into an Error at its border.
struct BadJson {
    const char* code;
    std::string message;
};

/// Text to JSON: valid UTF-8, at most `max_depth` levels (checked while parsing, so that depth costs no
/// stack), no duplicate members, numbers within double. Throws BadJson.
Json parse_strictly(std::string_view text, int max_depth = kMaxDepth);

/// JSON to text; never throws for what a name may hold.
std::string dump(const Json& json);

// Values. `what` names the member in the error. Numbers must be numbers, integers must have no fraction.
double read_number(const Json& value, std::string_view what, double min, double max);
std::int64_t read_integer(const Json& value, std::string_view what, std::int64_t min, std::int64_t max);
bool read_bool(const Json& value, std::string_view what);
std::string read_string(const Json& value, std::string_view what, std::size_t max_length);
/// Position in `words` of the value.
std::size_t read_word(const Json& value, std::string_view what,
                      std::initializer_list<std::string_view> words);
glm::dvec2 read_vec2(const Json& value, std::string_view what, double min, double max);
glm::dvec3 read_vec3(const Json& value, std::string_view what, double min, double max);
glm::dvec4 read_vec4(const Json& value, std::string_view what, double min, double max);
const Json& read_object(const Json& value, std::string_view what);

Json to_json(const glm::dvec3& v);
Json to_json(const glm::dvec4& v);
/// 16 numbers row by row.
Json to_json(const glm::dmat4& matrix);

/// An outside string as an error message may repeat it: short.
std::string excerpt(std::string_view text);

}  // namespace vrut::protocol
