#include "nats/shared_room.hpp"

#include <algorithm>
#include <future>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "observe/log.hpp"
#include "rights.hpp"

namespace vrut::server::nats {

namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;

constexpr auto kLogPoll = 50ms;
constexpr auto kRenew = 500ms;
constexpr auto kYield = 3s;      // to who drew the room, and may be cut off or hang
constexpr auto kPause = 5s;      // after what would come again at once
constexpr int kTimesStored = 5;  // a state, in the time for which NATS keeps it
constexpr std::size_t kEntryBytes = std::size_t{256} << 10;  // of lines, at most
constexpr std::size_t kMostLines = 100'000;                  // since a checkpoint, that wait for NATS
constexpr std::size_t kMostGated = 2'000;                    // outputs and frames that wait for edges

/// An entry that says: what follows goes on from the state that is stored next.
constexpr std::string_view kRestart = "restart\n";

std::string text_of(const room::Checkpoint& checkpoint) {
    return protocol::encode(checkpoint.header) + "\n" +
           protocol::encode(protocol::LogLine{protocol::LogTime{0}, {}, checkpoint.revised});
}

struct Superseded : std::runtime_error {
    Superseded() : std::runtime_error("another server draws it") {}
};

}  // namespace

SharedRoom::SharedRoom(const Connection& connection, Options options)
    : connection_(connection),
      options_(std::move(options)),
      store_(connection, options_.room),
      owner_(connection, options_.room, options_.role_for) {}

SharedRoom::~SharedRoom() { stop(); }

void SharedRoom::stop() {
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
    end();  // and the engine may, from here on
}

void SharedRoom::end() {
    {
        const std::lock_guard lock(mutex_);
        is_stopped_ = true;
        to_clients_.clear();
        to_edges_.clear();
    }
    owner_.end();
}

engine::SharedHooks SharedRoom::hooks() {
    engine::SharedHooks hooks;
    hooks.on_line = [this](const protocol::LogLine& line) {
        {
            const std::lock_guard lock(mutex_);
            note(line);
            lines_.push_back({protocol::encode(line), ++written_lines_});
        }
        written_.notify_one();
    };
    hooks.on_checkpoint = [this](const room::Checkpoint& checkpoint) {
        const std::lock_guard lock(mutex_);
        room::Checkpoint with_sequences = checkpoint;
        for (protocol::LogHeader::Client& client : with_sequences.header.clients)
            client.sequence = clients_[client.client].sequence;
        checkpoint_ = Checkpoint{text_of(with_sequences), written_lines_};
    };
    hooks.on_failure = [this](const std::string& why) {
        const std::lock_guard lock(mutex_);
        failure_ = why;
    };
    return hooks;
}

/// Who is here, and what of their messages the log has.
void SharedRoom::note(const protocol::LogLine& line) {
    if (const auto* connected = std::get_if<protocol::LogLine::Connected>(&line.what))
        clients_[line.client] = {may(connected->role, protocol::Right::hold_control), engine::kHelloSequence};
    else if (std::holds_alternative<protocol::LogLine::Disconnected>(line.what))
        clients_.erase(line.client);
    else if (line.sequence > 0)
        clients_[line.client].sequence = line.sequence;
}

engine::EngineCallbacks SharedRoom::relay(engine::EngineCallbacks to_clients) {
    engine::EngineCallbacks callbacks;
    callbacks.on_output = [this, own = std::move(to_clients.on_output)](const engine::EngineOutput& output) {
        when_stored([own, output] { own(output); }, [this, output] { owner_.send(output); });
    };
    callbacks.on_encoded = [this, own = std::move(to_clients.on_encoded)](
                               const std::shared_ptr<const engine::EncodedPicture>& picture) {
        when_stored([own, picture] { own(picture); }, [this, picture] { owner_.send(picture); });
    };
    callbacks.on_failure = std::move(to_clients.on_failure);
    return callbacks;
}

void SharedRoom::when_stored(std::function<void()> to_clients, std::function<void()> to_edges) {
    const std::lock_guard lock(mutex_);
    if (is_stopped_) return;
    const bool is_stored = stored_lines_ == written_lines_;
    if ((is_stored || is_away_) && to_clients_.empty())
        to_clients();
    else
        to_clients_.push_back({written_lines_, std::move(to_clients)});
    if (is_stored && to_edges_.empty())
        to_edges();
    else
        to_edges_.push_back({written_lines_, std::move(to_edges)});
    if (to_edges_.size() <= kMostGated) return;
    // Edges find that something is missing, and ask for all.
    owner_.skip();
    to_edges_.front().release();
    to_edges_.pop_front();
}

