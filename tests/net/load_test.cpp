// Clients that do not do their part: who stand still, who come slowly, who die. The others are not to feel
// it.
#include <doctest/doctest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "audience.hpp"
#include "dying_clients.hpp"
#include "process.hpp"
#include "repetitions.hpp"

using namespace vrut;
using namespace vrut::server::observe;
using namespace vrut::server::net;
using namespace vrut::test;
using Clock = std::chrono::steady_clock;

namespace {

/// As many descriptors as both ends of a crowd take.
class DescriptorLimit {
public:
    explicit DescriptorLimit(rlim_t wanted) {
        getrlimit(RLIMIT_NOFILE, &before_);
        const rlimit more{std::min(std::max(before_.rlim_cur, wanted), before_.rlim_max), before_.rlim_max};
        setrlimit(RLIMIT_NOFILE, &more);
    }
    ~DescriptorLimit() { setrlimit(RLIMIT_NOFILE, &before_); }
    DescriptorLimit(const DescriptorLimit&) = delete;
    DescriptorLimit& operator=(const DescriptorLimit&) = delete;

private:
    rlimit before_{};
};

ServerOptions roomy() {
    ServerOptions options;
    options.max_clients = 600;
    return options;
}

/// What it goes on sending all the same.
std::vector<std::string> stubborn() {
    return {
        client_frame(R"({"type":"frame"})"),
        client_frame("ping", 9),
        client_frame(R"({"type":"tree","depth":9,"id":1})"),  // ids do not rise: each is answered by an error
        client_frame(R"({"type":"scenes"})"),
    };
}

/// Nodes whose names take several times their length in an answer.
server::scenes::LoadedScene long_names() {
    std::string name, text = "vrut-text 1\n";
    for (int i = 0; i < 500; ++i) name += "\\\"";
    for (int i = 1; i <= 300; ++i) text += "node " + std::to_string(i) + " \"" + name + "\" assembly end\n";
    return scene_of(text);
}

/// Who says what it has to say a byte each half second.
struct SlowClient {
    RawSocket socket;
    std::string says;
    Clock::time_point since = Clock::now();
    std::optional<double> cut_s = {};
};

/// Whoever works goes on meanwhile.
void dribble(std::vector<SlowClient>& slow, Audience& audience, std::chrono::seconds longest) {
    const auto is_cut = [](const SlowClient& client) { return client.cut_s.has_value(); };
    const auto start = Clock::now();
    for (std::size_t turn = 0; Clock::now() - start < longest; ++turn) {
        if (std::all_of(slow.begin(), slow.end(), is_cut)) return;
        // At least for a moment, where a turn takes longer than it should.
        audience.work_until(std::max<Clock::time_point>(start + turn * 100ms, Clock::now() + 20ms));
        for (SlowClient& client : slow) {
            if (client.cut_s) continue;
            if (turn % 5 == 0 && turn / 5 < client.says.size())
                client.socket.send(client.says.substr(turn / 5, 1));
            if (client.socket.ended())
                client.cut_s = std::chrono::duration<double>(Clock::now() - client.since).count();
        }
    }
}

}  // namespace

TEST_CASE("handshakes and hellos that come a byte each half second end at their deadline") {
    constexpr unsigned kHandshakes = 500, kHellos = 50;
    const DescriptorLimit many(4096);
    ServerOptions options = roomy();
    options.deadlines.request = 1'500ms;
    options.deadlines.hello = 2s;
    TestServer server({.noise = true}, options);
    Audience audience(server.port(), 2);
    audience.work_until(Clock::now() + 1s);
    const double alone_ms = audience.percentile(0.99);
    audience.forget();
    std::vector<SlowClient> slow;
    for (unsigned i = 0; i < kHandshakes; ++i)
        slow.push_back({RawSocket(server.port(), {.source = 100 + i}), upgrade_request()});
    const std::string hello = client_frame(R"({"type":"hello","role":"view"})");
    for (unsigned i = 0; i < kHellos; ++i)
        slow.push_back({websocket(server.port(), {.source = 700 + i}), i % 2 == 0 ? hello : ""});
    dribble(slow, audience, 9s);
    double handshakes_s = 0, hellos_s = 0;
    for (std::size_t i = 0; i < slow.size(); ++i) {
        double& longest = i < kHandshakes ? handshakes_s : hellos_s;
        longest = std::max(longest, slow[i].cut_s.value_or(99));
    }
    MESSAGE("cut after " << handshakes_s << " s, without hello after " << hellos_s << " s; the others' p99 "
                         << alone_ms << " ms before, " << audience.percentile(0.99) << " ms meanwhile");
    CHECK(handshakes_s < (kMemoryTells ? 2 : 4));
    CHECK(hellos_s < 6);  // after 2 s the server sends an error, then waits 3 s for the goodbye
    CHECK(audience.seen() > 100);
    Swarm(server.port()).join("view");
}

TEST_CASE("clients that connect and die leave nothing behind") {
    const DescriptorLimit many(4096);
    TestServer server({}, roomy());
    TestClient good(server.port());
    good.join("view");
    const double grown_mb = let_die(server, 6, 200);
    good.wait_for_still();
    if (kMemoryTells) CHECK(grown_mb < 4);
}

