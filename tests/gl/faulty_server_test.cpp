// The whole server on a driver that fails.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include "gl/handles.hpp"
#include "gl_faults.hpp"
#include "scenes/import_process.hpp"
#include "temporary_folder.hpp"
#include "test_client.hpp"

using namespace vrut;
using namespace vrut::server::scenes;
using namespace vrut::server::engine;
using namespace vrut::server::net;
using namespace vrut::test;

/// What reads a file is this program, started anew.
int main(int argc, char** argv) {
    if (is_import_process(argc, argv)) run_import_process(argv);
    return doctest::Context(argc, argv).run();
}

namespace {

/// A square of n x n small ones.
std::string square_text(int n) {
    std::string text = "vrut-text 1\ngeometry 1\nvertices " + std::to_string((n + 1) * (n + 1)) + "\n";
    for (int y = 0; y <= n; ++y)
        for (int x = 0; x <= n; ++x)
            text += std::to_string(2.0 * x / n - 1) + " " + std::to_string(2.0 * y / n - 1) + " 0\n";
    text += "triangles " + std::to_string(2 * n * n) + "\n";
    const auto corner = [&](int x, int y) { return " " + std::to_string(y * (n + 1) + x); };
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            text += corner(x, y) + corner(x + 1, y) + corner(x + 1, y + 1) + corner(x, y) +
                    corner(x + 1, y + 1) + corner(x, y + 1) + "\n";
    return text + "end\nnode 1 \"Square\" geometry geometry 1 end\n";
}

/// One client at a server that draws with GL.
struct Faulty {
    Faulty() {
        folder.write("large.vrut", square_text(100));
        ServerOptions options;
        options.library = SceneLibrary(folder.path());
        server.emplace(scene_of(square_text(10), "small.vrut"), gl_renderer(std::nullopt), options);
        client.emplace(server->port());
        client->join();
        client->send({{"type", "control"}, {"id", 1}, {"action", "take"}});
        at_first = client->wait_for_still();
    }
    ~Faulty() {
        gl_faults::heal();
        server.reset();
        CHECK(gl::live_gl_objects() == 0);
    }
    Faulty(const Faulty&) = delete;
    Faulty& operator=(const Faulty&) = delete;

    Json move_and_look() {
        client->send({{"type", "navigate"}, {"id", client->next_id()}, {"rotate", {7, 0}}});
        client->send({{"type", "frame"}});
        return client->wait_for("frame");
    }
    /// What the loading ends with.
    Json open_large() {
        client->send({{"type", "open"}, {"id", client->next_id()}, {"scene", "large.vrut"}});
        for (;;) {
            const Json loading = client->wait_for("loading", 20s);
            if (loading.contains("done") || loading.contains("refused")) return loading;
        }
    }
    void resize(int width, int height) {
        client->send({{"type", "resize"},
                      {"id", client->next_id()},
                      {"width", width},
                      {"height", height},
                      {"pixelRatio", 1}});
        client->wait_for("ok");
    }
    bool has_notice(const std::string& what) const {
        return client->state["notices"].dump().find(what) != std::string::npos;
    }

    TemporaryFolder folder;
    std::optional<TestServer> server;
    std::optional<TestClient> client;
    Json at_first;  ///< the header of the picture at rest
};

}  // namespace

TEST_CASE("a driver that resets itself is started anew, and all that was on the GPU comes back") {
    Faulty faulty;
    faulty.move_and_look();
    faulty.client->wait_for_still();
    const long objects = gl::live_gl_objects();
    for (int i = 1; i <= 3; ++i) {
        CAPTURE(i);
        gl_faults::reset_after(0);
        gl_faults::refuse_contexts(2 * i);
        const auto start = std::chrono::steady_clock::now();
        const Json header = faulty.move_and_look();
        CHECK(std::chrono::steady_clock::now() - start < 5s);
        CHECK(header["frame"] > faulty.at_first["frame"]);
        CHECK(header["handled"] >= i);
        gl_faults::heal();
    }
    faulty.client->wait_for_still();
    CHECK(gl::live_gl_objects() > 0);
    CHECK(gl::live_gl_objects() <=
          objects);  // what moving pictures of other levels needed may not be there yet
    CHECK(faulty.has_notice("driver"));
}

