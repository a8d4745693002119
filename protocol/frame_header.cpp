#include "frame_header.hpp"

#include <algorithm>
#include <stdexcept>

#include "json_reader.hpp"
#include "state_json.hpp"

namespace vrut::protocol {

std::string encode(const FrameHeader& header) {
    Json camera = section_json(header.camera);
    camera["viewMatrix"] = to_json(header.view_matrix);
    camera["projectionMatrix"] = to_json(header.projection_matrix);
    Json timing = {
        {"renderMs", header.render_ms}, {"readbackMs", header.readback_ms}, {"encodeMs", header.encode_ms}};
    if (header.since_input_ms) timing["sinceInputMs"] = *header.since_input_ms;
    const Quality& quality = header.quality;
    return dump({{"frame", header.frame},
                 {"revision", header.revision},
                 {"handled", header.handled},
                 {"camera", std::move(camera)},
                 {"width", header.width},
                 {"height", header.height},
                 {"view",
                  {{"width", header.view.width},
                   {"height", header.view.height},
                   {"pixelRatio", header.view.pixel_ratio}}},
                 {"renderer", {{"mode", "realistic"}, {"wireframe", false}, {"showSelection", false}}},
                 {"quality",
                  {{"level", quality.moving ? "moving" : "still"},
                   {"scale", quality.scale},
                   {"samples", quality.samples},
                   {"detail", 0},
                   {"jpegQuality", quality.jpeg_quality},
                   {"subsampling", quality.subsampled ? "4:2:0" : "4:4:4"}}},
                 {"timing", std::move(timing)}});
}

std::size_t comment_offset(std::span<const std::uint8_t> jpeg) {
    constexpr std::size_t kStart = 2;  // SOI
    if (jpeg.size() < kStart + 4 || jpeg[2] != 0xFF || jpeg[3] != 0xE0) return kStart;
    return kStart + 2 + (static_cast<std::size_t>(jpeg[4]) << 8) + jpeg[5];
}

std::vector<std::uint8_t> comment_segment(const std::string& text) {
    constexpr std::size_t kLongest = 65'533;
    if (text.size() > kLongest) throw std::length_error("a frame header is longer than a COM segment can be");
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
