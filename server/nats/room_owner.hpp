#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/clock.hpp"
#include "engine/output.hpp"
#include "engine/room_engine.hpp"
#include "nats/relay.hpp"
#include "room_relay.hpp"

namespace vrut::server::nats {

/// Clients of edges have a suffix behind a point: the edge's id.
bool is_of_edge(const std::string& client);

/// Serves a room that this process draws to edges. The output of the room's engine is sent once, for all of
/// them. An edge that is silent for 5 s is gone, and its clients with it.
class RoomOwner {
public:
    /// The role that a client gets who asks for `wanted` with this token; none where it may not come in.
    using RoleFor =
        std::function<std::optional<protocol::Role>(protocol::Role wanted, const std::string& token)>;

    /// A client that is here already.
    struct Known {
        bool may_steer = false;
        std::uint64_t sequence = 0;  ///< of its last message that the room's log has
    };

    RoomOwner(const Connection& connection, const std::string& room, RoleFor role_for);
    ~RoomOwner();
    RoomOwner(const RoomOwner&) = delete;
    RoomOwner& operator=(const RoomOwner&) = delete;

    /// The engine's output, from the first on; from any thread.
    void send(engine::EngineOutput output);
    void send(std::shared_ptr<const engine::EncodedPicture> picture);
    /// Edges do not get what is sent next: they find that something is missing, and ask for all.
    void skip();
    /// Messages of edges go to `engine` from here on, which must live longer. `lease` rises with each server
    /// that takes the room over; what is sent before is sent to nobody.
    void begin(engine::RoomEngine& engine, std::uint64_t lease, const std::map<std::string, Known>& clients);
    /// Tells edges that this server draws the room no longer. Nothing may be sent from here on, and nothing
    /// that was is kept.
    void end();

private:
    struct Client {
        std::string edge;
        bool may_steer = false;
        std::uint64_t sequence = 0;  ///< of its last message that was handed to the engine
        std::uint64_t followed = 0;  ///< the last that another server handled
    };
    struct Edge {
        base::Clock::time_point heard;
        bool in_step = true;  ///< no message of it was missed
    };

    // --- from edges, on a thread of its own
    void receive(const std::stop_token& stop);
    void handle(const std::string& edge, const protocol::EdgeSync& sync);
    void handle(const std::string& edge, const protocol::EdgeAlive& alive);
    void handle(const std::string& edge, const protocol::EdgeAdmission& asked);
    void handle(const std::string& edge, const protocol::EdgeJoined& joined);
    void handle(const std::string& edge, const protocol::EdgeLeft& left);
    void handle(const std::string& edge, const protocol::EdgeSaid& said);
    void handle(const std::string& edge, const protocol::EdgeWanted& wanted);
    void handle(const std::string& edge, const protocol::EdgeSnapshotSent& sent);
    void handle(const std::string& edge, const protocol::EdgePicture& picture);
    void join(const std::string& edge, const protocol::EdgeClient& client);
    void leave(const std::string& client);
    void forget_silent_edges(base::Clock::time_point now);
    void send_alive();
    /// Null where it is not there.
    Client* find(const std::string& edge, const std::string& client);

    // --- to edges, on the outbox's thread
    /// Those for clients of edges.
    std::vector<protocol::RoomAnswer> keep_answers(const std::vector<room::Answer>& answers);
    std::optional<Packet> output_packet(engine::EngineOutput output);
    std::optional<Packet> picture_packet(const engine::EncodedPicture& picture);
    std::optional<Packet> packet_of(decltype(protocol::RoomMessage::what) what);
    std::optional<Packet> whole_packet(const std::string& edge);

    const Connection& connection_;
    const std::string room_;
    const RoleFor role_for_;
    std::optional<Inbox> inbox_;
    engine::RoomEngine* engine_ = nullptr;

    // On the receiving thread.
    std::map<std::string, Edge> edges_;
    std::map<std::string, Client> clients_;
    base::Clock::time_point alive_at_{};
    base::Clock::time_point complained_at_{};

    std::mutex newest_mutex_;
    std::shared_ptr<const engine::EncodedPicture> newest_;  ///< frame that was not sent yet

    // On the outbox's thread.
    std::uint64_t lease_ = 0, number_ = 0;
    bool skips_ = false;
    std::shared_ptr<const protocol::StateDocument> document_;
    std::string by_;
    std::int64_t by_since_ = 0;
    std::string stats_, loading_;
    bool loads_ = false;
    std::optional<engine::PictureSize> size_;
    std::optional<std::int64_t> present_frame_;
    std::map<std::string, std::uint64_t> handled_;
    std::map<std::string, engine::Applied> applied_;  ///< as edges know it
    std::deque<protocol::RoomAnswer> answers_;        ///< the newest, for who missed them
    std::size_t answer_bytes_ = 0;
    std::shared_ptr<const engine::EncodedPicture> sent_;  ///< the newest frame

    std::optional<Outbox> outbox_;  ///< none: it has ended
    std::jthread thread_;           // last: it uses all of the above
};

}  // namespace vrut::server::nats
