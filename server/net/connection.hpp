#pragma once

#include <array>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "base/rate_limit.hpp"
#include "net/flow_control.hpp"
#include "net/http_request.hpp"
#include "net/newest_of_each.hpp"
#include "net/registry.hpp"
#include "net/transport.hpp"

namespace vrut::server::net {

/// Bytes per second of a message that a client must take at least.
inline constexpr int kLeastRate = 1000;

/// One WebSocket client, on the net thread. A slow client gets the newest frame, and one patch from the
/// document that it has to the newest. Only answers and snapshots queue; while kMaxAnswers bytes of answers
/// wait, nothing is read.
class Connection : public std::enable_shared_from_this<Connection> {
public:
    Connection(Transport transport, ConnectionLimit::Place place, ConnectionRegistry& registry,
               std::shared_ptr<ServedRoom> room);
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// Completes the handshake that `request` asks for.
    void accept(const HttpRequest& request);

    // What the engine says.
    void answer(room::Answer answer);
    /// The newest of what a client points at, for this one.
    void pointed(const std::string& client, Text text) { points_.put(client, std::move(text)); }
    void handled(const engine::EngineOutput::Handled& handled);
    /// The room's newest frame has changed; `before` is the number of the previous newest frame, 0 if none.
    void newest_changed(std::int64_t before);
    /// A picture that this client asked for.
    void take_snapshot(std::shared_ptr<const engine::EncodedPicture> picture);
    /// Sends what there is to send, if nothing is being sent.
    void pump();
    /// Bytes that wait for this client alone; of a picture that several share, its part.
    std::size_t backlog() const;
    bool is_dropped() const { return dropped_; }
    /// That it gave in `hello`.
    const std::string& resume_key() const { return resume_key_; }
    /// Ends the connection at once; `reason` is of kCloseReasons.
    void drop(const char* reason);
    /// Ends the connection after what is being sent.
    void close(boost::beast::websocket::close_code code, const std::string& reason);

private:
    void read();
    void receive();
    void on_received(std::size_t size);
    bool must_wait();
    void on_text(std::string_view text);
    void on_hello(const protocol::Hello& hello, std::optional<std::int64_t> id);
    void join(const std::string& client, protocol::Role role, const protocol::Hello& hello,
              std::optional<std::int64_t> id);
    void reject_and_close(const protocol::Error& error, boost::beast::websocket::close_code code);

    /// To the engine.
    void forward(tl::expected<protocol::ClientMessage, protocol::Error> message, std::string_view text);
    void on_grant(const protocol::FrameGrant& grant, std::optional<std::int64_t> id);
    void ask_for_frames(base::Clock::time_point now);
    bool has_newer_frame() const;
    base::Clock::time_point newest_from(base::Clock::time_point now) const;
    bool frame_is_due(base::Clock::time_point now) const;
    bool holds_in_vain(base::Clock::time_point now) const;
    bool has_updates() const;
    bool has_broadcasts() const;
    void ask_again(base::Clock::time_point now);
    void send_frame();
    void send_snapshot();
    void send_picture(std::optional<double> since_input_ms);
    bool sends_depth_of(const engine::EncodedPicture& picture) const;
    std::size_t bytes_of(const engine::EncodedPicture& picture) const;
    void send_update(base::Clock::time_point now);
    /// Of its role.
    DocumentUpdates& documents() const;
    void send_document();
    void send_point(base::Clock::time_point now);
    void send_answer();
    void send_text(Text text);
    void send_ping(base::Clock::time_point now);
    void write(const std::array<boost::asio::const_buffer, 4>& buffers);
    void on_written(boost::beast::error_code error);
    Traffic& traffic() { return boost::beast::get_lowest_layer(socket_).rate_policy(); }
    /// When the first bytes of a message came that is not all there.
    const std::optional<base::Clock::time_point>& unfinished_since() { return traffic().unfinished; }
    void send_goodbye();
    void on_close_frame(std::uint16_t code);
    void poll_deadlines();
    void check_deadlines(base::Clock::time_point now);
    void on_pong(std::string_view number, base::Clock::time_point now);
    std::size_t queued() const;
    std::size_t sending() const;
    bool takes_too_little(base::Clock::time_point now);

    boost::beast::websocket::stream<Transport, false> socket_;
    ConnectionRegistry& registry_;
    const std::shared_ptr<ServedRoom> room_;
    boost::beast::flat_buffer incoming_;
    boost::asio::steady_timer hello_deadline_, deadline_timer_, rate_timer_, flow_timer_;
    ConnectionLimit::Place place_;
    std::string client_;  // empty until it has joined
    std::string resume_key_;
    bool is_joining_ = false;  // its hello is not answered yet
    protocol::Role role_ = protocol::Role::view;
    std::string peer_;
    bool dropped_ = false;
    const char* close_reason_ = "shutdown";  // of kCloseReasons, where this side closes
    base::Clock::time_point shown_input_ =
        base::Clock::now();  // the newest that a frame showed it, of those since then

    // --- what the client knows, and what waits for it
    std::shared_ptr<const protocol::StateDocument> document_;  // that it last got
    struct Answer {
        Text text;
        std::int64_t revision = 0;
    };
    std::deque<Answer> answers_;
    std::size_t answer_bytes_ = 0;  // of answers_
    std::int64_t last_frame_ = 0;
    bool wants_depth_ = false;
    std::int64_t depth_frame_ = 0;  // whose depth it last got
    std::int64_t handled_ = 0;      // the highest message id that a picture showed it
    std::deque<std::shared_ptr<const engine::EncodedPicture>> snapshots_;
    Text stats_, loading_;  // that it last got
    NewestOfEach points_;   // by the client that points
    bool points_turn_ = false;

    base::Clock::time_point had_broadcasts_ = base::Clock::now();  // stats and loading: the newest

    // --- what its link takes
    FlowControl flow_;
    engine::FramesWanted wanted_;         // as the engine knows it
    std::uint64_t sequence_ = 0;          // of its messages: the last that was handed to the engine,
    std::uint64_t shown_sequence_ = 0;    // of these the last whose doing frames may show,
    std::uint64_t granted_at_ = 0;        // that one before the newest grant,
    std::uint64_t handled_sequence_ = 0;  // and that was handled
    std::map<std::int64_t, base::Clock::time_point> inputs_;  // newest that the last frames showed it

    // --- what is being sent
    bool writing_ = false;
    Text text_;
    std::vector<std::uint8_t> header_;
    std::shared_ptr<const engine::EncodedPicture> picture_;
    base::Clock::time_point write_by_;                          // else it is stuck
    std::uint64_t taken_seen_ = 0;                              // bytes, at the last check
    base::Clock::time_point progress_at_ = base::Clock::now();  // the last check that saw more of them
    bool sends_queued_ = false;                                 // an answer or a snapshot
    base::Clock::time_point rated_since_ = base::Clock::now();
    std::uint64_t taken_before_ = 0;  // bytes that it had taken then
    std::optional<boost::beast::websocket::close_reason> closing_;
    bool said_goodbye_ = false;

    // --- what has come and is not handled yet
    std::size_t unhandled_bytes_ = 0, unhandled_requests_ = 0;
    bool reading_ = false, throttled_ = false;
    std::size_t message_size_ = 0;  // of one that is not all there
    base::RateLimit rate_;
    base::Clock::time_point heard_at_;  // the newest bytes or pong
    base::Clock::time_point pinged_at_;
};

}  // namespace vrut::server::net
