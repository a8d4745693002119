// /frame.jpg: what is kept of it, and that it is never old.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "frame_header.hpp"
#include "raw_connection.hpp"

using namespace vrut;
using namespace vrut::server::scenes;
using namespace vrut::server::net;
using namespace vrut::test;

namespace {

struct Script {
    explicit Script(std::uint16_t port) : connection(port) {}
    HttpAnswer get(const std::string& query = {}, const std::string& fields = {},
                   const char* method = "GET") {
        connection.send(std::string(method) + " /frame.jpg" + query + " HTTP/1.1\r\nHost: 127.0.0.1\r\n" +
                        fields + "\r\n");
        return connection.answer(std::string(method) == "HEAD");
    }
    RawConnection connection;
};

std::string field(const HttpAnswer& answer, const std::string& name) {
    const std::size_t at = answer.headers.find("\r\n" + name + ": ");
    if (at == std::string::npos) return {};
    const std::size_t begin = at + name.size() + 4;
    return answer.headers.substr(begin, answer.headers.find("\r\n", begin) - begin);
}

Json header_in(const HttpAnswer& answer) {
    const TestClient::Message message{true, answer.body};
    return message.json();
}

}  // namespace

TEST_CASE("/frame.jpg of an unchanged view is drawn once, for all who ask") {
    TestServer server({.takes = 5ms});
    REQUIRE(eventually([&] { return http(server.port(), "GET", "/readyz").status == 200; }));
    Script script(server.port());
    std::vector<std::unique_ptr<Script>> others;
    for (int i = 0; i < 20; ++i) {
        others.push_back(std::make_unique<Script>(server.port()));
        others.back()->connection.send("GET /frame.jpg HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
    }
    const HttpAnswer first = script.get();
    CHECK(first.status == 200);
    const std::uint64_t encoded = server.metrics().frames_encoded;
    CHECK(encoded == 1);
    for (auto& other : others) CHECK(other->connection.answer().status == 200);
    const HttpAnswer again = script.get();
    CHECK(again.body == script.get("?width=1280&height=720").body);
    const HttpAnswer head = script.get({}, {}, "HEAD");
    CHECK(head.status == 200);
    CHECK(field(head, "Content-Length") == std::to_string(again.body.size()));
    CHECK(field(head, "ETag") == field(again, "ETag"));
    for (const std::string& tags : {field(again, "ETag"), "W/" + field(again, "ETag"),
                                    "\"other\", " + field(again, "ETag"), std::string("*")})
        CHECK(script.get({}, "If-None-Match: " + tags + "\r\n").status == 304);
    CHECK(script.get({}, "If-None-Match: \"other\"\r\n").status == 200);
    CHECK(server.metrics().frames_encoded == encoded);
}

TEST_CASE("/frame.jpg is never old: whatever is seen changes its tag and its bytes") {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "vrut-frame-jpg-test";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "other.vrut")
        << "vrut-text 1\ngeometry 1 vertices 3 -9 -1 0  1 -1 0  0 1 1 triangles 1 0 "
           "1 2 end\nnode 1 \"Other\" geometry geometry 1 end\n";
    ServerOptions options;
    options.library = SceneLibrary(folder);
    TestServer server({}, options);
    TestClient client(server.port());
    client.join();
    Script script(server.port());
    std::string tag = field(script.get("?width=64&height=48"), "ETag");
    const auto changes = [&](const char* what, Json message) {
        CAPTURE(what);
        message["id"] = client.next_id();
        client.send(message);
        const Json ok = client.wait_for("ok");
        const std::string size = "?width=64&height=48";
        const HttpAnswer answer = script.get(size, "If-None-Match: " + tag + "\r\n");
        CHECK(answer.status == 200);
        CHECK(header_in(answer)["revision"] >= ok["revision"]);
        CHECK(field(answer, "ETag") != tag);
        tag = field(answer, "ETag");
        CHECK(field(script.get(size), "ETag") == tag);
    };
    const auto patch = [](const Json& what) { return Json{{"type", "patch"}, {"patch", what}}; };
    changes("camera", patch({{"camera", {{"fov", 33}}}}));
    changes("mode", patch({{"renderer", {{"mode", "stylized"}}}}));
    changes("node", patch({{"nodes", {{"1", {{"active", false}}}}}}));
    changes("light", patch({{"lights", {{"items", {{"headlight", {{"color", {1, 0, 0, 1}}}}}}}}}));
    changes("background", patch({{"backgrounds", {{"color", {1, 0, 0, 1}}}}}));
    changes("selection", patch({{"selection", {{"node", 1}}}}));
    changes("marker", patch({{"markers", {{"a", {{"point", {0, 0, 0}}, {"text", "b"}}}}}}));
    changes("the view's size", {{"type", "resize"}, {"width", 300}, {"height", 200}, {"pixelRatio", 1}});
    client.send({{"type", "open"}, {"id", client.next_id()}, {"scene", "other.vrut"}});
    while (client.wait_for("state")["state"]["scene"]["name"] != "other") {
    }
    CHECK(script.get("?width=64&height=48", "If-None-Match: " + tag + "\r\n").status == 200);
    std::filesystem::remove_all(folder);
}

TEST_CASE("only a few pictures of /frame.jpg are kept") {
    TestServer server;
    Script script(server.port());
    for (int width = 10; width < 20; ++width)
        CHECK(script.get("?width=" + std::to_string(width) + "&height=9").status == 200);
    CHECK(eventually([&] { return server.metrics().pictures_held <= 1; }));
    const std::uint64_t encoded = server.metrics().frames_encoded;
    script.get("?width=19&height=9");
    CHECK(server.metrics().frames_encoded == encoded);
    script.get("?width=10&height=9");
    CHECK(server.metrics().frames_encoded == encoded + 1);
}
