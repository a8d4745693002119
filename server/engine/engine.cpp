#include "engine/engine.hpp"

#include <algorithm>
#include <limits>

#include "codec.hpp"
#include "observe/log.hpp"
#include "renderer.hpp"
#include "scene/level_store.hpp"

namespace vrut::server::engine {

namespace code = protocol::error_code;

namespace {

constexpr int kMostSnapshots = 2;  // of a client, waiting
/// At most, for those who follow the camera without frames.
constexpr std::chrono::milliseconds kFlightStep{16};

/// "" where it is of none.
std::string client_of(const EngineEvent& event) {
    return std::visit(
        [](const auto& what) {
            if constexpr (requires { what.client; })
                return what.client;
            else
                return std::string();
        },
        event);
}

/// The earlier of two times, where there are any.
std::optional<base::Clock::time_point> earlier(std::optional<base::Clock::time_point> a,
                                               std::optional<base::Clock::time_point> b) {
    return !a ? b : !b ? a : std::min(*a, *b);
}

}  // namespace

PainterFactory gl_painter(std::optional<int> device) {
    return [device] {
        auto renderer = std::make_shared<Renderer>(device);
        for (const std::string& sentence : renderer->rejected())
            observe::log_warning("device_passed_over", {{"reason", sentence}});
        observe::log_info("drawing", {{"renderer", renderer->description()}});
        return Painter{renderer->description(),
                       renderer->software(),
                       renderer->max_size(),
                       [renderer](const View& view) { renderer->take(view); },
                       [renderer](const View& view, Image& image, FrameStats& stats,
                                  const std::function<bool()>& interrupted, Accumulation* kept) {
                           return renderer->render(view, image, stats, interrupted, kept);
                       },
                       [renderer] { return renderer->gl_objects(); }};
    };
}

Engine::Engine(EngineOptions options, PainterFactory factory, observe::Metrics& metrics,
               EngineCallbacks callbacks)
    : library_(std::move(options.library)),
      record_folder_(std::move(options.record_folder)),
      metrics_(metrics),
      callbacks_(std::move(callbacks)),
      file_results_(
          std::make_shared<ResultPost>([this](FileWorkDone done) { mailbox_.push(std::move(done)); })),
      lookup_(
          {[library = library_] { return library.names(); },
           [library = library_](const std::string& name) { return library.find(name); }},
          file_results_,
          [this](auto request, const auto& names) { presentation_->scenes_listed(request, names); },
          [this](auto request, const auto& found) {
              presentation_->load_answered(request, load(found), time_of(base::Clock::now()));
          }),
      recordings_([folder = record_folder_](const std::string& name) { return open_log(folder, name); },
                  file_results_,
                  [this](auto recording, const auto& name) {
                      presentation_->recording_opened(recording, name, time_of(base::Clock::now()));
                  },
                  [this](auto recording, const auto& why) {
                      presentation_->recording_ended(recording, why, time_of(base::Clock::now()));
                  },
                  {}),
      encoder_(
          metrics, callbacks_.on_encoded, [this] { mailbox_.wake(); }, callbacks_.on_failure),
      snapshot_encoder_(
          metrics, callbacks_.on_encoded, [this] { mailbox_.wake(); }, callbacks_.on_failure),
      loader_([this](scene::SceneLoading loading) { mailbox_.push(std::move(loading)); },
              [this](scene::SceneLoaded loaded) { mailbox_.push(std::move(loaded)); }),
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
            while (!mailbox_.closed()) step();
        } catch (const std::exception& error) {
            if (begun)
                callbacks_.on_failure(error.what());
            else
                started.set_exception(std::current_exception());
        }
        painter_ = {};  // what belongs to GL ends on the thread that it began on
        presentation_.reset();
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
    file_results_->close();
}

scene::LoadedScene Engine::with_notices(scene::LoadedScene scene) const {
    if (painter_.software)
        scene.notices.push_back("Drawn in software, without a graphics card: expect fewer pictures a second");
    return scene;
}