TEST_CASE("clients that read nothing or single bytes, whatever they send, delay nobody and are cut") {
    ServerOptions options = roomy();
    options.deadlines.stuck = 4s;
    TestServer server({.noise = true}, options);
    Audience audience(server.port(), 20);
    audience.work_until(Clock::now() + 1s);
    const std::vector<std::string> said = stubborn();
    std::vector<RawSocket> stalled;
    for (unsigned i = 0; i <= said.size(); ++i) stalled.push_back(standing_client(server.port(), 500 + i));
    const RawSocket dribbling = standing_client(server.port(), 600);
    dribbling.send(said[0]);
    audience.work_until(Clock::now() + 500ms);  // what goes into the sockets has gone there
    const double memory = use_of(getpid()).resident_mb;
    double most = memory;
    std::size_t seen = 0;
    const auto start = Clock::now();
    for (int second = 0; second < 8 && server.metrics().clients_left <= stalled.size(); ++second) {
        dribbling.read(1);
        dribbling.send(said[0]);
        for (int tenth = 0; tenth < 10; ++tenth) {
            for (std::size_t i = 0; i < said.size(); ++i)
                for (int j = 0; j < 20; ++j) stalled[i].send(said[i]);
            audience.work_until(Clock::now() + 100ms);
        }
        most = std::max(most, use_of(getpid()).resident_mb);
        CHECK(audience.seen() > std::exchange(seen, audience.seen()));
    }
    const double cut_s = std::chrono::duration<double>(Clock::now() - start).count();
    const Metrics& metrics = server.metrics();
    CHECK(metrics.clients_left == stalled.size() + 1);
    for (const RawSocket& socket : stalled) CHECK(eventually([&] { return socket.ended(); }));
    CHECK(eventually([&] { return dribbling.ended(); }));
    // Each stalled client's in its socket, the newest, one on its way to those who read, one fresh from the
    // encoder.
    CHECK(metrics.pictures_held_most <= 4 + stalled.size());
    MESSAGE(audience.seen() << " pictures seen, p50 " << audience.percentile(0.5) << ", p99 "
                            << audience.percentile(0.99) << " ms; memory " << memory << " MB, at most "
                            << most << "; cut after " << cut_s << " s");
    if (kMemoryTells) CHECK(most - memory < 8);
}

TEST_CASE(
    "64 clients that take answers and snapshots by the drop are cut, and what waits is bounded for all") {
    constexpr unsigned kClients = 64, kRequests = 256;
    constexpr double kMost = 512e6;  // bytes
    ServerOptions options = roomy();
    options.deadlines.least_rate = 4s;
    options.deadlines.stuck = 1min;  // what they take is something
    TestServer server(long_names(), FakeRenderer{.noise = true}.factory(), options);
    TestClient good(server.port());
    good.join("view");
    const double idle = 1e6 * use_of(getpid()).resident_mb;
    std::vector<RawSocket> slow;
    for (unsigned i = 0; i < kClients; ++i) {
        slow.push_back(websocket(server.port(), {.receive_buffer = 4096, .source = 500 + i}));
        slow.back().send(client_frame(R"({"type":"hello","role":"view"})"));
        const bool draws = i % 2 == 0;
        for (unsigned id = 1; id <= (draws ? 2 : kRequests); ++id)
            slow.back().send(client_frame((draws ? R"({"type":"snapshot","width":4096,"height":2048,"id":)"
                                                 : R"({"type":"tree","id":)") +
                                          std::to_string(id) + "}"));
    }
    const Metrics& metrics = server.metrics();
    double held = 0, resident = 0;
    const auto all_left = [&] {
        held = std::max(held, static_cast<double>(metrics.bytes_held));
        resident = std::max(resident, 1e6 * use_of(getpid()).resident_mb - idle);
        return metrics.clients_left == kClients;
    };
    const auto start = Clock::now();
    for (int turn = 1; turn <= 20 && !eventually(all_left, 3s); ++turn) {
        for (const RawSocket& client : slow) client.read(4096);
        good.send({{"type", "tree"}, {"id", turn}});
        CHECK(good.wait_for("tree", 20s)["id"] == turn);
    }
    const double cut_s = std::chrono::duration<double>(Clock::now() - start).count();
    const std::uint64_t backlog = metrics.closes["backlog"], stuck = metrics.closes["stuck"];
    MESSAGE("held at most " << held / 1e6 << " MB, resident " << resident / 1e6 << " MB more than idle; "
                            << backlog << " cut for what waits for all, " << stuck
                            << " for their rate, all after " << cut_s << " s");
    CHECK(backlog + stuck == kClients);
    CHECK(held < kMost);
    if (kMemoryTells) CHECK(resident < kMost);
}

TEST_CASE("clients who join a large state and do not read it hold it once") {
    constexpr unsigned kClients = 12;
    constexpr int kNodes = repetitions(700);
    const std::string name(60'000, 'x');
    std::string scene = "vrut-text 1\n";
    for (int i = 1; i <= kNodes; ++i)
        scene += "node " + std::to_string(i) + " \"" + name + "\" camera eye 0 0 5 end\n";
    TestServer server(scene_of(scene), FakeRenderer{}.factory(), roomy());
    std::vector<RawSocket> stalled;
    for (unsigned i = 0; i < kClients; ++i) stalled.push_back(standing_client(server.port(), 500 + i));
    const Metrics& metrics = server.metrics();
    std::uint64_t most = 0;
    // Each has its welcome, and is being sent the state.
    CHECK(eventually([&] {
        most = std::max<std::uint64_t>(most, metrics.bytes_held);
        return metrics.bytes_sent >= kClients * kNodes * name.size();
    }));
    MESSAGE("held: " << most << " bytes");
    CHECK(most < 2 * kNodes * name.size());
    CHECK(metrics.clients_left == 0);
}
