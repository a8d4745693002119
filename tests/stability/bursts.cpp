// Studies of input that comes faster than pictures can.
#include <cmath>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "engine/engine.hpp"
#include "plan/render_job.hpp"
#include "shapes.hpp"
#include "study.hpp"

namespace vrut::stability {

namespace {

constexpr std::chrono::milliseconds kPicture{15};  ///< what one takes to draw
constexpr std::chrono::milliseconds kPatience{5000};

/// Draws nothing, in the time that a picture takes.
server::engine::FrameRenderer slow_renderer() {
    server::engine::FrameRenderer renderer;
    renderer.step = [](plan::RenderJob& rendering) {
        std::this_thread::sleep_for(kPicture / rendering.view.samples);
        if (++rendering.samples < rendering.view.samples) return false;
        rendering.image.resize(rendering.view.width, rendering.view.height);
        rendering.stats.render_ms = static_cast<double>(kPicture.count());
        return true;
    };
    return renderer;
}

using Asked = std::function<bool(const protocol::FrameHeader&)>;

/// A room of one: a client who steers, and takes each picture at once.
class OneClient {
public:
    OneClient()
        : engine_({{"room", "", scene_of({{1, sphere(1, 8), {}}}), {}}, {}, {}}, slow_renderer, metrics_,
                  {[this](const server::engine::EngineOutput& output) { count_refusals(output); },
                   [this](const std::shared_ptr<const server::engine::EncodedPicture>& picture) {
                       take(*picture);
                   },
                   [](const std::string&) {}}) {
        engine_.push(server::engine::ClientJoined{kClient, protocol::Role::control, {}});
        say(protocol::Control{});
        want_newer_than(0);
    }

    /// When it arrived.
    server::base::Clock::time_point say(decltype(protocol::ClientMessage::payload) payload,
                                        std::optional<std::int64_t> id = {}) {
        protocol::ClientMessage message;
        message.id = id;
        message.payload = std::move(payload);
        const server::base::Clock::time_point now = server::base::Clock::now();
        engine_.push(server::engine::MessageReceived{kClient, std::move(message), now});
        return now;
    }

    /// How long after `input` a picture came that shows it, and what `is_shown` asks for, in ms; kNothing
    /// where none does.
    double lag_of(
        server::base::Clock::time_point input, const Asked& is_shown = [](const auto&) { return true; }) {
        std::unique_lock lock(mutex_);
        const auto has_come = [&] { return shown_ && *shown_ >= input && is_shown(header_); };
        if (!arrived_.wait_until(lock, input + kPatience, has_come)) return kNothing;
        return std::chrono::duration<double, std::milli>(server::base::Clock::now() - input).count();
    }

    /// Of the newest picture.
    protocol::FrameHeader header() {
        const std::lock_guard lock(mutex_);
        return header_;
    }
    int refused() {
        const std::lock_guard lock(mutex_);
        return refused_;
    }

private:
    void count_refusals(const server::engine::EngineOutput& output) {
        const std::lock_guard lock(mutex_);
        for (const server::room::Answer& answer : output.answers) refused_ += !answer.rejection.empty();
    }

    void want_newer_than(std::int64_t frame) {
        engine_.push(server::engine::FramesWanted{kClient, frame, 1, 0, kUnlimited});
    }

    void take(const server::engine::EncodedPicture& picture) {
        want_newer_than(picture.header.frame);
        {
            const std::lock_guard lock(mutex_);
            shown_ = picture.newest_input;
            header_ = picture.header;
        }
        arrived_.notify_one();
    }

