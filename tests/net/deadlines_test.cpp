// How long a peer may take, and how much: shorter deadlines than the server's own, or these would take
// minutes.
#include <doctest/doctest.h>

#include <atomic>

#include "net/descriptors.hpp"
#include "raw_websocket.hpp"
#include "swarm.hpp"

using namespace vrut;
using namespace vrut::server::net;
using namespace vrut::test;
using std::chrono::steady_clock;

namespace {

/// Each in turn.
Over tcp_and_tls() {
    Over over = Over::tcp;
    SUBCASE("") {}
    SUBCASE("by TLS") { over = Over::tls; }
    return over;
}

ServerOptions with(const Deadlines& deadlines, Over over = Over::tcp) {
    ServerOptions options = over == Over::tls ? with_tls() : ServerOptions();
    options.deadlines = deadlines;
    return options;
}

/// Sends byte after byte until the server has had enough; how long that took.
steady_clock::duration trickle(RawConnection& connection, const std::string& bytes,
                               std::chrono::milliseconds pause = 50ms) {
    const auto start = steady_clock::now();
    for (const char byte : bytes) {
        connection.send({&byte, 1});
        if (connection.ended(pause)) break;
    }
    CHECK(connection.ended(10s));
    return steady_clock::now() - start;
}

/// Of the close frame that the server sends; 0 where it sends none.
int close_code(RawWebSocket& client) {
    int code = 0;
    while (const auto next = client.receive())
        if (next->opcode == kClose && next->payload.size() >= 2)
            code = static_cast<unsigned char>(next->payload[0]) << 8 |
                   static_cast<unsigned char>(next->payload[1]);
    return code;
}

const std::string kGet = "GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n";

}  // namespace

TEST_CASE("a request that trickles in is cut, and the next on its connection as well") {
    const Over over = tcp_and_tls();
    TestServer server({}, with({.request = 1s}, over));
    RawConnection slow(server.port(), over);
    const auto took = trickle(slow, kGet + "X: " + std::string(1000, 'x'));
    CHECK(took > 500ms);
    CHECK(took < 10s);
    RawConnection second(server.port(), over);
    second.send(kGet + "\r\n");
    CHECK(second.answer().status == 200);
    CHECK(trickle(second, kGet + "X: " + std::string(1000, 'x')) < 10s);
    RawConnection idle(server.port(), over);
    CHECK(idle.ended(10s));
    CHECK(http(server.port(), "GET", "/healthz").status == 200);
}

TEST_CASE("a hello that trickles in is cut like one that does not come") {
    const Over over = tcp_and_tls();
    TestServer server({}, with({.hello = 1s}, over));
    for (const bool trickles : {true, false}) {
        RawWebSocket client(server.port(), {}, over);
        REQUIRE(client.handshake.status == 101);
        const std::string hello = frame(kFinal | kText, R"({"type":"hello","role":"view"})");
        client.connection.send(trickles ? hello.substr(0, hello.size() / 2) : "");
        const auto error = client.receive();
        REQUIRE(error.has_value());
        CHECK(Json::parse(error->payload)["type"] == "error");
        const auto close = client.receive();
        REQUIRE(close.has_value());
        CHECK(close->payload.substr(0, 2) == big_endian(1008, 2));
        CHECK(trickle(client.connection, hello.substr(hello.size() / 2) + std::string(1000, 'x')) < 15s);
    }
}

TEST_CASE(
    "a message that does not come to its end ends the connection, one that only takes its time does not") {
    TestServer server({}, with({.message = 2s}));
    RawWebSocket client(server.port()), patient(server.port());
    for (RawWebSocket* each : {&client, &patient}) each->join();
    client.connection.send(frame(kFinal | kText, std::string(100, ' ')).substr(0, 50));
    const std::string whole = frame(kFinal | kText, R"({"type":"tree","id":1})");
    patient.connection.send(whole.substr(0, 12));
    CHECK_FALSE(patient.connection.ended(500ms));
    patient.connection.send(whole.substr(12));
    while (Json::parse(patient.receive()->payload)["type"] != "tree") {
    }
    CHECK(close_code(client) == 1008);
}

