#include "engine/engine.hpp"

#include <algorithm>
#include <limits>

#include "base/drawing_errors.hpp"
#include "codec.hpp"
#include "observe/log.hpp"
#include "renderer/renderer.hpp"
#include "scenes/level_store.hpp"

namespace vrut::server::engine {

namespace code = protocol::error_code;

namespace {

constexpr int kMostSnapshots = 2;  // of a client, waiting
/// At most, for those who follow the camera without frames.
constexpr std::chrono::milliseconds kFlightStep{16};

/// The earlier of two times, where there are any.
std::optional<base::Clock::time_point> earlier(std::optional<base::Clock::time_point> a,
                                               std::optional<base::Clock::time_point> b) {
    return !a ? b : !b ? a : std::min(*a, *b);
}

}  // namespace

FrameRendererFactory gl_renderer(std::optional<int> device) {
    return [device, resolve_on = std::optional<renderer::ResolveOn>()]() mutable {
        auto renderer = std::make_shared<renderer::Renderer>(device);
        for (const std::string& sentence : renderer->rejected())
            observe::log_warning("device_passed_over", {{"reason", sentence}});
        observe::log_info("drawing", {{"renderer", renderer->description()}});
        if (resolve_on) {
            renderer->use_resolver(*resolve_on);
        } else {
            const renderer::ResolverTimes times = renderer->choose_resolver();
            resolve_on = times.faster();
            observe::log_info("resolver", {{"on", resolve_on == renderer::ResolveOn::gpu ? "gpu" : "cpu"},
                                           {"cpu_ms", times.cpu_ms},
                                           {"gpu_ms", times.gpu_ms}});
        }
        return FrameRenderer{renderer->description(),
                             renderer->software(),
                             renderer->max_size(),
                             [renderer](const plan::View& view) { return renderer->upload_step(view); },
                             [renderer](plan::RenderJob& rendering) { return renderer->step(rendering); },
                             [renderer] { return renderer->gl_objects(); }};
    };
}

Engine::Engine(EngineOptions options, FrameRendererFactory factory, observe::Metrics& metrics,
               EngineCallbacks callbacks)
    : library_(std::move(options.library)),
      record_folder_(std::move(options.record_folder)),
      share_(std::move(options.share)),
      metrics_(metrics),
      callbacks_(std::move(callbacks)),
      shared_(std::move(options.shared)),
      follows_(shared_.has_value()),
      file_results_(
          std::make_shared<ResultPost>([this](FileWorkDone done) { mailbox_.push(std::move(done)); })),
      lookup_(
          {[library = library_] { return library.names(); },
           [library = library_](const std::string& name) { return library.find(name); }},
          file_results_, [this](auto request, const auto& names) { room_->scenes_listed(request, names); },
          [this](auto request, const auto& found) {
              room_->load_answered(request, load(found), time_of(base::Clock::now()));
          }),
      recordings_([folder = record_folder_](const std::string& name) { return open_log(folder, name); },
                  file_results_,
                  [this](auto recording, const auto& name) {
                      room_->recording_opened(recording, name, time_of(base::Clock::now()));
                  },
                  [this](auto recording, const auto& why) {
                      room_->recording_ended(recording, why, time_of(base::Clock::now()));
                  },
                  {}),
      change_keeper_(
          std::move(options.keep_changes), file_results_,
          {[this](const std::string& why) {
               notice({protocol::notice_code::not_kept, "Views, markers and parts cannot be kept: " + why});
           },
           [this](const std::string& file) {
               notice({protocol::notice_code::unusable_changes,
                       "What was kept and cannot be used is set aside as " + file});
           }}),
      encoder_(
          metrics,
          [this](std::shared_ptr<const EncodedPicture> picture) {
              const std::int64_t frame = picture->header.frame;
              const std::size_t depth =
                  picture->depth && picture->depth->frame == frame ? picture->depth->bytes.size() : 0;
              const FrameEncoded encoded{frame, picture->header.timing.encode_ms,
                                         picture->file.size() + depth, depth};
              callbacks_.on_encoded(std::move(picture));
              mailbox_.push(encoded);
          },
          [this] { mailbox_.wake(); },
          [this](Picture picture, std::string why) {
              mailbox_.push(PictureFailed{std::move(picture), std::move(why)});
          }),
      snapshot_encoder_(
          metrics, callbacks_.on_encoded, [this] { mailbox_.wake(); },
          [this](Picture picture, std::string why) {
              mailbox_.push(PictureFailed{std::move(picture), std::move(why)});
          }),
      loader_([this](scenes::SceneLoading loading) { mailbox_.push(std::move(loading)); },
              [this](scenes::SceneLoaded loaded) { mailbox_.push(std::move(loaded)); }),
      factory_(std::move(factory)),
      stats_(metrics) {
    std::promise<void> started;
    std::future<void> start = started.get_future();
    thread_ = std::thread([this, &started, scene = std::move(options.scene)]() mutable {
        bool begun = false;
        try {
            begin(std::exchange(scene, {}));  // not kept when another is shown
            begun = true;
            started.set_value();
            run();
        } catch (const std::exception& error) {
            if (begun)
                callbacks_.on_failure(error.what());
            else
                started.set_exception(std::current_exception());
        }
        // What may take a while to end begins to now, and is waited for by the destructors.
        encoder_.stop();
        snapshot_encoder_.stop();
        loader_.stop();
        recordings_.end_all(base::Clock::now());
        if (begun) keep_changes();
        renderer_ = {};  // what belongs to GL ends on the thread that it began on
        room_.reset();
    });
    try {
        start.get();
    } catch (...) {
        thread_.join();
        throw;
    }
}

void Engine::stop() { mailbox_.close(); }

std::optional<std::string> Engine::why_unready() const {
    if (follows_) return "another server draws this room";
    if (draws_) return std::nullopt;
    return "the graphics driver is being started again";
}

Engine::~Engine() {
    stop();
    thread_.join();
}

/// With what the engine adds to a scene that it shows: notices, and trees for picks, which are not awaited.
scenes::LoadedScene Engine::prepared(scenes::LoadedScene scene) const {
    scene.picking_trees = std::make_shared<const mesh::PickingTrees>(scene.placed->scene);
    if (renderer_.software)
        scene.notices.push_back({protocol::notice_code::software,
                                 "Drawn in software, without a graphics card: expect fewer frames a second"});
    return scene;
}

void Engine::begin(const scenes::LoadedScene& scene) {
    watchdog_.busy();
    renderer_ = factory_();
    description_ = renderer_.description;
    limits_.max_side = std::min(renderer_.max_size, limits_.max_side);
    pixel_budget_ = limits_;
    use(scenes::built_in_levels());
    read_levels(scene);
    room_.emplace(prepared(scene), shared_ ? room::RoomOptions{} : live_options());
    note_kept();
    set_changes_aside();
    try {
        while (renderer_.upload_step && !renderer_.upload_step(room_->visible())) {
        }
    } catch (const vrut::base::OutOfMemory& error) {
        throw std::runtime_error(scene.name + ": " + error.what());
    }

    // Drivers compile programs and states when they are first used; better now than under the first finger.
    plan::View small = room_->visible();
    small.width = small.height = 64;
    plan::RenderJob first(std::move(small));
    while (!renderer_.step(first)) {
    }
    draws_ = true;
}

void Engine::run() {
    std::optional<base::Clock::time_point> until = base::Clock::now();
    while (!mailbox_.closed()) {
        drain(until);
        check_files();
        apply();
        if (!follows_) {
            publish();
            check_changes();
            keep_checkpoint();
        }
        until = take_step(scheduler_.next(situation(base::Clock::now())));
    }
}

void Engine::drain(std::optional<base::Clock::time_point> until) {
    until = earlier(earlier(until, stats_.due()), files_due());
    if (room_->moves() && !follows_) until = earlier(until, base::Clock::now() + kFlightStep);
    if (const auto deadline = room_->deadline(); deadline && !follows_)
        until = earlier(until, start_ + *deadline);
    if (lines_ > 0) until = earlier(until, line_at_ + kJournalQuiet);
    if (!waiting_.empty() || (arrived_ && !renewal_)) until = base::Clock::now();
    watchdog_.idle();
    std::vector<EngineEvent> events = mailbox_.wait(until);
    watchdog_.busy();
    for (EngineEvent& event : events) waiting_.push(std::move(event));
}

void Engine::apply() {
    handle_waiting();
    if (arrived_) show_arrived();
    if (room_->view_size() != budget_for_ || (failed_ && !has_failed())) {
        budget_for_ = room_->view_size();
        pixel_budget_ = limits_;
        failed_.reset();
    }
    if (!follows_) advance_room();
    motion_.add(ms_since_start(), room_->visible().camera);
    if (frame_ && is_outdated(*frame_)) give_up_frame();
}

ScheduleInput Engine::situation(base::Clock::time_point now) const {
    ScheduleInput input;
    input.now = now;
    input.last_change = last_change_;
    if (renewal_) return input;  // there is nothing to draw with
    input.changed = !shows_present();
    input.newest = newest_.refinement;
    input.slow_link = has_slow_link();
    input.encoder_free = encoder_.is_free();
    input.frame_under_way = frame_.has_value();
    input.snapshot_waits = !snapshots_.empty() && snapshot_encoder_.is_free();
    for (const auto& [name, client] : clients_) {
        if (!wants_newer(client) || has_failed()) continue;
        const base::Clock::time_point from = last_change_ + refined_delivery(client.wanted.link);
        input.sharp_from = input.frame_wanted ? std::min(input.sharp_from, from) : from;
        input.frame_wanted = true;
    }
    return input;
}

std::optional<base::Clock::time_point> Engine::take_step(const ScheduledStep& step) {
    using Action = ScheduledStep::Action;
    if (renewal_) {
        if (base::Clock::now() >= renewal_->at) renew_renderer();
        return renewal_ ? renewal_->at : base::Clock::now();
    }
    if (step.action == Action::wait) return step.until;
    const base::Clock::time_point begin = base::Clock::now();
    if (step.action == Action::begin_frame) begin_frame(step.refinement);
    if (step.action != Action::draw_snapshot) {
        if (frame_) draw_frame();
    } else {
        draw_snapshot();
        scheduler_.drew_snapshot(begin, base::Clock::now());
    }
    return base::Clock::now();
}

void Engine::advance_room() {
    const base::Clock::time_point now = base::Clock::now();
    const auto deadline = room_->deadline();
    // Else what waits would count as later than it arrived.
    const bool moves = room_->moves();
    if (!moves && !(deadline && *deadline <= time_of(now))) return;
    const plan::View before = room_->visible();
    const protocol::Resize size_before = room_->view_size();
    room_->advance(time_of(now));
    if (moves || room_->moves() || room_->visible() != before || room_->view_size() != size_before)
        last_change_ = now;
}

// --- events

void Engine::handle_waiting() {
    constexpr std::chrono::milliseconds kSlice{4};  // then it is time for pictures and answers
    const base::Clock::time_point end = base::Clock::now() + kSlice;
    while (!waiting_.empty() && !mailbox_.closed() && base::Clock::now() < end) {
        const EngineEvent event = waiting_.pop();
        std::visit([&](const auto& what) { handle(what); }, event);
    }
}

void Engine::handle(const ClientJoined& joined) {
    clients_[joined.client].handled = joined.id;
    output_.handled[joined.client].sequence = clients_[joined.client].sequence = joined.sequence;
    const base::Clock::time_point now = base::Clock::now();
    room_->join(joined.client, joined.role, time_of(now), joined.name, joined.resume_key);
    stats_.joined(joined.client, joined.role, room_->client_name(joined.client), now);
}

void Engine::handle(const ClientLeft& left) {
    clients_.erase(left.client);
    std::erase_if(snapshots_, [&](const Snapshot& snapshot) { return snapshot.order.client == left.client; });
    const base::Clock::time_point now = base::Clock::now();
    room_->leave(left.client, time_of(now));
    stats_.left(left.client, now);
}

void Engine::handle(const FramesWanted& wanted) {
    const auto found = clients_.find(wanted.client);
    if (found == clients_.end()) return;
    Client& client = found->second;
    if (wanted.since_sequence != client.wanted.since_sequence || client.wanted.client.empty())
        client.from_frame = next_frame_;
    client.wanted = wanted;
}

/// The cost of an interactive frame decides on the levels of those that follow.
void Engine::handle(const FrameEncoded& encoded) {
    if (encoded.depth_bytes > 0) blocks_.took(encoded.depth_bytes, encoded.bytes - encoded.depth_bytes);
    const auto frame = std::find_if(in_flight_.begin(), in_flight_.end(),
                                    [&](const FrameInFlight& each) { return each.frame == encoded.frame; });
    if (frame != in_flight_.end()) {
        choice_->took(frame->level, {frame->drawn_ms + encoded.encode_ms, static_cast<double>(encoded.bytes)},
                      frame->pixels, base::Clock::now());
        in_flight_.erase(in_flight_.begin(), frame + 1);
    }
    if (encoded.frame >= scene_since_ && !detail_) make_detail_levels();
}

void Engine::handle(const PictureFailed& failed) {
    const Picture& picture = failed.picture;
    observe::log_warning("picture_not_encoded", {{"frame", picture.header.frame}, {"reason", failed.why}});
    if (!picture.client.empty())
        return reject(picture.client, picture.header.snapshot, "the image cannot be encoded: " + failed.why);
    std::erase(drawn_, picture.header.frame);
    if (picture.header.frame != newest_.frame) return;  // a newer one may do better
    failed_ = Failed{newest_.visible, newest_.view_size};
    newest_ = before_newest_;
    notice({protocol::notice_code::not_encoded, "This view cannot be encoded: " + failed.why});
}

/// The first frame of a scene is not kept waiting by coarser surfaces that are made for later ones.
void Engine::make_detail_levels() {
    const auto& placed = room_->visible().scene;
    const auto simplifies = [](const protocol::Level& level) { return level.quality.detail > 0; };
    if (!placed || std::none_of(choice_->levels().begin(), choice_->levels().end(), simplifies)) return;
    const auto log_failure = [](const std::string& reason) {
        observe::log_warning("no_levels_of_detail", {{"reason", reason}});
    };
    try {
        detail_ = std::make_shared<const mesh::DetailLevels>(placed->scene, log_failure);
    } catch (const std::exception& error) {  // no memory, or no thread
        log_failure(error.what());
        scene_since_ = std::numeric_limits<std::int64_t>::max();  // it is not tried again for this scene
    }
}

/// For the scene that is shown from now on.
void Engine::use(const protocol::LevelTable& table) {
    choice_.emplace(table);
    refined_levels_.clear();
    for (const protocol::Level& level : table.levels)
        if (level.quality.level == protocol::Quality::Level::still) refined_levels_.push_back(level);
    if (frame_) give_up_frame();  // its level is of the table before
    refining_.reset();
    in_flight_.clear();
    detail_.reset();
    scene_since_ = next_frame_;
}

void Engine::handle(const SnapshotSent& sent) {
    if (const auto found = clients_.find(sent.client); found != clients_.end()) --found->second.snapshots;
}

void Engine::handle(const PictureAsked& asked) {
    const PictureSize present = present_size();
    auto order = room_->order(asked.width > 0 ? asked.width : present.width,
                              asked.height > 0 ? asked.height : present.height, asked.view);
    if (!order) return reject(asked.name, {}, order.error().message);
    order->client = asked.name;
    snapshots_.push_back({*std::move(order)});
}

void Engine::handle(const scenes::SceneLoading& loading) {
    broadcast({loading.name, loading.fraction, {}, {}});
}

void Engine::broadcast(const protocol::Loading& loading) {
    output_.loading = std::make_shared<const std::string>(protocol::encode(loading));
    output_.loads = !loading.done && !loading.refused;
}

void Engine::handle(const scenes::SceneLoaded& loaded) {
    arrived_ = Arrived{loaded};
    if (loaded.scene)
        arrived_->view = room::view_of(room::starting_state(*loaded.scene, 1), loaded.scene->placed);
}

void Engine::handle(const MessageReceived& received) {
    const auto found = clients_.find(received.client);
    if (found == clients_.end()) return;  // it has left
    Client& client = found->second;
    output_.handled[received.client].bytes += received.bytes;
    output_.handled[received.client].requests += received.is_request();
    output_.handled[received.client].sequence = received.sequence;
    client.sequence = std::max(client.sequence, received.sequence);  // an earlier one may come again
    const auto id = received.message ? received.message->id : received.message.error().id;
    if (id && *id <= client.handled)
        room_->reject(received.client, {id, code::out_of_range,
                                        "'id' must rise: " + std::to_string(client.handled) +
                                            " came before " + std::to_string(*id)});
    else if (!received.message)
        room_->reject(received.client, received.message.error());
    else if (!std::holds_alternative<protocol::FrameGrant>(received.message->payload))  // the connection's
        handle_message(received, *received.message, client);
    if (id) client.handled = std::max(client.handled, *id);
}

void Engine::handle_message(const MessageReceived& received, const protocol::ClientMessage& message,
                            Client& client) {
    if (std::holds_alternative<protocol::Snapshot>(message.payload) && client.snapshots >= kMostSnapshots)
        return room_->reject(received.client, {message.id, code::busy,
                                               std::to_string(kMostSnapshots) +
                                                   " snapshots of this client are waiting already"});
    if (const auto* snapshot = std::get_if<protocol::Snapshot>(&message.payload))
        if (!fits(snapshot->width, snapshot->height, limits_))
            return room_->reject(received.client,
                                 {message.id, code::out_of_range,
                                  "'width' x 'height' must be at most " + std::to_string(limits_.max_pixels) +
                                      " pixels, each side at most " + std::to_string(limits_.max_side)});
    const plan::View before = room_->visible();
    const protocol::Resize size_before = room_->view_size();
    sequence_ = received.sequence;
    const bool accepted = room_->handle_message(received.client, message, time_of(received.arrival));
    sequence_ = 0;
    if (room_->visible() != before || room_->view_size() != size_before) {
        last_change_ = base::Clock::now();
        newest_input_ = received.arrival;
    }
    if (const auto* shown = std::get_if<protocol::Shown>(&message.payload); shown && accepted)
        stats_.shown(received.client, shown->revision, received.arrival);
    for (room::PictureOrder& order : room_->take_orders()) {
        ++client.snapshots;
        snapshots_.push_back({std::move(order)});
    }
}

PictureSize Engine::present_size() const {
    const protocol::Resize& view = room_->view_size();
    return picture_size(view, quality_of(kRefined, view, pixel_budget_, false).scale);
}

/// Hands over what there is to send.
void Engine::publish() {
    const base::Clock::time_point now = base::Clock::now();
    if (shared_) room_->write_revision();
    if (const auto& document = room_->document(); document != reported_) {
        reported_ = output_.document = document;
        output_.by = room_->changed_by();
        output_.by_since = room_->changed_by_since();
        stats_.made(document->revision(), now);
        metrics_.scene_nodes = room_->state().scene.value->nodes;
        metrics_.scene_triangles = room_->state().scene.value->triangles;
    }
    if (const PictureSize size = present_size(); size != reported_size_) output_.size = reported_size_ = size;
    const std::int64_t present = shows_present() ? newest_.frame : 0;
    if (present != reported_present_) output_.present_frame = reported_present_ = present;
    std::ranges::move(room_->take_answers(), std::back_inserter(output_.answers));
    for (const room::Answer& answer : output_.answers)
        if (!answer.rejection.empty()) {
            ++metrics_.errors[answer.code];
            observe::log_debug(
                "message_refused",
                {{"client", answer.client}, {"code", answer.code}, {"reason", answer.rejection}});
        }
    if (const auto stats = stats_.take(now))
        output_.stats = std::make_shared<const std::string>(protocol::encode(*stats));
    for (const protocol::Pointed& pointed : room_->take_pointed())
        output_.pointed[pointed.client] = std::make_shared<const std::string>(protocol::encode(pointed));
    if (!output_.empty()) callbacks_.on_output(std::exchange(output_, {}));
}

}  // namespace vrut::server::engine