void Engine::begin(const scene::LoadedScene& scene) {
    heart_.beat();
    painter_ = factory_();
    description_ = painter_.description;
    limits_.max_side = std::min(painter_.max_size, limits_.max_side);
    room_ = limits_;
    use(scene::levels_of(scene.sha256, description_));
    room::PresentationOptions options;
    connect_files(options);
    presentation_.emplace(with_notices(scene), std::move(options));
    if (const auto refusal = take(scene)) throw std::runtime_error(*refusal);

    // Drivers compile programs and states when they are first used; better now than under the first finger.
    Image image;
    FrameStats stats;
    View small = presentation_->visible();
    small.width = small.height = 64;
    paint(small, image, stats);
}

void Engine::step() {
    check_files();
    if (!waiting_.empty()) handle_waiting();
    if (arrived_) show(*std::exchange(arrived_, std::nullopt));
    if (presentation_->view_size() != room_for_ || (undrawable_ && !is_undrawable())) {
        room_for_ = presentation_->view_size();
        room_ = limits_;
        undrawable_.reset();
    }
    fly();
    const base::Clock::time_point now = base::Clock::now();
    serve_newest(now);
    report();
    const PacingDecision decision = pace(now);
    const bool draws = decision.action == PacingDecision::Action::draw;
    // While things move, snapshots get a fifth of the time: a sample of theirs may take longer than a
    // picture.
    const base::Clock::time_point begin = base::Clock::now();
    const bool moves = begin < last_change_ + kQuiet;
    const bool snapshot = !snapshots_.empty() && snapshot_encoder_.is_free();
    if (snapshot && (moves ? begin >= snapshot_turn_ : !draws)) {
        draw_snapshot();
        const base::Clock::time_point end = base::Clock::now();
        snapshot_turn_ = end + 4 * (end - begin);
    } else if (draws) {
        draw(decision);
    } else {
        wait_for_event(snapshot && moves ? earlier(decision.until, snapshot_turn_) : decision.until);
    }
}

void Engine::wait_for_event(std::optional<base::Clock::time_point> until) {
    until = earlier(earlier(until, stats_.due()), files_due());
    if (presentation_->flies()) until = earlier(until, base::Clock::now() + kFlightStep);
    receive(waiting_.empty() ? until : base::Clock::now());
    handle_waiting();
}

void Engine::fly() {
    if (!presentation_->flies()) return;
    last_change_ = base::Clock::now();
    presentation_->advance(time_of(last_change_));
}

// --- events

void Engine::receive(std::optional<base::Clock::time_point> until) {
    heart_.rest();
    std::vector<EngineEvent> events = mailbox_.wait(until);
    heart_.beat();
    for (EngineEvent& event : events) {
        const std::string client = client_of(event);
        if (std::holds_alternative<ClientLeft>(event)) taken_ -= std::exchange(waiting_[client], {}).size();
        waiting_[client].push_back(std::move(event));
        ++taken_;
    }
}

/// What must not wait for the whole of a long picture; between two of its samples.
void Engine::attend() {
    receive(base::Clock::now());
    handle_waiting();
    fly();
    report();
}

void Engine::handle_waiting() {
    constexpr std::chrono::milliseconds kSlice{4};  // then it is time for pictures and answers
    const base::Clock::time_point end = base::Clock::now() + kSlice;
    while (!waiting_.empty() && !mailbox_.closed() && base::Clock::now() < end) {
        auto next = waiting_.upper_bound(last_handled_);
        if (next == waiting_.end()) next = waiting_.begin();
        last_handled_ = next->first;
        const EngineEvent event = std::move(next->second.front());
        next->second.pop_front();
        --taken_;
        if (next->second.empty()) waiting_.erase(next);
        std::visit([&](const auto& what) { handle(what); }, event);
    }
}

void Engine::handle(const ClientJoined& joined) {
    clients_[joined.client].handled = joined.id;
    const base::Clock::time_point now = base::Clock::now();
    presentation_->join(joined.client, joined.role, time_of(now), joined.name);
    stats_.joined(joined.client, joined.role, joined.name, now);
}

