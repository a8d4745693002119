#include <doctest/doctest.h>

#include <cmath>

#include "test_client.hpp"

using namespace vrut;
using namespace vrut::test;

namespace {

double length(const Json& a, const Json& b) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += std::pow(a[i].get<double>() - b[i].get<double>(), 2);
    return std::sqrt(sum);
}

}  // namespace

TEST_CASE("navigate turns, moves and zooms by the numbers given, whatever the speeds") {
    TestServer server;
    TestClient client(server.port());
    client.join();
    const Json start = {
        {"eye", {0, 0, 10}}, {"focus", {0, 0, 0}}, {"center", {0, 0, 0}}, {"up", {0, 1, 0}}, {"fov", 90}};
    const auto after = [&](const Json& navigate) {
        client.send(
            {{"type", "patch"},
             {"id", client.next_id()},
             {"patch",
              {{"camera", start}, {"navigation", {{"rotateSpeed", 3}, {"panSpeed", 3}, {"zoomSpeed", 3}}}}}});
        client.wait_for("ok");
        Json message = navigate;
        message["type"] = "navigate";
        message["id"] = client.next_id();
        client.send(message);
        client.wait_for("ok");
        return client.state["camera"];
    };
    // The scene turns right, so the eye goes left; its top tips towards the viewer, so the eye goes up.
    CHECK(length(after({{"rotate", {90, 0}}})["eye"], {-10, 0, 0}) < 1e-12);
    CHECK(length(after({{"rotate", {0, 30}}})["eye"], {0, 5, 10 * std::sqrt(0.75)}) < 1e-12);
    // The view is 20 high at the focus: the picture moves right by 5 and down by 10.
    const Json panned = after({{"pan", {0.25, 0.5}}});
    CHECK(length(panned["focus"], {-5, 10, 0}) < 1e-12);
    CHECK(length(panned["center"], {0, 0, 0}) == 0);
    CHECK(length(after({{"zoom", 4}})["eye"], {0, 0, 2.5}) < 1e-12);
    // In this order: the pan is measured after the turn and before the zoom.
    const Json all = after({{"zoom", 2}, {"rotate", {90, 0}}, {"pan", {0.5, 0}}});
    CHECK(length(all["focus"], {0, 0, -10}) < 1e-12);
    CHECK(length(all["eye"], {-5, 0, -10}) < 1e-12);
    CHECK(after(Json::object())["eye"] == Json({0.0, 0.0, 10.0}));
}

TEST_CASE("fit brings the scene, or a node of it, into view along the same direction") {
    TestServer server;
    TestClient client(server.port());
    const Json home = client.join()["camera"];
    client.send({{"type", "navigate"}, {"pan", {3, 3}}, {"zoom", 5}});
    client.send({{"type", "fit"}, {"id", 1}});
    client.wait_for("ok");
    CHECK(length(client.state["camera"]["eye"], home["eye"]) < 1e-9);
    client.send({{"type", "fit"}, {"id", 2}, {"node", 1}});
    client.wait_for("ok");
    CHECK(length(client.state["camera"]["eye"], home["eye"]) < 1e-9);
    client.send({{"type", "fit"}, {"id", 3}, {"node", 99}});
    CHECK(client.wait_for("error")["code"] == "unknown-node");
    client.send({{"type", "fit"}, {"id", 4}, {"node", 2}});  // a background
    CHECK(client.wait_for("error")["code"] == "failed");
}

TEST_CASE("control is taken, and given back") {
    TestServer server;
    TestClient a(server.port()), b(server.port()), view(server.port());
    a.join();
    b.join();
    view.join("view");
    const auto control = [](TestClient& client, const char* action) {
        client.send({{"type", "control"}, {"action", action}, {"id", client.next_id()}});
    };
    const auto steers = [](TestClient& client) {
        client.send({{"type", "navigate"}, {"rotate", {1, 0}}, {"id", client.next_id()}});
        for (;;) {
            const Json answer = client.receive()->json();
            if (answer["type"] != "patch") return answer["type"] == "ok";
        }
    };
    while (view.state["control"].value("holder", "") != "c1") view.wait_for("patch");
    CHECK_FALSE(steers(b));
    control(b, "take");
    b.wait_for("ok");
    CHECK(b.state["control"]["holder"] == "c2");
    CHECK_FALSE(steers(a));
    control(a, "release");  // it has none to give
    a.wait_for("ok");
    CHECK_FALSE(steers(a));
    control(b, "release");
    b.wait_for("ok");
    CHECK(b.state["control"]["holder"] == "c1");
    CHECK(steers(a));
    control(view, "take");
    CHECK(view.wait_for("error")["code"] == "not-allowed");
}
