#include "net/transport.hpp"

#include <boost/beast/websocket/ssl.hpp>
#include <boost/beast/websocket/teardown.hpp>

namespace vrut::server::net {

namespace asio = boost::asio;
namespace beast = boost::beast;

Stream& Transport::next_layer() {
    Secure* const secure = std::get_if<Secure>(&layers_);
    return secure ? secure->next_layer() : std::get<Stream>(layers_);
}

void Transport::async_secure(asio::ssl::context& context, Handler handler) {
    Stream tcp = std::move(std::get<Stream>(layers_));
    layers_.emplace<Secure>(std::move(tcp), context)
        .async_handshake(asio::ssl::stream_base::server, std::move(handler));
}

void Transport::async_end_sending(const std::function<void()>& handler) {
    const auto end = [this, handler](beast::error_code) {
        beast::error_code ignored;
        next_layer().socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
        handler();
    };
    if (Secure* const secure = std::get_if<Secure>(&layers_))
        secure->async_shutdown(Handler(end));
    else
        end({});
}

void Transport::read_some(asio::mutable_buffer buffer, TransferHandler handler) {
    std::visit([&](auto& layer) { layer.async_read_some(buffer, std::move(handler)); }, layers_);
}

void Transport::write_some(const ConstBuffers& buffers, TransferHandler handler) {
    std::visit([&](auto& layer) { layer.async_write_some(buffers, std::move(handler)); }, layers_);
}

void Transport::tear_down(beast::role_type role, Handler handler) {
    using beast::async_teardown, beast::websocket::async_teardown;
    std::visit([&](auto& layer) { async_teardown(role, layer, std::move(handler)); }, layers_);
}

}  // namespace vrut::server::net
