#pragma once

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/core/role.hpp>
#include <functional>
#include <memory>
#include <utility>
#include <variant>

#include "net/traffic.hpp"

namespace vrut::server::net {

/// The bytes of a connection: as TCP carries them, or by TLS over it. A stream of Asio and Beast. It hands
/// buffers and handlers of one type to the layers below, so that these are compiled once.
class Transport {
public:
    using executor_type = Stream::executor_type;
    using Handler = std::function<void(boost::beast::error_code)>;

    explicit Transport(boost::asio::ip::tcp::socket socket) : layers_(Stream(std::move(socket))) {}

    executor_type get_executor() { return next_layer().get_executor(); }
    /// TCP, by which bytes are counted.
    Stream& next_layer();

    /// Speaks TLS from here on, as a server. The context is needed for the call alone.
    void async_secure(boost::asio::ssl::context& context, Handler handler);
    /// Says that nothing more will be sent. Calls `handler` when that is on its way, with TLS when the peer
    /// has answered, or could not.
    void async_end_sending(const std::function<void()>& handler);

    template <class Buffers, class Token>
    void async_read_some(const Buffers& buffers, Token&& token) {
        boost::asio::mutable_buffer first;
        for (auto at = boost::asio::buffer_sequence_begin(buffers);
             first.size() == 0 && at != boost::asio::buffer_sequence_end(buffers); ++at)
            first = *at;
        read_some(first, kept(std::forward<Token>(token)));
    }
    template <class Buffers, class Token>
    void async_write_some(const Buffers& buffers, Token&& token) {
        ConstBuffers some;
        for (auto at = boost::asio::buffer_sequence_begin(buffers);
             some.count < some.buffers.size() && at != boost::asio::buffer_sequence_end(buffers); ++at)
            if (const boost::asio::const_buffer buffer = *at; buffer.size() > 0)
                some.buffers[some.count++] = buffer;
        write_some(some, kept(std::forward<Token>(token)));
    }

private:
    using Secure = boost::asio::ssl::stream<Stream>;
    using TransferHandler = std::function<void(boost::beast::error_code, std::size_t)>;
    /// None of them is empty.
    struct ConstBuffers {
        std::array<boost::asio::const_buffer, 8> buffers;
        std::size_t count = 0;
        const boost::asio::const_buffer* begin() const { return buffers.data(); }
        const boost::asio::const_buffer* end() const { return buffers.data() + count; }
    };

    /// Of a handler that can only be moved, and is called once.
    template <class Token>
    static auto kept(Token&& token) {
        return [handler = std::make_shared<std::decay_t<Token>>(std::forward<Token>(token))](
                   auto... arguments) { std::decay_t<Token>(std::move(*handler))(arguments...); };
    }
    void read_some(boost::asio::mutable_buffer buffer, TransferHandler handler);
    void write_some(const ConstBuffers& buffers, TransferHandler handler);
    void tear_down(boost::beast::role_type role, Handler handler);
    template <class Token>
    friend void async_teardown(boost::beast::role_type role, Transport& transport, Token&& token) {
        transport.tear_down(role, kept(std::forward<Token>(token)));
    }

    std::variant<Stream, Secure> layers_;
};

}  // namespace vrut::server::net
