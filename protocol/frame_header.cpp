#include "frame_header.hpp"

#include <algorithm>
#include <stdexcept>

#include "descriptions.hpp"

namespace vrut::protocol {

namespace {

constexpr std::size_t kLongestComment = 65'533;

}  // namespace

std::string encode(const FrameHeader& header) {
    Json json = write_struct(header);
    std::string text = dump(json);
    if (text.size() > kLongestComment && json.erase("markers") > 0) text = dump(json);
    // Of the others, the only one without a bound.
    if (text.size() > kLongestComment && json["camera"].erase("name") > 0) text = dump(json);
    return text;
}

EncodedFrameHeader::EncodedFrameHeader(const FrameHeader& header) : header_(header) {
    header_.handled = 0;
    header_.timing.since_input_ms = 0;
    // Quotes within a name are escaped, so that neither of the two stands elsewhere.
    const std::string text = dump(write_struct(header_)),
                      handled = "\"handled\":", since_input = ",\"sinceInputMs\":0.0";
    const std::size_t first = text.find(handled + "0,") + handled.size(),
                      second = text.find(since_input, first);
    before_handled_ = text.substr(0, first);
    before_since_input_ = text.substr(first + 1, second - first - 1);
    rest_ = text.substr(second + since_input.size());
}

std::string EncodedFrameHeader::with(std::int64_t handled, std::optional<double> since_input_ms) const {
    std::string text = before_handled_ + std::to_string(handled) + before_since_input_;
    if (since_input_ms) text += ",\"sinceInputMs\":" + dump(Json(*since_input_ms));
    text += rest_;
    if (text.size() <= kLongestComment) return text;
    FrameHeader shorter = header_;
    shorter.handled = handled;
    shorter.timing.since_input_ms = since_input_ms;
    return encode(shorter);
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
