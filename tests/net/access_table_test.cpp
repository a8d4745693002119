// Who may do what, every cell over real sockets. The rules are said here once more, apart from the server's
// own code; protocol/ACCESS.md is what was seen.
#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "message_table.hpp"
#include "raw_connection.hpp"

using namespace vrut;
using namespace vrut::server::scenes;
using namespace vrut::server::net;
using namespace vrut::test;

namespace {

const std::string kControl = "control-token-16", kView = "view-token-16-xx";
const std::string kAllowed = "https://allowed.example";

/// A column of the tables.
struct TokenState {
    std::string name;
    bool set = true;
    std::string sent;
};
const std::vector<TokenState> kTokens{{"no tokens set", false, ""},
                                      {"none sent", true, ""},
                                      {"a wrong one", true, "control-token-17"},
                                      {"the view token", true, kView},
                                      {"the control token", true, kControl}};

/// Servers with tokens and without.
struct Servers {
    Servers() {
        std::filesystem::create_directories(folder);
        std::ofstream(folder / "other.vrut") << "vrut-text 1\nnode 1 \"Part\" assembly end\n";
        ServerOptions options;
        options.access.allowed_origins = {kAllowed};
        options.library = SceneLibrary(folder);
        options.record_folder = folder;
        open = std::make_unique<TestServer>(FakeRenderer{}, options);
        options.access.control_token = kControl;
        options.access.view_token = kView;
        guarded = std::make_unique<TestServer>(FakeRenderer{}, options);
        const std::string bearer = "Host: 127.0.0.1\r\nAuthorization: Bearer " + kView + "\r\n";
        for (const auto* server : {&open, &guarded})
            REQUIRE(
                eventually([&] { return http((*server)->port(), "GET", "/readyz", bearer).status == 200; }));
    }
    ~Servers() {
        open.reset();
        guarded.reset();
        std::filesystem::remove_all(folder);
    }
    const TestServer& of(const TokenState& state) const { return state.set ? *guarded : *open; }

