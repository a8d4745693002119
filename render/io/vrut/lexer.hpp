#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace vrut::io {

/// What a sentence repeats of the file: printable, at most so many bytes, and whole characters.
std::string excerpt(std::string_view text, std::size_t most = 40);

/// Of a word, a number or a string; nobody writes longer ones.
inline constexpr std::size_t kMaxTokenBytes = std::numeric_limits<std::uint16_t>::max();

struct Token {
    enum class Kind : std::uint8_t { word, number, string, end_of_file, fault };

    const char* begin = nullptr;  ///< of a string behind its quote
    double number = 0;
    std::uint32_t line = 0;  ///< line breaks before it in its chunk
    std::uint16_t length = 0;
    Kind kind = Kind::end_of_file;

    /// As written; of a string what is between the quotes, still escaped.
    std::string_view text() const { return {begin, length}; }
};

/// A stretch of scene text that starts between two tokens, and its tokens, which point into it.
struct Chunk {
    std::vector<char> text;  ///< and one line break more, at which every search ends
    std::size_t offset = 0;  ///< of its first byte in the file
    bool last = false;       ///< of the file

    // What lex() finds:
    std::vector<Token> tokens;  ///< behind a fault there are none
    std::string fault;          ///< what its token of that kind means
    std::size_t lines = 0;      ///< line breaks up to `rest`
    std::size_t rest = 0;       ///< where the next chunk starts: a token may be longer than this one
};

/// Splits a chunk into bare words, finite numbers and quoted strings; `#` starts a comment. Faults are bytes
/// that are not UTF-8, numbers and strings that are none, and what is longer than kMaxTokenBytes.
void lex(Chunk& chunk);

}  // namespace vrut::io
