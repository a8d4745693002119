#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <vector>

namespace vrut::io {

/// Writes JSON text (RFC 8259) value by value, and the commas between them. Strings are UTF-8.
class JsonWriter {
public:
    JsonWriter& open_object(std::string_view name = {}) { return open(name, "{", '}'); }
    JsonWriter& open_array(std::string_view name = {}) { return open(name, "[", ']'); }
    JsonWriter& close() {
        text_ += ends_.back();
        ends_.pop_back();
        first_ = false;
        return *this;
    }

    // Each writes a member of the open object or, without a name, an element of the open array.
    template <class Number>
    JsonWriter& number(Number value, std::string_view name = {}) {
        char digits[40];
        begin(name);
        text_.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
        return *this;
    }
    JsonWriter& boolean(bool value, std::string_view name = {}) {
        begin(name);
        text_ += value ? "true" : "false";
        return *this;
    }
    JsonWriter& string(std::string_view value, std::string_view name = {}) {
        begin(name);
        quote(value);
        return *this;
    }
    /// Writes an array of `count` numbers.
    template <class Number>
    JsonWriter& numbers(const Number* values, std::size_t count, std::string_view name = {}) {
        open_array(name);
        for (std::size_t i = 0; i < count; ++i) number(values[i]);
        return close();
    }

    /// Writes a value that is JSON text already.
    JsonWriter& raw(std::string_view json, std::string_view name) {
        begin(name);
        text_ += json;
        return *this;
    }

    const std::string& text() const { return text_; }

private:
    JsonWriter& open(std::string_view name, std::string_view bracket, char end) {
        begin(name);
        text_ += bracket;
        ends_ += end;
        first_ = true;
        return *this;
    }
    void begin(std::string_view name) {
        if (!first_) text_ += ',';
        first_ = false;
        if (name.empty()) return;
        quote(name);
        text_ += ':';
    }
    void quote(std::string_view value) {
        constexpr std::string_view kHex = "0123456789abcdef";
        text_ += '"';
        for (const char c : value) {
            const auto byte = static_cast<unsigned char>(c);
            if (byte < 0x20)
                text_.append("\\u00").append(1, kHex[byte >> 4U]).append(1, kHex[byte & 15U]);
            else
                text_.append(c == '"' || c == '\\' ? "\\" : "").append(1, c);
        }
        text_ += '"';
    }

    std::string text_, ends_;
    bool first_ = true;
};

}  // namespace vrut::io
