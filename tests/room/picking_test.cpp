#include <doctest/doctest.h>

#include <cmath>

#include "test_client.hpp"

using namespace vrut;
using namespace vrut::test;

namespace {

// The triangle (−1 −1 0) (1 −1 0) (0 1 1) seen from (0 0 10): 8 high is the view at its foot.
const Json kCamera = {
    {"eye", {0, 0, 10}}, {"focus", {0, 0, 0}}, {"center", {0, 0, 0}}, {"up", {0, 1, 0}}, {"fov", 40}};

Json pick(std::int64_t id, double x, double y) { return {{"type", "pick"}, {"id", id}, {"x", x}, {"y", y}}; }

}  // namespace

TEST_CASE("pick tells what is under a point") {
    TestServer server;
    TestClient client(server.port()), view(server.port());
    client.join();
    view.join("view");
    client.send({{"type", "patch"}, {"patch", {{"camera", kCamera}}}});
    client.wait_for("patch");
    view.send(pick(1, 640, 360));  // whoever looks may ask
    const Json hit = view.wait_for("picked");
    CHECK(hit["id"] == 1);
    CHECK(hit["node"] == 1);
    CHECK(hit["name"] == "Triangle");
    CHECK(hit["path"] == Json({"", "Triangle"}));
    // The triangle's plane is z = (y + 1) / 2.
    CHECK(hit["point"][2].get<double>() == doctest::Approx(0.5));
    CHECK(hit["distance"].get<double>() == doctest::Approx(9.5));
    CHECK(hit["normal"][1].get<double>() == doctest::Approx(-1 / std::sqrt(5)));
    CHECK(hit["normal"][2].get<double>() == doctest::Approx(2 / std::sqrt(5)));
    view.send(pick(2, 5, 5));
    CHECK(view.wait_for("picked") == Json({{"type", "picked"}, {"id", 2}}));
}

TEST_CASE("a pick sees what its frame showed, not what has come since") {
    TestServer server;
    TestClient client(server.port());
    client.join();
    client.send({{"type", "patch"}, {"patch", {{"camera", kCamera}}}});
    const std::int64_t frame = client.wait_for_still()["frame"];
    client.send({{"type", "navigate"}, {"pan", {3, 3}}});
    Json message = pick(1, 640, 360);
    client.send(message);
    CHECK_FALSE(client.wait_for("picked").contains("node"));
    message["frame"] = frame;
    message["id"] = client.next_id();
    client.send(message);
    CHECK(client.wait_for("picked")["node"] == 1);
    message["frame"] = 12345;
    message["id"] = client.next_id();
    client.send(message);
    CHECK(client.wait_for("error")["code"] == "unknown-frame");
}

TEST_CASE("a pick may select, set the centre of rotation, and look at the point") {
    TestServer server;
    TestClient client(server.port()), view(server.port());
    client.join();
    view.join("view");
    client.send({{"type", "patch"}, {"id", client.next_id()}, {"patch", {{"camera", kCamera}}}});
    client.wait_for("ok");
    const auto picked = [&](double x, const char* then) {
        Json message = pick(client.next_id(), x, 360);
        message["then"] = then;
        client.send(message);
        return client.wait_for("picked");
    };
    picked(640, "select");
    CHECK(client.state["selection"] == Json({{"node", 1},
                                             {"name", "Triangle"},
                                             {"path", {"", "Triangle"}},
                                             {"pathIds", {0, 1}},
                                             {"hinge", 1}}));
    picked(5, "select");
    CHECK(client.state["selection"] == Json::object());

    const Json point = picked(600, "center")["point"];
    CHECK(client.state["camera"]["center"] == point);
    CHECK(client.state["camera"]["eye"] == Json({0.0, 0.0, 10.0}));
    picked(5, "center");
    CHECK(client.state["camera"]["center"] == point);

    const Json seen = picked(600, "lookAt")["point"];
    const Json camera = client.state["camera"];
    CHECK(camera["focus"] == seen);
    CHECK(camera["eye"][0].get<double>() == doctest::Approx(seen[0].get<double>()));
    CHECK(camera["eye"][2].get<double>() - camera["focus"][2].get<double>() == doctest::Approx(10));

    Json forbidden = pick(3, 640, 360);
    forbidden["then"] = "select";
    view.send(forbidden);
    CHECK(view.wait_for("error")["code"] == "not-allowed");
}

