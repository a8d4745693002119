#include <algorithm>
#include <cmath>

#include "base/drawing_errors.hpp"
#include "engine/engine.hpp"
#include "observe/log.hpp"

// What it draws, and how accurately.
namespace vrut::server::engine {

namespace {

constexpr std::size_t kFramesRemembered = 64;
/// Of snapshots under way, beside the largest of them: each pixel takes 20 bytes.
constexpr double kPixelsUnderWay = 1 << 21;
/// Whatever its nodes' states are.
std::shared_ptr<const scene::Scene> scene_of(const plan::View& view) {
    return view.scene ? view.scene->scene : nullptr;
}

double pixels_of(const PictureSize& size) { return static_cast<double>(size.width) * size.height; }

/// What the JPEG encoder takes.
plan::RenderJob::Output output_of(const protocol::Quality& quality) {
    using Output = plan::RenderJob::Output;
    return quality.subsampling == protocol::Quality::Subsampling::yuv420 ? Output::ycbcr_420
                                                                         : Output::ycbcr_444;
}

/// Counts a frame that was drawn, and logs it.
void count_frame(const protocol::FrameHeader& drawn, observe::Metrics& metrics, observe::LiveStats& stats) {
    const bool still = drawn.quality.level == protocol::Quality::Level::still;
    ++(still ? metrics.frames_rendered_still : metrics.frames_rendered_moving);
    (still ? metrics.render_still : metrics.render_moving).observe(drawn.timing.render_ms / 1000);
    metrics.readback.observe(drawn.timing.readback_ms / 1000);
    stats.drawn(drawn.quality, drawn.timing.render_ms, base::Clock::now());
    observe::log_debug("frame_drawn", {{"frame", drawn.frame},
                                       {"revision", drawn.revision},
                                       {"quality", still ? "still" : "moving"},
                                       {"width", drawn.width},
                                       {"height", drawn.height},
                                       {"samples", drawn.quality.samples},
                                       {"ms", drawn.timing.render_ms}});
}

}  // namespace

/// The newest frame shows what is to be seen now.
bool Engine::shows_present() const {
    return newest_.frame != 0 && room_->visible() == newest_.visible &&
           room_->view_size() == newest_.view_size && (newest_.depth_frame != 0 || !wants_depth());
}

/// Returns true if frames are to hold depth. Wireframes have none: one sees through them.
bool Engine::wants_depth() const {
    return !room_->state().renderer.wireframe &&
           std::ranges::any_of(clients_, [](const auto& entry) { return entry.second.wanted.depth; });
}

/// Where the camera is expected to be when its holder sees a frame that is begun now; none: where it is.
/// Where anybody does not warp frames, it is drawn where it is, for they would see it sway.
std::optional<scene::Camera> Engine::camera_ahead(std::size_t level, const PictureSize& size) const {
    const std::optional<Link> link = holders_link();
    const bool all_warp = std::ranges::all_of(clients_, [](const auto& entry) {
        const FramesWanted& wanted = entry.second.wanted;
        return wanted.client.empty() || wanted.only_warped;  // hosts ask for none
    });
    if (!link || !all_warp || !wants_depth()) return std::nullopt;
    const PictureCost cost = choice_->expected(level, pixels_of(size), base::Clock::now());
    return motion_.ahead(ms_since_start(), cost.delay_ms(*link));
}

/// Returns true if a client may be sent more frames than there are for it. One from before its last grant
/// will do for it while that shows what is to be seen.
bool Engine::wants_newer(const Client& client) const {
    const auto will_do = [&](std::int64_t frame) {
        return frame > client.wanted.newer_than &&
               (frame >= client.from_frame || (frame == newest_.frame && shows_present()));
    };
    return client.wanted.count > std::count_if(drawn_.begin(), drawn_.end(), will_do);
}

/// Expected of a frame at full accuracy: about as many as of the most accurate interactive one.
double Engine::refined_bytes() const {
    const std::size_t level = choice_->levels().size() - 1;
    const protocol::Resize view_size = room_->view_size();
    const double scale =
        quality_of(choice_->levels()[level].quality, view_size, pixel_budget_, thin_lines()).scale;
    return choice_->expected(level, pixels_of(picture_size(view_size, scale)), base::Clock::now()).bytes;
}

/// How long a frame at full accuracy is expected to be on its way over a slow link, at most a minute; 0 over
/// others. It is held back for as long: a client that moves the view again would wait for it.
base::Clock::duration Engine::refined_delivery(const std::optional<Link>& link) const {
    if (!link) return {};
    const std::chrono::duration<double> takes(refined_bytes() / link->bytes_per_second);
    return takes > kLongDelivery
               ? std::chrono::duration_cast<base::Clock::duration>(
                     std::min<std::chrono::duration<double>>(takes, std::chrono::minutes(1)))
               : base::Clock::duration{};
}

/// Of who steers; none where it is not measured, or nobody who wants frames steers.
std::optional<Link> Engine::holders_link() const {
    const auto holder = clients_.find(room_->holder().value_or(""));
    return holder == clients_.end() ? std::nullopt : holder->second.wanted.link;
}

bool Engine::thin_lines() const {
    const protocol::State& state = room_->state();
    return state.renderer.wireframe || state.renderer.mode == protocol::DrawMode::stylized ||
           (state.renderer.show_selection && state.selection.node);
}

/// Returns true if a sharp frame is long on its way to who steers.
bool Engine::has_slow_link() const { return refined_delivery(holders_link()) > base::Clock::duration{}; }

/// With the error that the table has for such a picture.
protocol::Quality Engine::refined_quality(Refinement refinement) const {
    protocol::Quality quality = kRefined;
    if (refinement == Refinement::small) quality = choice_->levels().front().quality;
    // Over a slow link the first of full size is as coarsely encoded as the best interactive ones: it comes
    // sooner.
    if (refinement == Refinement::first && has_slow_link()) {
        quality.jpeg_quality = choice_->levels().back().quality.jpeg_quality;
        quality.subsampling = choice_->levels().back().quality.subsampling;
    }
    quality = quality_of(quality, room_->view_size(), pixel_budget_, thin_lines());
    quality.level = protocol::Quality::Level::still;
    quality.samples = samples_of(refinement);
    quality.detail = 0;
    quality.error.reset();
    if (thin_lines()) return quality;
    const auto same = [&](const protocol::Level& level) {
        protocol::Quality known = level.quality;
        known.error.reset();
        return known == quality;
    };
    const auto level = std::find_if(refined_levels_.begin(), refined_levels_.end(), same);
    if (level != refined_levels_.end()) quality.error = level->quality.error;
    return quality;
}

std::size_t Engine::choose_level() {
    const protocol::QualityState& wanted = room_->state().quality;
    const auto holder = clients_.find(room_->holder().value_or(""));
    const bool waits = holder != clients_.end() && holder->second.wanted.count > 0;
    const bool warps = holder != clients_.end() && holder->second.wanted.depth && wants_depth();
    const double target = preferred_target(
        warps ? warped_target(wanted.latency_target_ms, holders_link(), motion_.speed(ms_since_start()))
              : wanted.latency_target_ms,
        wanted.preference);
    // The first pictures to a client are small: its link may be slow, and they cannot be taken back.
    if (std::isfinite(target) && waits && !holder->second.wanted.link) return 0;
    return choice_->choose({room_->view_size(), pixel_budget_, target, holders_link()}, base::Clock::now());
}

/// An interactive frame is finished though the camera has moved on: else a camera that never stops would show
/// none.
bool Engine::is_outdated(const FrameUnderWay& frame) const {
    const plan::View& now = room_->visible();
    if (scene_of(now) != scene_of(frame.visible)) return true;
    return frame.refinement != Refinement::none &&
           (now != frame.visible || room_->view_size() != frame.view_size);
}

void Engine::give_up_frame() {
    ++metrics_.frames_interrupted;
    encoder_.give_spare(std::move(frame_->job.image));
    frame_.reset();
}

std::map<std::string, Applied> Engine::applied() const {
    std::map<std::string, Applied> applied;
    for (const auto& [name, client] : clients_) applied[name] = {client.handled, client.sequence};
    return applied;
}

/// Goes on from the newest frame where that shows the same. A frame of full size and full detail keeps its
/// samples, an interactive one, too: its only sample is the first of the refined ones.
plan::RenderJob Engine::begin_job(plan::View view, Refinement refinement) {
    if (refining_) {
        plan::RenderJob job = *std::move(refining_);
        refining_.reset();
        plan::View same =
            view;  // but for the samples; levels of detail change nothing where all triangles are drawn
        same.samples = job.view.samples;
        same.levels = job.view.levels;
        if (same == job.view && view.samples >= job.samples) {
            job.refine(view.samples, encoder_.take_spare());
            return job;
        }
    }
    const bool goes_on = refinement == Refinement::first || refinement == Refinement::better ||
                         (refinement == Refinement::none && view.detail == 0 &&
                          PictureSize{view.width, view.height} ==
                              picture_size(room_->view_size(), refined_quality(Refinement::first).scale));
    return plan::RenderJob(std::move(view), encoder_.take_spare(),
                           goes_on ? plan::RenderJob::Keep::samples : plan::RenderJob::Keep::image);
}

/// What is drawn is what stands here now, whatever comes in between two steps.
void Engine::begin_frame(Refinement refinement) {
    const protocol::Resize view_size = room_->view_size();
    const bool still = refinement != Refinement::none;
    const std::size_t level = still ? 0 : choose_level();
    const protocol::Quality quality =
        still ? refined_quality(refinement)
              : quality_of(choice_->levels()[level].quality, view_size, pixel_budget_, thin_lines());
    const PictureSize size = picture_size(view_size, quality.scale);
    const plan::View visible = room_->visible();
    plan::View view = visible;
    view.width = size.width;
    view.height = size.height;
    view.samples = quality.samples;
    view.detail = quality.detail;
    view.levels = detail_;

    Picture picture;
    picture.header = room::header_of(room_->state(), view, view_size);
    picture.header.revision = room_->document()->revision();
    picture.header.lease = lease_;
    picture.header.quality = quality;
    picture.background_turns = visible.background.shows_cube_map();
    picture.newest_input = newest_input_;
    // A small one that shows something new delays nobody longer than an interactive frame.
    if (still && (shows_present() || refinement != Refinement::small)) picture.idle_since = last_change_;
    picture.applied = applied();
    if (!still) picture.ahead = camera_ahead(level, size);
    view.camera = picture.ahead.value_or(view.camera);
    if (!still) {
        picture.header.frame = next_frame_;
        room_->remember(next_frame_++);  // with the camera as it is now
    }
    try {
        frame_.emplace(FrameUnderWay{std::move(picture), visible, view_size, refinement, level,
                                     begin_job(std::move(view), refinement)});
        frame_->job.interactive = !still;
        frame_->job.output = output_of(quality);
        const bool known = newest_.depth_frame != 0 && !frame_->picture.ahead && shows_present();
        if (known) frame_->picture.depth_frame = newest_.depth_frame;
        if (!known && wants_depth())
            frame_->job.depth_size = warp::depth_map_size(size.width, size.height, blocks_.pixels());
    } catch (const std::bad_alloc&) {
        draw_smaller({visible, view_size}, size, "there is no memory to draw it");
    }
}

void Engine::draw_frame() {
    try {
        if (draw(frame_->job) == Drawn::whole) finish_frame();
    } catch (const vrut::base::OutOfMemory& error) {
        const FrameUnderWay frame = *std::exchange(frame_, std::nullopt);
        draw_smaller({frame.visible, frame.view_size}, {frame.job.view.width, frame.job.view.height},
                     error.what());
    } catch (const std::bad_alloc&) {
        const FrameUnderWay frame = *std::exchange(frame_, std::nullopt);
        draw_smaller({frame.visible, frame.view_size}, {frame.job.view.width, frame.job.view.height},
                     "there is no memory to draw it");
    } catch (const std::exception& error) {
        failed_ = Failed{frame_->visible, frame_->view_size};
        frame_.reset();
        notice({protocol::notice_code::not_drawn, std::string("This view cannot be drawn: ") + error.what()});
    }
}

void Engine::finish_frame() {
    FrameUnderWay frame = *std::exchange(frame_, std::nullopt);
    protocol::FrameHeader& header = frame.picture.header;
    if (frame.refinement != Refinement::none) {
        header.frame = next_frame_;
        room_->remember(next_frame_++);
        // It shows what came meanwhile, too: that changed nothing.
        frame.picture.applied = applied();
    }
    warp::DepthMap depth = std::exchange(frame.job.depth, {});
    const bool is_new = depth.columns > 0 || frame.picture.depth_frame == 0;
    if (frame.job.depth_size.columns > 0 && is_new) frame.picture.depth_frame = header.frame;
    before_newest_ = newest_;
    frame.visible.camera = frame.job.view.camera;
    newest_ = {header.frame, frame.visible, frame.view_size, frame.refinement, frame.picture.depth_frame};
    drawn_.push_back(header.frame);
    if (drawn_.size() > kFramesRemembered) drawn_.pop_front();
    const plan::FrameStats& stats = frame.job.stats;
    header.timing.render_ms = stats.render_ms;
    header.timing.readback_ms = stats.readback_ms;
    count_frame(header, metrics_, stats_);
    if (frame.refinement == Refinement::none) {
        in_flight_.push_back({header.frame, frame.level, pixels_of({header.width, header.height}),
                              stats.render_ms + stats.readback_ms});
        if (in_flight_.size() > kFramesRemembered) in_flight_.pop_front();
    }
    encoder_.offer(std::move(frame.picture), std::move(frame.job.image), std::move(frame.job.planes),
                   std::move(depth));
    refining_.reset();
    if (frame.job.keep == plan::RenderJob::Keep::samples && frame.refinement != Refinement::sharp &&
        stats.substitutes == 0)
        refining_ = std::move(frame.job);
}

/// The clients in turn. A snapshot is begun where those under way, the largest left out, take few pixels: a
/// large one waits for another large one, and a small one for neither.
std::deque<Engine::Snapshot>::iterator Engine::next_snapshot() {
    const auto pixels = [](const Snapshot& snapshot) {
        return pixels_of({snapshot.order.header.width, snapshot.order.header.height});
    };
    double begun = 0, largest = 0;
    for (const Snapshot& snapshot : snapshots_) {
        if (!snapshot.job) continue;
        begun += pixels(snapshot);
        largest = std::max(largest, pixels(snapshot));
    }
    return std::find_if(snapshots_.begin(), snapshots_.end(), [&](const Snapshot& snapshot) {
        return snapshot.job ||
               begun + pixels(snapshot) - std::max(largest, pixels(snapshot)) <= kPixelsUnderWay;
    });
}

/// Draws on a snapshot that waits, one step; the next has its turn then.
void Engine::draw_snapshot() {
    const auto next = next_snapshot();
    Snapshot snapshot = std::move(*next);
    snapshots_.erase(next);
    Drawn drawn = Drawn::part;
    try {
        if (!snapshot.job) {
            plan::View view = snapshot.order.view;
            view.samples = snapshot.order.samples.value_or(kRefined.samples);
            snapshot.job.emplace(std::move(view), snapshot_encoder_.take_spare());
            if (snapshot.order.format == protocol::ImageFormat::jpeg)
                snapshot.job->output = output_of(kRefined);
        }
        drawn = draw(*snapshot.job);
    } catch (const vrut::base::OutOfMemory& error) {
        return reject(snapshot, error.what());
    } catch (const std::bad_alloc&) {
        return reject(snapshot, "there is no memory to draw it");
    } catch (const std::exception& error) {
        return reject(snapshot, std::string("the image cannot be drawn: ") + error.what());
    }
    if (drawn == Drawn::whole) return finish_snapshot(std::move(snapshot));
    if (drawn == Drawn::lost && ++snapshot.losses == kMostLosses)
        return reject(snapshot, "the graphics driver is lost whenever this image is drawn");
    // Behind those of others, before further ones of its own client.
    const auto own = std::stable_partition(snapshots_.begin(), snapshots_.end(), [&](const Snapshot& other) {
        return other.order.client != snapshot.order.client;
    });
    snapshots_.insert(own, std::move(snapshot));
}

void Engine::finish_snapshot(Snapshot snapshot) {
    ++metrics_.snapshots_rendered;
    Picture picture;
    picture.header = std::move(snapshot.order.header);
    picture.header.lease = lease_;
    picture.header.quality = kRefined;
    picture.header.quality.samples = snapshot.job->view.samples;
    picture.header.quality.jpeg_quality = snapshot.order.jpeg_quality;
    picture.header.timing.render_ms = snapshot.job->stats.render_ms;
    picture.header.timing.readback_ms = snapshot.job->stats.readback_ms;
    picture.header.frame = next_frame_++;
    picture.format = snapshot.order.format;
    picture.client = snapshot.order.client;
    snapshot_encoder_.offer(std::move(picture), std::move(snapshot.job->image),
                            std::move(snapshot.job->planes));
}

}  // namespace vrut::server::engine
