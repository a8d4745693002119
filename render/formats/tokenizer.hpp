#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace vrut {

/// What is wrong with a text and where; caught by the reader, which knows the file's name.
struct ParseError : std::runtime_error {
    ParseError(std::size_t line_number, const std::string& what_is_wrong)
        : std::runtime_error(what_is_wrong), line(line_number) {}
    std::size_t line;
};

/// What a sentence repeats of the file: printable, at most so many bytes, and whole characters.
std::string excerpt(std::string_view text, std::size_t most = 40);

struct Token {
    enum class Kind { word, number, string, end_of_file };
    Kind kind = Kind::end_of_file;
    std::string_view text;  ///< as written; of a string what is between the quotes, still escaped
    double number = 0;
    std::size_t line = 1;
};

/// Splits scene text into bare words, finite numbers and quoted strings; `#` starts a comment. Views into
/// `text`, which must outlive it. Throws ParseError.
class Tokenizer {
public:
    explicit Tokenizer(std::string_view text);

    const Token& peek() const { return next_; }
    Token take();

    // Each takes one token of its kind; `what` names it in the error ("the material's name").
    std::string_view take_word(std::string_view what);
    std::string take_string(std::string_view what);
    double take_number(std::string_view what);
    double take_number(std::string_view what, double min, double max);
    std::int64_t take_integer(std::string_view what, std::int64_t min, std::int64_t max);
    bool take_flag(std::string_view what);
    /// A number of things that each need at least `bytes_each` of the text that is left.
    std::size_t take_count(std::string_view what, std::size_t bytes_each);

    [[noreturn]] void fail_expected(std::string_view what) const;

private:
    void advance();
    void skip_space();

    std::string_view text_;
    std::size_t position_ = 0;
    std::size_t line_ = 1;
    Token next_;
};

}  // namespace vrut
