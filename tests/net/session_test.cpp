#include <doctest/doctest.h>

#include <cmath>

#include "test_client.hpp"

using namespace vrut;
using namespace vrut::server::scenes;
using namespace vrut::server::net;
using namespace vrut::test;

TEST_CASE("hello is answered by welcome, then the state") {
    TestServer server;
    TestClient client(server.port());
    CHECK(client.status() == 101);
    CHECK(client.subprotocol() == "vrut-preview.v1");
    client.send({{"type", "hello"}, {"role", "control"}, {"name", "test"}});
    const auto welcome = client.receive();
    REQUIRE(welcome.has_value());
    CHECK(welcome->json()["type"] == "welcome");
    CHECK(welcome->json()["version"] == 1);
    CHECK(welcome->json()["role"] == "control");
    CHECK(welcome->json()["limits"]["maxGrants"] == 2);
    CHECK(welcome->json()["limits"]["messagesPerSecond"] >= 10'000);
    const auto state = client.receive();
    REQUIRE(state.has_value());
    CHECK(state->json()["type"] == "state");
    CHECK(state->json()["state"]["scene"]["name"] == "triangle");
    CHECK(state->json()["state"]["scene"]["triangles"] == 1);
    CHECK(state->json()["state"]["lights"]["active"] == "headlight");
}

TEST_CASE("the first state tells that the client that gets it has control") {
    for (int i = 0; i < 20; ++i) {
        TestServer server;
        TestClient client(server.port());
        client.send({{"type", "hello"}, {"role", "control"}});
        const std::string name = client.wait_for("welcome")["client"];
        CHECK(client.wait_for("state")["state"]["control"]["holder"] == name);
    }
}

TEST_CASE("two clients have two ids") {
    TestServer server;
    TestClient a(server.port()), b(server.port());
    a.send({{"type", "hello"}, {"role", "view"}});
    b.send({{"type", "hello"}, {"role", "view"}});
    CHECK(a.wait_for("welcome")["client"] != b.wait_for("welcome")["client"]);
}

TEST_CASE("ends of a connection have the contract's codes, and an error goes before") {
    TestServer server;
    const auto end = [&](auto act) {
        TestClient client(server.port());
        act(client);
        const Json error = client.wait_for("error");
        CHECK(error["message"].get<std::string>().size() > 10);
        return client.wait_for_close();
    };
    CHECK(end([](TestClient& c) { c.send({{"type", "frame"}}); }) == 1008);
    CHECK(end([](TestClient& c) { c.send_text("nonsense"); }) == 1008);
    CHECK(end([](TestClient& c) { c.send({{"type", "hello"}, {"role", "king"}}); }) == 1008);
    CHECK(end([](TestClient& c) { c.send({{"type", "ä" + std::string(100, 'x')}}); }) == 1008);
    CHECK(end([](TestClient& c) {
              c.join();
              c.send({{"type", "hello"}, {"role", "control"}});
          }) == 1008);
    CHECK(end([](TestClient& c) {
              c.join();
              c.send_binary("picture");
          }) == 1003);
}

TEST_CASE("too large and badly encoded messages end the connection with their codes") {
    TestServer server;
    for (const std::size_t size : {65'600u, 70'000u, 1'000'000u}) {
        TestClient large(server.port());
        large.join();
        large.send_text(R"({"type":"frame","x":")" + std::string(size, 'x') + "\"}");
        CHECK(large.wait_for("error")["message"].get<std::string>().find("65536") != std::string::npos);
        CHECK(large.wait_for_close() == 1009);
    }
    TestClient bad(server.port());
    bad.join();
    bad.send_text("{\"type\":\"frame\",\"x\":\"\xff\"}");
    CHECK(bad.wait_for_close() == 1007);
}

TEST_CASE("who says nothing is cut at the deadline, which is five seconds") {
    CHECK(Deadlines{}.hello == 5s);
    ServerOptions options;
    options.deadlines.hello = 1s;
    TestServer server({}, options);
    TestClient silent(server.port());
    const auto start = std::chrono::steady_clock::now();
    CHECK(silent.wait_for("error", 8s)["message"].get<std::string>().find("hello") != std::string::npos);
    CHECK(silent.wait_for_close() == 1008);
    CHECK(std::chrono::steady_clock::now() - start < 3s);
    CHECK(std::chrono::steady_clock::now() - start > 800ms);
}

