#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "frame_header.hpp"
#include "scene/camera.hpp"

namespace vrut::server::engine {

/// What of a client's messages a picture shows.
struct Applied {
    std::int64_t id = 0;         ///< the highest id
    std::uint64_t sequence = 0;  ///< the last message
};

/// A picture with what is to be said of it, the same for all clients but for `handled`.
struct Picture {
    protocol::FrameHeader header;
    std::map<std::string, Applied> applied;                    ///< of each client
    std::optional<base::Clock::time_point> newest_input = {};  ///< arrival of the newest input that it shows
    base::Clock::time_point idle_since{};  ///< of one that may wait: the newest change of what it shows
    protocol::ImageFormat format = protocol::ImageFormat::jpeg;
    std::string client = {};  ///< of a snapshot: who asked for it
    /// The frame whose depth is this one's, too; 0: none is known.
    std::int64_t depth_frame = 0;
    std::optional<scene::Camera> ahead = {};  ///< that it is drawn from, with its depth; none: the header's
    bool background_turns = false;            ///< with the camera
};

/// A map of depth as frames hold it.
struct EncodedDepth {
    std::int64_t frame = 0;  ///< for which it was made
    std::vector<std::uint8_t> bytes;
};

struct EncodedPicture : Picture {
    std::vector<std::uint8_t> file;
    std::size_t header_offset = 0;  ///< where the header of each client goes
    protocol::EncodedFrameHeader encoded_header = {};
    std::shared_ptr<const EncodedDepth> depth = {};  ///< null: none

    /// The header as it stands in the file, at header_offset, with these of a client.
    std::vector<std::uint8_t> header_of_file(std::int64_t handled, std::optional<double> since_input_ms,
                                             protocol::EncodedFrameHeader::Depth which) const;
};

}  // namespace vrut::server::engine
