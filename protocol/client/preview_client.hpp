#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

/// A client of VRUT Preview for a host, a program that shows the same scene on walls: it follows the shared
/// camera, tells what the walls show, and may lead. C++17; README.md tells how to build it in.
namespace vrut::client {

using Vector3 = std::array<double, 3>;
/// Row by row, for column vectors: element (row, column) is at [4 * row + column].
using Matrix4 = std::array<double, 16>;

/// The camera of the state document. The planes are not called near and far, which are macros on Windows.
struct Camera {
    Vector3 eye{0, 0, 5}, focus{0, 0, 0};  ///< world, in the scene's unit
    Vector3 up{0, 1, 0};                   ///< as it comes from the server: unit, at right angles to the view
    Vector3 center{0, 0, 0};               ///< of rotation
    double fov = 40;                       ///< vertical, degrees, 1 to 170
    double near_plane = 0.1, far_plane = 100;  ///< the server's, from the scene's bounds; never sent
};
bool operator==(const Camera& a, const Camera& b);
inline bool operator!=(const Camera& a, const Camera& b) { return !(a == b); }

/// View from world: right-handed, view along −z. Eye and focus must differ, and `up` not lie along the view.
Matrix4 view_matrix(const Camera& camera);
/// Clip from view: OpenGL's, clip z from −w to w. `aspect` is width / height.
Matrix4 projection_matrix(const Camera& camera, double aspect);

enum class Role { control, view, host };

/// How the server is spoken to by TLS, 1.2 or later. Its certificate is always verified.
struct Tls {
    std::string ca_file;      ///< PEM, of the authorities that are trusted; empty: those of the system
    std::string server_name;  ///< that the certificate must have; empty: Options::host
};

struct Options {
    /// A name, or better an address: a name is looked up by Asio's own thread.
    std::string host = "127.0.0.1";
    std::uint16_t port = 8080;
    std::string path = "/ws";  ///< of the WebSocket; that of a room at an edge is "/rooms/NAME/ws"
    std::optional<Tls> tls;    ///< none: without encryption
    std::string name;          ///< that others see
    std::string token;         ///< empty: none
    Role role = Role::host;
    std::chrono::milliseconds connect_timeout{5000};
    std::size_t max_message = std::size_t{64} << 20;  ///< bytes; who sends more is disconnected
};

/// What went wrong: an answer of the server, or the connection.
struct Problem {
    std::string code;                ///< one of the protocol's, or "connection"
    std::string message;             ///< a sentence for a person
    std::optional<std::int64_t> id;  ///< of the message that the server refused
};

/// How far the loading of a scene is.
struct Loading {
    std::string scene;
    double fraction = 0;
    bool done = false;
    std::string refused;  ///< a sentence; empty: it was not
};

/// What a client points at now.
struct Pointed {
    std::string client;            ///< its id
    std::string name;              ///< as others see it; empty: it has none
    std::optional<Vector3> point;  ///< world; none: it points at nothing any more
    Vector3 normal{0, 0, 1};       ///< of the surface there: unit, towards who points
};

/// Everything happens in the thread that calls, and callbacks come out of poll() alone. They may call the
/// other members, and what they throw comes out of poll(); nothing else does.
class PreviewClient {
public:
    /// Does nothing yet: the first poll() connects.
    explicit PreviewClient(Options options);
    ~PreviewClient();
    PreviewClient(const PreviewClient&) = delete;
    PreviewClient& operator=(const PreviewClient&) = delete;

    /// To be called once a frame. Handles what has come, and where nothing has, waits for it no longer than
    /// `wait`; zero returns at once. True when a callback was due. Connects by itself, and again after a
    /// loss, 0.25 to 4 s later; after a refusal (a wrong token) 30 s later.
    bool poll(std::chrono::milliseconds wait);

    bool connected() const;         ///< the server has sent its state
    std::int64_t revision() const;  ///< of the state below; that of the last connection after a loss
    const Camera& camera() const;   ///< that of the state below
    std::optional<std::int64_t> selection() const;  ///< the selected node's id
    /// The state document or the member at a JSON pointer ("/nodes", RFC 6901) as JSON; empty: there is none.
    std::string state_json(const std::string& pointer = {}) const;
    const std::string& client() const;  ///< the id that the server gave

    /// The walls now show this revision. Of reports that wait to be sent the newest goes.
    void report_shown(std::int64_t revision);

    // What steers returns the message's id, which comes back in `ok` or `error`, or 0 where nothing was sent:
    // there is no connection, too much waits, or it is no JSON object of finite numbers below 64 KiB.

    /// Patches the shared camera's eye, focus, up, center and fov. Call it when the host's own user moves,
    /// not every frame: whoever leads keeps the others from steering. Of poses that wait to be sent the
    /// newest goes, and only its id is answered.
    std::int64_t lead(const Camera& camera);
    /// A merge patch (RFC 7396) on the state; a host may patch `camera`, `nodes` and `selection`.
    std::int64_t patch(const std::string& json);

    /// The server's state has come, or the connection is lost.
    std::function<void(bool connected)> on_connection;
    /// The camera has changed, or a state came anew. `mine`: by this client's own patch, which a host that
    /// leads shows already.
    std::function<void(const Camera& camera, bool mine)> on_camera;
    /// The state has changed by `changes`, a merge patch as JSON; `whole`: it is the document itself.
    std::function<void(const std::string& changes, bool whole)> on_state;
    /// A scene is being loaded, has been, or is refused.
    std::function<void(const Loading&)> on_loading;
    /// Somebody points at something, or at nothing any more. Who does not say so within 2 s has been lost:
    /// hide the point then. When the connection is lost or a scene loaded, hide all.
    std::function<void(const Pointed&)> on_pointed;
    /// A connection that cannot be made or is lost is told once, not at each attempt.
    std::function<void(const Problem&)> on_error;
    /// Messages of all other types (`ok`, `stats`, …) as they came.
    std::function<void(const std::string& type, const std::string& json)> on_message;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vrut::client
