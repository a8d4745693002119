#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "base/clock.hpp"
#include "engine/output.hpp"
#include "engine/room_engine.hpp"
#include "nats/relay.hpp"
#include "observe/metrics.hpp"
#include "room_relay.hpp"

namespace vrut::server::nats {

/// A room that another server draws, as an edge's connections see it. A client's message is kept until that
/// server has handled it, and is sent again to the next one.
class RemoteRoom final : public engine::RoomEngine {
public:
    using Admitted = std::function<void(tl::expected<protocol::Role, protocol::Error>)>;

    /// `edge`: this edge's id, with which the names of its clients end, behind a point. The callbacks are
    /// called on a thread of the room's own.
    RemoteRoom(const Connection& connection, std::string room, std::string edge, observe::Metrics& metrics,
               engine::EngineCallbacks callbacks);
    ~RemoteRoom() override;

    /// Asks the room's server; `done` is called on a thread of the room's own. Where nobody answers within 3
    /// s that is the error.
    void admit(const engine::Admission& asked, Admitted done);

    void push(engine::EngineEvent event) override;
    engine::PictureLimits limits() const override;
    std::string description() const override;
    std::optional<std::string> why_unready() const override;
    std::size_t events_waiting() const override;
    std::vector<std::pair<const char*, base::Clock::duration>> busy_times() const override { return {}; }
    void stop() override {}

private:
    struct Said {
        protocol::EdgeSaid message;
        bool is_request = false;
    };
    struct Client {
        protocol::EdgeClient who;
        std::deque<Said> unhandled;
        std::deque<std::string> answers;     ///< keys of the last
        std::deque<std::int64_t> snapshots;  ///< ids of the last
        engine::FramesWanted wanted;
    };
    struct AskedPicture {
        protocol::EdgePicture what;
        base::Clock::time_point until;
    };
    struct Asked {
        Admitted done;
        base::Clock::time_point until;
    };

    // All with mutex_ held.
    void handle(const engine::ClientJoined& joined);
    void handle(const engine::ClientLeft& left);
    void handle(const engine::MessageReceived& received);
    void handle(const engine::FramesWanted& wanted);
    void handle(const engine::SnapshotSent& sent);
    void handle(const engine::PictureAsked& asked);
    template <class Event>
    void handle(const Event&) {}  // the engine's own
    void say(decltype(protocol::EdgeMessage::what) what);
    void say_wanted(const engine::FramesWanted& wanted);
    void count_viewer(const engine::FramesWanted& wanted, bool wants);
    void want_for_viewers();
    void sync(base::Clock::time_point now);
    void learn(const protocol::RoomMessage& message, base::Clock::time_point now);
    std::optional<engine::EngineOutput> output_of(const protocol::RoomOutput& said);
    void take_state(const protocol::RoomOutput& said, engine::EngineOutput& output);
    void take_answers(const protocol::RoomOutput& said, bool may_be_known, engine::EngineOutput& output);
    void take_loading(const protocol::RoomOutput& said, engine::EngineOutput& output);
    void take_handled(const protocol::RoomOutput& said, engine::EngineOutput& output);
    void applies(const std::string& client, const engine::Applied& applied);
    std::shared_ptr<const engine::EncodedPicture> picture_of(const protocol::RoomPicture& said,
                                                             std::vector<std::uint8_t> bytes);
    bool is_lost(base::Clock::time_point now) const;

    void receive(const std::stop_token& stop);
    void take(Packet packet);
    void poll(base::Clock::time_point now);

    const Connection& connection_;
    const std::string room_, edge_;
    observe::Metrics& metrics_;
    const engine::EngineCallbacks callbacks_;
    Inbox inbox_;

    mutable std::mutex mutex_;
    std::map<std::string, Client> clients_;
    std::map<std::int64_t, Asked> asked_;
    std::int64_t next_asked_ = 1;
    std::map<std::string, AskedPicture> pictures_;  ///< under way, for those who are no clients
    std::string viewer_;                            ///< in whose name frames for all viewers are asked for
    engine::FramesWanted viewers_want_;             ///< as the room's server knows it
    std::map<std::int64_t, std::size_t> viewers_wanting_;  ///< how many, by the newest frame that they have

    std::uint64_t lease_ = 0, number_ = 0;
    bool in_step_ = false;  ///< nothing was missed since the last whole state
    std::optional<protocol::RoomAlive> alive_;
    std::optional<base::Clock::time_point> heard_;
    base::Clock::time_point synced_at_{}, said_alive_at_{};
    base::Clock::duration clock_difference_{};  ///< of this clock and that of the room's server
    std::shared_ptr<const protocol::StateDocument> document_;
    std::map<std::string, engine::Applied> applied_;
    std::string loading_;  ///< what was said last of a scene that is being loaded; empty: none is
    bool was_lost_ = false;
    base::Clock::time_point complained_at_{};

    Outbox outbox_;
    std::jthread thread_;  // last: it uses all of the above
};

}  // namespace vrut::server::nats
