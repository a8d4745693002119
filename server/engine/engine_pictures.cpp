#include <cmath>

#include "drawing_errors.hpp"
#include "engine/engine.hpp"
#include "observe/log.hpp"

// What it draws, and when.
namespace vrut::server::engine {

namespace {

constexpr std::size_t kBegunRemembered = 512;  // others may get many while a slow client gets one
/// A picture that takes longer to arrive is on its way alone.
constexpr std::chrono::milliseconds kLongDelivery{500};
/// One at rest that takes longer is held back for as long as it takes: whoever moves again would wait for it.
constexpr std::chrono::seconds kLongDeliveryAtRest{2};
/// So long at most until the first picture has told.
constexpr std::chrono::seconds kUntilItTells{5};
/// So long at most where TCP has pictures acknowledged quickly: it may be the client that takes its time.
constexpr std::chrono::milliseconds kUnsure{2500};

/// Whatever its nodes' states are.
std::shared_ptr<const Scene> scene_of(const View& view) { return view.scene ? view.scene->scene : nullptr; }

base::Clock::duration milliseconds(double ms) {
    return std::chrono::duration_cast<base::Clock::duration>(std::chrono::duration<double, std::milli>(ms));
}

/// A picture that was drawn, to who watches the server.
void tell_of(const protocol::FrameHeader& drawn, observe::Metrics& metrics, observe::LiveStats& stats) {
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

bool Engine::shows_present() const {
    return drawn_.frame != 0 && presentation_->visible() == drawn_.visible &&
           presentation_->view_size() == drawn_.view_size;
}

/// How long a whole picture at rest is expected to be on its way to who steers; 0 where that is not known.
base::Clock::duration Engine::delivery_at_rest() const {
    const auto holder = clients_.find(presentation_->holder().value_or(""));
    if (holder == clients_.end() || holder->second.last_frame == 0) return {};
    const Client& client = holder->second;
    if (holder->first != measured_by_) {
        const bool will_tell = std::any_of(begun_.begin(), begun_.end(), [&](const Begun& begun) {
            return begun.frame > client.answered && begun.frame <= client.last_frame;
        });
        return will_tell ? kUntilItTells : base::Clock::duration{};
    }
    // Not 0, since the other end of a quick link may be a proxy.
    const base::Clock::duration delivery = delivery_of(choice_->levels().size() - 1);
    return client.is_late ? delivery : std::min<base::Clock::duration>(delivery, kUnsure);
}

/// How long a picture of a level is expected to be on its way to who steers; 0 where that is not known.
base::Clock::duration Engine::delivery_of(std::size_t level) const {
    if (presentation_->holder() != measured_by_) return {};
    const protocol::Resize view_size = presentation_->view_size();
    const PictureSize size = picture_size(
        view_size, quality_of(choice_->levels()[level].quality, view_size, room_, thin_lines()).scale);
    const double pixels = static_cast<double>(size.width) * size.height;
    return milliseconds(choice_->expected(level, pixels, base::Clock::now()).client.value_or(0));
}

/// How long a moving picture is expected to be on its way to who steers; 0 where that is not known.
base::Clock::duration Engine::delivery_of_moving() const {
    return begun_.empty() ? base::Clock::duration{} : delivery_of(begun_.back().level);
}

/// Whether there is no picture for this client yet, of so many samples where it is one at rest: over a slow
/// link one is on its way at a time, and a large one only when the view has rested.
bool Engine::is_held(const std::string& name, const Client& client, int still_samples,
                     base::Clock::time_point now) const {
    if (name != presentation_->holder()) return false;
    const base::Clock::duration moving = delivery_of_moving();
    if (moving > kLongDelivery && client.last_frame > client.answered &&
        now - client.promised_at < 2 * moving)
        return true;
    if (still_samples < kStillSamples.back() || client.last_frame < present_since_) return false;
    const base::Clock::duration at_rest = delivery_at_rest();
    return at_rest > kLongDeliveryAtRest && now - last_change_ < at_rest;
}

bool Engine::waits_for_newer(const std::string& name, const Client& client,
                             base::Clock::time_point now) const {
    const bool next_is_last = shows_present() && drawn_.still_samples > 0;
    if (client.grants == 0 || is_held(name, client, next_is_last ? kStillSamples.back() : 0, now))
        return false;
    return !shows_present() || client.last_frame != drawn_.frame ||
           drawn_.still_samples < kStillSamples.back();
}

bool Engine::thin_lines() const {
    const protocol::State& state = presentation_->state();
    return state.renderer.wireframe || state.renderer.mode == protocol::DrawMode::stylized ||
           (state.renderer.show_selection && state.selection.node);
}

/// Clients that have not got the newest picture, which shows what is to be seen, get that; no drawing is
/// needed.
void Engine::serve_newest(base::Clock::time_point now) {
    if (!shows_present()) return;
    for (auto& [name, client] : clients_) {
        if (client.grants == 0 || client.last_frame == drawn_.frame ||
            is_held(name, client, drawn_.still_samples, now))
            continue;
        client.owe(drawn_.frame, now);
        output_.owed.push_back({name, drawn_.frame});
    }
}

PacingDecision Engine::pace(base::Clock::time_point now) {
    PacingInput input;
    for (const auto& [name, client] : clients_)
        input.somebody_waits =
            input.somebody_waits || (waits_for_newer(name, client, now) && !is_undrawable());
    input.changed = !shows_present();
    input.newest_samples = drawn_.still_samples;
    input.encoder_free = encoder_.is_free();
    input.last_change = last_change_;
    input.now = now;
    PacingDecision decision = decide(input);
    // Who waits for a picture that is held may have it later.
    const auto look_again = [&](base::Clock::time_point at) {
        if (decision.action == PacingDecision::Action::wait && at > now)
            decision.until = std::min(decision.until.value_or(at), at);
    };
    look_again(last_change_ + delivery_at_rest());
    if (const auto holder = clients_.find(presentation_->holder().value_or("")); holder != clients_.end())
        look_again(holder->second.promised_at + 2 * delivery_of_moving());
    return decision;
}

/// What a moving frame took, from the begin of its drawing until its client, who steers, asked for the next.
/// A client that slept makes no more of it than a link that is slow.
void Engine::measure(const FrameSent& sent, base::Clock::time_point asked) {
    constexpr std::chrono::seconds kAsleep{5};
    if (sent.newest_input > measured_input_ && asked - *sent.newest_input < kAsleep)
        metrics_.input_to_grant.observe(std::chrono::duration<double>(asked - *sent.newest_input).count());
    measured_input_ = std::max(measured_input_, sent.newest_input.value_or(measured_input_));
    for (const Begun& begun : begun_)
        if (begun.frame == sent.frame && asked > begun.at) {
            const double all = std::chrono::duration<double, std::milli>(
                                   std::min<base::Clock::duration>(asked - begun.at, kAsleep))
                                   .count();
            const double server = std::min(begun.drawn_ms + sent.encode_ms, all);
            // No level makes the way itself shorter.
            const double way = std::chrono::duration<double, std::milli>(sent.round_trip).count();
            choice_->took(begun.level, {server, std::max(0.0, all - server - way)}, begun.pixels, asked);
            measured_by_ = sent.client;
        }
}

void Engine::promise(std::int64_t frame, int still_samples) {
    const base::Clock::time_point now = base::Clock::now();
    for (auto& [name, client] : clients_) {
        if (client.grants == 0 || is_held(name, client, still_samples, now)) continue;
        client.owe(frame, now);
        output_.owed.push_back({name, frame});
    }
}

/// With the error that the table has for such a picture.
protocol::Quality Engine::quality_at_rest(int samples) const {
    if (samples < kStillSamples.back() && delivery_at_rest() > kLongDeliveryAtRest) {
        protocol::Quality quality =
            quality_of(choice_->levels()[begun_.empty() ? 0 : begun_.back().level].quality,
                       presentation_->view_size(), room_, thin_lines());
        quality.level = protocol::Quality::Level::still;
        quality.samples = samples;
        quality.detail = 0;
        quality.error.reset();
        return quality;
    }
    protocol::Quality quality = quality_of(kStill, presentation_->view_size(), room_, thin_lines());
    quality.samples = samples;
    if (thin_lines()) return quality;
    for (const protocol::Level& level : at_rest_) {
        quality.error = level.quality.error;
        if (level.quality == quality) return quality;
    }
    quality.error.reset();
    return quality;
}

/// Whether there is one from which it was heard what a moving frame takes, or nobody who waits for one.
bool Engine::knows_link() const {
    const auto holder = clients_.find(presentation_->holder().value_or(""));
    return holder == clients_.end() || holder->first == measured_by_ || holder->second.grants == 0;
}

std::size_t Engine::choose_level() {
    const protocol::QualityState& wanted = presentation_->state().quality;
    const double target = preferred_target(wanted.latency_target_ms, wanted.preference);
    // The first pictures to a client are small: its link may be slow, and they cannot be taken back.
    if (std::isfinite(target) && !knows_link()) return 0;
    return choice_->choose({presentation_->view_size(), room_, target}, base::Clock::now());
}

void Engine::draw(const PacingDecision& decision) {
    // What is drawn is what stands here now, whatever comes in meanwhile.
    const base::Clock::time_point begin = base::Clock::now();
    const View visible = presentation_->visible();
    const protocol::Resize view_size = presentation_->view_size();
    const bool still = decision.still_samples > 0;
    const std::size_t level = still ? 0 : choose_level();
    const protocol::Quality quality =
        still ? quality_at_rest(decision.still_samples)
              : quality_of(choice_->levels()[level].quality, view_size, room_, thin_lines());
    const PictureSize size = picture_size(view_size, quality.scale);
    View view = visible;
    view.width = size.width;
    view.height = size.height;
    view.samples = quality.samples;
    view.detail = quality.detail;
    view.levels = detail_;

    Picture picture;
    protocol::FrameHeader& header = picture.header;
    header = room::header_of(presentation_->state(), view, view_size);
    header.frame = next_frame_;
    header.revision = presentation_->document()->revision();
    header.quality = quality;
    picture.newest_input = newest_input_;
    for (const auto& [name, client] : clients_) picture.handled[name] = client.handled;

    Image image = encoder_.take_spare();
    FrameStats stats;
    // A moving picture is finished though the camera has moved on: while it moves on and on, none would be.
    const auto interrupted = [&] {
        attend();
        const View& now = presentation_->visible();
        return mailbox_.closed() || arrived_ || scene_of(now) != scene_of(visible) ||
               (still && (now != visible || presentation_->view_size() != view_size));
    };
    if (!still) presentation_->remember(next_frame_++);  // with the camera as it is now
    Painted painted = Painted::whole;
    try {
        painted = paint(view, image, stats, interrupted);
    } catch (const OutOfMemory& error) {
        return draw_smaller({visible, view_size}, size, error.what());
    }
    if (painted != Painted::whole) {
        ++metrics_.frames_interrupted;
        encoder_.give_spare(std::move(image));
        return;
    }
    if (still) presentation_->remember(next_frame_++);
    if (drawn_.frame == 0 || visible != drawn_.visible || view_size != drawn_.view_size)
        present_since_ = header.frame;
    drawn_ = {header.frame, visible, view_size, decision.still_samples};
    header.timing.render_ms = stats.render_ms;
    header.timing.readback_ms = stats.readback_ms;
    tell_of(header, metrics_, stats_);
    if (!still)
        note({header.frame, level, static_cast<double>(size.width) * size.height,
              stats.render_ms + stats.readback_ms, begin});
    promise(drawn_.frame, drawn_.still_samples);
    encoder_.offer(std::move(picture), std::move(image));
}

/// Remembers a moving frame, to measure it when the next is asked for.
void Engine::note(const Begun& begun) {
    begun_.push_back(begun);
    if (begun_.size() > kBegunRemembered) begun_.pop_front();
    const auto holder = clients_.find(presentation_->holder().value_or(""));
    if (holder != clients_.end() && holder->second.tells) return;
    // Nobody tells when it has arrived.
    choice_->took(begun.level, {begun.drawn_ms}, begun.pixels, base::Clock::now());
    measured_by_.clear();
}

/// Draws on the first snapshot that waits, a sample at least; it gives way to the live picture.
void Engine::draw_snapshot() {
    const std::string client = snapshots_.front().order.client;
    Snapshot snapshot = std::move(snapshots_.front());  // while it is drawn, its client may leave
    snapshots_.pop_front();
    View& view = snapshot.order.view;
    protocol::FrameHeader& header = snapshot.order.header;
    header.quality = kStill;
    header.quality.jpeg_quality = snapshot.order.jpeg_quality;
    view.samples = header.quality.samples;

    if (snapshot.image.rgba.empty()) snapshot.image = snapshot_encoder_.take_spare();
    FrameStats stats;
    const auto interrupted = [&] {
        attend();
        return mailbox_.closed() || arrived_ ||
               pace(base::Clock::now()).action == PacingDecision::Action::draw;
    };
    Painted painted = Painted::whole;
    try {
        painted = paint(view, snapshot.image, stats, interrupted, &snapshot.kept);
    } catch (const OutOfMemory& error) {
        return refuse(snapshot, error.what());
    }
    header.timing.render_ms += stats.render_ms;
    header.timing.readback_ms += stats.readback_ms;
    const bool is_client = header.snapshot.has_value();
    if (is_client && !clients_.contains(client)) return;  // it has left
    if (painted == Painted::lost && ++snapshot.losses == kMostLosses)
        return refuse(snapshot, "the graphics driver is lost whenever this picture is drawn");
    if (painted != Painted::whole) {
        snapshots_.push_front(std::move(snapshot));
        return;
    }
    ++metrics_.snapshots_rendered;
    Picture picture;
    picture.header = header;
    picture.header.frame = next_frame_++;
    picture.format = snapshot.order.format;
    picture.client = client;
    snapshot_encoder_.offer(std::move(picture), std::move(snapshot.image));
}

}  // namespace vrut::server::engine
