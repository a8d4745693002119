#include "measure/glass.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <future>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "compare/flip.hpp"
#include "engine/level_choice.hpp"
#include "engine/scheduler.hpp"
#include "io/image/image_file.hpp"
#include "navigation/camera_motion.hpp"
#include "warp/warp.hpp"

namespace vrut::server::measure {

namespace {

using Clock = base::Clock;

constexpr double kMegabit = 1e6 / 8;  // bytes
constexpr double kDecodeMs = 5;
constexpr int kGrants = 2;
constexpr double kStepMs = 1;
constexpr double kRefreshMs = 1000 / kRefreshesPerSecond;

Clock::duration duration_of(double ms) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double, std::milli>(ms));
}

/// A frame as it was sent.
struct Frame {
    ShownFrame what;
    scene::Camera camera;
    std::vector<std::uint8_t> file;
    std::string depth;
    warp::DepthMapSize depth_size;
    double depth_scale = 0;
};

/// And as the glass has it.
struct DecodedFrame {
    scene::Image image;
    warp::DepthMap depth;
};

DecodedFrame decoded(const Frame& frame, const plan::View& glass) {
    auto image = io::decode_image({reinterpret_cast<const char*>(frame.file.data()), frame.file.size()});
    if (!image) throw std::runtime_error("an image that was encoded cannot be read: " + image.error());
    DecodedFrame result{resized(*image, glass.width, glass.height), {}};
    if (frame.depth.empty()) return result;
    auto depth =
        warp::decode(frame.depth, frame.depth_size.columns, frame.depth_size.rows, frame.depth_scale);
    if (!depth) throw std::runtime_error("a depth map that was encoded cannot be read");
    result.depth = *std::move(depth);
    return result;
}

/// Draws and encodes frames.
class FrameSource {
public:
    FrameSource(const std::vector<plan::View>& states, bool has_depth, renderer::Renderer& renderer,
                engine::JpegEncoder& jpeg)
        : states_(states), has_depth_(has_depth), renderer_(renderer), jpeg_(jpeg) {}

    bool has_depth() const { return has_depth_; }

    /// `camera`: another than the state's.
    Frame draw(std::size_t state, const Setting& setting, const std::optional<scene::Camera>& camera = {}) {
        plan::View view = states_[state];
        view.camera = camera.value_or(view.camera);
        plan::RenderJob job(view_with(view, setting));
        if (has_depth_) job.depth_size = warp::depth_map_size(view.width, view.height, blocks_.pixels());
        while (!renderer_.step(job)) {
        }
        Frame frame{{state, setting},
                    view.camera,
                    jpeg_.encode(job.image, setting.jpeg_quality, setting.subsampled),
                    {},
                    job.depth_size,
                    job.depth.scale};
        frame.what.bytes = frame.file.size();
        if (!has_depth_) return frame;
        frame.depth = warp::encode(job.depth);
        frame.what.depth_bytes = frame.depth.size();
        blocks_.took(frame.what.depth_bytes, frame.what.bytes);
        return frame;
    }

private:
    const std::vector<plan::View>& states_;
    bool has_depth_;
    renderer::Renderer& renderer_;
    engine::JpegEncoder& jpeg_;
    warp::BlockChoice blocks_;
};

/// The same numbers in each run.
class Dice {
public:
    double next() {
        state_ = state_ * 6364136223846793005U + 1442695040888963407U;  // Knuth, TAOCP 2, section 3.3.4
        return static_cast<double>(state_ >> 11U) / static_cast<double>(std::uint64_t{1} << 53U);
    }

private:
    std::uint64_t state_ = 1;
};

/// A server, a link and a client, in steps of a millisecond.
class Delivery {
public:
    Delivery(const std::vector<plan::View>& states, const SimulatedLink& link,
             const protocol::LevelTable& table, double target_ms, FrameSource& source,
             std::optional<std::size_t> level = {})
        : states_(states),
          link_(link),
          source_(source),
          choice_(table),
          target_ms_(target_ms),
          only_level_(level) {
        const plan::View& first = states.front();
        size_ = {static_cast<double>(first.width), static_cast<double>(first.height), 1};
        arrived_.push_back({std::make_shared<const Frame>(source.draw(0, setting_of(engine::kRefined))), 0});
    }

