#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace vrut::io {

struct JsonError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A streaming JSON scanner: visits the members that the caller asks for and skips the rest. Lenient about
/// skipped values, since a full parser follows. The nesting depth is bounded. Throws JsonError.
class JsonScan {
public:
    explicit JsonScan(std::string_view text) : text_(text) {}

    /// Each member of an object, its value to be taken or skipped by `take`; names come as written, and each
    /// once. What is no object is skipped.
    void each_member(const std::function<void(std::string_view name)>& take);
    /// The same for an array's elements.
    void each_element(const std::function<void(std::size_t index)>& take);
    /// A whole number from 0 to 2^32 - 1.
    std::uint32_t take_index();
    /// A string as written between its quotes; of something else, skipped, an empty one.
    std::string_view take_string();
    void skip();

    /// Where in the text a part of it begins.
    std::size_t place_of(std::string_view part) const {
        return static_cast<std::size_t>(part.data() - text_.data());
    }

private:
    char peek();
    void expect(char c);
    std::string_view take_quoted();
    void enter();

    std::string_view text_;
    std::size_t position_ = 0;
    int depth_ = 0;
};

/// The beginning of a string that is `written` with escapes between its quotes: `most` bytes of it or a few
/// more. What is no escape stands for itself.
std::string decoded_string(std::string_view written, std::size_t most = std::string_view::npos);

}  // namespace vrut::io
