#pragma once

#include <openssl/ssl.h>

#include <string>
#include <string_view>

#include "test_client.hpp"

namespace vrut::test {

/// What carries a test's bytes; TLS trusts any server.
enum class Over { tcp, tls };

/// A connection on which a test sends what bytes it likes.
class RawConnection {
public:
    explicit RawConnection(std::uint16_t port, Over over = Over::tcp);
    ~RawConnection();
    RawConnection(const RawConnection&) = delete;
    RawConnection& operator=(const RawConnection&) = delete;

    /// What the peer does not take any more is lost.
    void send(std::string_view bytes);
    /// The next `size` bytes, fewer where the connection ends or `timeout` passes first.
    std::string receive(std::size_t size, std::chrono::milliseconds timeout = 5s);
    /// The next HTTP answer, by its Content-Length; status 0 where none comes.
    HttpAnswer answer(bool to_head = false, std::chrono::milliseconds timeout = 5s);
    /// Sends bytes as TCP carries them.
    void send_below_tls(std::string_view bytes);
    /// As OpenSSL calls it; null without TLS.
    SSL* tls() { return tls_.get(); }
    /// The peer sends nothing more.
    bool ended(std::chrono::milliseconds timeout = 5s);

private:
    /// Reads once; false at the end and where nothing comes until then.
    bool read(std::chrono::steady_clock::time_point until);

    int socket_;
    std::unique_ptr<SSL, void (*)(SSL*)> tls_{nullptr, SSL_free};
    std::string received_;
    bool ended_ = false;
};

}  // namespace vrut::test
