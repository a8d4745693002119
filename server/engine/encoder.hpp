#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "base/watchdog.hpp"
#include "engine/pacing.hpp"
#include "frame_header.hpp"
#include "image.hpp"
#include "observe/metrics.hpp"

namespace vrut::server::engine {

/// A picture with what is to be said of it, the same for all clients but for `handled`.
struct Picture {
    protocol::FrameHeader header;
    std::map<std::string, std::int64_t>
        handled;  ///< for each client, its highest message id that the picture shows
    std::optional<base::Clock::time_point> newest_input;  ///< arrival of the newest input that it shows
    protocol::ImageFormat format = protocol::ImageFormat::jpeg;
    std::string client;  ///< of a snapshot: who asked for it
};

struct EncodedPicture : Picture {
    std::vector<std::uint8_t> file;
    std::size_t header_offset = 0;  ///< where the header of each client goes
};

/// `header` as it stands in the picture's file, at header_offset.
std::vector<std::uint8_t> header_of_file(const EncodedPicture& picture, const protocol::FrameHeader& header);

/// The encode thread: one picture waits at most.
class Encoder {
public:
    /// All are called on the encode thread: `on_encoded` with each picture, `on_free` when the next may be
    /// offered, `on_failure` when there will be no more. Pictures may not outlive `metrics`.
    Encoder(observe::Metrics& metrics, std::function<void(std::shared_ptr<const EncodedPicture>)> on_encoded,
            std::function<void()> on_free, std::function<void(const std::string&)> on_failure);
    ~Encoder();
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;

    bool is_free() const;
    /// How long it has worked at one picture; 0 while it has none. From any thread.
    base::Clock::duration silence() const { return heart_.silence(); }
    /// Only while is_free().
    void offer(Picture picture, Image image);
    /// An image to draw into, used before where possible: its pages are there already.
    Image take_spare();
    void give_spare(Image image);

private:
    void run();

    observe::Metrics& metrics_;
    std::function<void(std::shared_ptr<const EncodedPicture>)> on_encoded_;
    std::function<void()> on_free_;
    std::function<void(const std::string&)> on_failure_;
    mutable std::mutex mutex_;
    std::condition_variable condition_;
    std::optional<std::pair<Picture, Image>> slot_;
    Image spare_;
    bool closed_ = false;
    base::Heartbeat heart_;
    std::thread thread_;  // last: it uses all of the above
};

}  // namespace vrut::server::engine