void SharedRoom::release(Gate& gate, std::uint64_t stored) {
    while (!gate.empty() && gate.front().number <= stored) {
        gate.front().release();
        gate.pop_front();
    }
}

void SharedRoom::begin(engine::RoomEngine& engine) {
    engine_ = &engine;
    has_state_ = load_state();
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void SharedRoom::run(const std::stop_token& stop) {
    try {
        if (follow(stop)) own(stop);
    } catch (const Superseded& error) {
        leave(error.what(), stop);
    } catch (const std::exception& error) {
        std::unique_lock lock(mutex_);
        observe::log_warning("room_stalls", {{"room", options_.room}, {"reason", error.what()}});
        written_.wait_for(lock, stop, kPause, [] { return false; });
        lock.unlock();
        leave(error.what(), stop);
    }
}

void SharedRoom::leave(const std::string& why, const std::stop_token& stop) {
    observe::log_warning("room_left", {{"room", options_.room}, {"reason", why}});
    if (!stop.stop_requested()) options_.on_superseded(why);
}

// --- while another server draws the room

/// As the room stood when its state was stored last; false: it has none. Throws std::runtime_error where it
/// cannot be shown.
bool SharedRoom::load_state() {
    const auto state = store_.state();
    if (!state) return false;
    std::istringstream lines(state->text);
    std::string header_line, revised_line;
    std::getline(lines, header_line);
    std::getline(lines, revised_line);
    auto header = protocol::decode_log_header(header_line);
    const auto revised = protocol::decode_log_line(revised_line);
    if (!header || !revised)
        throw std::runtime_error("the state of the room '" + options_.room +
                                 "' cannot be used: " + (header ? revised.error() : header.error()).message);
    auto scene = options_.find_scene(header->scene, header->scene_sha256, header->up_axis);
    if (!scene)
        throw std::runtime_error("the room '" + options_.room + "' shows another scene: " + scene.error());
    auto checkpoint = std::make_shared<room::Checkpoint>();
    clients_.clear();
    for (const protocol::LogHeader::Client& client : header->clients)
        clients_[client.client] = {may(client.role, protocol::Right::hold_control), client.sequence};
    checkpoint->header = *std::move(header);
    if (const auto* what = std::get_if<protocol::LogLine::Revised>(&revised->what))
        checkpoint->revised = *what;
    engine_->push(
        engine::FollowFrom{checkpoint, std::make_shared<const scenes::LoadedScene>(*std::move(scene))});
    store_.follow(followed_ = state->sequence);
    awaited_state_.reset();
    return true;
}

/// What came since. Where some of it is forgotten, the state that made it needless is there.
void SharedRoom::follow_log() try {
    if (awaited_state_) {
        const auto state = store_.state();
        if (state && state->sequence >= *awaited_state_) load_state();
    }
    for (const RoomStore::Entry& entry : store_.next(kLogPoll)) follow_entry(entry);
} catch (const RoomStore::EntriesForgotten&) {
    if (!load_state()) throw;
}

void SharedRoom::follow_entry(const RoomStore::Entry& entry) {
    followed_ = entry.sequence;
    if (entry.text == kRestart) {
        awaited_state_ = entry.sequence;
        return;
    }
    if (awaited_state_) return;  // they come again behind the state
    std::istringstream lines(entry.text);
    for (std::string text; std::getline(lines, text);) {
        auto line = protocol::decode_log_line(text);
        if (!line)
            throw std::runtime_error("a line of the room's log cannot be read: " + line.error().message);
        note(*line);
        engine::Follow follow{*std::move(line)};
        if (const auto* opened = std::get_if<protocol::LogLine::Opened>(&follow.line.what)) {
            auto scene = options_.find_scene(opened->scene, opened->sha256, opened->up_axis);
            if (!scene) throw std::runtime_error(scene.error());
            follow.scene = std::make_shared<const scenes::LoadedScene>(*std::move(scene));
        }
        engine_->push(std::move(follow));
    }
}

/// Until this server draws the room. Returns false if it is to stop.
bool SharedRoom::follow(const std::stop_token& stop) {
    observe::log_info("room_followed", {{"room", options_.room}});
    std::uint64_t reconnects = connection_.reconnects();
    while (!stop.stop_requested()) {
        if (has_state_)
            follow_log();
        else
            has_state_ = load_state();
        {
            std::unique_lock lock(mutex_);
            if (failure_) throw std::runtime_error(*failure_);
            if (!has_state_) written_.wait_for(lock, stop, kLogPoll, [] { return false; });
        }
        if (reconnects != connection_.reconnects()) {
            reconnects = connection_.reconnects();
            may_take_from_ = steady_clock::now() + kYield;
        }
        const bool may_take = connection_.is_connected() && steady_clock::now() >= may_take_from_;
        if (may_take && may_draw() && store_.take_lease(id_) && take_over()) return true;
    }
    return false;
}

/// With a state, or as the first. While NATS has a log without the state from which it goes on, a server that
/// has followed the room, and may hang, has all; who has nothing would begin an empty room in its place.
bool SharedRoom::may_draw() {
    if (has_state_) return true;
    const auto log = store_.range();
    if (!log) return false;
    followed_ = log->last;
    if (store_.may_begin(*log)) return true;
    may_take_from_ = steady_clock::now() + kYield;
    if (!std::exchange(waits_, true))
        observe::log_warning(
            "room_waits",
            {{"room", options_.room},
             {"reason",
              "NATS has the log of the room, but no state: a server that has followed the room draws it; if "
              "none is left, serve it by another name, or wait for ten minutes, when NATS has forgotten "
              "it"}});
    return false;
}

/// Behind the last line of who drew the room before: it can add no further one then. The place of this entry
/// in the log is the lease's number, which rises with each server that takes over.
bool SharedRoom::take_over() {
    // A state may have been stored since it was asked for; else this server is the first.
    if (!has_state_) has_state_ = load_state();
    for (const auto end = steady_clock::now() + RoomStore::kLease; steady_clock::now() < end;) {
        const auto log = store_.range();
        if (!log) continue;
        if (!has_state_ && followed_ < log->last) break;  // another server was
        // What came between was forgotten when a later state was stored.
        if (followed_ + 1 < log->first && !load_state())
            throw std::runtime_error("entries of the room's log are lost, from " +
                                     std::to_string(followed_ + 1));
        while (followed_ < log->last && steady_clock::now() < end) follow_log();
        if (followed_ < log->last) continue;
        const auto appended = store_.append("", followed_, id_ + ".first");
        if (!appended) continue;
        const std::uint64_t lease = followed_ = *appended;
        renewed_at_ = steady_clock::now();
        observe::log_info("room_taken_over", {{"room", options_.room}, {"lease", lease}});
        std::map<std::string, RoomOwner::Known> of_edges;
        std::map<std::string, std::uint64_t> sequences;
        for (const auto& [client, known] : clients_) sequences[client] = known.sequence;
        std::promise<void> taken_over;
        engine_->push(engine::TakeOver{lease, std::move(sequences), [&] { taken_over.set_value(); }});
        taken_over.get_future().wait();
        {
            const std::lock_guard lock(mutex_);
            if (failure_) throw std::runtime_error(*failure_);  // of the last lines
            of_edges = clients_;
        }
        // The door of who drew it before is another's.
        for (const auto& [client, known] : of_edges)
            if (!is_of_edge(client)) engine_->push(engine::ClientLeft{client});
        owner_.begin(*engine_, lease, of_edges);
        return true;
    }
    store_.release_lease();
    return false;
}

// --- while this server does

void SharedRoom::own(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
        {
            std::unique_lock lock(mutex_);
            written_.wait_for(lock, stop, kLogPoll, [&] { return !lines_.empty(); });
        }
        if (steady_clock::now() - renewed_at_ >= kRenew && !renew()) throw Superseded();
        if (!append_lines()) throw Superseded();
        store_checkpoint();
    }
    while (append_lines() && entry_.empty()) {
        const std::lock_guard lock(mutex_);
        if (lines_.empty()) break;
    }
    end();  // before another draws
    store_.release_lease();
}

