#include "engine/encoder.hpp"

#include <cassert>

#include "engine/images.hpp"
#include "room/scene_state.hpp"

namespace vrut::server::engine {

namespace {

// With its header it is no longer than a message may be.
constexpr std::size_t kLargestPicture = protocol::kMaxServerMessageBytes - 65'600;

}  // namespace

std::shared_ptr<EncodedPicture> counted_picture(observe::Metrics& metrics) {
    const std::uint64_t held = ++metrics.pictures_held;
    std::uint64_t most = metrics.pictures_held_most;
    while (held > most && !metrics.pictures_held_most.compare_exchange_weak(most, held)) {
    }
    return {new EncodedPicture, [&metrics](EncodedPicture* picture) {
                metrics.bytes_held -= picture->file.capacity();
                --metrics.pictures_held;
                delete picture;
            }};
}

std::vector<std::uint8_t> EncodedPicture::header_of_file(std::int64_t handled,
                                                         std::optional<double> since_input_ms,
                                                         protocol::EncodedFrameHeader::Depth which) const {
    const std::string text = encoded_header.with(handled, since_input_ms, which);
    return format == protocol::ImageFormat::png ? png_text_chunk(text) : protocol::comment_segment(text);
}

Encoder::Encoder(observe::Metrics& metrics,
                 std::function<void(std::shared_ptr<const EncodedPicture>)> on_encoded,
                 std::function<void()> on_free, std::function<void(Picture, std::string)> on_failed)
    : metrics_(metrics),
      on_encoded_(std::move(on_encoded)),
      on_free_(std::move(on_free)),
      on_failed_(std::move(on_failed)),
      thread_([this] { run(); }) {}

Encoder::~Encoder() {
    stop();
    thread_.join();
}

void Encoder::stop() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
    }
    condition_.notify_one();
}

bool Encoder::is_free() const {
    const std::lock_guard lock(mutex_);
    return !slot_;
}

void Encoder::offer(Picture picture, scene::Image image, scene::PlanarImage planes, warp::DepthMap depth) {
    {
        const std::lock_guard lock(mutex_);
        assert(!slot_);
        slot_.emplace(Job{std::move(picture), std::move(image), std::move(planes), std::move(depth)});
    }
    condition_.notify_one();
}

scene::Image Encoder::take_spare() {
    const std::lock_guard lock(mutex_);
    return std::exchange(spare_, {});
}

void Encoder::give_spare(scene::Image image) {
    const std::lock_guard lock(mutex_);
    spare_ = std::move(image);
}

/// Refinements show what the frame before them showed.
void Encoder::encode_depth(const warp::DepthMap& map, Picture& picture, EncodedPicture& encoded) {
    static_assert(warp::kMostBlocks <= protocol::kMostDepthBlocks);
    protocol::FrameHeader& header = picture.header;
    if (map.columns > 0) {
        const std::string bytes = warp::encode(map);
        depth_ =
            std::make_shared<const EncodedDepth>(EncodedDepth{header.frame, {bytes.begin(), bytes.end()}});
        depth_header_ = {header.frame,
                         map.columns,
                         map.rows,
                         map.scale,
                         picture.background_turns,
                         picture.ahead ? std::optional(room::pose_of(*picture.ahead)) : std::nullopt,
                         static_cast<std::int64_t>(bytes.size())};
        picture.depth_frame = header.frame;
    }
    if (!depth_ || depth_->frame != picture.depth_frame) return;
    encoded.depth = depth_;
    header.depth = depth_header_;
}

std::shared_ptr<EncodedPicture> Encoder::encode(Job& job) {
    Picture& picture = job.picture;
    const base::Clock::time_point start = base::Clock::now();
    std::shared_ptr<EncodedPicture> encoded = counted_picture(metrics_);
    const protocol::Quality& quality = picture.header.quality;
    if (picture.format == protocol::ImageFormat::png) {
        encoded->file = io::encode_png(job.image);
        encoded->header_offset = kPngTextOffset;
    } else {
        encoded->file = job.planes.bytes.empty()
                            ? jpeg_.encode(job.image, quality.jpeg_quality,
                                           quality.subsampling == protocol::Quality::Subsampling::yuv420)
                            : jpeg_.encode(job.planes, quality.jpeg_quality);
        encoded->header_offset = protocol::comment_offset(encoded->file);
    }
    metrics_.bytes_held += encoded->file.capacity();
    encode_depth(job.depth, picture, *encoded);
    const std::size_t with_depth = encoded->file.size() + (encoded->depth ? encoded->depth->bytes.size() : 0);
    if (with_depth > kLargestPicture)
        throw std::runtime_error("it takes " + std::to_string(with_depth) +
                                 " bytes, more than a message of this server may (maxServerMessage)");
    double& encode_ms = picture.header.timing.encode_ms;
    encode_ms = std::chrono::duration<double, std::milli>(base::Clock::now() - start).count();
    metrics_.encode.observe(encode_ms / 1000);
    encoded->encoded_header = protocol::EncodedFrameHeader(picture.header);
    static_cast<Picture&>(*encoded) = std::move(picture);
    ++metrics_.frames_encoded;
    metrics_.bytes_encoded += encoded->file.size();
    return encoded;
}

void Encoder::run() {
    for (;;) {
        std::optional<Job> job;
        watchdog_.idle();
        {
            std::unique_lock lock(mutex_);
            condition_.wait(lock, [&] { return slot_ || closed_; });
            if (closed_) return;
            job.swap(slot_);
        }
        watchdog_.busy();
        on_free_();
        try {
            on_encoded_(encode(*job));
        } catch (const std::bad_alloc&) {
            on_failed_(std::move(job->picture), "there is no memory to encode it");
        } catch (const std::exception& error) {
            on_failed_(std::move(job->picture), error.what());
        }
        give_spare(std::move(job->image));
    }
}

}  // namespace vrut::server::engine
