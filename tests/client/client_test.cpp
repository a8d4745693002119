// The client for hosts, against the server.
#include <doctest/doctest.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "io/vrut/text_reader.hpp"
#include "preview_client.hpp"
#include "test_client.hpp"

using namespace vrut;
using namespace vrut::server::engine;
using namespace vrut::server::net;
using namespace vrut::test;
using boost::asio::ip::tcp;
using client::PreviewClient;
using client::Problem;

namespace {

client::Options options_for(std::uint16_t port) {
    client::Options options;
    options.port = port;
    options.name = "wall";
    return options;
}

std::chrono::milliseconds since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - start);
}

/// A client that writes down what it is told.
struct Host {
    explicit Host(client::Options options) : client(std::move(options)) {
        client.on_connection = [this](bool connected) { connections.push_back(connected); };
        client.on_camera = [this](const client::Camera& camera, bool mine) {
            cameras.push_back({camera, mine});
        };
        client.on_state = [this](const std::string& changes, bool whole) {
            states.push_back({Json::parse(changes), whole});
        };
        client.on_error = [this](const Problem& problem) { problems.push_back(problem); };
        client.on_message = [this](const std::string& type, const std::string& json) {
            (type == "stats" ? stats : messages).push_back({type, Json::parse(json)});
        };
    }
    explicit Host(std::uint16_t port) : Host(options_for(port)) {}

    template <class Condition>
    bool poll_until(Condition condition, std::chrono::milliseconds timeout = 5s) {
        const auto start = std::chrono::steady_clock::now();
        while (!condition() && since(start) < timeout) client.poll(5ms);
        return condition();
    }
    void poll_for(std::chrono::milliseconds time) {
        poll_until([] { return false; }, time);
    }
    void join() {
        REQUIRE(poll_until([this] { return client.connected(); }));
    }
    Json state() const { return Json::parse(client.state_json()); }

    PreviewClient client;
    std::vector<bool> connections;
    std::vector<std::pair<client::Camera, bool>> cameras;
    std::vector<std::pair<Json, bool>> states;
    std::vector<Problem> problems;
    std::vector<std::pair<std::string, Json>> messages, stats;  // which come when they like
};

/// A server on a given port, which may have been another server's before.
class ServerAt {
public:
    explicit ServerAt(std::uint16_t port) {
        ServerOptions options;
        options.listen = {"127.0.0.1", port};
        server_ = std::make_unique<Server>(
            options,
            scene_of("vrut-text 1\ngeometry 1 vertices 3 -1 -1 0  1 -1 0  0 1 1 triangles 1 0 1 2 end\n"
                     "node 1 \"Triangle\" geometry geometry 1 end\n",
                     "again.vrut"),
            FakeRenderer{}.factory());
        thread_ = std::thread([this] { server_->run(); });
    }
    ~ServerAt() {
        server_->stop();
        thread_.join();
    }

private:
    std::unique_ptr<Server> server_;
    std::thread thread_;
};

/// Says what it is told to, to one client, and then listens until that one leaves.
class FakeServer {
public:
    explicit FakeServer(std::vector<std::string> texts) : texts_(std::move(texts)) {
        thread_ = std::thread([this] { run(); });
    }
    ~FakeServer() { thread_.join(); }
    std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
    std::string target;  ///< of the request, once something it says has come
    Json hello;          ///< likewise
    std::atomic<int> pongs{0};

private:
    void run() {
        boost::beast::websocket::stream<tcp::socket> socket(context_);
        acceptor_.accept(socket.next_layer());
        boost::beast::flat_buffer buffer;
        boost::beast::http::request<boost::beast::http::empty_body> request;
        boost::beast::http::read(socket.next_layer(), buffer, request);
        target = std::string(request.target());
        socket.accept(request);
        socket.read(buffer);
        hello = Json::parse(boost::beast::buffers_to_string(buffer.data()));
        socket.control_callback([this](boost::beast::websocket::frame_type kind, boost::beast::string_view) {
            if (kind == boost::beast::websocket::frame_type::pong) ++pongs;
        });
        boost::beast::error_code error;
        socket.ping({}, error);
        for (const std::string& text : texts_) socket.write(boost::asio::buffer(text), error);
        while (!error) socket.read(buffer, error);
    }

