#include "io/gltf/json_scanner.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <unordered_set>

namespace vrut::io {

namespace {

constexpr int kMostNested = 200;

[[noreturn]] void fail(std::size_t position, const std::string& what) {
    throw JsonError("its JSON is invalid at byte " + std::to_string(position) + ": " + what);
}

/// The number of `\uXXXX` at `at`, or nothing.
std::optional<std::uint32_t> code_unit(std::string_view written, std::size_t at) {
    const std::string_view escape = written.substr(std::min(at, written.size()), 6);
    std::uint32_t code = 0;
    const char* const end = escape.data() + escape.size();
    if (escape.size() < 6 || !escape.starts_with("\\u") ||
        std::from_chars(escape.data() + 2, end, code, 16).ptr != end)
        return std::nullopt;
    return code;
}

/// As UTF-8 (RFC 3629).
void append_utf8(std::string& text, std::uint32_t code) {
    const auto byte = [&](std::uint32_t value) { text += static_cast<char>(value); };
    if (code < 0x80) return byte(code);
    if (code < 0x800) {
        byte(0xC0 | code >> 6);
    } else {
        if (code < 0x10000) {
            byte(0xE0 | code >> 12);
        } else {
            byte(0xF0 | code >> 18);
            byte(0x80 | (code >> 12 & 0x3F));
        }
        byte(0x80 | (code >> 6 & 0x3F));
    }
    byte(0x80 | (code & 0x3F));
}

}  // namespace

std::string decoded_string(std::string_view written, std::size_t most) {
    constexpr std::string_view kLetters = "bfnrt", kMeant = "\b\f\n\r\t";
    std::string text;
    for (std::size_t i = 0; i < written.size() && text.size() < most; ++i) {
        auto code = code_unit(written, i);
        if (code) {
            i += 5;
            const auto low = *code >> 10 == 0x36 ? code_unit(written, i + 1) : std::nullopt;
            if (low && *low >> 10 == 0x37) {  // a pair of surrogates
                code = 0x10000 + ((*code & 0x3FF) << 10) + (*low & 0x3FF);
                i += 6;
            }
            append_utf8(text, *code);
        } else if (written[i] == '\\' && i + 1 < written.size()) {
            const std::size_t letter = kLetters.find(written[++i]);
            text += letter == std::string_view::npos ? written[i] : kMeant[letter];
        } else {
            text += written[i];
        }
    }
    return text;
}

char JsonScan::peek() {
    position_ = std::min(text_.find_first_not_of(" \t\r\n", position_), text_.size());
    if (position_ == text_.size()) fail(position_, "unexpected end");
    return text_[position_];
}

void JsonScan::expect(char c) {
    if (peek() != c) fail(position_, std::string("expected '") + c + "'");
    ++position_;
}

void JsonScan::enter() {
    if (++depth_ > kMostNested) fail(position_, "it is nested too deeply");
    ++position_;
}

std::string_view JsonScan::take_quoted() {
    expect('"');
    const std::size_t begin = position_;
    while (position_ < text_.size() && text_[position_] != '"')
        position_ += text_[position_] == '\\' ? 2U : 1U;
    if (position_ >= text_.size()) fail(begin, "a string does not end");
    return text_.substr(begin, position_++ - begin);
}

void JsonScan::each_member(const std::function<void(std::string_view)>& take) {
    if (peek() != '{') return skip();
    enter();
    std::unordered_set<std::string_view> names;
    while (peek() != '}') {
        if (!names.empty()) expect(',');
        const std::string_view name = take_quoted();
        // What is looked for could hide behind either.
        if (name.find('\\') != std::string_view::npos || !names.insert(name).second)
            fail(position_, "a member's name contains an escape character or occurs twice");
        expect(':');
        take(name);
    }
    ++position_;
    --depth_;
}

void JsonScan::each_element(const std::function<void(std::size_t)>& take) {
    if (peek() != '[') return skip();
    enter();
    for (std::size_t index = 0; peek() != ']'; ++index) {
        if (index > 0) expect(',');
        take(index);
    }
    ++position_;
    --depth_;
}

std::uint32_t JsonScan::take_index() {
    peek();
    std::uint32_t value = 0;
    const char* const last = text_.data() + text_.size();
    const auto [end, error] = std::from_chars(text_.data() + position_, last, value);
    if (error != std::errc() || (end != last && (*end == '.' || *end == 'e' || *end == 'E')))
        fail(position_, "expected an integer from 0 to 2^32 - 1");
    position_ = static_cast<std::size_t>(end - text_.data());
    return value;
}

std::string_view JsonScan::take_string() {
    if (peek() == '"') return take_quoted();
    skip();
    return {};
}

void JsonScan::skip() {
    const int outside = depth_;
    do {
        const char c = peek();
        if (c == '"') {
            take_quoted();
        } else if (c == '{' || c == '[') {
            enter();
        } else if (c == '}' || c == ']') {
            if (depth_ == outside) fail(position_, "expected a value");
            --depth_;
            ++position_;
        } else if (c == ',' || c == ':') {
            if (depth_ == outside) fail(position_, "expected a value");
            ++position_;
        } else {
            position_ = std::min(text_.find_first_of(" \t\r\n,:{}[]\"", position_), text_.size());
        }
    } while (depth_ > outside);
}

}  // namespace vrut::io
