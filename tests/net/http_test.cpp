#include <doctest/doctest.h>

#include "test_client.hpp"

using namespace vrut;
using namespace vrut::server::net;
using namespace vrut::test;

TEST_CASE("the page and its files are served, and nothing else") {
    TestServer server;
    const HttpAnswer page = http(server.port(), "GET", "/");
    CHECK(page.status == 200);
    CHECK(page.body.find("app.js") != std::string::npos);
    CHECK(page.headers.find("Content-Security-Policy: default-src 'none'") != std::string::npos);
    CHECK(page.headers.find("; connect-src 'self' ws://127.0.0.1 wss://127.0.0.1\r\n") != std::string::npos);
    CHECK(page.headers.find("\r\nCross-Origin-Resource-Policy: same-origin\r\n") != std::string::npos);
    CHECK(page.headers.find("; manifest-src 'self'; ") != std::string::npos);
    CHECK(http(server.port(), "GET", "/app.js").headers.find("text/javascript") != std::string::npos);
    CHECK(http(server.port(), "GET", "/style.css?x=1").status == 200);
    const HttpAnswer head = http(server.port(), "HEAD", "/");
    CHECK(head.status == 200);
    CHECK(head.body.empty());
    for (const char* target :
         {"/nothing", "/../README.md", "/%2e%2e/README.md", "//etc/passwd", "/CMakeLists.txt"})
        CHECK_MESSAGE(http(server.port(), "GET", target).status == 404, target);
    CHECK(http(server.port(), "POST", "/", "Host: 127.0.0.1\r\nContent-Length: 0\r\n").status == 405);
}

TEST_CASE("health and counters") {
    TestServer server;
    CHECK(http(server.port(), "GET", "/healthz").status == 200);
    CHECK(eventually([&] { return http(server.port(), "GET", "/readyz").status == 200; }));
    TestClient client(server.port());
    client.join();
    client.wait_for_still();
    const std::string metrics = http(server.port(), "GET", "/metrics").body;
    CHECK(metrics.find("\nvrut_preview_clients{role=\"control\"} 1\n") != std::string::npos);
    CHECK(metrics.find("\nvrut_preview_frames_rendered_total{level=\"still\"} 3\n") != std::string::npos);
}

TEST_CASE("where tokens are set, counters ask for one and the page does not") {
    ServerOptions options;
    options.access.view_token = "view-token-16-xx";
    TestServer server({}, options);
    const std::string host = "Host: cave.example\r\n";
    CHECK(http(server.port(), "GET", "/", host).status == 200);
    CHECK(http(server.port(), "GET", "/healthz", host).status == 200);
    CHECK(http(server.port(), "GET", "/metrics", host).status == 401);
    CHECK(http(server.port(), "GET", "/metrics", host + "Authorization: Bearer wrong\r\n").status == 401);
    CHECK(
        http(server.port(), "GET", "/metrics", host + "Authorization: Bearer view-token-16-xx\r\n").status ==
        200);
}

TEST_CASE("a name of another site's that leads here is refused") {
    TestServer server;
    CHECK(http(server.port(), "GET", "/", "Host: evil.example\r\n").status == 403);
    CHECK(http(server.port(), "GET", "/", "").status == 400);
    for (const std::string name : {"evil.example", "127.evil.example"}) {
        CHECK(http(server.port(), "GET", "/", "Host: " + name + "\r\n").status == 403);
        CHECK(TestClient(server.port(), {.origin = "http://" + name, .host = name}).status() == 403);
    }
}

TEST_CASE("pages of other origins may not connect") {
    ServerOptions options;
    options.access.allowed_origins = {"https://preview.example"};
    TestServer server({}, options);
    const std::string own = "http://127.0.0.1:" + std::to_string(server.port());
    CHECK(TestClient(server.port(), {.origin = own}).status() == 101);
    CHECK(TestClient(server.port(), {.origin = "https://preview.example"}).status() == 101);
    for (const char* origin : {"null", "http://evil.example", "http://127.0.0.1:1"})
        CHECK_MESSAGE(TestClient(server.port(), {.origin = origin}).status() == 403, origin);
}

TEST_CASE("behind a proxy that says another Host the page comes, and is told why it may not connect") {
    TestServer server;
    const std::string host = "Host: 127.0.0.1:" + std::to_string(server.port()) + "\r\n";
    const std::string foreign = host + "Origin: https://preview.example\r\n";
    for (const char* file : {"/", "/app.js", "/style.css"})
        CHECK_MESSAGE(http(server.port(), "GET", file, foreign).status == 200, file);
    for (const char* other : {"/frame.jpg", "/metrics", "/ws", "/nothing"})
        CHECK_MESSAGE(http(server.port(), "GET", other, foreign).status == 403, other);
    // Of the same origin, a browser's request names none.
    const auto why = [&](const std::string& origin) {
        return http(server.port(), "GET", "/ws?origin=" + origin, host);
    };
    CHECK(why("https://preview.example").status == 403);
    CHECK(why("https://preview.example").body ==
          "pages of this origin may not connect: start the server with --allow-origin "
          "https://preview.example\n");
    CHECK(why("null").status == 403);
    CHECK(why("<script>").body.find('<') == std::string::npos);
    const HttpAnswer own = why("http://127.0.0.1:" + std::to_string(server.port()));
    CHECK(own.status == 426);
    CHECK(own.body.find("let the proxy pass their handshake on") != std::string::npos);
}

TEST_CASE("a client without a subprotocol is served without one, one with only others refused") {
    TestServer server;
    TestClient none(server.port(), {.subprotocol = ""});
    CHECK(none.status() == 101);
    CHECK(none.subprotocol().empty());
    none.join();
    CHECK(TestClient(server.port(), {.subprotocol = "chat, vrut-preview.v1"}).status() == 101);
    CHECK(TestClient(server.port(), {.subprotocol = "vrut-preview.v2"}).status() == 400);
}

TEST_CASE("requests that are none, and too large ones, end") {
    TestServer server;
    CHECK(http(server.port(), "GET", "/", "Host: 127.0.0.1\r\nX: " + std::string(20'000, 'x') + "\r\n")
              .status == 431);
    CHECK(http(server.port(), "GE T", "/").status == 400);
    CHECK(http(server.port(), "GET", "/healthz").status == 200);
}

TEST_CASE("the picture's ETag tells revision and size") {
    TestServer server;
    TestClient client(server.port());
    client.join();
    client.send({{"type", "navigate"}, {"id", 1}, {"rotate", {5, 0}}});
    client.wait_for("ok");
    client.send({{"type", "resize"}, {"id", 2}, {"width", 400}, {"height", 300}, {"pixelRatio", 1}});
    client.wait_for("ok");
    const auto tag_of = [&](const HttpAnswer& answer) {
        const std::size_t at = answer.headers.find("ETag: ") + 6;
        return answer.headers.substr(at, answer.headers.find("\r\n", at) - at);
    };
    const auto get = [&](const std::string& tag) {
        return http(server.port(), "GET", "/frame.jpg", "Host: 127.0.0.1\r\nIf-None-Match: " + tag + "\r\n");
    };
    const HttpAnswer first = get("\"none\"");
    CHECK(first.status == 200);
    CHECK(get(tag_of(first)).status == 304);
    client.send({{"type", "resize"}, {"id", 3}, {"width", 200}, {"height", 600}, {"pixelRatio", 1}});
    client.wait_for("ok");
    const HttpAnswer second = get(tag_of(first));
    CHECK(second.status == 200);
    CHECK(get(tag_of(second)).status == 304);
}
