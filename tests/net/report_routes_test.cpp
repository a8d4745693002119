// /report.html and /report.csv: who gets them, and what they cost.
#include <doctest/doctest.h>

#include <list>

#include "raw_connection.hpp"
#include "temporary_folder.hpp"

using namespace vrut;
using namespace vrut::server::net;
using namespace vrut::test;

namespace {

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

std::string get(const std::string& path) { return "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"; }

/// A server with so many notes; home adds a picture to theirs.
struct WithNotes {
    explicit WithNotes(int notes, const FakeRenderer& renderer = {}, const ServerOptions& options = {})
        : server(renderer, options) {
        TestClient client(server.port());
        client.join();
        Json markers = Json::object();
        for (int i = 0; i < notes; ++i)
            markers["note " + std::to_string(i)] = {
                {"point", {1, 2, 3}}, {"text", "<b>Žena & muž</b>"}, {"time", 1'764'345'600'000}};
        client.send({{"type", "patch"}, {"id", client.next_id()}, {"patch", {{"markers", markers}}}});
        client.wait_for("ok");
    }
    HttpAnswer answer(const std::string& path, const char* method = "GET") {
        return http(server.port(), method, path);
    }
    TestServer server;
};

}  // namespace

TEST_CASE("a report is one file with the notes and a picture of each") {
    WithNotes notes(2);
    const HttpAnswer report = notes.answer("/report.html");
    CHECK(report.status == 200);
    CHECK(report.headers.find("Content-Type: text/html; charset=utf-8\r\n") != std::string::npos);
    CHECK(report.headers.find("Content-Disposition: attachment; filename=\"report.html\"\r\n") !=
          std::string::npos);
    CHECK(report.headers.find("Cache-Control: no-store\r\n") != std::string::npos);
    CHECK(count_of(report.body,
                   "<img alt=\"&lt;b&gt;Žena &amp; muž&lt;/b&gt;\" src=\"data:image/jpeg;base64,/9j/") == 2);
    CHECK(count_of(report.body, "<img ") == 3);
    CHECK(report.body.find("<b>") == std::string::npos);
    CHECK(report.body.find("2025-11-28 16:00 UTC") != std::string::npos);
}

TEST_CASE("a table of notes needs no picture") {
    WithNotes notes(2);
    const std::uint64_t drawn = notes.server.metrics().frames_encoded;
    const HttpAnswer table = notes.answer("/report.csv");
    CHECK(table.status == 200);
    CHECK(table.headers.find("Content-Type: text/csv; charset=utf-8\r\n") != std::string::npos);
    CHECK(table.body.find("\r\nnote 0,<b>Žena & muž</b>,,2025-11-28T16:00:00Z,false,1,2,3,\r\n") !=
          std::string::npos);
    for (const char* path : {"/report.html", "/report.csv"}) {
        const HttpAnswer head = notes.answer(path, "HEAD");
        CHECK(head.status == 200);
        CHECK(head.body.empty());
    }
    CHECK(notes.server.metrics().frames_encoded == drawn);
}

TEST_CASE("a report draws its pictures one after the other, and keeps none of them") {
    WithNotes notes(8);
    CHECK(eventually([&] { return notes.server.metrics().pictures_held <= 1; }));
    CHECK(notes.answer("/report.html").status == 200);
    CHECK(eventually([&] { return notes.server.metrics().pictures_held <= 1; }));
}

TEST_CASE("a report is of one scene") {
    const TemporaryFolder folder;
    folder.write("other.vrut",
                 "vrut-text 1\ngeometry 1 vertices 3 -9 -1 0  1 -1 0  0 1 1 triangles 1 0 "
                 "1 2 end\nnode 1 \"Other\" geometry geometry 1 end\n");
    ServerOptions options;
    options.library = server::scenes::SceneLibrary(folder.path());
    WithNotes notes(40, {.takes = 5ms}, options);
    const std::uint64_t before = notes.server.metrics().frames_encoded;
    RawConnection reader(notes.server.port());
    reader.send(get("/report.html"));
    REQUIRE(eventually([&] { return notes.server.metrics().frames_encoded >= before + 2; }));
    TestClient client(notes.server.port());
    client.join();
    client.send({{"type", "open"}, {"id", client.next_id()}, {"scene", "other.vrut"}});
    const HttpAnswer answer = reader.answer();
    CHECK(answer.status == 503);
    CHECK(answer.body.find("another scene is shown meanwhile: try again") != std::string::npos);
}

TEST_CASE("who does not read reports is cut before they hold the server's memory, and others get theirs") {
    WithNotes notes(40, {.noise = true});
    const std::size_t size = notes.answer("/report.html").body.size();
    const std::size_t readers_wanted = (std::size_t{128} << 20) / size + 2;
    REQUIRE(readers_wanted < 30);
    std::list<RawConnection> readers;
    while (readers.size() < readers_wanted) {
        readers.emplace_back(notes.server.port()).send(get("/report.html"));
        REQUIRE(readers.back().receive(12, 30s) == "HTTP/1.1 200");
    }
    CHECK(readers.front().receive(size).size() < size - 12);
    CHECK(notes.answer("/report.html").body.size() == size);
}

TEST_CASE("two reports at most are made at once, and who goes away makes room") {
    WithNotes notes(40, {.takes = 5ms});
    const std::uint64_t before = notes.server.metrics().frames_encoded;
    RawConnection second(notes.server.port());
    {
        RawConnection first(notes.server.port());
        first.send(get("/report.html"));
        second.send(get("/report.html"));
        REQUIRE(eventually([&] { return notes.server.metrics().frames_encoded >= before + 2; }));
        const HttpAnswer third = notes.answer("/report.html");
        CHECK(third.status == 503);
        CHECK(third.headers.find("Retry-After: 1\r\n") != std::string::npos);
        CHECK(notes.answer("/report.csv").status == 200);
    }
    // Another is begun as soon as the first has gone.
    RawConnection third(notes.server.port());
    CHECK(eventually([&] {
        third.send(get("/report.html"));
        return third.answer(false, 100ms).status == 0;
    }));
    CHECK(notes.server.metrics().frames_encoded < before + 41);  // neither had come to its end
}
