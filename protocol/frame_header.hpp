#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "messages.hpp"
#include "state.hpp"

namespace vrut::protocol {

/// What every frame says about itself.
struct FrameHeader {
    struct Camera {
        CameraState pose;
        glm::dmat4 view_matrix{1}, projection_matrix{1};
    };
    struct Renderer {
        DrawMode mode = DrawMode::realistic;
        bool wireframe = false, show_selection = true;
    };
    struct Timing {
        double render_ms = 0, readback_ms = 0, encode_ms = 0;
        std::optional<double> since_input_ms;
    };
    std::int64_t frame = 0, revision = 0, handled = 0;
    std::optional<std::int64_t> snapshot;  ///< id of the message that asked for it
    std::optional<std::uint64_t> lease;    ///< of the server, where several share the room
    Camera camera;
    int width = 0, height = 0;  ///< of the frame
    Resize view;
    Renderer renderer;
    Quality quality;
    Timing timing;
    std::map<std::string, glm::dvec3> markers;  ///< where the signs stand in the world, by name
};

/// At most 65,533 bytes: where it would be longer, `markers` are left out, and then a camera's name.
std::string encode(const FrameHeader& header);

/// A header that is encoded once for all clients but for what differs among them.
class EncodedFrameHeader {
public:
    EncodedFrameHeader() = default;
    explicit EncodedFrameHeader(const FrameHeader& header);
    /// From text(); throws std::runtime_error if it is not one.
    explicit EncodedFrameHeader(const std::string& text);
    /// With `handled` 0 and `sinceInputMs` 0.
    std::string text() const { return with(0, 0.0); }
    /// As encode() of the header with these two of a client.
    std::string with(std::int64_t handled, std::optional<double> since_input_ms) const;

private:
    std::string before_handled_, before_since_input_, rest_;
};

/// Where in a JPEG file a COM segment goes: behind SOI and the JFIF APP0.
std::size_t comment_offset(std::span<const std::uint8_t> jpeg);
/// The COM segment that holds `text` (at most 65,533 bytes).
std::vector<std::uint8_t> comment_segment(const std::string& text);

}  // namespace vrut::protocol