TEST_CASE("the selection is a node of the scene; f fits it, Escape clears it") {
    TestServer server;
    TestClient client(server.port());
    client.join();
    const auto patch = [&](const Json& node) {
        client.send(
            {{"type", "patch"}, {"id", client.next_id()}, {"patch", {{"selection", {{"node", node}}}}}});
    };
    patch(99);
    CHECK(client.wait_for("error")["code"] == "unknown-node");
    patch(1);
    client.wait_for("ok");
    CHECK(client.state["selection"]["name"] == "Triangle");
    const Json before = client.state["camera"]["eye"];
    client.send({{"type", "navigate"}, {"id", client.next_id()}, {"zoom", 3}});
    client.wait_for("ok");
    client.send({{"type", "keydown"}, {"key", "f"}, {"code", "KeyF"}});
    client.wait_for("patch");
    CHECK(client.state["camera"]["eye"][2].get<double>() == doctest::Approx(before[2].get<double>()));
    client.send({{"type", "keydown"}, {"key", "Escape"}, {"code", "Escape"}});
    client.wait_for("patch");
    CHECK(client.state["selection"] == Json::object());
    patch(1);
    client.wait_for("ok");
    patch(nullptr);
    client.wait_for("ok");
    CHECK(client.state["selection"] == Json::object());
}

TEST_CASE("double clicks, double taps and a tap beside a resting finger select, centre and look") {
    TestServer server;
    TestClient client(server.port());
    client.join();
    client.send({{"type", "patch"}, {"id", 1}, {"patch", {{"camera", kCamera}}}});
    client.wait_for("ok");
    int id = 1;
    double time = 0;
    const auto say = [&](const char* type, double x, const char* device, int button, unsigned buttons,
                         int pointer) {
        Json message = pointer_event(type, x, 360, device, button, buttons, pointer);
        message["timeStamp"] = time += 50;
        client.send(message);
    };
    const auto twice = [&](double x, const char* device, int button, unsigned buttons) {
        for (int i = 0; i < 2; ++i) {
            say("pointerdown", x, device, button, buttons, 1);
            say("pointerup", x, device, button, 0, 1);
        }
        client.send({{"type", "resize"}, {"id", ++id}, {"width", 1280}, {"height", 720}, {"pixelRatio", 1}});
        client.wait_for("ok");
    };
    twice(640, "mouse", 0, 1);
    CHECK(client.state["selection"]["node"] == 1);
    twice(5, "touch", 0, 1);
    CHECK(client.state["selection"] == Json::object());
    twice(600, "mouse", 2, 2);
    const double across = client.state["camera"]["center"][0];
    CHECK(across < -0.2);
    CHECK(client.state["camera"]["focus"] == Json({0.0, 0.0, 0.0}));
    twice(600, "mouse", 1, 4);
    CHECK(client.state["camera"]["focus"][0].get<double>() == doctest::Approx(across));

    client.send({{"type", "patch"}, {"id", ++id}, {"patch", {{"camera", kCamera}}}});
    client.wait_for("ok");
    say("pointerdown", 100, "touch", 0, 1, 1);
    time += 300;
    say("pointerdown", 680, "touch", 0, 1, 2);
    say("pointerup", 680, "touch", 0, 0, 2);
    say("pointerup", 100, "touch", 0, 0, 1);
    client.send({{"type", "resize"}, {"id", ++id}, {"width", 1280}, {"height", 720}, {"pixelRatio", 1}});
    client.wait_for("ok");
    CHECK(client.state["camera"]["focus"][0].get<double>() == doctest::Approx(-across));
    CHECK(client.state["camera"]["center"] == client.state["camera"]["focus"]);
}

TEST_CASE("three fingers leave nothing behind: a double tap after them still selects") {
    TestServer server;
    TestClient client(server.port());
    client.join();
    client.send({{"type", "patch"}, {"id", 1}, {"patch", {{"camera", kCamera}}}});
    for (int pointer = 1; pointer <= 3; ++pointer)
        client.send(pointer_event("pointerdown", 100 * pointer, 100, "touch", 0, 1, pointer));
    for (int pointer = 1; pointer <= 3; ++pointer)
        client.send(pointer_event("pointerup", 100 * pointer, 100, "touch", 0, 0, pointer));
    client.send({{"type", "patch"}, {"id", 2}, {"patch", {{"camera", kCamera}}}});
    for (int pointer = 4; pointer <= 5; ++pointer) {
        client.send(pointer_event("pointerdown", 640, 360, "touch", 0, 1, pointer));
        client.send(pointer_event("pointerup", 640, 360, "touch", 0, 0, pointer));
    }
    client.send({{"type", "resize"}, {"id", 3}, {"width", 1280}, {"height", 720}, {"pixelRatio", 1}});
    while (client.wait_for("ok")["id"] != 3) {
    }
    CHECK(client.state["selection"]["node"] == 1);
}