    /// The frame on the glass at each refresh.
    std::vector<std::shared_ptr<const Frame>> run() {
        const double end = kRefreshMs * static_cast<double>(states_.size());
        for (double now = 0; now < end; now += kStepMs) step(now);
        std::vector<std::shared_ptr<const Frame>> shown;
        std::size_t newest = 0;
        for (std::size_t refresh = 0; refresh < states_.size(); ++refresh) {
            while (newest + 1 < arrived_.size() && arrived_[newest + 1].refresh <= refresh) ++newest;
            shown.push_back(arrived_[newest].frame);
        }
        return shown;
    }

private:
    struct Drawing {
        std::shared_ptr<const Frame> frame;
        std::size_t state = 0;
        engine::Refinement refinement = engine::Refinement::none;
        double done_at = 0;  ///< ms
    };
    struct Arrived {
        std::shared_ptr<const Frame> frame;
        std::size_t refresh = 0;  ///< at which it is shown
    };

    /// What the server knows of the session then.
    std::size_t known(double now) const {
        const double refresh = std::floor((now - link_.round_trip_ms / 2) / kRefreshMs);
        return static_cast<std::size_t>(std::clamp(refresh, 0.0, static_cast<double>(states_.size() - 1)));
    }

    void step(double now) {
        const std::size_t state = known(now);
        if (states_[state] != states_[state_]) last_change_ = now;
        state_ = state;
        motion_.add(now, states_[state].camera);
        if (drawing_) {
            // A frame of an idle view is given up when that moves.
            const bool is_moving = drawing_->refinement == engine::Refinement::none;
            if (!is_moving && states_[state] != states_[drawing_->state])
                drawing_.reset();
            else if (now < drawing_->done_at)
                return;
            else
                send(now);
        }
        engine::ScheduleInput input;
        input.now = Clock::time_point(duration_of(now));
        input.last_change = Clock::time_point(duration_of(last_change_));
        input.frame_wanted = wire_free_at_ <= now && grants(now) > 0;
        input.changed = states_[state] != states_[drawn_];
        input.newest = refinement_;
        const double delivery_ms = refined_ms();
        input.slow_link = delivery_ms > 0;
        input.sharp_from = input.last_change + duration_of(delivery_ms);
        const engine::ScheduledStep step = scheduler_.next(input);
        if (step.action == engine::ScheduledStep::Action::begin_frame)
            draw(now, state, step.refinement, input.slow_link);
    }

    int grants(double now) const {
        return kGrants - static_cast<int>(std::ranges::count_if(
                             arrived_.begin() + 1, arrived_.end(), [&](const Arrived& frame) {
                                 const double shown = kRefreshMs * static_cast<double>(frame.refresh);
                                 return shown + link_.round_trip_ms / 2 > now;
                             }));
    }

    /// As the engine holds a sharp frame back; 0: it does not.
    double refined_ms() const {
        const double bytes = expected(choice_.levels().size() - 1, 1).bytes;
        const double ms = 1000 * bytes / link_.bytes_per_second;
        return ms > std::chrono::duration<double, std::milli>(engine::kLongDelivery).count() ? ms : 0;
    }

    engine::PictureCost expected(std::size_t level, double scale) const {
        return choice_.expected(
            level, size_.width * size_.height * scale * scale,
            Clock::time_point(duration_of(1000 / kRefreshesPerSecond * static_cast<double>(state_))));
    }

