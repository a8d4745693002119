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
#include "engine/images.hpp"
#include "engine/picture.hpp"
#include "observe/metrics.hpp"
#include "scene/image.hpp"
#include "warp/depth_map.hpp"

namespace vrut::server::engine {

/// A picture that is counted as long as anybody holds it. It may not outlive `metrics`, and what its file
/// takes is to be added to Metrics::bytes_held.
std::shared_ptr<EncodedPicture> counted_picture(observe::Metrics& metrics);

/// The encode thread: one picture waits at most.
class Encoder {
public:
    /// All are called on the encode thread: `on_encoded` with each picture, or `on_failed` where it cannot be
    /// encoded, and `on_free` when the next may be offered. Pictures may not outlive `metrics`.
    Encoder(observe::Metrics& metrics, std::function<void(std::shared_ptr<const EncodedPicture>)> on_encoded,
            std::function<void()> on_free, std::function<void(Picture, std::string why)> on_failed);
    ~Encoder();
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;

    /// Nothing more is encoded, but for what is in hand; the destructor waits for that.
    void stop();
    bool is_free() const;
    /// How long it has worked at one picture; 0 while it has none. From any thread.
    base::Clock::duration busy_for() const { return watchdog_.busy_for(); }
    /// Only while is_free(). `planes` are encoded if there are any, else the image. A picture without a
    /// `depth` gets the last one, if that is of its `depth_frame`.
    void offer(Picture picture, scene::Image image, scene::PlanarImage planes = {},
               warp::DepthMap depth = {});
    /// An image to draw into, used before where possible: its pages are there already.
    scene::Image take_spare();
    void give_spare(scene::Image image);

private:
    struct Job {
        Picture picture;
        scene::Image image;
        scene::PlanarImage planes;
        warp::DepthMap depth;
    };
    void run();
    std::shared_ptr<EncodedPicture> encode(Job& job);
    void encode_depth(const warp::DepthMap& map, Picture& picture, EncodedPicture& encoded);

    observe::Metrics& metrics_;
    std::function<void(std::shared_ptr<const EncodedPicture>)> on_encoded_;
    std::function<void()> on_free_;
    std::function<void(Picture, std::string)> on_failed_;
    mutable std::mutex mutex_;
    std::condition_variable condition_;
    std::optional<Job> slot_;
    scene::Image spare_;
    bool closed_ = false;
    base::Watchdog watchdog_;
    std::shared_ptr<const EncodedDepth> depth_;  // the last; of the encode thread
    protocol::FrameHeader::Depth depth_header_;
    JpegEncoder jpeg_;    // of the encode thread; its own threads are there from the start
    std::thread thread_;  // last: it uses all of the above
};

}  // namespace vrut::server::engine