    std::vector<std::string> texts_;
    boost::asio::io_context context_;
    tcp::acceptor acceptor_{context_, {boost::asio::ip::make_address("127.0.0.1"), 0}};
    std::thread thread_;
};

constexpr const char* kWelcome =
    R"({"type":"welcome","version":1,"client":"c7","role":"host","limits":{"maxServerMessage":1000}})";
constexpr const char* kState =
    R"({"type":"state","revision":5,"state":{"selection":{},"camera":{"eye":[0,0,4],"focus":[0,0,0],)"
    R"("up":[0,1,0],"center":[0,0,0],"fov":40,"near":1,"far":9}}})";

client::Camera camera_of(const Json& json) {
    client::Camera camera;
    json.at("eye").get_to(camera.eye);
    json.at("focus").get_to(camera.focus);
    json.at("up").get_to(camera.up);
    json.at("center").get_to(camera.center);
    json.at("fov").get_to(camera.fov);
    json.at("near").get_to(camera.near_plane);
    json.at("far").get_to(camera.far_plane);
    return camera;
}

double largest_difference(const client::Matrix4& a, const Json& b) {
    REQUIRE(b.size() == 16);
    double largest = 0;
    for (std::size_t i = 0; i < 16; ++i) largest = std::max(largest, std::abs(a[i] - b[i].get<double>()));
    return largest;
}

void drag(TestClient& tablet) {
    tablet.send(pointer_event("pointerdown", 200, 300));
    tablet.send(pointer_event("pointermove", 533.3, 188.9));
    tablet.send(pointer_event("pointerup", 533.3, 188.9, "touch", 0, 0));
    tablet.send({{"type", "resize"}, {"id", 1}, {"width", 1280}, {"height", 720}, {"pixelRatio", 1}});
    tablet.wait_for("ok");
}

}  // namespace

TEST_CASE("the matrices of a camera, by hand") {
    client::Camera camera;
    camera.eye = {3, 2, 10};
    camera.focus = {3, 2, 0};
    camera.fov = 90;
    camera.near_plane = 1;
    camera.far_plane = 3;
    CHECK(client::view_matrix(camera) == client::Matrix4{1, 0, 0, -3, 0, 1, 0, -2, 0, 0, 1, -10, 0, 0, 0, 1});
    const client::Matrix4 projection = client::projection_matrix(camera, 2);
    const client::Matrix4 expected{0.5, 0, 0, 0, 0, 1, 0, 0, 0, 0, -2, -3, 0, 0, -1, 0};
    for (std::size_t i = 0; i < 16; ++i) CHECK(projection[i] == doctest::Approx(expected[i]).epsilon(1e-15));
    // From the right, looking to the left: what was behind lies to the right.
    camera.eye = {5, 0, 0};
    camera.focus = {0, 0, 0};
    CHECK(client::view_matrix(camera) == client::Matrix4{0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, -5, 0, 0, 0, 1});
}

TEST_CASE("a host joins, and knows the server's state and its own id") {
    TestServer server;
    Host host(server.port());
    CHECK_FALSE(host.client.connected());
    CHECK(host.client.state_json().empty());
    host.join();
    TestClient other(server.port());
    CHECK(host.state() == other.join("view"));
    CHECK(host.client.client() == "c1");
    CHECK(host.connections == std::vector<bool>{true});
    REQUIRE(host.states.size() == 1);
    CHECK(host.states[0].second);
    REQUIRE(host.cameras.size() == 1);
    CHECK_FALSE(host.cameras[0].second);
    CHECK(host.client.state_json("/scene/name") == "\"triangle\"");
    CHECK(host.client.state_json("/scene/nose").empty());
    CHECK(host.client.state_json("no pointer").empty());
    CHECK_FALSE(host.client.selection().has_value());
}