TEST_CASE("a bad message is answered by an error with its id, and the connection goes on") {
    TestServer server;
    TestClient client(server.port());
    client.join();
    client.send({{"type", "dance"}, {"id", 4}});
    Json error = client.wait_for("error");
    CHECK(error["id"] == 4);
    CHECK(error["code"] == "bad-message");
    client.send({{"type", "patch"}, {"id", 5}, {"patch", {{"camera", {{"nose", 1}}}}}});
    error = client.wait_for("error");
    CHECK(error["id"] == 5);
    CHECK(error["code"] == "unknown-member");
    client.send({{"type", "resize"}, {"id", 6}, {"width", 100}, {"height", 100}, {"pixelRatio", 1}});
    CHECK(client.wait_for("ok")["id"] == 6);
}

TEST_CASE("answers come in order, those to unreadable messages too") {
    TestServer server;
    TestClient client(server.port());
    client.join();
    client.send({{"type", "resize"}, {"id", 1}, {"width", 9}, {"height", 9}, {"pixelRatio", 1}});
    client.wait_for("ok");  // home is fitted to that
    // More answers than may wait: the server stops reading until they are taken.
    constexpr int kMessages = 6000;
    std::thread sender([&] {
        for (int id = 2; id <= kMessages; ++id) {
            if (id % 2 == 0)
                client.send({{"type", "dance"}, {"id", id}});
            else
                client.send({{"type", "resize"}, {"id", id}, {"width", 9}, {"height", 9}, {"pixelRatio", 1}});
        }
    });
    for (int id = 2; id <= kMessages; ++id) {
        const auto answer = client.receive();
        REQUIRE(answer.has_value());
        CHECK(answer->json()["id"] == id);
        CHECK(answer->json()["type"] == (id % 2 == 0 ? "error" : "ok"));
    }
    sender.join();
    CHECK(client.wait_for_still()["handled"] == kMessages);
}

TEST_CASE("a camera that stands upright stays upright where no up is given") {
    TestServer server;
    TestClient client(server.port());
    client.join();
    const auto up_after = [&](const Json& camera) {
        client.send({{"type", "patch"}, {"id", client.next_id()}, {"patch", {{"camera", camera}}}});
        client.wait_for("ok");
        const Json& state = client.state["camera"];
        const auto eye = state["eye"], focus = state["focus"], up = state["up"];
        // How far the camera's right axis, view × up, leans: 0 without roll.
        return (focus[2].get<double>() - eye[2].get<double>()) * up[0].get<double>() -
               (focus[0].get<double>() - eye[0].get<double>()) * up[2].get<double>();
    };
    CHECK(std::abs(up_after({{"eye", {3, 2, 5}}, {"focus", {0, 0.7, 0}}})) < 1e-12);
    CHECK(std::abs(up_after({{"eye", {-7, 1, 0.5}}})) < 1e-12);
    CHECK(std::abs(up_after({{"up", {1, 1, 0}}})) > 0.1);
    CHECK(std::abs(up_after({{"eye", {3, 2, 5}}})) > 0.01);  // it leans, and goes on to
}

TEST_CASE("a patch reaches everybody; its sender before the answer and before any frame of its revision") {
    TestServer server;
    TestClient sender(server.port()), watcher(server.port());
    sender.join();
    watcher.join("view");
    sender.send({{"type", "frame"}});
    sender.send({{"type", "patch"}, {"id", 1}, {"patch", {{"camera", {{"eye", {0.1, 0.2, 7.7}}}}}}});
    sender.send({{"type", "frame"}});
    std::int64_t known = 0;
    bool answered = false, framed = false;
    while (!answered || !framed) {
        const auto message = sender.receive();
        REQUIRE(message.has_value());
        if (message->binary) {
            CHECK(message->json()["revision"] <= known);
            framed = framed || message->json()["camera"]["eye"] == Json({0.1, 0.2, 7.7});
        } else if (message->json()["type"] == "patch") {
            CHECK(message->json()["revision"] > known);
            known = message->json()["revision"];
        } else if (message->json()["type"] == "ok") {
            CHECK(message->json()["revision"] == known);
            answered = true;
        }
    }
    while (watcher.state["camera"]["eye"] != Json({0.1, 0.2, 7.7})) watcher.wait_for("patch");
    CHECK(watcher.state == sender.state);
}

TEST_CASE("a patch that changes nothing leaves the revision") {
    TestServer server;
    TestClient client(server.port());
    client.join();
    client.send({{"type", "patch"}, {"id", 1}, {"patch", Json::object()}});
    const auto first = client.wait_for("ok")["revision"];
    client.send({{"type", "patch"}, {"id", 2}, {"patch", {{"navigation", {{"zoomSpeed", 1}}}}}});
    CHECK(client.wait_for("ok")["revision"] == first);
}