    void draw(double now, std::size_t state, engine::Refinement refinement, bool slow_link) {
        const Clock::time_point time(duration_of(now));
        const std::optional<engine::Link> link =
            engine::Link{link_.bytes_per_second, duration_of(link_.round_trip_ms)};
        const bool is_moving = refinement == engine::Refinement::none;
        const std::size_t last = choice_.levels().size() - 1;
        std::size_t level = last;
        protocol::Quality quality = engine::kRefined;
        if (is_moving) {
            const double target_ms = source_.has_depth()
                                         ? engine::warped_target(target_ms_, link, motion_.speed(now))
                                         : target_ms_;
            level = only_level_ ? *only_level_ : choice_.choose({size_, {}, target_ms, link}, time);
            quality = choice_.levels()[level].quality;
        } else {
            if (refinement == engine::Refinement::small) quality = choice_.levels().front().quality;
            if (refinement == engine::Refinement::first && slow_link) {
                quality.jpeg_quality = choice_.levels().back().quality.jpeg_quality;
                quality.subsampling = choice_.levels().back().quality.subsampling;
            }
            quality.samples = engine::samples_of(refinement);
            quality.detail = 0;
        }
        engine::PictureCost cost = expected(level, quality.scale);
        std::optional<scene::Camera> ahead;
        if (is_moving && source_.has_depth()) ahead = motion_.ahead(now, cost.delay_ms(*link));
        Frame frame = source_.draw(state, setting_of(quality), ahead);
        if (!is_moving)
            cost.ms *= quality.samples / std::max(1.0, choice_.levels()[last].quality.samples * 1.0);
        cost.bytes = static_cast<double>(frame.what.bytes + frame.what.depth_bytes);
        if (is_moving)
            choice_.took(level, cost, size_.width * size_.height * quality.scale * quality.scale, time);

        frame.what.is_moving = is_moving;
        frame.what.ms = cost.ms;
        drawing_ = {std::make_shared<const Frame>(std::move(frame)), state, refinement, now + cost.ms};
    }

    void send(double now) {
        const ShownFrame& what = drawing_->frame->what;
        const double bytes = static_cast<double>(what.bytes + what.depth_bytes);
        wire_free_at_ = std::max(now, wire_free_at_) + 1000 * bytes / link_.bytes_per_second;
        const double there = wire_free_at_ + link_.round_trip_ms * (0.5 + resent(bytes)) + kDecodeMs;
        there_at_ = std::max(there_at_, there);
        arrived_.push_back({drawing_->frame, static_cast<std::size_t>(std::ceil(there_at_ / kRefreshMs))});
        drawn_ = drawing_->state;
        refinement_ = drawing_->refinement;
        drawing_.reset();
    }

    /// How many round trips its packets take more.
    int resent(double bytes) {
        int most = 0;
        for (double sent = 0; sent < bytes; sent += kPacket) {
            int times = 0;
            while (dice_.next() < link_.loss) ++times;
            most = std::max(most, times);
        }
        return most;
    }

    const std::vector<plan::View>& states_;
    const SimulatedLink& link_;
    FrameSource& source_;
    engine::LevelChoice choice_;
    double target_ms_;
    std::optional<std::size_t> only_level_;  ///< none: the server's choice
    engine::Scheduler scheduler_;
    navigation::CameraMotion motion_;
    protocol::Resize size_;
    Dice dice_;
    std::optional<Drawing> drawing_;
    std::vector<Arrived> arrived_;
    std::size_t state_ = 0, drawn_ = 0;  ///< that the server knows, that its newest frame shows
    engine::Refinement refinement_ = engine::Refinement::sharp;
    double last_change_ = -1e6, wire_free_at_ = 0, there_at_ = 0;
};

warp::Background background_of(const plan::View& view) {
    return view.background.shows_cube_map() ? warp::Background::turns : warp::Background::stays;
}

/// What the page does where the camera only moves or zooms: all as far away as the focus.
scene::Image shifted(const DecodedFrame& frame, const scene::Camera& from, const scene::Camera& to,
                     warp::Background background) {
    constexpr double kSame = 1e-9;
    const bool is_turned = glm::distance(scene::view_direction(from), scene::view_direction(to)) > kSame ||
                           glm::distance(from.up, to.up) > kSame;
    if (is_turned || from == to) return frame.image;
    const auto nearest = static_cast<std::uint8_t>(warp::DepthMap::kSteps);
    const warp::DepthMap plane{1, 1, 1 / scene::focus_distance(from), {nearest}, {nearest}, {0xffff}};
    return warp::warped(frame.image, plane, from, to, background);
}

using Errors = std::array<double, kPredictions.size()>;

