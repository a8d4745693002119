// A full audience keeps neither hosts out nor who presents.
#include <doctest/doctest.h>

#include <memory>
#include <vector>

#include "test_client.hpp"

using namespace vrut;
using namespace vrut::test;
using vrut::server::net::ServerOptions;

namespace {

constexpr const char *kControl = "control-token-16", *kView = "view-token-16-xx";

using Client = std::unique_ptr<TestClient>;

Json hello(const std::string& role, const std::string& token = {}, const std::string& resume_key = {}) {
    Json message = {{"type", "hello"}, {"role", role}};
    if (!token.empty()) message["token"] = token;
    if (!resume_key.empty()) message["resume"] = resume_key;
    return message;
}

/// Who has come in by this message; null: it was too many.
Client enter(const TestServer& server, const Json& message) {
    auto client = std::make_unique<TestClient>(server.port());
    client->send(message);
    for (;;) {
        const auto first = client->receive();
        REQUIRE(first.has_value());
        const Json answer = first->json();
        if (answer["type"] == "welcome") {
            CHECK(answer["role"] == message["role"]);
            return client;
        }
        if (answer["type"] != "error") continue;
        CHECK(answer["code"] == "too-many");
        CHECK(answer["message"] ==
              "the server has its " + std::to_string(ServerOptions{}.max_clients) + " clients already");
        CHECK(client->wait_for_close() == 1013);
        return nullptr;
    }
}

/// As many as the server takes, and then some that knock in vain.
std::vector<Client> audience(const TestServer& server, const Json& message = hello("view")) {
    std::vector<Client> inside;
    while (Client client = enter(server, message)) {
        inside.push_back(std::move(client));
        REQUIRE(inside.size() <= ServerOptions{}.max_clients);
    }
    for (int knocks = 0; knocks < 8; ++knocks) CHECK_FALSE(enter(server, message));
    return inside;
}

ServerOptions with_tokens() {
    ServerOptions options;
    options.access.control_token = kControl;
    options.access.view_token = kView;
    return options;
}

/// After welcome.
bool steers(TestClient& client) {
    client.wait_for("state");
    client.send({{"type", "navigate"}, {"id", 1}, {"rotate", {5, 0}}});
    return client.wait_for("ok")["id"] == 1;
}

}  // namespace

TEST_CASE("who presents and loads the page again comes in at once, though the audience takes every place") {
    TestServer server;
    auto presenter = std::make_unique<TestClient>(server.port());
    presenter->join("control", "", "secret");
    std::vector<Client> watchers = audience(server);
    REQUIRE(watchers.size() == 63);
    for (int reloads = 0; reloads < 3; ++reloads) {
        presenter.reset();
        // It has gone when its place is another's.
        if (reloads == 0) {
            Client last;
            REQUIRE(eventually([&] { return (last = enter(server, hello("view"))) != nullptr; }));
            watchers.push_back(std::move(last));
        }
        CHECK_FALSE(enter(server, hello("view")));
        CHECK_FALSE(enter(server, hello("control", "", "another secret")));
        presenter = enter(server, hello("control", "", "secret"));
        REQUIRE(presenter);
        CHECK(steers(*presenter));
    }
}

TEST_CASE("who has the control token comes in, though watchers came first and take every place") {
    TestServer server({}, with_tokens());
    const std::vector<Client> watchers = audience(server, hello("view", kView));
    REQUIRE(watchers.size() == 64);
    const Client presenter = enter(server, hello("control", kControl));
    REQUIRE(presenter);
    CHECK(steers(*presenter));
    CHECK_FALSE(enter(server, hello("view", kView)));
}

TEST_CASE("a host comes in, though the audience takes every place") {
    for (const bool by_token : {false, true}) {
        TestServer server({}, by_token ? with_tokens() : ServerOptions{});
        const std::vector<Client> watchers = audience(server, hello("view", by_token ? kView : ""));
        REQUIRE(watchers.size() == 64);
        for (int restarts = 0; restarts < 3; ++restarts)
            CHECK(enter(server, hello("host", by_token ? kControl : "")));
    }
}

TEST_CASE("a watcher takes no place of others, whatever it says") {
    TestServer server({}, with_tokens());
    const Client presenter = enter(server, hello("control", kControl, "secret"));
    REQUIRE(presenter);
    CHECK(steers(*presenter));
    const std::vector<Client> watchers = audience(server, hello("view", kView));
    REQUIRE(watchers.size() == 63);
    for (const char* role : {"view", "control", "host"}) {
        TestClient client(server.port());
        client.send(hello(role, kView, "secret"));
        CHECK(client.wait_for("error")["code"] == "too-many");
    }
    CHECK_FALSE(enter(server, hello("view", kControl)));  // nor who has the token, and only watches
}

TEST_CASE("hosts do not take the places of who resumes control, and nobody has places without end") {
    TestServer server;
    auto presenter = std::make_unique<TestClient>(server.port());
    presenter->join("control", "", "secret");
    const std::vector<Client> watchers = audience(server);
    std::vector<Client> hosts;
    while (Client host = enter(server, hello("host"))) {
        hosts.push_back(std::move(host));
        REQUIRE(hosts.size() <= 12);
    }
    CHECK(hosts.size() == 12);
    std::vector<Client> again;  // while the server takes the former connections for alive
    while (Client resumed = enter(server, hello("control", "", "secret"))) {
        again.push_back(std::move(resumed));
        REQUIRE(again.size() <= 4);
    }
    CHECK(again.size() == 4);
}

TEST_CASE("connections that have not said hello take no place of a client") {
    TestServer server;
    std::vector<Client> silent;
    for (int i = 0; i < 100; ++i) silent.push_back(std::make_unique<TestClient>(server.port()));
    const std::vector<Client> watchers = audience(server);
    CHECK(watchers.size() == 64);
    CHECK(enter(server, hello("host")));
}