TEST_CASE("a host follows another client's drag, and its matrices are the frame's") {
    TestServer server;
    Host host(server.port());
    host.join();
    const client::Camera before = host.client.camera();
    TestClient tablet(server.port());
    tablet.state = tablet.join();
    tablet.send({{"type", "patch"}, {"patch", {{"comfort", {{"on", false}}}}}});  // it follows at once
    drag(tablet);
    tablet.send({{"type", "patch"}, {"id", 2}, {"patch", {{"camera", {{"fov", 33.3}}}}}});
    const std::int64_t revision = tablet.wait_for("ok")["revision"];
    REQUIRE(host.poll_until([&] { return host.client.revision() == revision; }));

    CHECK(host.client.camera() != before);
    CHECK(host.client.camera() == camera_of(tablet.state["camera"]));
    CHECK(host.client.camera() == host.cameras.back().first);
    CHECK_FALSE(host.cameras.back().second);
    CHECK(host.state() == tablet.state);
    CHECK_FALSE(host.states.back().second);
    CHECK(host.states.back().first["camera"]["fov"] == 33.3);

    const Json header = tablet.wait_for_still();
    CHECK(header["revision"] == revision);
    const double aspect = header["view"]["width"].get<double>() / header["view"]["height"].get<double>();
    CHECK(largest_difference(client::view_matrix(host.client.camera()), header["camera"]["viewMatrix"]) <
          1e-12);
    CHECK(largest_difference(client::projection_matrix(host.client.camera(), aspect),
                             header["camera"]["projectionMatrix"]) < 1e-12);
}

TEST_CASE("a host leads, and is told which camera is its own") {
    TestServer server;
    TestClient tablet(server.port());
    tablet.state = tablet.join();
    Host host(server.port());
    host.join();
    client::Camera camera = host.client.camera();
    camera.eye = {0.1, 2.0 / 3, 7};
    camera.focus = {0, 0.25, 0};
    camera.center = {0, 1, 0};
    camera.fov = 55.5;
    CHECK(host.client.lead(camera) == 1);
    REQUIRE(host.poll_until([&] { return !host.messages.empty(); }));
    CHECK(host.messages[0].first == "ok");
    CHECK(host.messages[0].second["id"] == 1);
    REQUIRE(host.cameras.size() == 2);
    CHECK(host.cameras[1].second);
    CHECK(host.client.camera().eye == camera.eye);
    CHECK(host.client.camera().focus == camera.focus);
    CHECK(host.client.camera().center == camera.center);
    CHECK(host.client.camera().fov == 55.5);
    tablet.wait_for("patch");
    CHECK(camera_of(tablet.state["camera"]) == host.client.camera());

    camera.eye[1] = std::numeric_limits<double>::quiet_NaN();
    CHECK(host.client.lead(camera) == 0);
}

TEST_CASE("of poses that wait to be sent the newest goes, unless a patch came between") {
    TestServer server;
    Host host(server.port());
    host.join();
    client::Camera camera = host.client.camera();
    for (int i = 1; i <= 1000; ++i) {
        camera.fov = 20 + i * 0.01;
        CHECK(host.client.lead(camera) == i);
    }
    CHECK(host.client.patch(R"({"camera": {"fov": 70}})") == 1001);
    camera.fov = 60;
    CHECK(host.client.lead(camera) == 1002);
    REQUIRE(
        host.poll_until([&] { return !host.messages.empty() && host.messages.back().second["id"] == 1002; }));
    CHECK(host.client.camera().fov == 60);
    // The first was on its way, the newest waited.
    std::vector<int> answered;
    for (const auto& [type, message] : host.messages) answered.push_back(message["id"]);
    CHECK(answered == std::vector<int>{1, 1000, 1001, 1002});
    CHECK(host.problems.empty());
}