/// Returns false if another server draws the room.
bool SharedRoom::renew() {
    switch (store_.renew_lease()) {
        case RoomStore::Renewed::yes:
            break;
        case RoomStore::Renewed::lost:
            return false;
        case RoomStore::Renewed::unknown:
            renewed_at_ = steady_clock::now();
            return true;
        case RoomStore::Renewed::expired:
            // If another server has taken the room over, the next entry is not added.
            store_.take_lease(id_);
            break;
    }
    renewed_at_ = steady_clock::now();
    return true;
}

/// With mutex_ held. Clients of this server's own door go on. What lies before a checkpoint need not be kept
/// for the log, which goes on from that once NATS answers.
void SharedRoom::go_on_alone() {
    release(to_clients_, written_lines_);
    if (checkpoint_ && !lines_.empty() && lines_.front().number <= checkpoint_->number) {
        while (!lines_.empty() && lines_.front().number <= checkpoint_->number) lines_.pop_front();
        if (!restart_) observe::log_info("room_log_restarts", {{"room", options_.room}});
        restart_ = std::exchange(checkpoint_, std::nullopt);
    }
    if (lines_.size() > kMostLines)
        throw std::runtime_error("NATS has not answered for too long: its log of the room is incomplete");
}

/// Makes an entry of the lines that wait. Returns false if there are none.
bool SharedRoom::next_entry() {
    const std::lock_guard lock(mutex_);
    if (restart_) {
        entry_ = kRestart;
    } else {
        // Those behind a checkpoint come when that is stored.
        const auto is_next = [&] { return !checkpoint_ || lines_.front().number <= checkpoint_->number; };
        while (!lines_.empty() && is_next() && entry_.size() < kEntryBytes) {
            entry_ += lines_.front().text + "\n";
            entry_number_ = lines_.front().number;
            lines_.pop_front();
        }
    }
    entry_id_ = id_ + "." + std::to_string(++entries_);
    return !entry_.empty();
}

