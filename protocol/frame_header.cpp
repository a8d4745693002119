#include "frame_header.hpp"

#include <algorithm>
#include <stdexcept>

#include "file_descriptions.hpp"

namespace vrut::protocol {

namespace {

constexpr std::size_t kLongestComment = 65'533;

/// No longer than a COM segment.
std::string text_of(Json json) {
    std::string text = dump(json);
    if (text.size() > kLongestComment && json.erase("markers") > 0) text = dump(json);
    // Of the others, the only one without a bound.
    if (text.size() > kLongestComment && json["camera"].erase("name") > 0) text = dump(json);
    return text;
}

std::string without_clients_part(FrameHeader header) {
    header.handled = 0;
    header.timing.since_input_ms = 0;
    return dump(write_struct(header));
}

}  // namespace

std::string encode(const FrameHeader& header) { return text_of(write_struct(header)); }

EncodedFrameHeader::EncodedFrameHeader(const FrameHeader& header)
    : EncodedFrameHeader(without_clients_part(header)) {}

EncodedFrameHeader::EncodedFrameHeader(const std::string& text) {
    Json header = Json::parse(text, nullptr, false);
    if (!header.is_object()) throw std::runtime_error("a frame's header is no object");
    const Parts sent = parts_of(text);
    if (const auto depth = header.find("depth"); depth != header.end()) (*depth)["bytes"] = 0;
    const Parts known = parts_of(dump(header));
    header.erase("depth");
    parts_ = {parts_of(dump(header)), known, sent};
}

EncodedFrameHeader::Parts EncodedFrameHeader::parts_of(const std::string& text) {
    // Quotes within a name are escaped, so that the member stands nowhere else.
    const std::string handled = "\"handled\":", since_input = ",\"sinceInputMs\":0.0";
    const std::size_t at = text.find(handled + "0,"),
                      second = text.find(since_input, std::min(at, text.size()));
    if (at == std::string::npos || second == std::string::npos)
        throw std::runtime_error("a frame's header has no 'handled' or no 'sinceInputMs'");
    const std::size_t first = at + handled.size();
    return {text.substr(0, first), text.substr(first + 1, second - first - 1),
            text.substr(second + since_input.size())};
}

std::string EncodedFrameHeader::with(std::int64_t handled, std::optional<double> since_input_ms,
                                     Depth depth) const {
    const Parts& parts = parts_.at(static_cast<std::size_t>(depth));
    std::string text = parts.before_handled + std::to_string(handled) + parts.before_since_input;
    if (since_input_ms) text += ",\"sinceInputMs\":" + dump(Json(*since_input_ms));
    text += parts.rest;
    if (text.size() <= kLongestComment) return text;
    return text_of(Json::parse(text));
}

std::size_t comment_offset(std::span<const std::uint8_t> jpeg) {
    constexpr std::size_t kStart = 2;  // SOI
    if (jpeg.size() < kStart + 4 || jpeg[2] != 0xFF || jpeg[3] != 0xE0) return kStart;
    return kStart + 2 + (static_cast<std::size_t>(jpeg[4]) << 8) + jpeg[5];
}

std::vector<std::uint8_t> comment_segment(const std::string& text) {
    if (text.size() > kLongestComment)
        throw std::length_error("a frame header is longer than a COM segment can be");
    const std::size_t length = text.size() + 2;
    std::vector<std::uint8_t> segment(4 + text.size());
    segment[0] = 0xFF;
    segment[1] = 0xFE;
    segment[2] = static_cast<std::uint8_t>(length >> 8);
    segment[3] = static_cast<std::uint8_t>(length & 0xFF);
    std::copy(text.begin(), text.end(), segment.begin() + 4);
    return segment;
}

}  // namespace vrut::protocol
