#include <doctest/doctest.h>

#include "test_client.hpp"

using namespace vrut;
using namespace vrut::server::engine;
using namespace vrut::test;

namespace {

Json zoom_speed(int id, double speed) {
    return {{"type", "patch"}, {"id", id}, {"patch", {{"navigation", {{"zoomSpeed", speed}}}}}};
}

/// Waits until a client knows that another holds control: the server may tell it after the state.
void wait_for_holder(TestClient& client, const std::string& holder, bool absent = false) {
    const auto is_so = [&] {
        const Json& control = client.state["control"];
        return control.value("holder", "") == holder && control["absent"] == absent;
    };
    while (!is_so()) REQUIRE(client.wait_for("patch", 15s)["type"] == "patch");
}

}  // namespace

TEST_CASE("one steers; the other is told that he does not, or nothing for a finger without an id") {
    TestServer server;
    TestClient a(server.port()), b(server.port());
    a.join();
    b.join();
    a.send(zoom_speed(1, 2));
    a.wait_for("ok");
    b.send(zoom_speed(1, 3));
    CHECK(b.wait_for("error")["code"] == "not-in-control");
    b.send(pointer_event("pointerdown", 1, 1));
    b.send({{"type", "resize"}, {"id", 2}, {"width", 100}, {"height", 100}, {"pixelRatio", 1}});
    for (;;) {
        const auto message = b.receive();
        REQUIRE(message.has_value());
        CHECK(message->json()["type"] != "error");
        if (message->json()["type"] == "ok") break;
    }
}

TEST_CASE("when a holder without a resume key leaves, the next has control at once, and no finger is left") {
    TestServer server;
    TestClient b(server.port());
    {
        TestClient a(server.port());
        a.join();
        b.join();
        wait_for_holder(b, "c1");
        a.send(pointer_event("pointerdown", 1, 1));
        a.send({{"type", "resize"}, {"id", 1}, {"width", 100}, {"height", 100}, {"pixelRatio", 1}});
        a.wait_for("ok");
    }
    wait_for_holder(b, "c2");
    b.send(zoom_speed(1, 3));
    CHECK(b.wait_for("ok")["id"] == 1);
}

TEST_CASE("a holder whose connection is lost has control again when it comes back with its resume key") {
    TestServer server;
    TestClient b(server.port());
    {
        TestClient a(server.port());
        a.join("control", "", "secret");
        b.join("control", "", "another");
    }
    wait_for_holder(b, "c1", true);
    b.send(zoom_speed(1, 3));
    CHECK(b.wait_for("error")["code"] == "not-in-control");
    TestClient again(server.port());
    again.join("control", "", "secret");
    wait_for_holder(again, "c3");
}

TEST_CASE("control that nobody comes back for passes on, though nobody says a word") {
    TestServer server;
    TestClient b(server.port());
    {
        TestClient a(server.port());
        a.join("control", "", "secret");
        b.join();
    }
    wait_for_holder(b, "c2");
    b.send(zoom_speed(1, 3));
    CHECK(b.wait_for("ok")["id"] == 1);
}

TEST_CASE("roles: a view steers nothing, a host the camera alone") {
    TestServer server;
    TestClient view(server.port()), host(server.port());
    view.join("view");
    host.join("host");
    view.send(zoom_speed(1, 2));
    CHECK(view.wait_for("error")["code"] == "not-allowed");
    view.send(pointer_event("pointerdown", 1, 1));
    CHECK(view.wait_for("error")["code"] == "not-allowed");
    host.send(zoom_speed(1, 2));
    CHECK(host.wait_for("error")["code"] == "not-allowed");
    host.send(pointer_event("pointerdown", 1, 1));
    CHECK(host.wait_for("error")["code"] == "not-allowed");
    host.send({{"type", "patch"}, {"id", 2}, {"patch", {{"camera", {{"fov", 33}}}}}});
    CHECK(host.wait_for("ok")["id"] == 2);
    CHECK(host.state["camera"]["fov"] == 33);
}

