#include "engine.hpp"

#include <spdlog/spdlog.h>

#include <future>

#include "renderer.hpp"
#include "scene_state.hpp"

namespace vrut {

PainterFactory gl_painter(std::optional<int> device) {
    return [device] {
        auto renderer = std::make_shared<Renderer>(device);
        for (const std::string& sentence : renderer->rejected()) spdlog::warn("passed over {}", sentence);
        spdlog::info("drawing on {}", renderer->description());
        return Painter{renderer->description(), renderer->software(), renderer->max_size(),
                       [renderer](const View& view, Image& image, FrameStats& stats,
                                  const std::function<bool()>& interrupted, Accumulation* kept) {
                           return renderer->render(view, image, stats, interrupted, kept);
                       }};
    };
}

Engine::Engine(std::shared_ptr<const PlacedScene> scene, const PainterFactory& factory, Metrics& metrics,
               EngineCallbacks callbacks)
    : scene_(std::move(scene)),
      metrics_(metrics),
      callbacks_(std::move(callbacks)),
      encoder_(
          metrics, callbacks_.on_encoded, [this] { mailbox_.wake(); }, callbacks_.on_failure) {
    std::promise<void> started;
    std::future<void> start = started.get_future();
    thread_ = std::thread([this, &factory, &started] {
        Painter painter;
        try {
            painter = factory();
            description_ = painter.description;
            limits_.max_side = std::min(painter.max_size, limits_.max_side);
            started.set_value();
        } catch (...) {
            started.set_exception(std::current_exception());
            return;
        }
        try {
            painter_ = std::move(painter);
            run();
        } catch (const std::exception& error) {
            callbacks_.on_failure(error.what());
        }
        painter_ = {};  // what belongs to GL ends on the thread that it began on
    });
    try {
        start.get();
    } catch (...) {
        thread_.join();
        throw;
    }
}

Engine::~Engine() {
    mailbox_.close();
    thread_.join();
}

void Engine::run() {
    std::vector<std::string> notices = all_notices(*scene_->scene);
    if (painter_.software)
        notices.push_back("Drawn in software, without a graphics card: expect fewer pictures a second");
    presentation_.emplace(scene_, std::move(notices));

    // Drivers compile programs and states when they are first used; better now than under the first finger.
    Image image;
    FrameStats stats;
    View small = presentation_->visible();
    small.width = small.height = 64;
    painter_.paint(small, image, stats, {}, nullptr);

    while (!mailbox_.closed()) {
        serve_newest();
        report();
        const PacingDecision decision = pace();
        if (decision.action != PacingDecision::Action::wait) {
            draw(decision.action == PacingDecision::Action::draw_still);
            continue;
        }
        handle_all(mailbox_.wait(decision.until));
    }
}

// --- events

void Engine::handle_all(const std::vector<EngineEvent>& events) {
    for (const EngineEvent& event : events) std::visit([&](const auto& what) { handle(what); }, event);
}

void Engine::handle(const ClientJoined& joined) {
    clients_[joined.client];
    presentation_->join(joined.client, joined.role);
}

void Engine::handle(const ClientLeft& left) {
    clients_.erase(left.client);
    presentation_->leave(left.client);
}

void Engine::handle(const FrameSent& sent) {
    const auto found = clients_.find(sent.client);
    if (found == clients_.end()) return;
    Client& client = found->second;
    client.last_frame = std::max(client.last_frame, sent.frame);
    client.grants = std::min(client.grants + sent.unused_grants, protocol::kMaxGrants);
}

void Engine::handle(const ClientSaid& said) {
    const auto found = clients_.find(said.client);
    if (found == clients_.end()) return;  // it has left
    Client& client = found->second;
    output_.handled_bytes[said.client] += said.bytes;
    const auto id = said.message ? said.message->id : said.message.error().id;
    if (!said.message) {
        presentation_->refuse(said.client, said.message.error());
    } else if (std::holds_alternative<protocol::FrameGrant>(said.message->payload)) {
        ++metrics_.frames_granted;
        client.grants = std::min(client.grants + 1, protocol::kMaxGrants);
    } else {
        const View before = presentation_->visible();
        const protocol::Resize size_before = presentation_->view_size();
        presentation_->say(said.client, *said.message, said.arrival);
        if (presentation_->visible() != before || presentation_->view_size() != size_before) {
            last_change_ = Clock::now();
            newest_input_ = said.arrival;
        }
    }
    if (id) client.handled = std::max(client.handled, *id);
}

/// Hands over what there is to tell.
void Engine::report() {
    if (const auto& document = presentation_->document(); document != reported_) {
        reported_ = output_.document = document;
        output_.by = presentation_->changed_by();
        output_.by_since = presentation_->changed_by_since();
    }
    output_.answers = presentation_->take_answers();
    for (const Answer& answer : output_.answers) metrics_.messages_refused += answer.refusal;
    if (!output_.empty()) callbacks_.on_output(std::exchange(output_, {}));
}

// --- pictures

bool Engine::shows_present() const {
    return drawn_.frame != 0 && presentation_->visible() == drawn_.visible &&
           presentation_->view_size() == drawn_.view_size;
}

bool Engine::waits_for_newer(const Client& client) const {
    if (client.grants == 0) return false;
    return !shows_present() || client.last_frame != drawn_.frame || !drawn_.still;
}

/// Clients that have not got the newest picture, which shows what is to be seen, get that; no drawing is
/// needed.
void Engine::serve_newest() {
    if (!shows_present()) return;
    for (auto& [name, client] : clients_) {
        if (client.grants == 0 || client.last_frame == drawn_.frame) continue;
        --client.grants;
        client.last_frame = drawn_.frame;
        output_.owed.push_back({name, drawn_.frame});
    }
}

PacingDecision Engine::pace() {
    PacingInput input;
    for (const auto& [name, client] : clients_)
        input.somebody_waits = input.somebody_waits || waits_for_newer(client);
    input.changed = !shows_present();
    input.newest_is_still = drawn_.still;
    input.encoder_free = encoder_.is_free();
    input.last_change = last_change_;
    input.now = Clock::now();
    return decide(input);
}

void Engine::draw(bool still) {
    // What is drawn is what stands here now, whatever comes in meanwhile.
    const View visible = presentation_->visible();
    const protocol::Resize view_size = presentation_->view_size();
    Picture picture;
    protocol::FrameHeader& header = picture.header;
    header.quality = still ? still_quality(view_size, limits_) : moving_quality(view_size, limits_);
    const PictureSize size = picture_size(view_size, header.quality.scale);
    header.frame = drawn_.frame + 1;
    header.revision = presentation_->document()->revision();
    header.camera = presentation_->state().camera;
    header.view_matrix = view_from_world(visible.camera);
    header.projection_matrix = clip_from_view(visible.camera, static_cast<double>(size.width) / size.height,
                                              {header.camera.near, header.camera.far});
    header.width = size.width;
    header.height = size.height;
    header.view = view_size;
    picture.newest_input = newest_input_;
    for (const auto& [name, client] : clients_) picture.handled[name] = client.handled;

    View view = visible;
    view.width = size.width;
    view.height = size.height;
    view.samples = header.quality.samples;
    Image image = encoder_.take_spare();
    FrameStats stats;
    const auto interrupted = [&] {
        handle_all(mailbox_.wait(Clock::now()));
        report();
        return mailbox_.closed() || presentation_->visible() != visible ||
               presentation_->view_size() != view_size;
    };
    if (!painter_.paint(view, image, stats, interrupted, nullptr)) {
        ++metrics_.frames_interrupted;
        encoder_.give_spare(std::move(image));
        return;
    }
    ++(still ? metrics_.frames_rendered_still : metrics_.frames_rendered_moving);
    drawn_ = {header.frame, visible, view_size, still};
    presentation_->remember(drawn_.frame);
    header.render_ms = stats.render_ms;
    header.readback_ms = stats.readback_ms;
    for (auto& [name, client] : clients_) {
        if (client.grants == 0) continue;
        --client.grants;
        client.last_frame = drawn_.frame;
        output_.owed.push_back({name, drawn_.frame});
    }
    encoder_.offer(std::move(picture), std::move(image));
}

}  // namespace vrut
