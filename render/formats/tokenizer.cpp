#include "tokenizer.hpp"

#include <charconv>
#include <cmath>

namespace vrut {

namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v'; }
bool ends_bare(char c) { return is_space(c) || c == '"' || c == '#'; }
bool starts_number(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.'; }

std::string compact(double value) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    return std::string(buffer, end);
}

bool continues_utf8(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

}  // namespace

std::string excerpt(std::string_view text, std::size_t most) {
    std::size_t length = std::min(text.size(), most);
    while (length > 0 && length < text.size() && continues_utf8(text[length])) --length;
    std::string result(text.substr(0, length));
    for (char& c : result)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    return length < text.size() ? result + "…" : result;
}

Tokenizer::Tokenizer(std::string_view text) : text_(text) { advance(); }

void Tokenizer::skip_space() {
    while (position_ < text_.size()) {
        const char c = text_[position_];
        if (c == '#') {
            position_ = std::min(text_.find('\n', position_), text_.size());
        } else if (is_space(c)) {
            line_ += c == '\n';
            ++position_;
        } else {
            return;
        }
    }
}

void Tokenizer::advance() {
    skip_space();
    next_ = Token{Token::Kind::end_of_file, {}, 0, line_};
    if (position_ == text_.size()) return;

    const std::size_t start = position_;
    if (text_[start] == '"') {
        for (++position_; position_ < text_.size() && text_[position_] != '"'; ++position_) {
            if (text_[position_] == '\n') throw ParseError(line_, "expected \" before the end of the line");
            if (text_[position_] == '\\') {
                ++position_;
                if (position_ == text_.size() || (text_[position_] != '"' && text_[position_] != '\\'))
                    throw ParseError(line_, "expected \\\" or \\\\ in a string, found another escape");
            }
        }
        if (position_ >= text_.size()) throw ParseError(line_, "expected \" before the end of the file");
        next_.kind = Token::Kind::string;
        next_.text = text_.substr(start + 1, position_ - start - 1);
        ++position_;
        return;
    }
    while (position_ < text_.size() && !ends_bare(text_[position_])) ++position_;
    next_.text = text_.substr(start, position_ - start);
    next_.kind = Token::Kind::word;
    if (!starts_number(next_.text[0])) return;

    const char* first = next_.text.data();
    const char* last = first + next_.text.size();
    if (next_.text[0] == '+' && !next_.text.starts_with("+-")) ++first;  // from_chars takes no plus
    const auto [end, error] = std::from_chars(first, last, next_.number);
    if (error == std::errc::result_out_of_range)
        throw ParseError(line_,
                         "expected a number in the range of double, found '" + excerpt(next_.text) + "'");
    if (error != std::errc() || end != last || !std::isfinite(next_.number))
        throw ParseError(line_, "expected a number, found '" + excerpt(next_.text) + "'");
    next_.kind = Token::Kind::number;
}

Token Tokenizer::take() {
    const Token token = next_;
    advance();
    return token;
}

void Tokenizer::fail_expected(std::string_view what) const {
    const std::string found = next_.kind == Token::Kind::end_of_file ? "the end of the file"
                              : next_.kind == Token::Kind::string    ? "\"" + excerpt(next_.text) + "\""
                                                                     : "'" + excerpt(next_.text) + "'";
    throw ParseError(next_.line, "expected " + std::string(what) + ", found " + found);
}

std::string_view Tokenizer::take_word(std::string_view what) {
    if (next_.kind != Token::Kind::word) fail_expected(what);
    return take().text;
}

std::string Tokenizer::take_string(std::string_view what) {
    if (next_.kind != Token::Kind::string) fail_expected(std::string(what) + " in quotes");
    const Token token = take();
    std::string result;
    result.reserve(token.text.size());
    for (std::size_t i = 0; i < token.text.size(); ++i) result += token.text[token.text[i] == '\\' ? ++i : i];
    return result;
}

double Tokenizer::take_number(std::string_view what) {
    if (next_.kind != Token::Kind::number) fail_expected(what);
    return take().number;
}

double Tokenizer::take_number(std::string_view what, double min, double max) {
    if (next_.kind != Token::Kind::number || next_.number < min || next_.number > max)
        fail_expected(std::string(what) + " (a number from " + compact(min) + " to " + compact(max) + ")");
    return take().number;
}

std::int64_t Tokenizer::take_integer(std::string_view what, std::int64_t min, std::int64_t max) {
    const double number = next_.number;
    if (next_.kind != Token::Kind::number || number != std::floor(number) ||
        number < static_cast<double>(min) || number > static_cast<double>(max))
        fail_expected(std::string(what) + " (an integer from " + std::to_string(min) + " to " +
                      std::to_string(max) + ")");
    return static_cast<std::int64_t>(take().number);
}

bool Tokenizer::take_flag(std::string_view what) { return take_integer(what, 0, 1) != 0; }

std::size_t Tokenizer::take_count(std::string_view what, std::size_t bytes_each) {
    // A count is checked against the file before anything is allocated for it.
    const std::size_t left = (text_.size() - position_) / bytes_each;
    const Token token = next_;
    const auto count = static_cast<std::size_t>(take_integer(what, 0, std::int64_t{1} << 32));
    if (count > left)
        throw ParseError(token.line, "expected " + std::string(what) + " that fits into the file, found " +
                                         excerpt(token.text));
    return count;
}

}  // namespace vrut