void Engine::handle(const ClientLeft& left) {
    clients_.erase(left.client);
    std::erase_if(snapshots_, [&](const Snapshot& snapshot) { return snapshot.order.client == left.client; });
    const base::Clock::time_point now = base::Clock::now();
    presentation_->leave(left.client, time_of(now));
    stats_.left(left.client, now);
}

void Engine::handle(const FrameSent& sent) {
    const auto found = clients_.find(sent.client);
    if (found == clients_.end()) return;
    Client& client = found->second;
    client.last_frame = std::max(client.last_frame, sent.frame);
    client.grants = std::min(client.grants + sent.unused_grants, protocol::kMaxGrants);
    // One that it had already is not sent again.
    client.owed = std::max(client.owed - (sent.frame > client.newest_sent) - sent.unused_grants, 0);
    if (sent.frame > client.newest_sent) client.sent.push_back(sent);
    client.newest_sent = std::max(client.newest_sent, sent.frame);
    if (client.sent.size() > protocol::kMaxGrants) client.sent.pop_front();
    was_delivered(sent.frame);
}

/// The first picture of a scene is not kept waiting by coarser surfaces that are made for later ones.
void Engine::was_delivered(std::int64_t frame) {
    const auto& placed = presentation_->visible().scene;
    const auto simplifies = [](const protocol::Level& level) { return level.quality.detail > 0; };
    if (detail_ || frame < scene_since_ || !placed ||
        std::none_of(choice_->levels().begin(), choice_->levels().end(), simplifies))
        return;
    try {
        detail_ = std::make_shared<const DetailLevels>(placed->scene);
    } catch (const std::exception& error) {  // no memory, or no thread
        observe::log_warning("no_coarser_surfaces", {{"reason", error.what()}});
        scene_since_ = std::numeric_limits<std::int64_t>::max();  // it is not tried again for this scene
    }
}

/// For the scene that is shown from now on.
void Engine::use(const protocol::LevelTable& table) {
    choice_.emplace(table);
    at_rest_.clear();
    for (const protocol::Level& level : table.levels)
        if (level.quality.level == protocol::Quality::Level::still) at_rest_.push_back(level);
    begun_.clear();
    measured_by_.clear();
    // Elsewhere, since the level that is being made is waited for.
    if (detail_) given_up_ = std::async([levels = std::move(detail_)]() mutable { levels.reset(); });
    scene_since_ = next_frame_;
}

void Engine::handle(const SnapshotSent& sent) {
    if (const auto found = clients_.find(sent.client); found != clients_.end()) --found->second.snapshots;
}

void Engine::handle(const PictureAsked& asked) {
    const PictureSize present = present_size();
    room::PictureOrder order = presentation_->order(asked.width > 0 ? asked.width : present.width,
                                                    asked.height > 0 ? asked.height : present.height);
    order.client = asked.name;
    snapshots_.push_back({std::move(order), {}, {}});
}

void Engine::handle(const scene::SceneLoading& loading) { tell({loading.name, loading.fraction, {}, {}}); }

void Engine::tell(const protocol::Loading& loading) {
    output_.loading = std::make_shared<const std::string>(protocol::encode(loading));
    output_.loads = !loading.done && !loading.refused;
}

void Engine::handle(const scene::SceneLoaded& loaded) { arrived_ = loaded; }

void Engine::handle(const ClientSaid& said) {
    const auto found = clients_.find(said.client);
    if (found == clients_.end()) return;  // it has left
    Client& client = found->second;
    output_.handled[said.client].bytes += said.bytes;
    output_.handled[said.client].requests += said.is_request();
    const auto id = said.message ? said.message->id : said.message.error().id;
    if (id && *id <= client.handled)
        presentation_->refuse(said.client, {id, code::out_of_range,
                                            "'id' must rise: " + std::to_string(client.handled) +
                                                " came before " + std::to_string(*id)});
    else if (!said.message)
        presentation_->refuse(said.client, said.message.error());
    else if (std::holds_alternative<protocol::FrameGrant>(said.message->payload))
        grant(client, said);
    else
        say(said, *said.message, client);
    if (id) client.handled = std::max(client.handled, *id);
}

