#include "io/vrut/lexer.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

#include "base/utf8.hpp"

namespace vrut::io {

namespace {

constexpr std::uint8_t kSpace = 1, kEndsBare = 2, kStartsNumber = 4;

constexpr std::array<std::uint8_t, 256> kClasses = [] {
    std::array<std::uint8_t, 256> classes{};
    const auto add = [&](std::string_view characters, std::uint8_t to) {
        for (const char c : characters) classes[static_cast<unsigned char>(c)] |= to;
    };
    add(" \t\r\n\f\v", kSpace);
    add(" \t\r\n\f\v\"#", kEndsBare);
    add("0123456789-+.", kStartsNumber);
    return classes;
}();

bool is(char c, std::uint8_t what) { return (kClasses[static_cast<unsigned char>(c)] & what) != 0; }

bool continues_utf8(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

class Lexer {
public:
    explicit Lexer(Chunk& chunk)
        : chunk_(chunk), begin_(chunk.text.data()), at_(begin_), end_(begin_ + chunk.text.size() - 1) {}

    void run() {
        const std::size_t invalid =
            base::find_invalid_utf8({begin_, static_cast<std::size_t>(end_ - begin_)});
        const bool valid = invalid == std::string_view::npos;
        if (!valid) end_before(invalid);
        while (skip_space() && add_token()) {
        }
        if (chunk_.fault.empty() && !valid) fault("expected UTF-8, found another byte");
        if (chunk_.fault.empty() && chunk_.last) append(Token::Kind::end_of_file, at_, at_);
        chunk_.rest = static_cast<std::size_t>(at_ - begin_);
    }

private:
    void end_before(std::size_t offset) {
        end_ = begin_ + offset;
        *end_ = '\n';
        open_ = true;
    }

    /// To the next token, if there is one.
    bool skip_space() {
        for (;;) {
            for (; at_ < end_ && is(*at_, kSpace); ++at_) chunk_.lines += *at_ == '\n';
            if (at_ == end_) return false;
            if (*at_ != '#') return true;
            if (!skip_comment()) return false;
        }
    }

    /// To the end of its line; what goes on in the next chunk is a comment there, too.
    bool skip_comment() {
        const void* const line_break = std::memchr(at_, '\n', static_cast<std::size_t>(end_ - at_));
        at_ = line_break ? begin_ + (static_cast<const char*>(line_break) - begin_) : end_;
        if (!line_break && open_) *--at_ = '#';
        return line_break;
    }

    // --- tokens: whether there is another behind them

    bool add_token() {
        if (*at_ == '"') return add_string();
        if (is(*at_, kStartsNumber)) return add_number();
        return add(Token::Kind::word, end_of_bare());
    }

    bool add_number() {
        const char* const first = at_ + (*at_ == '+' && at_[1] != '-');  // from_chars takes no plus
        std::uint64_t whole = 0;
        if (const char* const end = std::from_chars(first, end_, whole).ptr;
            end != first && end - first < 16 && is(*end, kEndsBare))
            return add(Token::Kind::number, end, static_cast<double>(whole));
        double number = 0;
        const auto [end, error] = std::from_chars(first, end_, number);
        if (error == std::errc() && is(*end, kEndsBare) && std::isfinite(number))
            return add(Token::Kind::number, end, number);
        return add_no_number(error == std::errc::result_out_of_range);
    }

    bool add_no_number(bool out_of_range) {
        const char* const end = end_of_bare();
        if (goes_on(end)) return add(Token::Kind::word, end);
        const std::string found = excerpt({at_, static_cast<std::size_t>(end - at_)});
        return fault((out_of_range ? "expected a number in the range of double, found '"
                                   : "expected a number, found '") +
                     found + "'");
    }

    bool add_string() {
        const char* end = at_ + 1;
        for (; end < end_ && *end != '"'; ++end) {
            if (*end == '\n') return fault("expected \" before the end of the line");
            if (*end != '\\') continue;
            ++end;
            if (goes_on(end)) break;
            if (end == end_ || (*end != '"' && *end != '\\'))
                return fault("expected \\\" or \\\\ in a string, found another escape");
        }
        if (end == end_ && !open_) return fault("expected \" before the end of the file");
        return add(Token::Kind::string, end);
    }

    const char* end_of_bare() const {
        const char* end = at_;
        while (!is(*end, kEndsBare)) ++end;
        return end;
    }

    /// Returns true if what reaches this far may be cut off there.
    bool goes_on(const char* end) const { return end == end_ && open_; }

    [[gnu::always_inline]] bool add(Token::Kind kind, const char* end, double number = 0) {
        const bool quoted = kind == Token::Kind::string;
        const char* const begin = at_ + quoted;
        if (static_cast<std::size_t>(end - begin) > kMaxTokenBytes) return fault_of_length();
        if (goes_on(end)) return false;
        append(kind, begin, end, number);
        at_ += end + quoted - at_;
        return true;
    }

    void append(Token::Kind kind, const char* begin, const char* end, double number = 0) {
        chunk_.tokens.push_back({begin, number, static_cast<std::uint32_t>(chunk_.lines),
                                 static_cast<std::uint16_t>(end - begin), kind});
    }

    bool fault_of_length() {
        return fault("expected words, numbers and strings of at most " + std::to_string(kMaxTokenBytes) +
                     " bytes, found a longer one");
    }

    bool fault(std::string what) {
        chunk_.fault = std::move(what);
        append(Token::Kind::fault, at_, at_);
        return false;
    }

    Chunk& chunk_;
    char* const begin_;
    char* at_;
    char* end_;                 // a line break stands there
    bool open_ = !chunk_.last;  // something may go on behind it
};

}  // namespace

std::string excerpt(std::string_view text, std::size_t most) {
    std::size_t length = std::min(text.size(), most);
    while (length > 0 && length < text.size() && continues_utf8(text[length])) --length;
    std::string result(text.substr(0, length));
    for (char& c : result)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    return length < text.size() ? result + "…" : result;
}

void lex(Chunk& chunk) {
    chunk.tokens.clear();
    chunk.fault.clear();
    chunk.lines = 0;
    Lexer(chunk).run();
}

}  // namespace vrut::io