TEST_CASE("ifRevision refuses only what has changed since") {
    TestServer server;
    TestClient client(server.port());
    client.join();
    client.send({{"type", "patch"}, {"id", 1}, {"patch", {{"navigation", {{"zoomSpeed", 2}}}}}});
    const std::int64_t before = client.wait_for("ok")["revision"];
    client.send({{"type", "patch"}, {"id", 2}, {"patch", {{"navigation", {{"zoomSpeed", 3}}}}}});
    client.wait_for("ok");
    client.send({{"type", "patch"},
                 {"id", 3},
                 {"patch", {{"navigation", {{"panSpeed", 3}}}}},
                 {"ifRevision", before}});
    CHECK(client.wait_for("ok")["id"] == 3);
    client.send({{"type", "patch"},
                 {"id", 4},
                 {"patch", {{"navigation", {{"zoomSpeed", 4}}}}},
                 {"ifRevision", before}});
    CHECK(client.wait_for("error")["code"] == "stale-revision");
    CHECK(client.state["navigation"]["zoomSpeed"] == 3);
}

TEST_CASE("a camera that sees nothing is refused, and nothing is changed") {
    TestServer server;
    TestClient client(server.port());
    const Json camera = client.join()["camera"];
    int id = 0;
    const auto refused = [&](const Json& patch) {
        client.send({{"type", "patch"}, {"id", ++id}, {"patch", {{"camera", patch}}}});
        CHECK(client.wait_for("error")["code"] == "out-of-range");
    };
    refused({{"eye", camera["focus"]}});
    refused({{"up", {0, 0, 0}}});
    refused({{"eye", {0, 5, 0}}, {"focus", {0, 0, 0}}, {"up", {0, 2, 0}}});
    CHECK(client.state["camera"] == camera);
}

TEST_CASE("up is made right-angled and unit, the rest kept to the bit") {
    TestServer server;
    TestClient client(server.port());
    client.join();
    client.send(
        {{"type", "patch"},
         {"id", 1},
         {"patch", {{"camera", {{"eye", {0, 0, 10.1}}, {"focus", {0, 0, 0.3}}, {"up", {0, 3, 4}}}}}}});
    client.wait_for("ok");
    CHECK(client.state["camera"]["eye"] == Json({0.0, 0.0, 10.1}));
    CHECK(client.state["camera"]["focus"] == Json({0.0, 0.0, 0.3}));
    CHECK(client.state["camera"]["up"] == Json({0.0, 1.0, 0.0}));
}

TEST_CASE("tokens: none, wrong, view's, control's") {
    ServerOptions options;
    options.access.control_token = "control-token-16";
    options.access.view_token = "view-token-16-xx";
    TestServer server({}, options);
    const auto joined = [&](const char* role, const char* token) {
        TestClient client(server.port());
        Json hello = {{"type", "hello"}, {"role", role}};
        if (*token) hello["token"] = token;
        client.send(hello);
        const auto first = client.receive();
        REQUIRE(first.has_value());
        if (first->json()["type"] == "welcome") return first->json()["role"].get<std::string>();
        CHECK(first->json()["type"] == "error");
        CHECK(client.wait_for_close() == 1008);
        return std::string("refused");
    };
    CHECK(joined("control", "") == "refused");
    CHECK(joined("view", "wrong-token-wrong") == "refused");
    CHECK(joined("view", "view-token-16-xx") == "view");
    CHECK(joined("control", "view-token-16-xx") == "view");
    CHECK(joined("control", "control-token-16") == "control");
    CHECK(joined("host", "control-token-16") == "host");
}

TEST_CASE("one client too many is told so") {
    ServerOptions options;
    options.max_clients = 2;
    TestServer server({}, options);
    TestClient a(server.port()), b(server.port()), c(server.port());
    a.join();
    b.join();
    c.send({{"type", "hello"}, {"role", "view"}});
    CHECK(c.wait_for("error")["code"] == "too-many");
    CHECK(c.wait_for_close() == 1013);
}