    std::filesystem::path folder =
        std::filesystem::temp_directory_path() /
        ("vrut-access-" + std::to_string(std::rand()) + "-" + std::to_string(static_cast<long>(::getpid())));
    std::unique_ptr<TestServer> open, guarded;
};

// --- routes

const std::vector<std::string> kPublic{"/", "/app.js", "/healthz"};
const std::vector<std::string> kGuarded{
    "/readyz",      "/metrics",   "/protocol.schema.json", "/frame.jpg?width=16&height=16",
    "/report.html", "/report.csv"};

int expected_status(const std::string& route, const TokenState& state, bool good_origin) {
    const bool is_page_file = route == "/" || route == "/app.js";
    if (!good_origin && !is_page_file) return 403;
    if (route == "/ws") return 101;
    if (route == "/nothing" || route == "/metrics/") return 404;
    const bool guarded = std::find(kGuarded.begin(), kGuarded.end(), route) != kGuarded.end();
    return guarded && state.set && state.sent != kView && state.sent != kControl ? 401 : 200;
}

struct Origin {
    std::string name, value;  ///< of no value: no such field
    bool good = false;
};
std::vector<Origin> origins(const std::string& own) {
    return {{"none", "", true},
            {"own", "http://" + own, true},
            {"own behind TLS", "https://" + own, true},
            {"allowed", kAllowed, true},
            {"foreign", "http://evil.example"},
            {"`null`", "null"},
            {"another port", "http://127.0.0.1:1"},
            {"no port", "http://127.0.0.1"},
            {"own name, another's behind it", "http://" + own + ".evil.example"},
            {"own name behind another's", "http://evil.example." + own},
            {"own name as a user", "http://" + own + "@evil.example"},
            {"a user at the own name", "http://evil.example@" + own},
            {"another scheme", "ftp://" + own},
            {"with a path", "http://" + own + "/"},
            {"two in one", "http://" + own + " http://evil.example"},
            {"allowed name, another's behind it", kAllowed + ".evil.example"},
            {"allowed name, another scheme", "http://allowed.example"}};
}

int status_of(std::uint16_t port, const std::string& route, const std::string& token,
              const std::string& origin) {
    std::string request = "GET " + route + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n";
    if (!token.empty()) request += "Authorization: Bearer " + token + "\r\n";
    if (!origin.empty()) request += "Origin: " + origin + "\r\n";
    if (route == "/ws")
        request +=
            "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
    RawConnection connection(port);
    connection.send(request + "\r\n");
    return connection.answer().status;
}

/// A row of a table, and those whose rows are the same.
class Rows {
public:
    void add(const std::string& name, const std::string& cells) {
        for (auto& [names, same] : rows_)
            if (same == cells) {
                names += ", " + name;
                return;
            }
        rows_.emplace_back(name, cells);
    }
    std::string text() const {
        std::string text;
        for (const auto& [names, cells] : rows_) text += "| " + names + " |" + cells + "\n";
        return text;
    }

private:
    std::vector<std::pair<std::string, std::string>> rows_;
};

std::string heads(const std::string& first) {
    std::string head = "| " + first + " |", line = "|---|";
    for (const TokenState& state : kTokens) {
        head += " " + state.name + " |";
        line += "---|";
    }
    return head + "\n" + line + "\n";
}

std::string names_of(bool good) {
    std::string names;
    for (const Origin& origin : origins(""))
        if (origin.good == good) names += (names.empty() ? "" : "; ") + origin.name;
    return names;
}

std::string see_routes(const Servers& servers) {
    std::vector<std::string> routes{"/nothing", "/metrics/", "/ws"};
    routes.insert(routes.begin(), kGuarded.begin(), kGuarded.end());
    routes.insert(routes.begin(), kPublic.begin(), kPublic.end());
    Rows rows;
    for (const std::string& route : routes) {
        std::string cells;
        for (const TokenState& state : kTokens) {
            const std::uint16_t port = servers.of(state).port();
            for (const Origin& origin : origins("127.0.0.1:" + std::to_string(port))) {
                CAPTURE(route);
                CAPTURE(state.name);
                CAPTURE(origin.name);
                const int status = status_of(port, route, state.sent, origin.value);
                CHECK(status == expected_status(route, state, origin.good));
                if (origin.name == "none") cells += " " + std::to_string(status) + " |";
            }
        }
        rows.add("`" + route.substr(0, route.find('?')) + "`", cells);
    }
    return "## Routes\nTokens by `Authorization: Bearer`; what `/ws` asks for comes with `hello`. This holds "
           "where "
           "`Origin` is: " +
           names_of(true) +
           ". Each of them but `/` and the page's files is 403 where it is: " + names_of(false) + ".\n\n" +
           heads("GET") + rows.text();
}

// --- messages

/// Who may: "everybody", "control", "control, host", "host".
struct MessageType {
    std::string name, who;
    Json message;
};

std::vector<MessageType> message_types() {
    const auto pointer = [](const char* type, unsigned buttons) {
        return pointer_event(type, 3, 4, "mouse", buttons ? 0 : -1, buttons);
    };
    const auto patch = [](const Json& what) { return Json{{"type", "patch"}, {"patch", what}}; };
    const Json at{{"type", "pick"}, {"x", 640}, {"y", 360}};
    const auto pick = [&](const char* then) {
        Json message = at;
        message["then"] = then;
        return message;
    };
    const Json key{{"key", "f"}, {"code", "KeyF"}};
    const auto keyed = [&](const char* type) {
        Json message = key;
        message["type"] = type;
        return message;
    };
    return {
        {"resize", "everybody", {{"type", "resize"}, {"width", 640}, {"height", 360}, {"pixelRatio", 1}}},
        {"frame", "everybody", {{"type", "frame"}}},
        {"pick", "everybody", at},
        {"point", "everybody", {{"type", "point"}, {"x", 640}, {"y", 360}}},
        {"snapshot", "everybody", {{"type", "snapshot"}, {"width", 8}, {"height", 8}}},
        {"tree", "everybody", {{"type", "tree"}}},
        {"scenes", "everybody", {{"type", "scenes"}}},
        {"check",
         "everybody",
         {{"type", "check"},
          {"cues", {{"format", "vrut-preview-cues"}, {"version", 1}, {"cues", Json::object()}}}}},
        {"pointerdown", "control", pointer("pointerdown", 1)},
        {"pointermove", "control", pointer("pointermove", 1)},
        {"pointerup", "control", pointer("pointerup", 0)},
        {"pointercancel", "control", pointer("pointercancel", 0)},
        {"wheel",
         "control",
         {{"type", "wheel"}, {"x", 1}, {"y", 1}, {"deltaX", 0}, {"deltaY", 1}, {"deltaMode", 0}}},
        {"keydown", "control", keyed("keydown")},
        {"keyup", "everybody", keyed("keyup")},  // it does nothing
        {"navigate", "control", {{"type", "navigate"}, {"rotate", {1, 0}}}},
        {"fit", "control", {{"type", "fit"}}},
        {"swing", "control", {{"type", "swing"}, {"node", 1}, {"ms", 0}}},
        {"fly",
         "control",
         {{"type", "fly"}, {"keyframes", Json::array({{{"at", 1}, {"camera", {{"fov", 30}}}}})}}},
        {"patch of cues", "control", patch({{"cues", {{"here", Json::object()}}}})},
        {"cue", "control", {{"type", "cue"}, {"name", "here"}, {"ms", 0}}},
        {"patch of anything else", "control", patch({{"renderer", {{"wireframe", true}}}})},
        {"patch of camera", "control, host", patch({{"camera", {{"fov", 35}}}})},
        {"patch of nodes", "control, host", patch({{"nodes", {{"1", {{"active", true}}}}}})},
        {"patch of selection", "control, host", patch({{"selection", {{"node", 1}}}})},
        {"pick with then select", "control", pick("select")},
        {"pick with then center", "control", pick("center")},
        {"pick with then lookAt", "control", pick("lookAt")},
        {"record start", "control", {{"type", "record"}, {"action", "start"}}},
        {"record stop", "control", {{"type", "record"}, {"action", "stop"}}},
        {"control take", "control", {{"type", "control"}, {"action", "take"}}},
        {"control release", "control", {{"type", "control"}, {"action", "release"}}},
        {"control ask", "control", {{"type", "control"}, {"action", "ask"}}},
        {"control cancel", "control", {{"type", "control"}, {"action", "cancel"}}},
        {"control decline", "control", {{"type", "control"}, {"action", "decline"}, {"client", "c0"}}},
        {"share", "control", {{"type", "share"}}},
        {"shown", "host", {{"type", "shown"}, {"revision", 1}}},
        {"open", "control", {{"type", "open"}, {"scene", "other.vrut"}}},
    };
}

std::string expected_role(const std::string& asked, const TokenState& state) {
    if (!state.set || state.sent == kControl) return asked;
    return state.sent == kView ? "view" : "1008";
}

/// The role that it was given, or the code with which it was closed.
std::string role_after_hello(TestClient& client, const std::string& role, const TokenState& state) {
    Json hello{{"type", "hello"}, {"role", role}};
    if (!state.sent.empty()) hello["token"] = state.sent;
    client.send(hello);
    const auto answer = client.receive();
    REQUIRE(answer.has_value());
    if (answer->json()["type"] == "welcome") return answer->json()["role"];
    CHECK(answer->json()["code"] == "not-allowed");
    return std::to_string(client.wait_for_close());
}

/// The code of the error that answers it, or "yes".
std::string outcome(TestClient& client, Json message) {
    const std::int64_t id = client.next_id();
    message["id"] = id;
    client.send(message);
    client.send({{"type", "tree"}, {"id", id + 1}});
    for (std::string outcome = "yes";;) {
        const auto next = client.receive();
        REQUIRE(next.has_value());
        if (next->binary) continue;
        const Json json = next->json();
        if (json.value("id", std::int64_t{0}) == id && json["type"] == "error") outcome = json["code"];
        if (json.value("id", std::int64_t{0}) == id + 1) return outcome;
    }
}

std::string see_messages(const Servers& servers) {
    const std::vector<std::string> roles{"control", "view", "host"};
    Rows given, done;
    std::map<std::string, std::string> cells;
    for (const std::string& role : roles) {
        std::string roles_given;
        for (const TokenState& state : kTokens) {
            CAPTURE(role);
            CAPTURE(state.name);
            const TestServer& server = servers.of(state);
            const std::uint64_t left = server.metrics().clients_left;
            {
                TestClient client(server.port());
                const std::string now = role_after_hello(client, role, state);
                CHECK(now == expected_role(role, state));
                roles_given += " " + now + " |";
                if (now == "1008") continue;
                for (const MessageType& type : message_types()) {
                    CAPTURE(type.name);
                    const bool may = type.who == "everybody" || type.who.find(now) != std::string::npos;
                    const std::string seen = outcome(client, type.message);
                    CHECK(seen == (may ? "yes" : "not-allowed"));
                    if (!state.set) cells[type.name] += " " + seen + " |";
                }
                client.send({{"type", "hello"}, {"role", role}});
                CHECK(client.wait_for_close() == 1008);
            }
            REQUIRE(eventually([&] { return server.metrics().clients_left == left + 1; }));
        }
        given.add("`" + role + "`", roles_given);
    }
    for (const MessageType& type : message_types()) done.add("`" + type.name + "`", cells[type.name]);
    return "## Roles\nWhat `hello` gives, by its `token`.\n\n" + heads("asked for") + given.text() +
           "\n## Messages\nBy the role given; of who may steer, only the holder of control does. A second "
           "`hello` "
           "is 1008 for everybody.\n\n| message | control | view | host |\n|---|---|---|---|\n" +
           done.text();
}

/// A committed file that follows from the sources is renewed by whoever asks for it.
void check_file(const std::string& path, const std::string& text) {
    if (std::getenv("VRUT_RENEW")) std::ofstream(path, std::ios::binary) << text;
    std::ostringstream there;
    there << std::ifstream(path, std::ios::binary).rdbuf();
    CHECK_MESSAGE(there.str() == text,
                  path << " is not what the server does; VRUT_RENEW=1 test_access writes it anew");
}

}  // namespace

TEST_CASE("every type of client message stands in the table of who may send it") {
    const std::vector<MessageType> types = message_types();
    for (const protocol::ClientMessageType& each : protocol::client_message_types()) {
        const protocol::MessageTraits& traits = each.traits;
        const auto is_of_type = [&](const MessageType& type) { return type.message["type"] == traits.type; };
        CAPTURE(traits.type);
        CHECK((std::any_of(types.begin(), types.end(), is_of_type) || traits.type == std::string("hello")));
    }
}

TEST_CASE("who may do what: every route, token and Origin, and every message, role and token") {
    const Servers servers;
    const std::string page =
        "# Who may do what\n\nThis page is written by a test that tries every cell over a real connection "
        "(tests/net/access_table_test.cpp), and compares it with what is expected and with what stands "
        "here.\n\n" +
        see_routes(servers) + "\n" + see_messages(servers);
    check_file(VRUT_SCENES "/../protocol/ACCESS.md", page);
}
