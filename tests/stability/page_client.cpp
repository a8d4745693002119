#include "page_client.hpp"

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <cmath>
#include <deque>
#include <string>
#include <string_view>

#include "codec.hpp"

namespace vrut::stability {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using namespace std::chrono_literals;

namespace {

constexpr auto kBetweenMoves = 50ms;
constexpr auto kLate = 1s;  // for a move to be seen: from there on moves are fewer
constexpr auto kSparing = 250ms;
constexpr auto kFirstRetry = 250ms, kLastRetry = 4000ms;
constexpr std::size_t kHeader = 8192;  // bytes of a picture, among which its header is
constexpr double kWidth = 1180, kHeight = 820;

/// The number behind `"name":`; 0 where there is none.
double number(std::string_view text, const std::string& name) {
    const std::size_t at = text.find("\"" + name + "\":");
    return at == std::string_view::npos ? 0 : std::strtod(text.data() + at + name.size() + 3, nullptr);
}

}  // namespace

struct PageClient::Impl : std::enable_shared_from_this<PageClient::Impl> {
    using Socket = websocket::stream<asio::ip::tcp::socket>;
    /// What belongs to one connection, and ends with it.
    struct Connection {
        explicit Connection(asio::io_context& context) : socket(context) {}
        Socket socket;
        beast::flat_buffer buffer;
        std::deque<std::string> outgoing;
        bool open = false;
    };

    Impl(asio::io_context& the_context, std::uint16_t the_port, protocol::Role the_role)
        : context(the_context), port(the_port), role(the_role), retry(the_context), beat(the_context) {}

    void connect() {
        auto made = std::make_shared<Connection>(context);
        connection = made;
        made->socket.next_layer().async_connect(
            {asio::ip::address_v4::loopback(), port},
            [self = shared_from_this(), made](beast::error_code error) {
                if (error) return self->lost(made);
                made->socket.next_layer().set_option(asio::ip::tcp::no_delay(true), error);
                made->socket.read_message_max(std::size_t{1} << 26);
                made->socket.set_option(
                    websocket::stream_base::decorator([](websocket::request_type& request) {
                        request.set(beast::http::field::sec_websocket_protocol, protocol::kSubprotocol);
                    }));
                made->socket.async_handshake("127.0.0.1:" + std::to_string(self->port), "/ws",
                                             [self, made](beast::error_code refused) {
                                                 if (refused) return self->lost(made);
                                                 self->say(protocol::Hello{self->role, {}, {}, {}});
                                                 self->read(made);
                                             });
            });
    }

    void lost(const std::shared_ptr<Connection>& which) {
        if (closed || which != connection) return;
        connection.reset();
        beat.cancel();
        retry.expires_after(
            std::min<std::chrono::milliseconds>(kFirstRetry * (1 << std::min(retries++, 8)), kLastRetry));
        retry.async_wait([self = shared_from_this()](beast::error_code stopped) {
            if (!stopped && !self->closed) self->connect();
        });
    }

    void read(const std::shared_ptr<Connection>& from) {
        from->socket.async_read(from->buffer,
                                [self = shared_from_this(), from](beast::error_code error, std::size_t) {
                                    if (error || self->closed) return self->lost(from);
                                    self->receive(*from);
                                    from->buffer.consume(from->buffer.size());
                                    self->read(from);
                                });
    }

    void receive(Connection& from) {
        const auto data = from.buffer.data();
        const std::string_view all(static_cast<const char*>(data.data()), data.size());
        if (from.socket.got_binary()) return receive_picture(all);
        if (!from.open && all.find(R"("type":"state")") != std::string_view::npos) return begin(from);
        if (all.find(R"("type":"patch")") != std::string_view::npos)
            patches.push_back(
                {server::base::Clock::now(), static_cast<std::int64_t>(number(all, "revision"))});
    }