TEST_CASE("a scene for which there is no memory is refused, and the one before goes on") {
    Faulty faulty;
    const Json scene = faulty.client->state["scene"];
    const long objects = gl::live_gl_objects();
    gl_faults::limit_memory(gl_faults::memory_used() + 100'000);
    const Json loading = faulty.open_large();
    CHECK(loading["refused"].get<std::string>().find("large.vrut: the graphics driver has no memory for") ==
          0);
    CHECK(gl::live_gl_objects() == objects);
    faulty.move_and_look();
    CHECK(faulty.client->wait_for_still()["quality"]["scale"] == 1.0);
    CHECK(faulty.client->state["scene"] == scene);
    gl_faults::heal();
    CHECK(faulty.open_large()["done"] == true);
    faulty.client->wait_for_still();
    CHECK(faulty.client->state["scene"]["triangles"] == 20'000);
}

TEST_CASE("a view for which there is no memory is drawn smaller, until it is another") {
    Faulty faulty;
    faulty.resize(200, 100);
    faulty.client->wait_for_still();
    gl_faults::limit_memory(gl_faults::memory_used() + 1'000'000);
    faulty.resize(3000, 1500);
    const Json small = faulty.client->wait_for_still();
    CHECK(small["quality"]["scale"] < 1.0);
    CHECK(small["view"]["width"] == 3000);
    CHECK(small["width"] == std::lround(3000 * small["quality"]["scale"].get<double>()));
    CHECK(faulty.has_notice("smaller"));
    faulty.resize(200, 100);
    CHECK(faulty.client->wait_for_still()["quality"]["scale"] == 1.0);
    gl_faults::heal();
    faulty.resize(3000, 1500);
    CHECK(faulty.client->wait_for_still()["width"] == 3000);
}

TEST_CASE("a snapshot for which there is no memory is refused, and the live picture goes on") {
    Faulty faulty;
    faulty.resize(200, 100);
    faulty.client->wait_for_still();
    gl_faults::limit_memory(gl_faults::memory_used() + 1'000'000);
    const std::int64_t id = faulty.client->next_id();
    faulty.client->send({{"type", "snapshot"}, {"id", id}, {"width", 3000}, {"height", 2000}});
    const Json error = faulty.client->wait_for("error");
    CHECK(error["id"] == id);
    CHECK(error["code"] == "failed");
    CHECK(error["message"] == "the graphics driver has no memory for a picture of 3000x2000 pixels");
    CHECK(http(faulty.server->port(), "GET", "/frame.jpg?width=3000&height=2000").status == 503);
    faulty.move_and_look();
    CHECK(faulty.client->wait_for_still()["quality"]["scale"] == 1.0);
}

TEST_CASE("what needs memory later, as edges do, ends nothing where there is none") {
    Faulty faulty;
    faulty.resize(60, 40);
    CHECK(faulty.open_large()["done"] == true);
    faulty.client->wait_for_still();
    gl_faults::limit_memory(gl_faults::memory_used() + 1000);
    const auto wireframe = [&](bool on) {
        faulty.client->send({{"type", "patch"},
                             {"id", faulty.client->next_id()},
                             {"patch", {{"renderer", {{"wireframe", on}}}}}});
        faulty.client->wait_for("ok");
    };
    wireframe(true);
    // What moves is drawn without edges; a refined frame needs them.
    faulty.client->send({{"type", "frame"}});
    CHECK(faulty.client->wait_for("frame")["renderer"]["wireframe"] == true);
    CHECK_FALSE(faulty.has_notice("cannot be drawn"));
    faulty.client->send({{"type", "frame"}});
    CHECK(eventually([&] {
        const auto message = faulty.client->receive(10ms);
        // Where drawing is quick, some frames come before the edges are computed.
        if (message && message->binary) faulty.client->send({{"type", "frame"}});
        return faulty.has_notice("cannot be drawn");
    }));
    wireframe(false);
    CHECK(faulty.move_and_look()["renderer"]["wireframe"] == false);
    CHECK(faulty.client->wait_for_still()["quality"]["scale"] == 1.0);
    gl_faults::heal();
    wireframe(true);
    CHECK(faulty.client->wait_for_still()["renderer"]["wireframe"] == true);
}

TEST_CASE("a scene for whose loading there is no thread is refused, and later is loaded") {
    Faulty faulty;
    gl_faults::refuse_threads(1);
    const std::int64_t id = faulty.client->next_id();
    faulty.client->send({{"type", "open"}, {"id", id}, {"scene", "large.vrut"}});
    const Json error = faulty.client->wait_for("error");
    CHECK(error["id"] == id);
    CHECK(error["code"] == "failed");
    CHECK(faulty.open_large()["done"] == true);
}

TEST_CASE("a first scene for which there is no memory is told at once") {
    gl_faults::limit_memory(300'000);
    ServerOptions options;
    options.listen = {"127.0.0.1", 0};
    CHECK_THROWS_WITH(Server(options, scene_of(square_text(100), "large.vrut"), gl_renderer(std::nullopt)),
                      doctest::Contains("large.vrut: the graphics driver has no memory for"));
    gl_faults::heal();
    CHECK(gl::live_gl_objects() == 0);
}