void Engine::grant(Client& client, const ClientSaid& said) {
    ++metrics_.frames_granted;
    client.grants = std::min(client.grants + 1, protocol::kMaxGrants);
    client.is_late = said.is_late;
    const int outstanding = client.grants + client.owed + static_cast<int>(client.sent.size());
    // With no picture that it can answer: so many grants does this client keep outstanding.
    if (client.sent.empty() || (client.sent.size() == 1 && !said.has_frame))
        client.window = std::clamp(outstanding, client.window, protocol::kMaxGrants);
    if (outstanding <= client.window || client.sent.empty()) return;
    // It comes when the oldest has arrived, not the newest, which may be on its way still.
    const FrameSent answered = client.sent.front();
    client.sent.pop_front();
    client.tells = true;
    client.answered = std::max(client.answered, answered.frame);
    if (presentation_->holder() == said.client) measure(answered, said.arrival);
}

void Engine::say(const ClientSaid& said, const protocol::ClientMessage& message, Client& client) {
    if (std::holds_alternative<protocol::Snapshot>(message.payload) && client.snapshots >= kMostSnapshots)
        return presentation_->refuse(
            said.client, {message.id, code::busy,
                          std::to_string(kMostSnapshots) + " snapshots of this client are waiting already"});
    if (const auto* snapshot = std::get_if<protocol::Snapshot>(&message.payload))
        if (!fits(snapshot->width, snapshot->height, limits_))
            return presentation_->refuse(
                said.client, {message.id, code::out_of_range,
                              "'width' x 'height' must be at most " + std::to_string(limits_.max_pixels) +
                                  " pixels, each side at most " + std::to_string(limits_.max_side)});
    const View before = presentation_->visible();
    const protocol::Resize size_before = presentation_->view_size();
    const bool accepted = presentation_->say(said.client, message, time_of(said.arrival));
    if (presentation_->visible() != before || presentation_->view_size() != size_before) {
        last_change_ = base::Clock::now();
        newest_input_ = said.arrival;
    }
    if (const auto* shown = std::get_if<protocol::Shown>(&message.payload); shown && accepted)
        stats_.shown(said.client, shown->revision, said.arrival);
    for (room::PictureOrder& order : presentation_->take_orders()) {
        ++client.snapshots;
        snapshots_.push_back({std::move(order), {}, {}});
    }
}

PictureSize Engine::present_size() const {
    const protocol::Resize& view = presentation_->view_size();
    return picture_size(view, quality_of(kStill, view, room_, false).scale);
}

/// Hands over what there is to tell.
void Engine::report() {
    const base::Clock::time_point now = base::Clock::now();
    if (const auto& document = presentation_->document(); document != reported_) {
        reported_ = output_.document = document;
        output_.by = presentation_->changed_by();
        output_.by_since = presentation_->changed_by_since();
        stats_.made(document->revision(), now);
        metrics_.scene_nodes = presentation_->state().scene.value->nodes;
        metrics_.scene_triangles = presentation_->state().scene.value->triangles;
    }
    if (const PictureSize size = present_size(); size != reported_size_) output_.size = reported_size_ = size;
    output_.answers = presentation_->take_answers();
    for (const room::Answer& answer : output_.answers)
        if (!answer.refusal.empty()) {
            ++metrics_.errors[answer.code];
            observe::log_debug(
                "message_refused",
                {{"client", answer.client}, {"code", answer.code}, {"reason", answer.refusal}});
        }
    if (const auto stats = stats_.take(now))
        output_.stats = std::make_shared<const std::string>(protocol::encode(*stats));
    if (!output_.empty()) callbacks_.on_output(std::exchange(output_, {}));
}

}  // namespace vrut::server::engine