/// What is on the glass, and the camera that the server drew it from.
struct Shown {
    DecodedFrame frame;
    scene::Camera camera;
};

double mean_flip(const scene::Image& shown, const scene::Image& judge) {
    const std::vector<float> values = compare::flip(shown, judge);
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double warped_error(const Shown& shown, const plan::View& now, const scene::Image& judge) {
    const auto& [image, depth] = shown.frame;
    if (shown.camera == now.camera) return mean_flip(image, judge);
    return mean_flip(warp::warped(image, depth, shown.camera, now.camera, background_of(now)), judge);
}

/// `plain`: without depth.
Errors errors_of(const Shown& plain, const Shown& with_depth, const DecodedFrame& without_delay,
                 const plan::View& now, const scene::Image& judge) {
    Errors errors;
    errors[0] = errors[1] = mean_flip(plain.frame.image, judge);
    if (plain.camera != now.camera)
        errors[1] = mean_flip(shifted(plain.frame, plain.camera, now.camera, background_of(now)), judge);
    errors[2] = warped_error(with_depth, now, judge);
    errors[3] = with_depth.camera == now.camera ? errors[2] : mean_flip(without_delay.image, judge);
    return errors;
}

}  // namespace

tl::expected<SimulatedLink, std::string> parse_link(const std::string& text) {
    SimulatedLink link{text};
    double megabits = 0, percent = 0;
    int read = 0;
    const auto is_whole = [&] { return static_cast<std::size_t>(read) == text.size(); };
    bool is_link =
        std::sscanf(text.c_str(), "%lf,%lf%n", &link.round_trip_ms, &megabits, &read) == 2 && is_whole();
    if (!is_link)
        is_link = std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &link.round_trip_ms, &megabits, &percent,
                              &read) == 3 &&
                  is_whole();
    // Not a number fails each of these.
    const bool is_in_range = link.round_trip_ms >= 0 && link.round_trip_ms <= 10'000 && megabits >= 0.01 &&
                             megabits <= 1e6 && percent >= 0 && percent <= 90;
    if (!is_link || !is_in_range)
        return tl::unexpected(
            "expected the round trip in ms (0 to 10000), Mbit/s (0.01 to 1000000), and "
            "maybe percent lost (0 to 90), as in 20,20 or 100,2,1; found '" +
            text + "'");
    link.bytes_per_second = megabits * kMegabit;
    link.loss = percent / 100;
    return link;
}

std::vector<SimulatedLink> usual_links() {
    return {{"LAN", 1, 1000 * kMegabit, 0},
            {"Wi-Fi", 20, 20 * kMegabit, 0},
            {"bad Wi-Fi", 100, 2 * kMegabit, 0},
            {"phone network", 200, 1 * kMegabit, 0}};
}

