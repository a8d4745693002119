#pragma once

#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <utility>
#include <variant>

#include "net/traffic.hpp"

namespace vrut::server::net {

/// The bytes of a connection: as TCP carries them, or by TLS over it. A stream of Asio and Beast.
class Transport {
public:
    using executor_type = Stream::executor_type;

    explicit Transport(boost::asio::ip::tcp::socket socket) : layers_(Stream(std::move(socket))) {}

    executor_type get_executor() { return next_layer().get_executor(); }
    /// TCP, by which bytes are counted.
    Stream& next_layer() {
        Secure* const secure = std::get_if<Secure>(&layers_);
        return secure ? secure->next_layer() : std::get<Stream>(layers_);
    }
    bool is_secure() const { return std::holds_alternative<Secure>(layers_); }

    /// Speaks TLS from here on, as a server. The context must live until the handshake is done.
    template <class Handler>
    void async_secure(boost::asio::ssl::context& context, Handler handler) {
        Stream tcp = std::move(std::get<Stream>(layers_));
        layers_.emplace<Secure>(std::move(tcp), context)
            .async_handshake(boost::asio::ssl::stream_base::server, std::move(handler));
    }

    /// Says that nothing more will be sent. Calls `handler` when that is on its way, with TLS when the peer
    /// has answered, or could not.
    template <class Handler>
    void async_end_sending(Handler handler) {
        auto end = [this, handler = std::move(handler)](boost::beast::error_code) mutable {
            boost::beast::error_code ignored;
            next_layer().socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
            handler();
        };
        if (Secure* const secure = std::get_if<Secure>(&layers_))
            secure->async_shutdown(std::move(end));
        else
            end({});
    }

    template <class Buffers, class Token>
    auto async_read_some(const Buffers& buffers, Token&& token) {
        return std::visit(
            [&](auto& layer) { return layer.async_read_some(buffers, std::forward<Token>(token)); }, layers_);
    }
    template <class Buffers, class Token>
    auto async_write_some(const Buffers& buffers, Token&& token) {
        return std::visit(
            [&](auto& layer) { return layer.async_write_some(buffers, std::forward<Token>(token)); },
            layers_);
    }

private:
    /// Beast's own stream of TLS takes an empty buffer before others for the end.
    using Secure = boost::asio::ssl::stream<Stream>;

    template <class Handler>
    friend void async_teardown(boost::beast::role_type role, Transport& transport, Handler&& handler) {
        using boost::beast::async_teardown, boost::beast::websocket::async_teardown;
        std::visit([&](auto& layer) { async_teardown(role, layer, std::forward<Handler>(handler)); },
                   transport.layers_);
    }

    std::variant<Stream, Secure> layers_;
};

}  // namespace vrut::server::net
