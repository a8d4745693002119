#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <stdexcept>
#include <string>
#include <string_view>

#include "io/vrut/lexer.hpp"

namespace vrut::io {

/// A syntax error and its line. The reader, which knows the file's name, catches it.
struct ParseError : std::runtime_error {
    ParseError(std::size_t line_number, const std::string& what_is_wrong)
        : std::runtime_error(what_is_wrong), line(line_number) {}
    std::size_t line;
};

/// A text of `size` bytes, which `read` hands out from its start, as many as asked for.
struct TextSource {
    std::size_t size = 0;
    std::function<void(char* to, std::size_t count)> read;
};

/// So much of a text is read at a time: a thread for each costs little, and they stay in the cache.
inline constexpr std::size_t kChunkBytes = std::size_t{1} << 18;

/// The tokens of scene text. Chunks are lexed ahead by `threads` threads; the result does not depend on their
/// number. Memory: some megabytes per thread, whatever the text's size. Throws ParseError at the first fault,
/// when it is reached, and whatever the source throws.
class Tokenizer {
public:
    Tokenizer(TextSource source, unsigned threads);

    /// The next token, and its line, from 1. A token's text is there until the one behind it is asked for.
    const Token& peek();
    std::size_t line() { return 1 + peek().line + lines_; }
    Token take();

    // Each consumes one token of its kind; `what` names it in the error ("the material's name").
    std::string_view take_word(std::string_view what);
    std::string take_string(std::string_view what);
    double take_number(std::string_view what, double min, double max);
    std::int64_t take_integer(std::string_view what, std::int64_t min, std::int64_t max);
    bool take_flag(std::string_view what);
    /// Consumes the count of a list whose elements need at least `bytes_each` bytes of the remaining text
    /// each.
    std::size_t take_count(std::string_view what, std::size_t bytes_each);

    [[noreturn]] void fail_expected(std::string_view what);

private:
    [[noreturn]] void fail_outside(std::string_view what, double min, double max);
    [[noreturn]] void fail_outside(std::string_view what, std::int64_t min, std::int64_t max);
    void next_chunk();
    void read_ahead(Chunk chunk);
    void fill(Chunk& chunk);

    TextSource source_;
    unsigned threads_;
    std::size_t offset_ = 0;   // of the chunk that is read next
    std::vector<char> carry_;  // its first bytes, which are read already
    bool ended_ = false;       // there is none
    Chunk chunk_;              // with the next token
    std::size_t next_ = 0;     // that token's place in it
    std::size_t lines_ = 0;    // line breaks before it
    std::deque<std::future<Chunk>> ahead_;
};

inline const Token& Tokenizer::peek() {
    while (next_ == chunk_.tokens.size()) next_chunk();
    const Token& token = chunk_.tokens[next_];
    if (token.kind == Token::Kind::fault) throw ParseError(1 + lines_ + token.line, chunk_.fault);
    return token;
}

inline Token Tokenizer::take() {
    const Token token = peek();
    ++next_;
    return token;
}

inline double Tokenizer::take_number(std::string_view what, double min, double max) {
    const Token& token = peek();
    if (token.kind == Token::Kind::number && token.number >= min && token.number <= max) [[likely]]
        return ++next_, token.number;
    fail_outside(what, min, max);
}

inline std::int64_t Tokenizer::take_integer(std::string_view what, std::int64_t min, std::int64_t max) {
    const Token& token = peek();
    if (token.kind == Token::Kind::number && token.number >= static_cast<double>(min) &&
        token.number <= static_cast<double>(max)) [[likely]] {
        const auto integer = static_cast<std::int64_t>(token.number);
        if (static_cast<double>(integer) == token.number) [[likely]]
            return ++next_, integer;
    }
    fail_outside(what, min, max);
}

}  // namespace vrut::io