    void receive_picture(std::string_view file) {
        retries = 0;
        const std::string header(file.substr(0, kHeader));
        shown.push_back({server::base::Clock::now(), static_cast<std::int64_t>(number(header, "handled")),
                         number(header, "scale"), header.find(R"("moving")") != std::string::npos});
        say(protocol::FrameGrant{static_cast<std::int64_t>(number(header, "frame"))});
    }

    void begin(Connection& with) {
        with.open = true;
        ++connections;
        moves.clear();
        shown.clear();
        patches.clear();
        id = 0;
        if (role == protocol::Role::view) return;
        say_numbered(protocol::Resize{kWidth, kHeight, 1});
        say_numbered(protocol::Control{});
        point(protocol::Pointer::Event::down);
        move();
        for (int i = 0; i < protocol::kMaxGrants; ++i) say(protocol::FrameGrant{});
    }

    void move() {
        const std::int64_t seen = shown.empty() ? 0 : shown.back().handled;
        const auto unseen =
            std::find_if(moves.begin(), moves.end(), [&](const Move& each) { return each.id > seen; });
        const server::base::Clock::time_point now = server::base::Clock::now();
        const bool sparing =
            unseen != moves.end() && now - unseen->sent > kLate && now - moves.back().sent < kSparing;
        if (!sparing) {
            point(protocol::Pointer::Event::move);
            moves.push_back({id, now});
        }
        beat.expires_after(kBetweenMoves);
        beat.async_wait([self = shared_from_this()](beast::error_code stopped) {
            if (!stopped && self->connection && self->connection->open) self->move();
        });
    }

    void point(protocol::Pointer::Event event) {
        protocol::Pointer pointer;
        pointer.event = event;
        pointer.pointer_id = 1;
        pointer.pointer_type = protocol::Pointer::Type::touch;
        pointer.button = event == protocol::Pointer::Event::down ? 0 : -1;
        pointer.buttons = 1;
        const double turn = 0.05 * static_cast<double>(id);
        pointer.x = kWidth / 2 + 300 * std::sin(turn);
        pointer.y = kHeight / 2 + 200 * std::sin(0.7 * turn);
        say_numbered(pointer);
    }

    template <class Payload>
    void say_numbered(Payload payload) {
        say(std::move(payload), ++id);
    }

    template <class Payload>
    void say(Payload payload, std::optional<std::int64_t> with_id = {}) {
        if (!connection) return;
        protocol::ClientMessage message;
        message.id = with_id;
        message.payload = std::move(payload);
        connection->outgoing.push_back(protocol::encode(message));
        if (connection->outgoing.size() == 1) write(connection);
    }

    void write(const std::shared_ptr<Connection>& to) {
        to->socket.async_write(asio::buffer(to->outgoing.front()),
                               [self = shared_from_this(), to](beast::error_code error, std::size_t) {
                                   if (error || self->closed) return self->lost(to);
                                   to->outgoing.pop_front();
                                   if (!to->outgoing.empty()) self->write(to);
                               });
    }

    asio::io_context& context;
    std::uint16_t port;
    protocol::Role role;
    asio::steady_timer retry, beat;
    std::shared_ptr<Connection> connection;
    std::vector<Move> moves;
    std::vector<Shown> shown;
    std::vector<Patch> patches;
    std::int64_t id = 0;
    int connections = 0, retries = 0;
    bool closed = false;
};

PageClient::PageClient(asio::io_context& context, std::uint16_t port, protocol::Role role)
    : impl_(std::make_shared<Impl>(context, port, role)) {
    impl_->connect();
}

PageClient::~PageClient() {
    impl_->closed = true;
    boost::system::error_code ignored;
    if (impl_->connection) impl_->connection->socket.next_layer().close(ignored);
}

const std::vector<PageClient::Move>& PageClient::moves() const { return impl_->moves; }
const std::vector<PageClient::Shown>& PageClient::shown() const { return impl_->shown; }
const std::vector<PageClient::Patch>& PageClient::patches() const { return impl_->patches; }
int PageClient::connections() const { return impl_->connections; }

}  // namespace vrut::stability