TEST_CASE("a million bytes of messages that nobody has handled yet stop the reading, not the server") {
    TestServer server({.takes = 20ms});
    TestClient flood(server.port()), other(server.port());
    flood.join();
    other.join("view");
    flood.send({{"type", "frame"}});
    flood.send(pointer_event("pointerdown", 0, 0));
    for (int i = 0; i < 20'000; ++i) flood.send(pointer_event("pointermove", i % 1000, i % 700));
    flood.send({{"type", "resize"}, {"id", 1}, {"width", 100}, {"height", 100}, {"pixelRatio", 1}});
    CHECK(flood.wait_for("ok", 20s)["id"] == 1);
    other.send({{"type", "resize"}, {"id", 2}, {"width", 100}, {"height", 100}, {"pixelRatio", 1}});
    CHECK(other.wait_for("ok", 20s)["id"] == 2);  // behind thousands of patches that it has not read yet
}

TEST_CASE("the end is told to clients and comes soon, even to one that does not read") {
    TestServer server({.noise = true});
    TestClient reader(server.port()), stuck(server.port(), {.receive_buffer = 4096});
    reader.join();
    stuck.join();
    for (int i = 0; i < 20; ++i) {
        stuck.send({{"type", "frame"}});
        reader.send({{"type", "patch"}, {"id", i + 1}, {"patch", {{"camera", {{"eye", {i, 0, 9}}}}}}});
        reader.wait_for("ok");
    }
    std::thread closer([&] { CHECK(reader.wait_for_close() == 1001); });
    const auto took = server.stop();
    closer.join();
    CHECK(took < 3s);
}

TEST_CASE("nobody waits behind another's thousand requests") {
    std::string text = "vrut-text 1\n";
    for (int id = 1; id <= 20'000; ++id) text += "node " + std::to_string(id) + " \"Part\" assembly end\n";
    TestServer server(scene_of(text), FakeRenderer{}.factory());
    TestClient flood(server.port()), presenter(server.port());
    flood.join("view");
    presenter.join();
    // More work than the wait below allows, from one who does not even take the answers.
    for (int id = 1; id <= 20'000; ++id)
        flood.send({{"type", "tree"}, {"id", id}, {"depth", 99}, {"search", "zzz"}});
    presenter.send({{"type", "navigate"}, {"id", 1}, {"rotate", {5, 0}}});
    CHECK(presenter.wait_for("ok", 2s)["id"] == 1);
}

TEST_CASE("who comes later hears nothing of a scene that was loaded before") {
    ServerOptions options;
    options.library = SceneLibrary(VRUT_CARS);
    TestServer server(FakeRenderer{}, options);
    TestClient first(server.port());
    first.join();
    first.send({{"type", "open"}, {"id", 1}, {"scene", "car-20k.vrut"}});
    first.wait_for("ok");
    while (!first.wait_for("loading").contains("done")) {
    }
    TestClient second(server.port());
    CHECK(second.join("view")["scene"]["name"] == "car-20k");
    second.send({{"type", "pick"}, {"id", 1}, {"x", 0}, {"y", 0}});
    for (;;) {
        const auto message = second.receive();
        REQUIRE(message.has_value());
        CHECK(message->json()["type"] != "loading");
        if (message->json()["type"] == "picked") break;
    }
}

TEST_CASE("changes that a slow client does not take wait as one, and do not fill its socket") {
    TestServer server;
    TestClient driver(server.port()), slow(server.port(), {.receive_buffer = 4096});
    driver.join();
    slow.join("host");
    constexpr int kChanges = 1000;
    for (int i = 1; i <= kChanges; ++i) {
        driver.send({{"type", "patch"}, {"id", i}, {"patch", {{"camera", {{"eye", {i, 2, 3}}}}}}});
        driver.wait_for("ok");
    }
    int patches = 0;
    while (slow.state["camera"]["eye"][0] != kChanges) {
        const auto message = slow.receive();
        REQUIRE(message.has_value());
        patches += !message->binary && message->json()["type"] == "patch";
    }
    MESSAGE(patches << " patches for " << kChanges << " changes");
    CHECK(patches < 100);
}

TEST_CASE("of what a client points at the newest waits for a slow client, and comes in the end") {
    TestServer server;
    TestClient driver(server.port()), slow(server.port(), {.receive_buffer = 4096});
    driver.join();
    slow.join("view");
    driver.send(
        {{"type", "patch"},
         {"patch",
          {{"camera", {{"eye", {0, 0, 10}}, {"focus", {0, 0, 0}}, {"up", {0, 1, 0}}, {"fov", 40}}}}}});
    constexpr int kPoints = 30;
    Json last;
    for (int i = 1; i <= kPoints; ++i) {
        driver.send({{"type", "point"}, {"x", 640 + i}, {"y", 360}});
        last = driver.wait_for("pointed");
    }
    int points = 0;
    for (Json newest; newest != last; ++points) newest = slow.wait_for("pointed");
    MESSAGE(points << " of " << kPoints << " points");
    CHECK(points < kPoints / 2);
}
