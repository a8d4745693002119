#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "event_log.hpp"
#include "frame_header.hpp"
#include "messages.hpp"
#include "plan/view.hpp"
#include "server_messages.hpp"

/// Values that a room gives to those around it, who need not know the room.
namespace vrut::server::room {

/// A message to a client; the client must know `revision` of the state first.
struct Answer {
    std::string client, text;
    std::int64_t revision = 0;
    std::string rejection = {};  ///< why, where the message was rejected
    std::string code = {};       ///< of that error
};

/// A picture that somebody asked for beside the live one, as things stood then.
struct PictureOrder {
    std::string client;
    plan::View view;               ///< with its size in pixels
    protocol::FrameHeader header;  ///< but for number, quality and times
    protocol::ImageFormat format = protocol::ImageFormat::jpeg;
    int jpeg_quality = 90;
    std::optional<int> samples = {};  ///< none: as many as at full accuracy
};

/// Where others may watch, for a client that has opened the page at this address; empty: it has not.
using ShareAddress =
    std::function<tl::expected<protocol::SharedAddress, protocol::Error>(const std::string& page)>;

/// A room at one moment, for Room::restore() and, behind it, Room::follow().
struct Checkpoint {
    protocol::LogHeader header;
    protocol::LogLine::Revised revised;
};

}  // namespace vrut::server::room
