#include <doctest/doctest.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <fstream>
#include <future>
#include <iterator>
#include <regex>
#include <set>

#include "base/drawing_errors.hpp"
#include "engine/encoder.hpp"
#include "exposition.hpp"
#include "plan/render_job.hpp"
#include "test_client.hpp"

using namespace vrut;
using namespace vrut::server::observe;
using namespace vrut::server::scenes;
using namespace vrut::server::engine;
using namespace vrut::server::net;
using namespace vrut::test;

namespace {

Exposition metrics_of(const TestServer& server) {
    const HttpAnswer answer = http(server.port(), "GET", "/metrics");
    CHECK(answer.status == 200);
    CHECK(answer.headers.find("Content-Type: text/plain; version=0.0.4; charset=utf-8") != std::string::npos);
    return Exposition(answer.body);
}

std::string deployed(const std::string& file) {
    std::ifstream stream(std::string(VRUT_SCENES) + "/../deploy/" + file, std::ios::binary);
    REQUIRE_MESSAGE(stream.is_open(), file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// All that are named in it.
std::set<std::string> metrics_in(const std::string& text) {
    static const std::regex name("\\b(vrut_preview|process)_[a-z_]+\\b");
    const std::sregex_iterator begin(text.begin(), text.end(), name), end;
    std::set<std::string> names;
    for (auto match = begin; match != end; ++match) names.insert(match->str());
    return names;
}

void find_expressions(const Json& board, std::string& all) {
    if (board.is_object() && board.contains("expr")) all += board["expr"].get<std::string>() + "\n";
    for (const Json& below : board)
        if (below.is_structured()) find_expressions(below, all);
}

/// A renderer that a test can stop in the middle of a picture.
struct Stoppable {
    std::shared_ptr<std::atomic<bool>> stopped = std::make_shared<std::atomic<bool>>(false);

    FrameRendererFactory factory(const FakeRenderer& of = {}) const {
        return [stop = stopped, inner = of.factory()] {
            FrameRenderer renderer = inner();
            renderer.step = [stop, step = renderer.step](plan::RenderJob& rendering) {
                while (*stop) std::this_thread::sleep_for(1ms);
                return step(rendering);
            };
            return renderer;
        };
    }
};

LoadedScene small_scene() { return scene_of("vrut-text 1\nnode 1 \"A\" assembly end\n"); }

ServerOptions impatient(std::chrono::milliseconds busy) {
    ServerOptions options;
    options.longest_busy = busy;
    return options;
}

int status(const TestServer& server, const std::string& path) {
    return http(server.port(), "GET", path).status;
}

}  // namespace

TEST_CASE("what is exported is what the table for people says, and what the board and the alerts ask for") {
    TestServer server;
    const Exposition metrics = metrics_of(server);

    std::map<std::string, std::string> exported, documented;
    for (const auto& [name, family] : metrics.families) exported[name] = family.type;
    const std::string page = deployed("monitoring.md");
    const std::regex row("\\| `([a-z_]+)` \\| (\\w+) \\|");
    for (std::sregex_iterator match(page.begin(), page.end(), row), end; match != end; ++match)
        CHECK(documented.emplace((*match)[1], (*match)[2]).second);
    // A server that shares no room has none of these.
    const std::set<std::string> shared{"vrut_preview_nats_connected", "vrut_preview_room_owner",
                                       "vrut_preview_rooms_open", "vrut_preview_jobs_total"};
    for (const std::string& name : shared) CHECK_MESSAGE(documented.erase(name) == 1, name);
    CHECK(documented == exported);

    std::string expressions;
    const Json board = Json::parse(deployed("grafana-board.json"));
    find_expressions(board, expressions);
    CHECK(metrics_in(expressions).size() > 10);
    CHECK(board["templating"]["list"][0]["type"] == "datasource");
    for (const Json& panel : board["panels"])
        if (panel.contains("targets")) CHECK(panel["datasource"]["uid"] == "${datasource}");
    const std::string alerts = deployed("alerts.yml");
    CHECK(metrics_in(alerts).size() > 2);
    for (const std::string& name : metrics_in(expressions + alerts))
        CHECK_MESSAGE((metrics.has(name) || shared.contains(name)), name);
}

TEST_CASE("what is counted moves as it should") {
    ServerOptions options;
    options.max_clients = 3;
    TestServer server({}, options);
    CHECK(eventually([&] { return status(server, "/readyz") == 200; }));
    const Exposition before = metrics_of(server);
    CHECK(before.value("vrut_preview_scene_triangles") == 1);
    CHECK(before.value("vrut_preview_clients", {{"role", "control"}}) == 0);
    CHECK(before.value("process_resident_memory_bytes") > 1e6);
    CHECK(before.value("process_start_time_seconds") > 1.6e9);
    CHECK(before.value("process_max_fds") > before.value("process_open_fds"));

    TestClient holder(server.port()), watcher(server.port()), silent(server.port());
    holder.join();
    watcher.join("view");
    holder.wait_for_still();
    holder.send({{"type", "navigate"}, {"id", holder.next_id()}, {"rotate", {10, 0}}});
    holder.wait_for_still();
    watcher.wait_for_still();
    holder.send({{"type", "navigate"}, {"id", holder.next_id()}, {"zoom", 0}});
    CHECK(holder.wait_for("error")["code"] == "out-of-range");

    const Exposition after = metrics_of(server);
    CHECK(after.value("vrut_preview_clients", {{"role", "control"}}) == 1);
    CHECK(after.value("vrut_preview_clients", {{"role", "view"}}) == 1);
    CHECK(after.value("vrut_preview_clients", {{"role", "host"}}) == 0);
    CHECK(after.value("vrut_preview_connections") == 3);
    CHECK(after.value("vrut_preview_errors_total", {{"code", "out-of-range"}}) == 1);
    CHECK(after.value("vrut_preview_received_bytes_total") > 100);
    CHECK(after.value("vrut_preview_events_waiting") < 100);
    for (const std::string level : {"moving", "still"}) {
        const double rendered = after.value("vrut_preview_frames_rendered_total", {{"level", level}});
        CHECK(rendered >= 1);
        CHECK(after.value("vrut_preview_render_seconds_count", {{"level", level}}) == rendered);
    }
    CHECK(after.value("vrut_preview_encode_seconds_count") >= 2);
    CHECK(after.value("vrut_preview_readback_seconds_count") >= 2);
    // One input: shown to each of both once, and answered by its holder once, however many samples followed.
    CHECK(after.value("vrut_preview_input_to_frame_seconds_count") == 2);
    CHECK(after.value("vrut_preview_input_to_grant_seconds_count") == 1);
}

TEST_CASE("a late client's first frame tells of no old input") {
    TestServer server;
    TestClient holder(server.port());
    holder.join();
    holder.send({{"type", "navigate"}, {"id", holder.next_id()}, {"rotate", {10, 0}}});
    holder.wait_for_still();
    TestClient late(server.port());
    late.join("view");
    late.wait_for_still();
    CHECK(metrics_of(server).value("vrut_preview_input_to_frame_seconds_count") == 1);
}

TEST_CASE("each end of a connection is counted with its reason") {
    ServerOptions options;
    options.access.control_token = "control-token-16";
    options.access.view_token = "view-token-16-xx";
    options.max_clients = 1;
    TestServer server({}, options);
    const auto ended = [&](const char* reason) {
        return eventually([&] {
            const HttpAnswer answer = http(server.port(), "GET", "/metrics",
                                           "Host: 127.0.0.1\r\nAuthorization: Bearer control-token-16\r\n");
            const Exposition metrics(answer.body);
            double sum = 0;
            for (const auto& sample : metrics.families.at("vrut_preview_closes_total").samples)
                sum += sample.value;
            CHECK(metrics.value("vrut_preview_connections") ==
                  metrics.value("vrut_preview_connections_opened_total") - sum);
            return metrics.value("vrut_preview_closes_total", {{"reason", reason}}) == 1;
        });
    };
    const Json hello = {{"type", "hello"}, {"role", "control"}, {"token", "control-token-16"}};
    const auto expect_close = [&](const char* reason, const auto& act) {
        CAPTURE(reason);
        TestClient client(server.port());
        act(client);
        client.wait_for_close();
        CHECK(ended(reason));
    };
    expect_close("hello", [](TestClient& client) { client.send({{"type", "frame"}}); });
    expect_close("token", [](TestClient& client) {
        client.send({{"type", "hello"}, {"role", "control"}, {"token", "another-token-16"}});
    });
    expect_close("binary", [](TestClient& client) { client.send_binary("x"); });
    expect_close("too-large", [](TestClient& client) { client.send_text(std::string(70'000, ' ')); });
    expect_close("protocol", [](TestClient& client) { client.send_text("\xff"); });
    {
        TestClient only(server.port());
        only.send(hello);
        only.wait_for("welcome");
        expect_close("too-many", [](TestClient& client) {
            client.send({{"type", "hello"}, {"role", "view"}, {"token", "view-token-16-xx"}});
        });
    }
    CHECK(ended("gone"));
}

TEST_CASE("a renderer's name cannot forge a metric") {
    const std::string name = "GL \"7\" \\ of\nvrut_preview_clients 99";
    const FrameRendererFactory factory = [&] {
        FrameRenderer renderer = FakeRenderer{}.factory()();
        renderer.description = name;
        return renderer;
    };
    TestServer server(small_scene(), factory);
    const Exposition metrics = metrics_of(server);
    CHECK(metrics.families.at("vrut_preview_build_info").samples[0].labels.at("renderer") == name);
}

TEST_CASE("a time falls into the bucket that ends at it, and none is lost") {
    Histogram histogram;
    for (const double seconds : {0.0, 0.0005, 0.0006, 10.0, 10.1, 1e6, -1.0}) histogram.observe(seconds);
    const Histogram::Counts counts = histogram.counts();
    CHECK(counts[0] == 3);
    CHECK(counts[1] == 1);
    CHECK(counts[counts.size() - 2] == 1);
    CHECK(counts.back() == 2);
    CHECK(histogram.sum() == doctest::Approx(1'000'020.1011));
}

TEST_CASE("a render loop that hangs is told, and one that comes back, too") {
    const Stoppable renderer;
    TestServer server(small_scene(), renderer.factory(), impatient(300ms));
    CHECK(eventually([&] { return status(server, "/readyz") == 200; }));
    CHECK(http(server.port(), "HEAD", "/readyz").status == 200);
    CHECK(metrics_of(server).value("vrut_preview_ready") == 1);

    TestClient client(server.port());
    client.join();
    *renderer.stopped = true;
    client.send({{"type", "frame"}});
    CHECK(eventually([&] { return status(server, "/healthz") == 503; }));
    const HttpAnswer answer = http(server.port(), "GET", "/healthz");
    CHECK(answer.body.starts_with("the render loop has not come round for "));
    CHECK(metrics_of(server).value("vrut_preview_healthy") == 0);
    const HttpAnswer head = http(server.port(), "HEAD", "/healthz");
    CHECK(head.status == 503);
    CHECK(head.body.empty());
    *renderer.stopped = false;
    CHECK(eventually([&] { return status(server, "/healthz") == 200; }));
    CHECK(metrics_of(server).value("vrut_preview_healthy") == 1);
}

TEST_CASE("while a driver that was lost is started again nothing is ready") {
    std::atomic<bool> lost{false};
    const auto factory = [&] {
        if (lost) throw std::runtime_error("the driver is not there yet");
        FrameRenderer renderer = FakeRenderer{}.factory()();
        renderer.step = [&, step = renderer.step](plan::RenderJob& rendering) {
            if (lost) throw vrut::base::ContextLost("the driver was reset");
            return step(rendering);
        };
        return renderer;
    };
    TestServer server(small_scene(), factory);
    CHECK(eventually([&] { return status(server, "/readyz") == 200; }));
    TestClient client(server.port());
    client.join();
    lost = true;
    client.send({{"type", "frame"}});
    CHECK(eventually([&] { return status(server, "/readyz") == 503; }));
    CHECK(metrics_of(server).value("vrut_preview_ready") == 0);
    CHECK(status(server, "/healthz") == 200);
    lost = false;
    CHECK(eventually([&] { return status(server, "/readyz") == 200; }));
    client.wait_for("frame");
}

TEST_CASE("a picture that takes long is alive, and so is a server with nothing to do") {
    const FakeRenderer slow{20ms};  // for each sample of 64
    TestServer server(small_scene(), slow.factory(), impatient(900ms));
    TestClient client(server.port());
    client.join();
    auto drawn = std::async(std::launch::async, [&] { client.wait_for_still(); });
    while (drawn.wait_for(20ms) != std::future_status::ready) CHECK(status(server, "/healthz") == 200);
    std::this_thread::sleep_for(1000ms);  // nothing to do, for longer than any loop may be silent
    CHECK(status(server, "/healthz") == 200);
}

TEST_CASE("an encode loop that does not come round is told apart from one that waits") {
    Metrics metrics;
    std::promise<void> go_on;
    {
        Encoder encoder(
            metrics, [&](const auto&) { go_on.get_future().wait(); }, [] {},
            [](const Picture&, const std::string&) {});
        CHECK(encoder.busy_for() == 0s);
        scene::Image image;
        image.resize(4, 4);
        encoder.offer({}, std::move(image));
        CHECK(eventually([&] { return encoder.busy_for() > 50ms; }));
        go_on.set_value();
        CHECK(eventually([&] { return encoder.busy_for() == 0s; }));
    }
}

TEST_CASE("who stops is not ready") {
    namespace asio = boost::asio;
    TestServer server;
    CHECK(eventually([&] { return status(server, "/readyz") == 200; }));
    asio::io_context context;
    asio::ip::tcp::socket kept(context);
    kept.connect({asio::ip::make_address("127.0.0.1"), server.port()});
    TestClient told(server.port()), deaf(server.port());
    told.join();
    deaf.join();
    auto stopping = std::async(std::launch::async, [&] { server.stop(); });
    CHECK(told.wait_for_close() == 1001);
    asio::write(kept, asio::buffer(std::string("GET /readyz HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")));
    std::string answer;
    asio::read_until(kept, asio::dynamic_buffer(answer), "down\n");
    CHECK(answer.starts_with("HTTP/1.1 503"));
    CHECK(answer.ends_with("the server is shutting down\n"));
    stopping.wait();
}