TEST_CASE("the view has the holder's size") {
    TestServer server;
    TestClient a(server.port()), b(server.port());
    a.join();
    b.join();
    b.send({{"type", "resize"}, {"id", 1}, {"width", 300}, {"height", 200}, {"pixelRatio", 2}});
    b.wait_for("ok");
    CHECK(b.wait_for_still()["view"] == Json({{"width", 1280.0}, {"height", 720.0}, {"pixelRatio", 1.0}}));
    b.send({{"type", "control"}, {"action", "take"}, {"id", 2}});
    b.wait_for("ok");
    const Json header = b.wait_for_still();
    CHECK(header["view"] == Json({{"width", 300.0}, {"height", 200.0}, {"pixelRatio", 2.0}}));
    CHECK(header["width"] == 600);
    CHECK(header["height"] == 400);
}

TEST_CASE("a drag of 50 moves and the same drag of 2 moves end in the same camera to the last bit") {
    const auto camera_after = [](int moves, const char* device, int button, unsigned buttons, bool slowly) {
        TestServer server({.takes = 1ms});
        TestClient client(server.port());
        client.join();
        client.send({{"type", "frame"}});
        client.send(pointer_event("pointerdown", 200, 300, device, button, buttons));
        for (int i = 1; i <= moves; ++i) {
            const double part = static_cast<double>(i) / moves;
            client.send(
                pointer_event("pointermove", 200 + 333.3 * part, 300 - 111.1 * part, device, -1, buttons));
            if (slowly) {  // each move has a picture of its own
                client.send({{"type", "frame"}});
                client.wait_for("frame");
            }
        }
        client.send(pointer_event("pointerup", 533.3, 188.9, device, button, 0));
        client.send({{"type", "resize"}, {"id", 1}, {"width", 1280}, {"height", 720}, {"pixelRatio", 1}});
        client.wait_for("ok");
        return client.state["camera"].dump();
    };
    struct Drag {
        const char* device;
        int button;
        unsigned buttons;
    };
    for (const Drag& drag : {Drag{"touch", 0, 1}, {"mouse", 0, 1}, {"mouse", 2, 2}, {"mouse", 1, 4}}) {
        const std::string two = camera_after(2, drag.device, drag.button, drag.buttons, true);
        CHECK(camera_after(50, drag.device, drag.button, drag.buttons, false) == two);
        CHECK(camera_after(50, drag.device, drag.button, drag.buttons, true) == two);
    }
}

TEST_CASE("a refused message changes nothing, and not who steers either") {
    TestServer server;
    TestClient client(server.port()), host(server.port());
    client.join();
    host.join("host");
    // The first view is fitted into this size; walls that follow gently would change the state for a while
    // yet.
    client.send({{"type", "patch"}, {"patch", {{"comfort", {{"on", false}}}}}});
    client.send(
        {{"type", "resize"}, {"id", client.next_id()}, {"width", 300}, {"height", 200}, {"pixelRatio", 1}});
    const std::int64_t revision = client.wait_for("ok")["revision"];
    const auto refused = [&](TestClient& who, Json message) {
        message["id"] = who.next_id();
        who.send(message);
        who.wait_for("error");
        who.send(
            {{"type", "resize"}, {"id", who.next_id()}, {"width", 300}, {"height", 200}, {"pixelRatio", 1}});
        CHECK(who.wait_for("ok")["revision"] == revision);
    };
    refused(host, {{"type", "navigate"}, {"rotate", {5, 5}}});
    refused(host, zoom_speed(2, 2));
    refused(client, {{"type", "patch"}, {"patch", {{"nose", 1}}}});
    refused(client, {{"type", "patch"}, {"patch", {{"camera", {{"up", {0, 0, 0}}}}}}});
    refused(client, {{"type", "fit"}, {"node", 99}});
    refused(client, {{"type", "wheel"}});
    client.send({{"type", "patch"},
                 {"id", client.next_id()},
                 {"patch", {{"camera", {{"fov", 33}}}}},
                 {"ifRevision", revision}});
    client.wait_for("ok");
}

TEST_CASE("a patch says who made it") {
    TestServer server;
    TestClient a(server.port()), watcher(server.port());
    a.join();
    watcher.join("view");
    wait_for_holder(watcher, "c1");
    a.send(zoom_speed(1, 2));
    CHECK(watcher.wait_for("patch")["by"] == "c1");
}
