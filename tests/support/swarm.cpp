#include "swarm.hpp"

#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

namespace vrut::test {

namespace {

constexpr std::size_t kStart = 8192;  // of a message: more than a frame's header takes
constexpr int kBinary = 2, kClose = 8, kPing = 9, kPong = 10;

sockaddr_in loopback(unsigned host, std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(0x7F000000U + host);
    address.sin_port = htons(port);
    return address;
}

/// The number behind `"name":`.
double number_of(std::string_view header, const std::string& name) {
    const std::size_t at = header.find("\"" + name + "\":");
    if (at == std::string_view::npos) FAIL("no '" << name << "' in " << header);
    const std::size_t begin = header.find_first_of("-0123456789", at + name.size() + 3);
    return std::strtod(std::string(header.substr(begin, 32)).c_str(), nullptr);
}

}  // namespace

RawSocket::RawSocket(std::uint16_t port, const Options& options)
    : descriptor_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    REQUIRE(descriptor_ >= 0);
    if (options.receive_buffer > 0)
        setsockopt(descriptor_, SOL_SOCKET, SO_RCVBUF, &options.receive_buffer, sizeof(int));
    const int on = 1;
    setsockopt(descriptor_, IPPROTO_IP, IP_BIND_ADDRESS_NO_PORT, &on, sizeof on);
    setsockopt(descriptor_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    const sockaddr_in from = loopback(options.source, 0), to = loopback(1, port);
    REQUIRE(bind(descriptor_, reinterpret_cast<const sockaddr*>(&from), sizeof from) == 0);
    REQUIRE(connect(descriptor_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0);
}

RawSocket::~RawSocket() {
    if (descriptor_ >= 0) close(descriptor_);
}

RawSocket::RawSocket(RawSocket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

bool RawSocket::send(std::string_view bytes) const {
    return ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT) >= 0 ||
           errno == EAGAIN;
}

std::string RawSocket::read(std::size_t most) const {
    std::string bytes(most, '\0');
    const ssize_t got = recv(descriptor_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    return bytes;
}

bool RawSocket::ended() const {
    while (!read().empty()) {
    }
    char byte = 0;
    const ssize_t got = recv(descriptor_, &byte, 1, MSG_DONTWAIT | MSG_PEEK);
    return got == 0 || (got < 0 && errno != EAGAIN);
}

void RawSocket::reset() {
    const linger at_once{1, 0};
    setsockopt(descriptor_, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    close(std::exchange(descriptor_, -1));
}

std::string upgrade_request(const std::string& path) {
    return "GET " + path +
           " HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
           "Sec-WebSocket-Protocol: vrut-preview.v1\r\n\r\n";
}

std::string client_frame(std::string_view payload, int opcode) {
    REQUIRE(payload.size() < 65536);
    std::string frame(1, static_cast<char>(0x80 | opcode));
    if (payload.size() < 126) {
        frame += static_cast<char>(0x80 | payload.size());
    } else {
        frame += '\xFE';
        frame += static_cast<char>(payload.size() >> 8);
        frame += static_cast<char>(payload.size() & 0xFF);
    }
    return frame.append(4, '\0').append(payload);
}

RawSocket websocket(std::uint16_t port, const RawSocket::Options& options) {
    RawSocket socket(port, options);
    REQUIRE(socket.send(upgrade_request()));
    std::string got;
    REQUIRE(eventually([&] { return (got += socket.read()).find("\r\n\r\n") != std::string::npos; }));
    return socket;
}

RawSocket standing_client(std::uint16_t port, unsigned source) {
    RawSocket socket = websocket(port, {.receive_buffer = 4096, .source = source});
    REQUIRE(socket.send(client_frame(R"({"type":"hello","role":"view"})")));
    for (int i = 0; i < 2; ++i) REQUIRE(socket.send(client_frame(R"({"type":"frame"})")));
    return socket;
}

Swarm::Swarm(std::uint16_t port) : Swarm(std::vector<Door>{{port}}) {}
Swarm::Swarm(std::vector<Door> doors) : doors_(std::move(doors)), epoll_(epoll_create1(EPOLL_CLOEXEC)) {}
Swarm::~Swarm() { close(epoll_); }

std::size_t Swarm::join(const std::string& role) {
    const std::size_t index = clients_.size();
    const Door& door = doors_[index % doors_.size()];
    Client& client =
        clients_.emplace_back(Client{RawSocket(door.port, {.source = static_cast<unsigned>(2 + index)})});
    client.frame.client = index;
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.u64 = index;
    REQUIRE(epoll_ctl(epoll_, EPOLL_CTL_ADD, client.socket.descriptor(), &event) == 0);
    REQUIRE(client.socket.send(upgrade_request(door.path)));
    read_until(std::chrono::steady_clock::now() + 5s, {}, [&] { return client.upgraded; });
    REQUIRE(client.upgraded);
    send(index, {{"type", "hello"}, {"role", role}});
    for (int i = 0; i < 2; ++i) send(index, {{"type", "frame"}});
    return index;
}

void Swarm::send(std::size_t client, const Json& message) {
    REQUIRE(clients_[client].socket.send(client_frame(message.dump())));
}

void Swarm::read_until(std::chrono::steady_clock::time_point end, const OnFrame& on_frame,
                       const std::function<bool()>& enough) {
    std::array<epoll_event, 64> events{};
    while (!enough || !enough()) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
        if (left < 0ms) return;
        const int count = epoll_wait(epoll_, events.data(), events.size(), static_cast<int>(left.count()));
        for (int i = 0; i < count; ++i) read(events[static_cast<std::size_t>(i)].data.u64, on_frame);
    }
}

void Swarm::read(std::size_t index, const OnFrame& on_frame) {
    Client& client = clients_[index];
    const int socket = client.socket.descriptor();
    static std::array<char, std::size_t{64} * 1024>
        bytes;  // the sanitizers do not know that MSG_TRUNC leaves it
    const std::size_t room = kStart - client.start.size();
    // What is skipped the system gives up without copying it.
    const ssize_t got = client.skip > 0 ? recv(socket, bytes.data(), std::min(client.skip, bytes.size()),
                                               MSG_DONTWAIT | MSG_TRUNC)
                                        : recv(socket, bytes.data(), room, MSG_DONTWAIT);
    if (got == 0 || (got < 0 && errno != EAGAIN)) FAIL("client " << index << " was cut off");
    if (got < 0) return;
    bytes_ += static_cast<std::size_t>(got);
    if (client.skip > 0) {
        client.skip -= static_cast<std::size_t>(got);
        if (client.skip == 0) deliver(client, on_frame);
        return;
    }
    client.start.append(bytes.data(), static_cast<std::size_t>(got));
    if (!client.upgraded && !take_handshake(client)) return;
    while (take(index, on_frame)) {
    }
}

bool Swarm::take_handshake(Client& client) {
    const std::size_t end = client.start.find("\r\n\r\n");
    if (end == std::string::npos) return false;
    REQUIRE_MESSAGE(client.start.starts_with("HTTP/1.1 101"), client.start);
    client.start.erase(0, end + 4);
    return client.upgraded = true;
}

/// The next message, if enough of it is there.
bool Swarm::take(std::size_t index, const OnFrame& on_frame) {
    Client& client = clients_[index];
    const auto byte = [&](std::size_t at) { return static_cast<std::uint8_t>(client.start[at]); };
    if (client.start.size() < 2) return false;
    const std::size_t extended = byte(1) < 126 ? 0 : byte(1) == 126 ? 2 : 8, begin = 2 + extended;
    if (client.start.size() < begin) return false;
    std::size_t length = extended == 0 ? byte(1) : 0;
    for (std::size_t i = 0; i < extended; ++i) length = length << 8 | byte(2 + i);
    const std::size_t whole = begin + length, kept = std::min(whole, kStart);
    if (client.start.size() < kept) return false;

    const int opcode = byte(0) & 0xF;
    const std::string_view payload = std::string_view(client.start).substr(begin, kept - begin);
    if (opcode == kClose) FAIL("client " << index << " was sent away: " << payload.substr(2));
    if (opcode == kPing) REQUIRE(client.socket.send(client_frame(payload, kPong)));
    client.frame.number = opcode == kBinary ? static_cast<std::int64_t>(number_of(payload, "frame")) : 0;
    if (opcode == kBinary) client.frame.fov = number_of(payload, "fov");
    client.start.erase(0, kept);
    client.skip = whole - kept;
    if (client.skip > 0) return false;
    deliver(client, on_frame);
    return true;
}

void Swarm::deliver(Client& client, const OnFrame& on_frame) {
    if (client.frame.number == 0) return;
    client.frame.at = std::chrono::steady_clock::now();
    send(client.frame.client, {{"type", "frame"}});
    if (on_frame) on_frame(client.frame);
}

}  // namespace vrut::test
