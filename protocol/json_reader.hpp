#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "messages.hpp"

/// Reading JSON from outside: strict where nlohmann-json is lenient. For protocol's own .cpp files.
namespace vrut::protocol {

using Json = nlohmann::json;

/// Thrown inside protocol only, and turned into an Error at its border.
struct BadJson {
    const char* code;
    std::string message;
};

/// What `read` gives, or the BadJson that it throws as an Error.
template <class Read>
auto or_error(Read read) -> tl::expected<decltype(read()), Error> {
    try {
        return read();
    } catch (const BadJson& bad) {
        return tl::unexpected(Error{{}, bad.code, bad.message});
    }
}

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
std::size_t read_word(const Json& value, std::string_view what, std::span<const std::string_view> words);
/// As many numbers as there is space for.
void read_numbers(const Json& value, std::string_view what, double min, double max,
                  std::span<double> numbers);
/// 16 numbers row by row.
glm::dmat4 read_matrix(const Json& value, std::string_view what, double max);
const Json& read_object(const Json& value, std::string_view what);
const Json& read_array(const Json& value, std::string_view what, std::size_t min, std::size_t max);

/// 16 numbers row by row.
Json to_json(const glm::dmat4& matrix);

/// An outside string as an error message may repeat it: short, and without control characters.
std::string excerpt(std::string_view text);

}  // namespace vrut::protocol
