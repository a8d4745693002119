#pragma once

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "base/rate_limit.hpp"
#include "net/http_request.hpp"
#include "net/registry.hpp"

namespace vrut::server::net {

/// One WebSocket client, on the net thread. What waits for a slow one is replaced, not queued: it keeps the
/// document that it last got and is sent the difference; it is owed a number of frames and is sent the
/// newest. Only answers queue, and who does not take them is not read.
class Session : public std::enable_shared_from_this<Session> {
public:
    Session(boost::beast::tcp_stream stream, ConnectionLimit::Place place, Hub& hub);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Completes the handshake that `request` asks for.
    void accept(const HttpRequest& request);

    // What the engine says.
    void answer(room::Answer answer);
    void owe(std::int64_t frame);
    void handled(const engine::EngineOutput::Handled& handled);
    /// The hub has a newer picture than `before`.
    void newest_changed(std::int64_t before);
    /// A picture that this client asked for.
    void take_snapshot(std::shared_ptr<const engine::EncodedPicture> picture);
    /// Sends what there is to send, if nothing is being sent.
    void pump();
    /// Ends the connection after what is being sent.
    void close(boost::beast::websocket::close_code code, const std::string& reason);

private:
    void read();
    void receive();
    void on_received(std::size_t size);
    bool must_wait();
    void on_text(std::string_view text);
    void on_hello(const protocol::Hello& hello, std::optional<std::int64_t> id);
    void refuse_and_close(const protocol::Error& error, boost::beast::websocket::close_code code);

    bool frame_is_due() const;
    bool has_news() const;
    bool is_behind();
    void tell_later();
    void send_frame();
    void send_snapshot();
    void send_picture(const protocol::FrameHeader& header);
    void send_news();
    void send_answer();
    void send_text(std::string text);
    void write(const std::array<boost::asio::const_buffer, 3>& buffers);
    void on_written(boost::beast::error_code error);
    void watch();
    void look_after(base::Clock::time_point now);
    void ping(base::Clock::time_point now);
    void on_pong(base::Clock::time_point now);
    void frame_written();
    bool has_frame();
    void drop(const char* reason);

    boost::beast::websocket::stream<boost::beast::tcp_stream, false> socket_;
    Hub& hub_;
    boost::beast::flat_buffer incoming_;
    boost::asio::steady_timer hello_deadline_, watch_, rate_timer_, news_timer_, frame_timer_;
    ConnectionLimit::Place place_;
    std::string client_;  // empty before hello
    protocol::Role role_ = protocol::Role::view;
    std::string peer_;
    bool dropped_ = false;
    const char* close_reason_ = "shutdown";  // of kCloseReasons, where this side closes
    base::Clock::time_point shown_input_ =
        base::Clock::now();  // the newest that a frame showed it, of those since then

    // --- what the client knows and is owed
    std::shared_ptr<const protocol::StateDocument> document_;  // that it last got
    std::deque<room::Answer> answers_;
    std::size_t answer_bytes_ = 0;  // of answers_
    std::deque<std::int64_t> owed_;
    std::int64_t last_frame_ = 0;
    std::int64_t handled_ = 0;  // the highest message id that it was told a picture shows
    std::deque<std::shared_ptr<const engine::EncodedPicture>> snapshots_;
    std::shared_ptr<const std::string> stats_, loading_;         // that it last got
    base::Clock::time_point told_at_{};                          // something of the document
    base::Clock::time_point had_all_news_ = base::Clock::now();  // and of what else is told to all
    bool tells_later_ = false;

    // --- what is being sent
    bool writing_ = false;
    std::string text_;
    std::vector<std::uint8_t> header_;
    std::shared_ptr<const engine::EncodedPicture> picture_;
    bool writes_frame_ = false;
    std::uint64_t frame_end_ = 0;  // of the newest, in bytes since the connection's begin
    std::size_t frame_bytes_ = 0;
    bool frames_are_late_ = false;         // the one before, as far as is known
    std::uint64_t acknowledged_ = 0;       // bytes, at the watch's last look
    base::Clock::time_point progress_at_;  // when it last saw more of them, or nothing to acknowledge
    std::optional<boost::beast::websocket::close_reason> closing_;

    // --- what has come and is not handled yet
    std::size_t unhandled_bytes_ = 0, unhandled_requests_ = 0;
    bool reading_ = false, throttled_ = false, pinging_ = false;
    std::optional<base::Clock::time_point> begun_;  // a message that is not all there
    std::size_t message_size_ = 0;                  // of it so far
    base::RateLimit rate_;
    std::uint64_t received_ = 0;        // bytes, at the watch's last look
    base::Clock::time_point heard_at_;  // when it last saw more of them, or did not read
    base::Clock::time_point pinged_at_;
    std::optional<base::Clock::duration> round_trip_;  // the least so far
};

}  // namespace vrut::server::net
