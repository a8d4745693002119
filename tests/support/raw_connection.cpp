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

RawConnection::RawConnection(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int on = 1;
    ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    REQUIRE(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
}

RawConnection::~RawConnection() { ::close(socket_); }

void RawConnection::send(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent <= 0) return;
        bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
}

bool RawConnection::read(steady_clock::time_point until) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - steady_clock::now());
    pollfd waits{socket_, POLLIN, 0};
    if (ended_ || ::poll(&waits, 1, std::max(0, static_cast<int>(left.count()))) <= 0) return false;
    std::array<char, 65536> bytes;
    const ssize_t size = ::recv(socket_, bytes.data(), bytes.size(), 0);
    ended_ = size <= 0;
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