/// The state from which the log goes on, once that is announced.
void SharedRoom::store_restart() {
    Checkpoint restart;
    {
        const std::lock_guard lock(mutex_);
        restart = *restart_;
    }
    const bool is_stored = connection_.is_connected() && store_.store_state({followed_, restart.text});
    const std::lock_guard lock(mutex_);
    is_away_ = !is_stored;
    if (is_away_) return go_on_alone();
    restart_is_announced_ = false;
    restart_.reset();
    stored_lines_ = restart.number;
    state_again_at_ = steady_clock::now() + store_.state_kept() / kTimesStored;
    kept_ = {followed_, std::move(restart.text)};
    release(to_clients_, stored_lines_);
    release(to_edges_, stored_lines_);
}

/// Appends the lines that wait, as one entry. Returns false if another server draws the room.
bool SharedRoom::append_lines() {
    if (restart_is_announced_) {
        store_restart();
        return true;
    }
    if (entry_.empty() && !next_entry()) return true;
    using NotAppended = RoomStore::NotAppended;
    const auto appended = connection_.is_connected() ? store_.append(entry_, followed_, entry_id_)
                                                     : tl::unexpected(NotAppended::unknown);
    if (!appended && appended.error() == NotAppended::superseded) return false;
    const std::lock_guard lock(mutex_);
    if (is_away_ == appended.has_value()) {
        is_away_ = !is_away_;
        if (is_away_)
            observe::log_warning("room_not_stored", {{"room", options_.room}});
        else
            observe::log_info("room_stored", {{"room", options_.room}});
    }
    if (is_away_) {
        go_on_alone();
        return true;
    }
    followed_ = *appended;
    restart_is_announced_ = entry_ == kRestart;
    entry_.clear();
    if (restart_is_announced_) return true;
    stored_lines_ = entry_number_;
    release(to_clients_, stored_lines_);
    release(to_edges_, stored_lines_);
    return true;
}

/// Where all lines before it are stored, and no others. Else the last one again, before it expires.
void SharedRoom::store_checkpoint() {
    std::optional<Checkpoint> newest;
    {
        const std::lock_guard lock(mutex_);
        const bool all_is_stored = checkpoint_ && checkpoint_->number == stored_lines_ && entry_.empty();
        if (checkpoint_ ? !all_is_stored : steady_clock::now() < state_again_at_) return;
        newest = std::exchange(checkpoint_, std::nullopt);
    }
    if (newest) kept_ = {followed_, std::move(newest->text)};
    const bool is_stored = newest ? store_.store_state(*kept_) : store_state_again();
    state_again_at_ = steady_clock::now() + (is_stored ? store_.state_kept() / kTimesStored : kPause);
    if (!is_stored) observe::log_warning("room_state_not_stored", {{"room", options_.room}});
}

/// Also while lines come without end: the log has all that came since. Where this server has followed the
/// room and not stored a state yet, it is the one of the server before.
bool SharedRoom::store_state_again() try {
    auto at_nats = store_.state();
    if (at_nats && (!kept_ || kept_->sequence < at_nats->sequence)) kept_ = std::move(at_nats);
    return kept_ && store_.store_state(*kept_);
} catch (const std::runtime_error&) {  // NATS does not answer
    return false;
}

}  // namespace vrut::server::nats
