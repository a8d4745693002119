#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/frame_quality.hpp"
#include "engine/picture.hpp"
#include "room/answers.hpp"
#include "state.hpp"
#include "state_document.hpp"

namespace vrut::server::engine {

/// What the render thread sends to the net thread after it has handled a batch of events.
struct EngineOutput {
    bool begins_anew = false;  ///< what clients have of the room leads nowhere: they have to come again
    std::shared_ptr<const protocol::StateDocument> document;  ///< the newest; null if unchanged
    std::string by;  ///< who made it and the revisions before it, down to by_since; empty: the server
    std::int64_t by_since = 0;
    std::vector<room::Answer> answers;
    bool again = false;                        ///< another server may have given some of the answers
    std::vector<std::string> failed_pictures;  ///< whose picture cannot be drawn (PictureAsked::name)
    struct Handled {
        std::size_t bytes = 0, requests = 0;
        std::uint64_t sequence = 0;  ///< of the last
    };
    std::map<std::string, Handled> handled;  ///< of messages, for each client
    std::optional<PictureSize> size;         ///< of a picture of the view; none if unchanged
    /// Number of the frame that shows what is to be seen now, 0 if none does; none if unchanged.
    std::optional<std::int64_t> present_frame;
    std::shared_ptr<const std::string> stats, loading;  ///< messages for all; null if there is nothing new
    bool loads = false;                                 ///< with `loading`: it goes on
    /// Messages for all: the newest of what each client points at.
    std::map<std::string, std::shared_ptr<const std::string>> pointed;

    bool empty() const {
        return !document && answers.empty() && failed_pictures.empty() && handled.empty() && !size &&
               !present_frame && !stats && !loading && pointed.empty();
    }
};

struct EngineCallbacks {
    std::function<void(EngineOutput)> on_output;  ///< on the render thread
    /// Frames and snapshots (which have a `client`), on an encode thread.
    std::function<void(std::shared_ptr<const EncodedPicture>)> on_encoded;
    std::function<void(const std::string& why)> on_failure;  ///< on any of them: nothing more will be drawn
};

}  // namespace vrut::server::engine
