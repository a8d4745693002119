// A room that several servers share: one draws it, and the others follow what it does.
#include "engine/engine.hpp"
#include "observe/log.hpp"

namespace vrut::server::engine {

namespace {

/// Snapshots have numbers, too, of which the log knows nothing.
constexpr std::int64_t kUnseenFrames = 1000;

template <class What>
void keep_newest(std::deque<What>& kept, std::vector<What> added) {
    constexpr std::size_t kMost = 256;
    for (What& each : added) kept.push_back(std::move(each));
    while (kept.size() > kMost) kept.pop_front();
}

}  // namespace

/// Of a room that this server draws.
room::RoomOptions Engine::live_options() {
    room::RoomOptions options;
    connect_files(options);
    options.share = share_;
    if (shared_)
        options.journal = [this](protocol::LogLine line) {
            line.sequence = sequence_;
            ++lines_;
            line_at_ = base::Clock::now();
            shared_->on_line(line);
        };
    return options;
}

void Engine::handle(const FollowFrom& from) {
    if (!follows_) return;
    room::RoomOptions options;
    options.policy = room::kFollow;
    room_.emplace(prepared(*from.scene), std::move(options));
    if (const auto restored = room_->restore(from.checkpoint->header); !restored)
        return shared_->on_failure("its state cannot be used: " + restored.error().message);
    room_->follow(from.checkpoint->revised, room::SessionTime{0});
    for (const protocol::LoggedFrame& frame : from.checkpoint->header.frames)
        next_frame_ = std::max(next_frame_, frame.frame + 1);
    clients_.clear();
    use(scenes::built_in_levels());
    read_levels(*from.scene);
}

void Engine::handle(const Follow& what) {
    if (!follows_) return;
    const auto find_scene = [&](const auto&...) -> tl::expected<scenes::LoadedScene, std::string> {
        if (!what.scene) return tl::unexpected<std::string>("the scene is not here");
        return prepared(*what.scene);
    };
    const auto wrong = room::play(*room_, what.line, find_scene);
    // Whether these have reached who asked is not known: who took them does not take them again.
    keep_newest(followed_answers_, room_->take_answers());
    keep_newest(followed_orders_, room_->take_orders());
    if (wrong) return shared_->on_failure(*wrong);
    if (const auto* drawn = std::get_if<protocol::LogLine::Drawn>(&what.line.what))
        next_frame_ = std::max(next_frame_, drawn->frame + 1);
    if (!what.scene) return;
    use(scenes::built_in_levels());
    read_levels(*what.scene);
}

void Engine::handle(const TakeOver& take_over) {
    lease_ = take_over.lease;
    const base::Clock::time_point now = base::Clock::now();
    start_ = now - room_->time();
    room_->go_on(live_options());
    note_kept();
    for (const auto& [client, role] : room_->clients()) {
        const auto followed = take_over.sequences.find(client);
        clients_[client].sequence =
            std::max(kHelloSequence, followed == take_over.sequences.end() ? 0 : followed->second);
        output_.handled[client].sequence = kHelloSequence;
        stats_.joined(client, role, room_->client_name(client), now);
    }
    for (room::Answer& answer : followed_answers_) output_.answers.push_back(std::move(answer));
    output_.again = !followed_answers_.empty();
    followed_answers_.clear();
    for (room::PictureOrder& order : followed_orders_) {
        if (!clients_.contains(order.client)) continue;
        ++clients_[order.client].snapshots;
        snapshots_.push_back({std::move(order)});
    }
    followed_orders_.clear();
    next_frame_ += kUnseenFrames;
    last_change_ = now;
    lines_ = 1;  // what was followed is kept as a whole, at once where nothing goes on
    line_at_ = now - kJournalQuiet;
    follows_ = false;
    keep_checkpoint();
    for (const protocol::Notice& notice : std::exchange(held_notices_, {})) room_->notice(notice);
    take_over.done();
}

/// What stands between two checkpoints is followed line by line.
void Engine::keep_checkpoint() {
    if (!shared_ || lines_ == 0 || base::Clock::now() - line_at_ < kJournalQuiet) return;
    if (const auto checkpoint = room_->checkpoint()) {
        shared_->on_checkpoint(*checkpoint);
        lines_ = 0;
    } else {
        line_at_ = base::Clock::now();
    }
}

}  // namespace vrut::server::engine