TEST_CASE("what cannot be sent is not") {
    TestServer server;
    Host host(server.port());
    CHECK(host.client.patch("{}") == 0);  // not connected yet
    CHECK(host.client.lead({}) == 0);
    host.join();
    CHECK(host.client.patch("nonsense") == 0);
    CHECK(host.client.patch("[1]") == 0);
    CHECK(host.client.patch(R"({"camera": {"fov": 1e999}})") == 0);
    CHECK(host.client.patch(Json({{"a", std::string(65'536, 'a')}}).dump()) == 0);
    int sent = 0;
    while (host.client.patch(R"({"camera": {"fov": 50}})") != 0) ++sent;
    CHECK(sent == 65);  // one is on its way, 64 wait
    REQUIRE(host.poll_until([&] { return host.messages.size() == 65; }));
    CHECK(host.problems.empty());
}

TEST_CASE("a host's patch on navigation is refused, and on_error tells") {
    TestServer server;
    Host host(server.port());
    host.join();
    const std::int64_t id = host.client.patch(R"({"navigation": {"zoomSpeed": 2}})");
    REQUIRE(host.poll_until([&] { return !host.problems.empty(); }));
    CHECK(host.problems[0].code == "not-allowed");
    CHECK(host.problems[0].id == id);
    CHECK(host.problems[0].message.size() > 10);
    CHECK(host.client.connected());
    CHECK(host.state()["navigation"]["zoomSpeed"] == 1);
}

TEST_CASE("a host selects") {
    TestServer server;
    Host host(server.port());
    host.join();
    host.client.patch(R"({"selection": {"node": 1}})");
    REQUIRE(host.poll_until([&] { return host.client.selection().has_value(); }));
    CHECK(host.client.selection() == 1);
    CHECK(host.cameras.size() == 1);  // the camera has not changed
    host.client.patch(R"({"selection": {"node": null}})");
    CHECK(host.poll_until([&] { return !host.client.selection().has_value(); }));
}

TEST_CASE("after a restart of the server everything is there again") {
    std::optional<TestServer> first(std::in_place);
    const std::uint16_t port = first->port();
    Host host(port);
    host.join();
    client::Camera camera = host.client.camera();
    camera.fov = 66;
    host.client.lead(camera);
    REQUIRE(host.poll_until([&] { return host.client.camera().fov == 66; }));

    std::thread stopping([&] { first->stop(); });
    CHECK(host.poll_until([&] { return !host.client.connected(); }));
    stopping.join();
    host.poll_for(1s);  // some attempts fail
    CHECK(host.client.lead(camera) == 0);
    CHECK(host.client.camera().fov == 66);  // the walls keep their picture
    CHECK(host.connections == std::vector<bool>{true, false});
    CHECK(host.problems.size() <= 2);  // the loss, and that nobody answers

    ServerAt second(port);
    REQUIRE(host.poll_until([&] { return host.client.connected(); }, 6s));
    CHECK(host.connections == std::vector<bool>{true, false, true});
    CHECK(host.client.state_json("/scene/name") == "\"again\"");
    CHECK(host.client.camera().fov == 40);
    CHECK(host.cameras.back().first == host.client.camera());
    CHECK(host.states.back().second);
    CHECK(host.client.lead(camera) == 1);
    CHECK(host.poll_until([&] { return host.client.camera().fov == 66; }));
}

TEST_CASE("a server that comes later is found") {
    std::uint16_t port = 0;
    {
        TestServer passing;
        port = passing.port();
    }
    Host host(port);
    host.poll_for(400ms);
    CHECK(host.problems.size() == 1);
    CHECK(host.problems.at(0).code == "connection");
    ServerAt server(port);
    CHECK(host.poll_until([&] { return host.client.connected(); }, 3s));
}

TEST_CASE("a token that is refused is told once, and not tried again and again") {
    TestServer server({},
                      {.access = {.control_token = "secret", .view_token = "look", .allowed_origins = {}}});
    client::Options options = options_for(server.port());
    options.token = "guess";
    Host host(options);
    host.poll_for(2s);
    REQUIRE(host.problems.size() == 1);
    CHECK(host.problems[0].code == "not-allowed");
    CHECK(host.problems[0].message == "the token is wrong");
    CHECK(server.metrics().messages_rejected() == 1);
    CHECK(host.connections.empty());

    options.token = "secret";
    Host right(options);
    right.join();
    CHECK(right.problems.empty());
}

TEST_CASE("a host connects to /ws, or to the path that its options name") {
    for (const char* path : {"", "/rooms/car/ws", "/ws?by=proxy"}) {
        FakeServer server({kWelcome, kState});
        client::Options options = options_for(server.port());
        if (*path) options.path = path;
        Host host(options);
        host.join();
        CHECK(server.target == (*path ? path : "/ws"));
    }
}

TEST_CASE("on_error tells what is no path") {
    for (const char* path : {"", "ws", "/rooms/my car/ws", "/ws#car", "/w\r\nHost: x", "/caf\u00e9"}) {
        client::Options options;
        options.path = path;
        Host host(options);
        REQUIRE(host.poll_until([&] { return !host.problems.empty(); }));
        CHECK(host.problems[0].code == "connection");
        CHECK(host.problems[0].message ==
              std::string("VRUT Preview at 127.0.0.1:8080: the path '") + path +
                  "' must begin with '/', and have ASCII characters alone, no space and no '#'");
    }
}

TEST_CASE("a message that is larger than allowed ends the connection") {
    TestServer server;
    client::Options options = options_for(server.port());
    options.max_message = 400;  // welcome fits, the state does not
    Host host(options);
    REQUIRE(host.poll_until([&] { return !host.problems.empty(); }));
    CHECK(host.problems[0].code == "connection");
    CHECK_FALSE(host.client.connected());
}

TEST_CASE("poll waits no longer than asked, also where nobody answers") {
    boost::asio::io_context context;
    tcp::acceptor silent(context, {boost::asio::ip::make_address("127.0.0.1"), 0});
    client::Options options = options_for(silent.local_endpoint().port());
    options.connect_timeout = 300ms;
    Host host(options);
    auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 100; ++i) CHECK_FALSE(host.client.poll(0ms));
    CHECK(since(start) < 100ms);
    start = std::chrono::steady_clock::now();
    CHECK_FALSE(host.client.poll(50ms));
    CHECK(since(start) >= 49ms);
    CHECK(since(start) < 150ms);
    CHECK(host.poll_until([&] { return !host.problems.empty(); }, 2s));  // and gives up in time
    CHECK(host.problems.at(0).code == "connection");
}

TEST_CASE("poll returns as soon as something has come") {
    TestServer server;
    Host host(server.port());
    host.join();
    host.client.patch(R"({"camera": {"fov": 50}})");
    const auto start = std::chrono::steady_clock::now();
    CHECK(host.client.poll(4s));
    CHECK(since(start) < 2s);
}

TEST_CASE("what a callback throws comes out of poll, and the client goes on") {
    TestServer server;
    Host host(server.port());
    host.client.on_camera = [](const client::Camera&, bool) { throw std::domain_error("the host's own"); };
    CHECK_THROWS_AS(host.poll_for(2s), std::domain_error);
    CHECK(host.client.connected());
    host.client.on_camera = [&](const client::Camera&, bool) { CHECK_FALSE(host.client.poll(1s)); };
    host.client.patch(R"({"camera": {"fov": 50}})");
    CHECK(host.poll_until([&] { return host.client.camera().fov == 50; }));
}

TEST_CASE("a name is looked up, and one that is nobody's is told") {
    TestServer server;
    client::Options options = options_for(server.port());
    options.host = "localhost";
    Host host(options);
    host.join();
    options.host = "no such name.invalid";
    Host lost(options);
    CHECK(lost.poll_until([&] { return !lost.problems.empty(); }, 10s));
}

TEST_CASE("a server that declines is told with its sentence") {
    TestServer server;  // without tokens it is to be reached as localhost
    client::Options options = options_for(server.port());
    options.host = "::ffff:127.0.0.1";
    Host host(options);
    host.poll_for(1s);
    REQUIRE(host.problems.size() == 1);
    CHECK(host.problems[0].code == "connection");
    CHECK(host.problems[0].message ==
          "VRUT Preview at [::ffff:127.0.0.1]:" + std::to_string(server.port()) +
              ": it declines: HTTP 403, this server answers to localhost only: open it by that name, "
              "or start it with --token-file");
}

TEST_CASE("a client says who it is, answers pings, and tells of loading and of what it does not know") {
    FakeServer server({kWelcome, kState, R"({"type":"loading","scene":"truck","fraction":0.25})",
                       R"({"type":"loading","scene":"truck","fraction":1,"refused":"no wheels"})",
                       R"({"type":"news","of":"tomorrow"})"});
    client::Options options = options_for(server.port());
    options.token = "secret";
    Host host(options);
    std::vector<client::Loading> loadings;
    host.client.on_loading = [&](const client::Loading& loading) { loadings.push_back(loading); };
    REQUIRE(host.poll_until([&] { return host.messages.size() == 1 && server.pongs == 1; }));
    CHECK(server.hello == Json({{"type", "hello"}, {"role", "host"}, {"name", "wall"}, {"token", "secret"}}));
    CHECK(host.client.client() == "c7");
    CHECK(host.client.revision() == 5);
    CHECK(host.client.camera().far_plane == 9);
    REQUIRE(loadings.size() == 2);
    CHECK(loadings[0].scene == "truck");
    CHECK(loadings[0].fraction == 0.25);
    CHECK_FALSE(loadings[0].done);
    CHECK(loadings[0].refused.empty());
    CHECK(loadings[1].refused == "no wheels");
    CHECK(host.messages[0].first == "news");
    CHECK(host.messages[0].second["of"] == "tomorrow");
}

TEST_CASE("a host is told what others point at, until it is taken away") {
    TestServer server;
    Host host(server.port());
    std::vector<client::Pointed> told;
    host.client.on_pointed = [&](const client::Pointed& pointed) { told.push_back(pointed); };
    host.join();
    TestClient tablet(server.port());
    tablet.send({{"type", "hello"}, {"role", "control"}, {"name", "Tablet"}});
    tablet.wait_for("state");
    tablet.send({{"type", "patch"},
                 {"patch", {{"camera", {{"eye", {0, 0, 10}}, {"focus", {0, 0, 0}}, {"up", {0, 1, 0}}}}}}});
    tablet.send({{"type", "point"}, {"x", 640}, {"y", 360}});
    REQUIRE(host.poll_until([&] { return !told.empty(); }));
    CHECK(told[0].client == "c2");
    CHECK(told[0].name == "Tablet");
    REQUIRE(told[0].point.has_value());
    CHECK((*told[0].point)[2] == doctest::Approx(0.5));  // the triangle's plane is z = (y + 1) / 2
    CHECK(told[0].normal[2] == doctest::Approx(2 / std::sqrt(5)));
    tablet.send({{"type", "point"}});
    REQUIRE(host.poll_until([&] { return told.size() == 2; }));
    CHECK(told[1].client == "c2");
    CHECK_FALSE(told[1].point.has_value());
    CHECK(host.messages.empty());
    CHECK(host.problems.empty());
}

TEST_CASE("a server that talks nonsense, or more than it said, is left") {
    const std::vector<std::string> nonsense = {
        "nonsense",
        "[]",
        R"({"type":7})",
        R"({"type":"state"})",
        R"({"type":"state","revision":6,"state":{}})",
        R"({"type":"patch","revision":6,"patch":{"camera":null}})",
        R"({"type":"patch","revision":6,"patch":{"camera":{"eye":[1,2]}}})",
        R"({"type":"patch","revision":6,"patch":{"selection":{"node":"one"}}})",
        R"({"type":"error"})",
        R"({"type":"loading","scene":1})",
        R"({"type":"welcome","version":2,"client":"c1","limits":{}})",
        R"({"type":"news","of":")" + std::string(1000, 'x') + R"("})",
    };
    for (const std::string& text : nonsense) {
        CAPTURE(text);
        FakeServer server({kWelcome, kState, text});
        Host host(server.port());
        REQUIRE(host.poll_until([&] { return !host.problems.empty(); }));
        CHECK(host.problems[0].code == "connection");
        CHECK(host.connections == std::vector<bool>{true, false});
        CHECK_FALSE(host.client.connected());
    }
}

// needs shown
TEST_CASE("a host reports what its walls show") {
    TestServer server;
    TestClient tablet(server.port());
    tablet.state = tablet.join();
    Host host(server.port());
    host.join();
    tablet.send({{"type", "patch"}, {"id", 1}, {"patch", {{"camera", {{"fov", 33}}}}}});
    const std::int64_t revision = tablet.wait_for("ok")["revision"];
    REQUIRE(host.poll_until([&] { return host.client.revision() == revision; }));
    host.client.report_shown(revision + 1);  // nothing that this client knows: not sent
    host.client.report_shown(revision);
    host.poll_for(50ms);
    Json entry;
    while (entry["revision"] != revision)
        entry = tablet.wait_for("stats")["hosts"].value("c2", Json::object());
    CHECK(entry["name"] == "wall");
    CHECK(entry["lagMs"].get<double>() >= 0);
    CHECK(entry["lagMs"].get<double>() < 5000);
    CHECK(host.problems.empty());
    CHECK(host.poll_until([&] { return !host.stats.empty(); }));
}

// needs shown
TEST_CASE("a host hides a node and shows it again") {
    TestServer server;
    Host host(server.port());
    host.join();
    host.client.patch(R"({"nodes": {"1": {"active": false}}})");
    REQUIRE(host.poll_until([&] { return host.client.state_json("/nodes/1/active") == "false"; }));
    host.client.patch(R"({"nodes": {"1": null}})");
    CHECK(host.poll_until([&] { return host.client.state_json("/nodes/1").empty(); }));
    CHECK(host.problems.empty());
}