    static constexpr const char* kClient = "c1";
    static constexpr server::engine::Link kUnlimited{std::numeric_limits<double>::infinity(), {}};
    std::mutex mutex_;
    std::condition_variable arrived_;
    std::optional<server::base::Clock::time_point> shown_;
    protocol::FrameHeader header_;
    int refused_ = 0;
    server::observe::Metrics metrics_;
    server::engine::Engine engine_;  // last: its threads use all of the above
};

/// The lag of the last of `rate` inputs a second that came for half a second, until a picture shows what is
/// asked for.
template <class Input>
double lag_after_burst(double rate, const Input& input, const Asked& is_shown) {
    constexpr std::chrono::milliseconds kBurst{500};
    OneClient client;
    const server::base::Clock::time_point start = server::base::Clock::now();
    server::base::Clock::time_point last = start;
    for (int sent = 0; last < start + kBurst; last = server::base::Clock::now()) {
        const double due = rate * std::chrono::duration<double>(last - start).count();
        for (; sent <= due; ++sent) client.say(input(sent));
        std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
    return client.lag_of(client.say(input(-1)), is_shown);
}

glm::dvec3 eye_at_start() {
    OneClient client;
    client.lag_of(client.say(protocol::Resize{200, 150, 1}));
    return client.header().camera.pose.eye;
}

constexpr int kTurns = 200;

/// Whether turn `i` is sent once more, where that happens to so many percent.
bool comes_again(int i, double percent) { return i * 37 % 100 < percent; }

/// The eye, and how many messages were refused, after `turns` turns of a degree each and one more, of which
/// so many percent come again: with the same id, or with one before it.
struct Turned {
    glm::dvec3 eye;
    int refused = 0;
};
Turned turned_with_repeats(int turns, double percent) {
    OneClient client;
    const protocol::Navigate turn{{1, 0}};
    for (int i = 1; i <= turns; ++i) {
        client.say(turn, 2 * i);
        if (comes_again(i, percent)) client.say(turn, 2 * i - i % 2);
    }
    client.lag_of(client.say(turn, 2 * turns + 2));
    return {client.header().camera.pose.eye, client.refused()};
}

}  // namespace

Study repeated_ids(const Laboratory& laboratory) {
    Study study{"ids", "Messages that come twice, or late", "messages that come again, in percent",
                "degrees turned too far, and repeats nobody is told of"};
    study.bound = 1e-6;
    study.method.title = "ids must rise";
    study.explanation =
        "A message whose id is not above all of its client's before is refused in a sentence, and nothing "
        "changes.";
    study.cost = "A message that was overtaken is lost, which its sender is told.";
    const glm::dvec3 begin = turned_with_repeats(0, 0).eye, once = turned_with_repeats(kTurns, 0).eye;
    const double radius = glm::length(glm::dvec2(once.x, once.z));
    const bool turns = glm::distance(begin, once) > radius;  // 200 degrees apart
    for (const double percent : laboratory.chosen({1, 5, 10, 30, 60, 100})) {
        int repeats = 0;
        for (int i = 1; i <= kTurns; ++i) repeats += comes_again(i, percent);
        const Turned turned = turned_with_repeats(kTurns, percent);
        // By the chord, which is exact where nothing differs.
        const double degrees = glm::degrees(glm::distance(once, turned.eye) / radius);
        study.method.points.push_back(
            {percent, turns ? degrees + std::abs(repeats - turned.refused) : kNothing});
    }
    return study;
}

Study bursts_of_moves(const Laboratory& laboratory) {
    Study study{"bursts", "Bursts of moves", "moves a second, for half a second",
                "ms from the last move to its picture"};
    study.bound = 300;
    study.method.title = "all that came since the last picture at once";
    study.explanation =
        "Before each picture all moves that have come are applied, neighbours of one pointer as one; what "
        "waits for a client is replaced, never queued. A picture takes 15 ms here.";
    study.cost = "Moves between two pictures are not seen.";
    const auto move = [](int i) {
        protocol::Pointer pointer;
        pointer.event = i == 0 ? protocol::Pointer::Event::down : protocol::Pointer::Event::move;
        pointer.button = i == 0 ? 0 : -1;
        pointer.buttons = 1;
        pointer.x = 300 + 200 * std::sin(0.01 * i);
        pointer.y = 200 + (i < 0 ? 50 : 0);
        return pointer;
    };
    const glm::dvec3 begin = eye_at_start();
    const auto has_turned = [&](const protocol::FrameHeader& header) {
        return header.camera.pose.eye != begin;
    };
    for (const double rate : laboratory.chosen({10, 30, 60, 1000, 3000, 10'000}))
        study.method.points.push_back({rate, lag_after_burst(rate, move, has_turned)});
    return study;
}

Study storms_of_sizes(const Laboratory& laboratory) {
    Study study{"resizes", "Storms of resizes", "sizes a second, for half a second",
                "ms from the last size to its picture"};
    study.bound = 300;
    study.method.title = "the newest size when a picture begins";
    study.explanation =
        "A size is a wish that holds for the next picture; those between are never drawn. A picture takes 15 "
        "ms here.";
    study.cost = "Buffers are made anew for each picture of another size.";
    constexpr double kLastHeight = 333;
    const auto resize = [](int i) {
        return protocol::Resize{200.0 + i % 40, i < 0 ? kLastHeight : 150.0 + i % 30, 1};
    };
    const auto has_last_size = [](const protocol::FrameHeader& header) {
        return header.view.height == kLastHeight;
    };
    for (const double rate : laboratory.chosen({10, 30, 60, 100, 300, 1000}))
        study.method.points.push_back({rate, lag_after_burst(rate, resize, has_last_size)});
    return study;
}

}  // namespace vrut::stability