namespace {

/// The frame on the glass at each refresh.
using Glass = std::vector<std::shared_ptr<const Frame>>;

/// Those for frames while things move, and what they cost in a view's size.
std::vector<GlassErrors::OfLevel> levels_of(const protocol::LevelTable& table, const plan::View& view) {
    const engine::LevelChoice choice(table);
    std::vector<GlassErrors::OfLevel> levels;
    for (std::size_t level = 0; level < choice.levels().size(); ++level) {
        const protocol::Quality& quality = choice.levels()[level].quality;
        const engine::PictureCost cost =
            choice.expected(level, quality.scale * quality.scale * view.width * view.height, {});
        levels.push_back({setting_of(quality), cost.ms, cost.bytes, {}});
    }
    return levels;
}

/// What came of a delivery, but for its errors.
GlassErrors::Delivered counted(const Glass& shown, const std::vector<plan::View>& states) {
    GlassErrors::Delivered result;
    double frozen_ms = 0;
    for (std::size_t k = 1; k < shown.size(); ++k) {
        const bool is_new = shown[k] != shown[k - 1];
        if (is_new) {
            ++result.frames;
            result.bytes += static_cast<double>(shown[k]->what.bytes);
            result.depth_bytes += static_cast<double>(shown[k]->what.depth_bytes);
            if (shown[k]->what.is_moving) {
                ++result.moving;
                result.moving_ms += shown[k]->what.ms;
            }
        }
        const bool is_right = states[shown[k]->what.drawn] == states[k];
        frozen_ms = is_new || is_right ? 0 : frozen_ms + kRefreshMs;
        result.longest_ms = std::max(result.longest_ms, frozen_ms);
    }
    return result;
}

/// What is on the glass over a link, and what came of it, but for the errors.
struct OfLink {
    Glass plain, with_depth;
    std::vector<Glass> levels;  ///< as GlassErrors::levels
    GlassErrors result;
};

OfLink delivered_over(const SimulatedLink& link, const std::vector<plan::View>& states,
                      const GlassDemand& demand, renderer::Renderer& renderer, engine::JpegEncoder& jpeg) {
    // Each delivery has a source of its own: what one chooses is nothing to another.
    const auto deliver = [&](bool has_depth, std::optional<std::size_t> level = {}) {
        FrameSource source(states, has_depth, renderer, jpeg);
        return Delivery(states, link, demand.levels, demand.target_ms, source, level).run();
    };
    OfLink of{deliver(false), deliver(true), {}, {}};
    of.result.delivered[0] = of.result.delivered[1] = counted(of.plain, states);
    of.result.delivered[2] = of.result.delivered[3] = counted(of.with_depth, states);
    if (!demand.each_level) return of;
    of.result.levels = levels_of(demand.levels, states.front());
    for (std::size_t level = 0; level < of.result.levels.size(); ++level)
        of.levels.push_back(deliver(true, level));
    return of;
}

/// Adds the errors of a refresh.
void add_errors(OfLink& of, const std::vector<plan::View>& states, std::size_t refresh,
                const Frame& without_delay, const scene::Image& judge) {
    const plan::View& now = states[refresh];
    const auto shown = [&](const Glass& glass) {
        const Frame& frame = *glass[refresh];
        return Shown{decoded(frame, now), frame.camera};
    };
    const Errors errors =
        errors_of(shown(of.plain), shown(of.with_depth), decoded(without_delay, now), now, judge);
    for (std::size_t p = 0; p < errors.size(); ++p) of.result.errors[p].push_back(errors[p]);
    for (std::size_t level = 0; level < of.levels.size(); ++level)
        of.result.levels[level].errors.push_back(warped_error(shown(of.levels[level]), now, judge));
}

}  // namespace

std::vector<GlassErrors> errors_at_glass(const std::vector<plan::View>& states,
                                         const std::vector<SimulatedLink>& links, const GlassDemand& demand,
                                         renderer::Renderer& renderer, const PartDone& done) {
    engine::JpegEncoder jpeg;
    std::vector<FrameSource> without_delay(links.size(), FrameSource(states, true, renderer, jpeg));
    std::vector<OfLink> of_links;
    of_links.reserve(links.size());
    for (const SimulatedLink& link : links)
        of_links.push_back(delivered_over(link, states, demand, renderer, jpeg));
    // An image is judged while the next one is drawn.
    std::future<void> judged;
    for (std::size_t k = 0; k < states.size(); k += demand.every) {
        plan::View view = states[k];
        view.samples = kGlassSamples;
        plan::RenderJob job(view);
        while (!renderer.step(job)) {
        }
        std::vector<Frame> fresh;
        fresh.reserve(links.size());
        for (std::size_t i = 0; i < links.size(); ++i)
            fresh.push_back(without_delay[i].draw(k, of_links[i].with_depth[k]->what.setting));
        if (judged.valid()) judged.get();
        judged = std::async(std::launch::async, [&, k, judge = std::move(job.image), fresh] {
            for (std::size_t i = 0; i < links.size(); ++i)
                add_errors(of_links[i], states, k, fresh[i], judge);
        });
        if (done) done(static_cast<double>(k + 1) / static_cast<double>(states.size()));
    }
    judged.get();
    std::vector<GlassErrors> results;
    results.reserve(links.size());
    for (OfLink& of : of_links) results.push_back(std::move(of.result));
    return results;
}

}  // namespace vrut::server::measure
