#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "messages.hpp"
#include "state.hpp"

namespace vrut::protocol {

struct Quality {
    bool moving = false;
    double scale = 1;
    int samples = 1;
    int jpeg_quality = 90;
    bool subsampled = false;  ///< 4:2:0, else 4:4:4
    bool operator==(const Quality&) const = default;
};

/// What every frame says about itself.
struct FrameHeader {
    std::int64_t frame = 0, revision = 0, handled = 0;
    CameraState camera;
    glm::dmat4 view_matrix{1}, projection_matrix{1};
    int width = 0, height = 0;  ///< of the picture
    Resize view;
    Quality quality;
    double render_ms = 0, readback_ms = 0, encode_ms = 0;
    std::optional<double> since_input_ms;
};

std::string encode(const FrameHeader& header);

/// Where in a JPEG file a COM segment goes: behind SOI and the JFIF APP0.
std::size_t comment_offset(std::span<const std::uint8_t> jpeg);
/// The COM segment that holds `text` (at most 65,533 bytes).
std::vector<std::uint8_t> comment_segment(const std::string& text);

}  // namespace vrut::protocol
