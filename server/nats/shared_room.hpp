#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <tl/expected.hpp>

#include "engine/engine.hpp"
#include "engine/output.hpp"
#include "nats/room_owner.hpp"
#include "nats/room_store.hpp"
#include "room/replay.hpp"

namespace vrut::server::nats {

/// A room that several servers share. One draws it: it holds a lease, and stores each line of the log before
/// clients see what the line did. The others follow the log, and one of them takes over when the lease
/// expires. While NATS does not answer, the clients of the server's own door go on.
class SharedRoom {
public:
    struct Options {
        std::string room;
        RoomOwner::RoleFor role_for;
        room::SceneFinder find_scene;
        /// On a thread of its own: another server draws the room, and this one has to start again.
        std::function<void(const std::string& why)> on_superseded;
    };

    SharedRoom(const Connection& connection, Options options);
    ~SharedRoom();
    SharedRoom(const SharedRoom&) = delete;
    SharedRoom& operator=(const SharedRoom&) = delete;

    /// For the engine of the room.
    engine::SharedHooks hooks();
    /// The engine's output goes through these to `to_clients`, those of this server's own door, and to
    /// edges.
    engine::EngineCallbacks relay(engine::EngineCallbacks to_clients);
    /// Follows, and takes over when nobody else draws the room. `engine` must live longer.
    void begin(engine::RoomEngine& engine);
    /// Draws the room no longer: another server may at once. The engine's output from here on is dropped,
    /// and nothing of it is kept.
    void stop();

private:
    struct Line {
        std::string text;
        std::uint64_t number = 0;  ///< of all lines that this server wrote, from 1
    };
    struct Checkpoint {
        std::string text;
        std::uint64_t number = 0;  ///< of the last line before it
    };
    /// What clients may see once a line is stored.
    struct Gated {
        std::uint64_t number = 0;
        std::function<void()> release;
    };
    using Gate = std::deque<Gated>;

    void run(const std::stop_token& stop);
    void end();
    void leave(const std::string& why, const std::stop_token& stop);
    // While another server draws the room.
    bool load_state();
    bool follow(const std::stop_token& stop);
    void follow_log();
    void follow_entry(const RoomStore::Entry& entry);
    bool may_draw();
    bool take_over();
    // While this server does.
    void own(const std::stop_token& stop);
    bool append_lines();
    bool next_entry();
    void go_on_alone();
    void store_restart();
    void store_checkpoint();
    bool store_state_again();
    bool renew();
    void note(const protocol::LogLine& line);
    void when_stored(std::function<void()> to_clients, std::function<void()> to_edges);
    void release(Gate& gate, std::uint64_t stored);

    const Connection& connection_;
    const Options options_;
    const std::string id_ = random_id();  ///< of its leases and entries; no other has it, not of this server
    RoomStore store_;
    RoomOwner owner_;
    engine::RoomEngine* engine_ = nullptr;

    // On the room's own thread.
    bool has_state_ = false;      ///< of the room, or it is the first to draw it
    std::uint64_t followed_ = 0;  ///< sequence of the last entry in the log, as far as is known
    /// While it follows: the sequence of an entry from which the log goes on with a state, which has not come
    /// yet.
    std::optional<std::uint64_t> awaited_state_;
    std::string entry_id_;  ///< of the entry that is being appended
    std::string entry_;
    std::uint64_t entry_number_ = 0;  ///< of its last line
    std::uint64_t entries_ = 0;
    bool waits_ = false;                                     ///< for a state, and has said so
    std::chrono::steady_clock::time_point may_take_from_{};  ///< the room
    std::chrono::steady_clock::time_point renewed_at_{}, state_again_at_{};
    std::optional<RoomStore::State> kept_;  ///< the last one, which is stored again before it expires

    // Of clients: the sequences of their last messages, as the log has them.
    std::map<std::string, RoomOwner::Known> clients_;

    std::mutex mutex_;
    std::condition_variable_any written_;
    std::deque<Line> lines_;
    std::optional<Checkpoint> checkpoint_;
    /// The log goes on from here once NATS answers: the lines before it are not kept for so long.
    std::optional<Checkpoint> restart_;
    bool restart_is_announced_ = false;
    std::uint64_t written_lines_ = 0, stored_lines_ = 0;
    bool is_away_ = false;  ///< NATS does not answer
    bool is_stopped_ = false;
    std::optional<std::string> failure_;
    Gate to_clients_, to_edges_;

    std::jthread thread_;  // last: it uses all of the above
};

}  // namespace vrut::server::nats
