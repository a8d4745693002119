#include "raw_connection.hpp"

#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

namespace vrut::test {

using std::chrono::steady_clock;

RawConnection::RawConnection(std::uint16_t port, Over over) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int on = 1;
    ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    REQUIRE(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    if (over == Over::tcp) return;
    const std::unique_ptr<SSL_CTX, void (*)(SSL_CTX*)> context(SSL_CTX_new(TLS_client_method()),
                                                               SSL_CTX_free);
    SSL_CTX_clear_mode(context.get(), SSL_MODE_AUTO_RETRY);  // or a session ticket would wait for data
    tls_.reset(SSL_new(context.get()));
    SSL_set_fd(tls_.get(), socket_);
    REQUIRE(SSL_connect(tls_.get()) == 1);
}

RawConnection::~RawConnection() { ::close(socket_); }

void RawConnection::send(std::string_view bytes) {
    if (!tls_) return send_below_tls(bytes);
    if (!bytes.empty()) SSL_write(tls_.get(), bytes.data(), static_cast<int>(bytes.size()));
}

void RawConnection::send_below_tls(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent <= 0) return;
        bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
}

bool RawConnection::read(steady_clock::time_point until) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - steady_clock::now());
    pollfd waits{socket_, POLLIN, 0};
    const bool is_there = tls_ && SSL_has_pending(tls_.get());
    if (ended_ || (!is_there && ::poll(&waits, 1, std::max(0, static_cast<int>(left.count()))) <= 0))
        return false;
    std::array<char, 65536> bytes;
    const ssize_t size = tls_ ? SSL_read(tls_.get(), bytes.data(), static_cast<int>(bytes.size()))
                              : ::recv(socket_, bytes.data(), bytes.size(), 0);
    ended_ = size <= 0 && !(tls_ && SSL_get_error(tls_.get(), static_cast<int>(size)) == SSL_ERROR_WANT_READ);
    if (size > 0) received_.append(bytes.data(), static_cast<std::size_t>(size));
    return !ended_;
}

std::string RawConnection::receive(std::size_t size, std::chrono::milliseconds timeout) {
    const auto until = steady_clock::now() + timeout;
    while (received_.size() < size && read(until)) {
    }
    const std::string taken = received_.substr(0, size);
    received_.erase(0, size);
    return taken;
}

HttpAnswer RawConnection::answer(bool to_head, std::chrono::milliseconds timeout) {
    const auto until = steady_clock::now() + timeout;
    std::size_t end;
    while ((end = received_.find("\r\n\r\n")) == std::string::npos)
        if (!read(until)) return {};
    HttpAnswer answer;
    answer.headers = receive(end + 4);
    answer.status = std::stoi(answer.headers.substr(9, 3));
    const std::size_t length = answer.headers.find("\r\nContent-Length: ");
    if (length != std::string::npos && !to_head)
        answer.body = receive(std::stoul(answer.headers.substr(length + 18)), timeout);
    return answer;
}

bool RawConnection::ended(std::chrono::milliseconds timeout) {
    const auto until = steady_clock::now() + timeout;
    while (read(until)) {
    }
    return ended_;
}

}  // namespace vrut::test