TEST_CASE("a message that trickles in ends the connection at its deadline, be it at its head") {
    TestServer server({}, with({.message = 2s}));
    const std::string message = frame(kFinal | kText, std::string(65'536, ' '));  // its head takes 14 bytes
    for (const unsigned at_once : {0U, 50U}) {
        CAPTURE(at_once);
        RawWebSocket client(server.port());
        client.join();
        client.connection.send(message.substr(0, at_once));
        const auto took = trickle(client.connection, message.substr(at_once, 60), 300ms);
        CHECK(took > 1500ms);
        CHECK(took < 10s);  // with the time that is left to it for its goodbye
        CHECK(close_code(client) == 1008);
    }
}

TEST_CASE("who is silent is pinged, and cut when no answer comes; who answers is not") {
    TestServer server({}, with({.ping = 1s, .idle = 3s}));
    RawWebSocket silent(server.port()), answering(server.port());
    silent.join();
    answering.join("host");
    std::atomic<int> pings{0};
    std::atomic<bool> cut{false};
    std::thread host([&] {
        while (!cut)
            if (answering.connection.ended(100ms))
                break;
            else if (const auto next = answering.receive(); next && next->opcode == kPing) {
                ++pings;
                answering.connection.send(frame(kFinal | kPong, next->payload));
            }
    });
    int seen = 0;
    while (const auto next = silent.receive()) seen += next->opcode == kPing;
    CHECK(seen >= 1);
    CHECK(silent.connection.ended());
    // As long again for the one that answers.
    CHECK(eventually([&] { return pings >= 3; }, 30s));
    cut = true;
    host.join();
    CHECK_FALSE(answering.connection.ended(100ms));
}

TEST_CASE("who sends more messages than he was promised is read more slowly, and nothing is lost") {
    TestServer server;
    TestClient flood(server.port()), other(server.port());
    flood.join();
    other.join("view");
    const std::uint64_t before = server.metrics().messages_received;
    constexpr int kMoves = 20'000;
    const auto start = steady_clock::now();
    std::thread sender([&] {
        for (int i = 0; i < kMoves; ++i)
            flood.send(pointer_event("pointermove", i % 1000, 1, "mouse", -1, 0));
        flood.send({{"type", "tree"}, {"id", 1}});
    });
    for (int id = 1; id <= 5; ++id) {
        other.send({{"type", "tree"}, {"id", id}});
        CHECK(other.wait_for("tree", 2s)["id"] == id);
    }
    CHECK(flood.wait_for("tree", 60s)["id"] == 1);
    sender.join();
    CHECK(steady_clock::now() - start > 800ms);  // 10,000 at once, the others in a second
    CHECK(server.metrics().messages_received == before + kMoves + 6);
}

TEST_CASE("one connection too many of any kind is told so, and there is room again when others go") {
    allow_descriptors(4096);
    ServerOptions options;
    options.max_clients = 1;
    TestServer server({}, options);
    std::vector<std::unique_ptr<RawConnection>> open;
    for (int i = 0; i < 1028; ++i) open.push_back(std::make_unique<RawConnection>(server.port()));
    RawConnection late(server.port());
    const HttpAnswer answer = late.answer();
    CHECK(answer.status == 503);
    CHECK(answer.body == "there are too many connections: close some, or try again later\n");
    CHECK(late.ended());
    open.resize(open.size() / 2);
    CHECK(eventually([&] { return http(server.port(), "GET", "/healthz").status == 200; }));
}

TEST_CASE("beyond loopback one address may not take all connections") {
    ServerOptions options;
    options.listen.host = "0.0.0.0";
    options.access.control_token = options.access.view_token = "secret";
    options.max_clients = 1;
    TestServer server({}, options);
    std::vector<std::unique_ptr<RawConnection>> open;
    for (int i = 0; i < 64 + 4; ++i) open.push_back(std::make_unique<RawConnection>(server.port()));
    RawConnection late(server.port());
    CHECK(late.answer().status == 503);
    open.pop_back();
    CHECK(eventually([&] { return http(server.port(), "GET", "/healthz").status == 200; }));
}

TEST_CASE("who takes its snapshots by the drop is cut, who takes them slowly is not") {
    TestServer server({.noise = true}, with({.least_rate = 2s}));
    std::vector<RawSocket> clients;  // the first takes 2 kB a second, the other 40
    for (unsigned i = 0; i < 2; ++i) {
        clients.push_back(websocket(server.port(), {.receive_buffer = 4096, .source = 2 + i}));
        clients[i].send(client_frame(R"({"type":"hello","role":"view"})"));
        for (const char* id : {"1", "2"})
            clients[i].send(client_frame(R"({"type":"snapshot","width":1000,"height":1000,"id":)" +
                                         std::string(id) + "}"));
    }
    const auto cut = [&] { return server.metrics().closes.sum(); };
    CHECK(eventually([&] { return server.metrics().snapshots_sent == 2; }));
    for (int i = 0; i < 60 && cut() == 0; ++i) {
        clients[0].read(200);
        clients[1].read(4000);
        std::this_thread::sleep_for(100ms);
    }
    CHECK(cut() == 1);
    CHECK(eventually([&] { return clients[0].ended(); }));  // it is counted before its socket is closed
}
