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

/// A streaming JSON scanner. It visits the members that the caller asks for and skips the rest. Skipped
/// values are not validated, since a full parser follows. The nesting depth is bounded. Throws JsonError.
class JsonScan {
public:
    explicit JsonScan(std::string_view text) : text_(text) {}

    /// Calls `take` for each member of an object. `take` must take or skip the value. A repeated
    /// name is an error, and so is one with an escape. A value that is no object is skipped.
    void each_member(const std::function<void(std::string_view name)>& take);
    /// Does the same for an array's elements.
    void each_element(const std::function<void(std::size_t index)>& take);
    /// Returns an integer from 0 to 2^32 - 1.
    std::uint32_t take_index();
    /// Returns a string as written between its quotes. Skips another value and returns an empty string.
    std::string_view take_string();
    void skip();

    /// Returns the offset in the text, in bytes, at which a part of it begins.
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

/// Returns a string of which `written` is the text between its quotes, with escapes: its first `most` bytes
/// or a few more. An invalid escape stands for itself.
std::string decoded_string(std::string_view written, std::size_t most = std::string_view::npos);

}  // namespace vrut::io
