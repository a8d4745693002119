#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "messages.hpp"
#include "state.hpp"

namespace vrut::protocol {

/// A map of depth has at most so many blocks in a row, and so many rows.
inline constexpr int kMostDepthBlocks = 160;

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
    /// Of a map of depth (warp::DepthMap).
    struct Depth {
        std::int64_t frame = 0;  ///< for which it was made
        int columns = 0, rows = 0;
        double scale = 0;
        bool background_turns = false;  ///< with the camera
        std::optional<Pose> camera;     ///< that it and the image were drawn from; none: the header's
        std::int64_t bytes = 0;         ///< behind the file
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
    std::optional<Depth> depth;
    std::map<std::string, glm::dvec3> markers;  ///< where the signs stand in the world, by name
};

/// At most 65,533 bytes: where it would be longer, `markers` are left out, and then a camera's name.
std::string encode(const FrameHeader& header);

/// A header that is encoded once for all clients but for what differs among them.
class EncodedFrameHeader {
public:
    /// What a client gets of `depth`: nothing, the member with 0 bytes, or with the map's.
    enum class Depth { none, known, sent };

    EncodedFrameHeader() = default;
    explicit EncodedFrameHeader(const FrameHeader& header);
    /// From text(); throws std::runtime_error if it is not one.
    explicit EncodedFrameHeader(const std::string& text);
    /// With `handled` 0 and `sinceInputMs` 0.
    std::string text() const { return with(0, 0.0, Depth::sent); }
    /// As encode() of the header with these of a client.
    std::string with(std::int64_t handled, std::optional<double> since_input_ms, Depth depth) const;

private:
    /// Of the text.
    struct Parts {
        std::string before_handled, before_since_input, rest;
    };
    static Parts parts_of(const std::string& text);

    std::array<Parts, 3> parts_;  // by Depth
};

/// Where in a JPEG file a COM segment goes: behind SOI and the JFIF APP0.
std::size_t comment_offset(std::span<const std::uint8_t> jpeg);
/// The COM segment that holds `text` (at most 65,533 bytes).
std::vector<std::uint8_t> comment_segment(const std::string& text);

}  // namespace vrut::protocol
