#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>

#include "net/server.hpp"
#include "observe/metrics.hpp"

namespace vrut::test {

using Json = nlohmann::json;
using namespace std::chrono_literals;

/// Draws without GL: a colour that depends on the camera, with noise where a large file is wanted.
struct FakeRenderer {
    std::chrono::milliseconds takes{0};  ///< for each sample
    bool noise = false;
    server::engine::FrameRendererFactory factory() const;
};

/// A scene as read from its text.
server::scenes::LoadedScene scene_of(const std::string& text, const std::string& name = "test.vrut");

/// With certificates of an authority of its own.
server::net::ServerOptions with_tls();

/// A server in this process, on a port of its own. It serves one triangle if nothing else is said.
class TestServer {
public:
    explicit TestServer(const FakeRenderer& renderer = {}, const server::net::ServerOptions& options = {});
    TestServer(server::scenes::LoadedScene scene, const server::engine::FrameRendererFactory& renderer,
               server::net::ServerOptions options = {});
    ~TestServer();
    std::uint16_t port() const { return server_->port(); }
    const server::observe::Metrics& metrics() const { return server_->metrics(); }
    std::string description() const { return server_->description(); }
    /// Returns how long it took until run() ended.
    std::chrono::milliseconds stop();

private:
    std::unique_ptr<server::net::Server> server_;
    std::thread thread_;
};

struct ConnectOptions {
    std::string subprotocol = "vrut-preview.v1";  ///< empty: none offered
    std::string origin = {};                      ///< empty: none
    std::string host = {};                        ///< empty: the true one
    int receive_buffer = 0;                       ///< bytes; 0: the system's choice
};

/// A WebSocket client that does what a test tells it and nothing else: no grants, no answers, and it reads
/// only when asked to.
class TestClient {
public:
    /// Connects; the handshake may be refused (status()).
    explicit TestClient(std::uint16_t port, const ConnectOptions& options = {});
    ~TestClient();

    int status() const;               ///< of the handshake: 101, 400 …
    std::string subprotocol() const;  ///< that the server chose
    void send(const Json& message);
    /// One more than any id that it sent.
    std::int64_t next_id() const { return last_id_ + 1; }
    void send_text(const std::string& text);
    void send_binary(const std::string& bytes);

    struct Message {
        bool binary = false;
        std::string data;
        /// A text's, or a frame's header.
        Json json() const;
    };
    /// The next message, `stats` left out, which come when they like; none when `timeout` passes or the
    /// connection has ended.
    std::optional<Message> receive(std::chrono::milliseconds timeout = 5s);
    std::int64_t newest_frame = 0;  ///< that was received; no snapshot
    bool takes_stats = false;       ///< they are not left out
    /// Reads on until a text of this `type`, or "frame"; fails the test when none comes.
    Json wait_for(const std::string& type, std::chrono::milliseconds timeout = 5s);
    /// One frame; acknowledges the newest.
    void grant();
    /// Until a notice begins with this.
    void wait_for_notice(const std::string& sentence);
    /// Reads on until the end; its close code, 1006 where there was none.
    int wait_for_close(std::chrono::milliseconds timeout = 5s);

    /// hello; returns the state document.
    Json join(const std::string& role = "control", const std::string& token = {},
              const std::string& resume_key = {});
    /// Frame, and the state as patches leave it, up to the last refinement of a still frame; grants as it
    /// reads.
    Json wait_for_still(std::chrono::milliseconds for_each = 5s);
    Json state;  ///< kept by every read

private:
    std::int64_t last_id_ = 0;
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// One HTTP request on a connection of its own. `headers` as "Name: value\r\n".
struct HttpAnswer {
    int status = 0;
    std::string headers, body;
};
HttpAnswer http(std::uint16_t port, const std::string& method, const std::string& target,
                const std::string& headers = "Host: 127.0.0.1\r\n");

Json pointer_event(const char* type, double x, double y, const char* device = "touch", int button = -1,
                   unsigned buttons = 1, int pointer = 1);

/// Waits until `condition` holds; false when it does not within `timeout`.
template <class Condition>
bool eventually(Condition condition, std::chrono::milliseconds timeout = 5s) {
    const auto end = std::chrono::steady_clock::now() + timeout;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(1ms);
    }
    return true;
}

}  // namespace vrut::test
