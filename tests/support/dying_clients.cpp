#include "dying_clients.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

#include "process.hpp"
#include "swarm.hpp"

namespace vrut::test {

namespace {

/// Waits for as much as tells that what was sent before is handled.
void wait_for_answer(const RawSocket& socket, const std::string& part) {
    std::string got;
    REQUIRE_MESSAGE(eventually([&] { return (got += socket.read()).find(part) != std::string::npos; }, 20s),
                    got);
}

void say(const RawSocket& socket, const Json& message) { socket.send(client_frame(message.dump())); }

void join(const RawSocket& socket) {
    socket.send(upgrade_request());
    wait_for_answer(socket, "\r\n\r\n");
    say(socket, {{"type", "hello"}, {"role", "control"}});
    wait_for_answer(socket, R"("type":"state")");
}

/// How a client begins, at whose end it dies.
const std::vector<void (*)(const RawSocket&)> kLives{
    [](const RawSocket&) {},
    [](const RawSocket& socket) { socket.send(upgrade_request().substr(0, 90)); },
    [](const RawSocket& socket) { socket.send(upgrade_request()); },
    [](const RawSocket& socket) {
        socket.send(upgrade_request());
        wait_for_answer(socket, "\r\n\r\n");
        socket.send(client_frame(R"({"type":"hello","role":"control"})").substr(0, 20));
    },
    [](const RawSocket& socket) { join(socket); },
    [](const RawSocket& socket) {  // with frames that it does not take
        join(socket);
        for (int i = 0; i < 2; ++i) say(socket, {{"type", "frame"}});
        say(socket, {{"type", "navigate"}, {"rotate", {5, 0}}});
    },
    [](const RawSocket& socket) {
        join(socket);
        say(socket, {{"type", "control"}, {"action", "take"}});
        say(socket, pointer_event("pointerdown", 100, 100));
        say(socket, pointer_event("pointermove", 120, 90));
        say(socket, {{"type", "frame"}});
    },
    [](const RawSocket& socket) {
        join(socket);
        for (int i = 1; i <= 2; ++i)
            say(socket, {{"type", "snapshot"}, {"id", i}, {"width", 64}, {"height", 48}});
    },
    [](const RawSocket& socket) {
        socket.send("GET /frame.jpg?width=64&height=48 HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
    },
};

}  // namespace

void connect_and_die(std::uint16_t port, std::size_t clients) {
    std::vector<RawSocket> sockets;
    for (std::size_t i = 0; i < clients; ++i) {
        sockets.emplace_back(
            port, RawSocket::Options{.receive_buffer = 4096, .source = static_cast<unsigned>(2 + i)});
        kLives[i % kLives.size()](sockets.back());
    }
    for (std::size_t i = 0; i < clients; ++i)
        if (i / kLives.size() % 2 == 1) sockets[i].reset();
}

double let_die(const TestServer& server, int rounds, std::size_t clients) {
    constexpr int kFirstRounds = 2;
    ProcessUse before = use_of(getpid());
    double memory = 0;
    for (int round = 0; round < rounds; ++round) {
        connect_and_die(server.port(), clients);
        ProcessUse use;
        eventually(
            [&] {
                use = use_of(getpid());
                // One that an earlier server left may have been among them, making detail levels.
                before.threads = std::min(before.threads, use.threads);
                return use.descriptors == before.descriptors && use.threads == before.threads;
            },
            30s);
        CHECK(use.descriptors == before.descriptors);
        CHECK(use.threads == before.threads);
        if (round < kFirstRounds) memory = use.resident_mb;
    }
    const std::string metrics = http(server.port(), "GET", "/metrics").body;
    CHECK(metrics.find("\nvrut_preview_clients{role=\"view\"} 1\n") != std::string::npos);
    const double now = use_of(getpid()).resident_mb;
    MESSAGE(clients << " clients: " << memory << " MB after " << kFirstRounds << " rounds, " << now
                    << " MB after " << rounds);
    return now - memory;
}

}  // namespace vrut::test
