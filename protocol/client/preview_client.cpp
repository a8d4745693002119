#include "preview_client.hpp"

#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <cmath>
#include <deque>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

namespace vrut::client {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;
namespace ssl = asio::ssl;
using TcpStream = beast::basic_stream<tcp, asio::io_context::executor_type>;
using PlainStream = websocket::stream<TcpStream>;
using TlsStream = websocket::stream<beast::ssl_stream<TcpStream>>;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::json;
using namespace std::chrono_literals;

namespace {

constexpr auto kFirstRetry = 250ms, kLastRetry = 4000ms, kRetryAfterRefusal = 30'000ms;
constexpr auto kIdle = 20s;  // a silent server is pinged after half of it and given up after all of it
constexpr auto kWork = 2ms;  // handling what has come may last so much longer than poll() was asked to
constexpr std::chrono::milliseconds kLongestWait = 1h;
constexpr std::size_t kMaxQueue = 64, kMaxMessage = 65'536;
constexpr double kPi = 3.14159265358979323846;

Vector3 minus(const Vector3& a, const Vector3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector3 cross(const Vector3& a, const Vector3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector3 normalized(const Vector3& v) {
    const double length = std::sqrt(dot(v, v));
    return {v[0] / length, v[1] / length, v[2] / length};
}

Camera read_camera(const Json& json) {
    Camera camera;
    json.at("eye").get_to(camera.eye);
    json.at("focus").get_to(camera.focus);
    json.at("up").get_to(camera.up);
    json.at("center").get_to(camera.center);
    json.at("fov").get_to(camera.fov);
    json.at("near").get_to(camera.near_plane);
    json.at("far").get_to(camera.far_plane);
    return camera;
}

bool is_finite(const Camera& camera) {
    for (const Vector3* v : {&camera.eye, &camera.focus, &camera.up, &camera.center})
        for (const double x : *v)
            if (!std::isfinite(x)) return false;
    return std::isfinite(camera.fov);
}

const char* name_of(Role role) {
    constexpr std::array kNames{"control", "view", "host"};
    return kNames[static_cast<std::size_t>(role)];
}

/// Whether an HTTP request can have it as its target.
bool is_path(const std::string& text) {
    return !text.empty() && text.front() == '/' &&
           std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~' && c != '#'; });
}

/// Throws boost::system::system_error where the authorities cannot be read.
ssl::context context_of(const Tls& options) {
    ssl::context context(ssl::context::tls_client);
    SSL_CTX_set_min_proto_version(context.native_handle(), TLS1_2_VERSION);
    context.set_verify_mode(ssl::verify_peer);
    if (options.ca_file.empty())
        context.set_default_verify_paths();
    else
        context.load_verify_file(options.ca_file);
    return context;
}

/// Why a certificate is refused, and what to do; `name` is the one that it must have.
std::string certificate_sentence(long verified, const std::string& name) {
    switch (verified) {
        case X509_V_ERR_HOSTNAME_MISMATCH:
        case X509_V_ERR_IP_ADDRESS_MISMATCH:
            return "its certificate is not for '" + name +
                   "': connect by a name that it has, or set the server name to one";
        case X509_V_ERR_CERT_HAS_EXPIRED:
            return "its certificate has expired: renew it, or set the clock of this machine";
        case X509_V_ERR_CERT_NOT_YET_VALID:
            return "its certificate is not valid yet: set the clock of this machine";
        case X509_V_ERR_DEPTH_ZERO_SELF_SIGNED_CERT:
        case X509_V_ERR_SELF_SIGNED_CERT_IN_CHAIN:
        case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT:
        case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT_LOCALLY:
        case X509_V_ERR_UNABLE_TO_VERIFY_LEAF_SIGNATURE:
            return "its certificate is not signed by an authority that is trusted here: name the file of its "
                   "authority";
        default:
            return std::string("its certificate is refused: ") + X509_verify_cert_error_string(verified);
    }
}

/// One connection, and all that its pending operations use: they keep it alive.
struct Connection {
    explicit Connection(asio::io_context& context)
        : resolver(context), stream(std::in_place_type<PlainStream>, context) {}
    Connection(asio::io_context& context, const Tls& options)
        : resolver(context), tls(context_of(options)), stream(std::in_place_type<TlsStream>, context, *tls) {}

    /// Calls `use` with the WebSocket.
    template <class Use>
    decltype(auto) with(Use use) {
        return std::visit(use, stream);
    }
    TcpStream& tcp_stream() {
        return with([](auto& socket) -> TcpStream& { return beast::get_lowest_layer(socket); });
    }

    tcp::resolver resolver;
    std::optional<ssl::context> tls;
    std::variant<PlainStream, TlsStream> stream;
    std::vector<tcp::endpoint> endpoints;
    websocket::response_type response;
    beast::flat_buffer incoming;
    std::string outgoing;
    bool open = false, reading = false, writing = false, welcomed = false;
    std::optional<Problem> refusal;  // what the server said before `welcome`
};

}  // namespace

bool operator==(const Camera& a, const Camera& b) {
    return a.eye == b.eye && a.focus == b.focus && a.up == b.up && a.center == b.center && a.fov == b.fov &&
           a.near_plane == b.near_plane && a.far_plane == b.far_plane;
}

Matrix4 view_matrix(const Camera& camera) {
    const Vector3 back = normalized(minus(camera.eye, camera.focus));
    const Vector3 right = normalized(cross(camera.up, back));
    const Vector3 up = cross(back, right);
    return {right[0], right[1], right[2], -dot(right, camera.eye),  //
            up[0],    up[1],    up[2],    -dot(up, camera.eye),     //
            back[0],  back[1],  back[2],  -dot(back, camera.eye),   //
            0,        0,        0,        1};
}

Matrix4 projection_matrix(const Camera& camera, double aspect) {
    const double cotangent = 1 / std::tan(camera.fov * kPi / 360), across = cotangent / aspect;
    const double near_plane = camera.near_plane, far_plane = camera.far_plane, depth = far_plane - near_plane;
    const double a = -(far_plane + near_plane) / depth, b = -2 * far_plane * near_plane / depth;
    return {across, 0,         0,  0,  //
            0,      cotangent, 0,  0,  //
            0,      0,         a,  b,  //
            0,      0,         -1, 0};
}

struct PreviewClient::Impl {
    Impl(PreviewClient& owner, Options wanted) : self(owner), options(std::move(wanted)) { connect(); }

    bool poll(std::chrono::milliseconds wait);
    void run(Clock::time_point end);

    void connect();
    void connect_to_endpoints();
    void handshake_tls();
    void handshake();
    void on_handshake(error_code error);
    void read();
    void on_read(error_code error);
    void write();
    void lose(Problem problem, bool refused);

    void take(const std::string& text);
    std::function<void()> read_message(const std::string& text);
    std::function<void()> read_welcome(const Json& message);
    std::function<void()> read_state(Json message, bool whole);
    std::function<void()> read_pointed(const Json& message);
    std::function<void()> read_error(const Json& message);

    enum class Kind { hello, shown, lead, patch };
    bool enqueue(Kind kind, const Json& message);
    std::int64_t steer(Kind kind, const Json& patch);

    /// A handler of an operation on the present connection: what comes from an earlier one is dropped.
    template <class Function>
    auto on_present(Function function) {
        return [this, mine = connection, function](error_code error,
                                                   auto&&... values) -> decltype(function(error, values...)) {
            if (mine == connection) function(error, values...);
        };
    }
    Problem connection_problem(const std::string& what) const {
        return {"connection", "VRUT Preview at " + address() + ": " + what, std::nullopt};
    }
    std::string address() const {
        const bool v6 = options.host.find(':') != std::string::npos;
        return (v6 ? "[" + options.host + "]" : options.host) + ":" + std::to_string(options.port);
    }

    PreviewClient& self;
    const Options options;
    asio::io_context context{1};
    asio::steady_timer retry{context};
    std::shared_ptr<Connection> connection;
    std::chrono::milliseconds next_retry = kFirstRetry;
    std::string told;  // the connection problem that was told last
    bool polling = false;

    // What has happened and is not told yet. Callbacks are called from poll(), never inside an operation.
    std::deque<std::function<void()>> events;
    struct Waiting {
        Kind kind;
        std::string text;
    };
    std::deque<Waiting> queue;
    std::int64_t last_id = 0, last_shown = 0;

    bool connected = false;
    std::string client;
    std::int64_t revision = 0;
    Json state;
    Camera camera;
    std::optional<std::int64_t> selection;
};

// --- the host's loop

bool PreviewClient::Impl::poll(std::chrono::milliseconds wait) {
    if (polling) return false;  // a callback must not
    struct Guard {
        bool& flag;
        ~Guard() { flag = false; }
    } guard{polling = true};
    const auto end = Clock::now() + (std::min)((std::max)(wait, std::chrono::milliseconds(0)), kLongestWait);
    bool happened = false;
    do {
        read();
        run(happened ? Clock::now() : end);
        if (events.empty()) break;
        happened = true;
        const auto event = std::move(events.front());
        events.pop_front();
        event();
    } while (Clock::now() < end + kWork);
    read();
    return happened;
}

/// Runs what is ready and, until something has happened, what gets ready before `end`.
void PreviewClient::Impl::run(Clock::time_point end) {
    context.restart();
    while (events.empty() && Clock::now() < end + kWork)
        if (context.poll_one() == 0 && (Clock::now() >= end || context.run_one_until(end) == 0)) return;
}

// --- the connection

void PreviewClient::Impl::connect() {
    if (!is_path(options.path))
        return lose(connection_problem("the path '" + options.path +
                                       "' must begin with '/', and have ASCII characters alone, no space "
                                       "and no '#'"),
                    true);
    try {
        connection = options.tls ? std::make_shared<Connection>(context, *options.tls)
                                 : std::make_shared<Connection>(context);
    } catch (const boost::system::system_error& error) {
        return lose(connection_problem("the authorities in '" + options.tls->ca_file +
                                       "' cannot be read: " + error.code().message()),
                    true);
    }
    error_code not_an_address;
    const auto numeric = asio::ip::make_address(options.host, not_an_address);
    if (!not_an_address) {
        connection->endpoints = {tcp::endpoint(numeric, options.port)};
        return connect_to_endpoints();
    }
    connection->resolver.async_resolve(
        options.host, std::to_string(options.port),
        on_present([this](error_code error, const tcp::resolver::results_type& results) {
            if (error) return lose(connection_problem(error.message()), false);
            for (const auto& result : results) connection->endpoints.push_back(result.endpoint());
            connect_to_endpoints();
        }));
}

void PreviewClient::Impl::connect_to_endpoints() {
    TcpStream& stream = connection->tcp_stream();
    stream.expires_after(options.connect_timeout);
    stream.async_connect(connection->endpoints, on_present([this](error_code error, const tcp::endpoint&) {
                             if (error) return lose(connection_problem(error.message()), false);
                             handshake_tls();
                         }));
}

/// TLS's own handshake, where there is TLS.
void PreviewClient::Impl::handshake_tls() {
    auto* const websocket = std::get_if<TlsStream>(&connection->stream);
    if (websocket == nullptr) return handshake();
    SSL* const tls = websocket->next_layer().native_handle();
    std::string name = options.tls->server_name.empty() ? options.host : options.tls->server_name;
    X509_VERIFY_PARAM* const verified = SSL_get0_param(tls);
    if (X509_VERIFY_PARAM_set1_ip_asc(verified, name.c_str()) != 1) {  // it is no address
        X509_VERIFY_PARAM_set_hostflags(verified, X509_CHECK_FLAG_NO_PARTIAL_WILDCARDS);
        if (X509_VERIFY_PARAM_set1_host(verified, name.data(), name.size()) != 1 ||
            SSL_ctrl(tls, SSL_CTRL_SET_TLSEXT_HOSTNAME, TLSEXT_NAMETYPE_host_name, name.data()) != 1)
            return lose(connection_problem("'" + name + "' is no name that a certificate can have"), true);
    }
    websocket->next_layer().async_handshake(
        ssl::stream_base::client, [this, tls, name, mine = connection](error_code error) {
            if (mine != connection) return;
            if (!error) return handshake();
            const long refused = SSL_get_verify_result(tls);
            if (refused == X509_V_OK) return lose(connection_problem("TLS fails: " + error.message()), false);
            lose(connection_problem(certificate_sentence(refused, name)), true);
        });
}

void PreviewClient::Impl::handshake() {
    error_code ignored;
    TcpStream& tcp_stream = connection->tcp_stream();
    tcp_stream.socket().set_option(tcp::no_delay(true), ignored);
    tcp_stream.expires_never();  // from here on the WebSocket's own deadlines hold
    websocket::stream_base::timeout deadlines{};
    deadlines.handshake_timeout = options.connect_timeout;
    deadlines.idle_timeout = kIdle;
    deadlines.keep_alive_pings = true;
    connection->with([&](auto& stream) {
        stream.set_option(deadlines);
        stream.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
            request.set(beast::http::field::sec_websocket_protocol, "vrut-preview.v1");
        }));
        stream.read_message_max(options.max_message);
        stream.async_handshake(connection->response, address(), options.path,
                               on_present([this](error_code error) { on_handshake(error); }));
    });
}

void PreviewClient::Impl::on_handshake(error_code error) {
    if (error == websocket::error::upgrade_declined) {
        const auto& response = connection->response;
        const unsigned status = response.result_int();
        const std::string sentence = response.body().substr(0, response.body().find('\n')).substr(0, 300);
        return lose(connection_problem("it declines: HTTP " + std::to_string(status) + ", " + sentence),
                    status >= 400 && status < 500);
    }
    if (error) return lose(connection_problem(error.message()), false);
    connection->open = true;
    Json hello = {{"type", "hello"}, {"role", name_of(options.role)}};
    if (!options.name.empty()) hello["name"] = options.name;
    if (!options.token.empty()) hello["token"] = options.token;
    if (!enqueue(Kind::hello, hello)) lose(connection_problem("name and token are too long"), true);
}

/// Waits for the next message; one at a time, so that no more than one has to be held.
void PreviewClient::Impl::read() {
    if (!connection || !connection->open || connection->reading) return;
    connection->reading = true;
    connection->with([this](auto& stream) {
        stream.async_read(connection->incoming,
                          on_present([this](error_code error, std::size_t) { on_read(error); }));
    });
}

void PreviewClient::Impl::on_read(error_code error) {
    if (error == websocket::error::closed) {
        const auto reason = connection->with([](auto& stream) { return stream.reason(); });
        const std::string why(reason.reason.data(), reason.reason.size());
        const Problem problem = connection_problem("it closes: " + std::to_string(reason.code) + " " + why);
        return lose(connection->refusal.value_or(problem),
                    reason.code == websocket::close_code::policy_error);
    }
    if (error) return lose(connection->refusal.value_or(connection_problem(error.message())), false);
    std::string text = beast::buffers_to_string(connection->incoming.data());
    connection->incoming.clear();
    connection->incoming.shrink_to_fit();
    events.emplace_back([this, mine = connection, text = std::move(text)] {
        mine->reading = false;
        if (mine == connection && mine->with([](auto& stream) { return stream.got_text(); })) take(text);
    });
}

/// Ends the connection and sets the time of the next attempt.
void PreviewClient::Impl::lose(Problem problem, bool refused) {
    if (connection) connection->tcp_stream().close();
    connection.reset();
    queue.clear();
    const bool was_connected = std::exchange(connected, false);
    retry.expires_after(refused ? kRetryAfterRefusal : next_retry);
    next_retry = (std::min)(2 * next_retry, std::chrono::milliseconds(kLastRetry));
    retry.async_wait([this](error_code stopped) {
        if (!stopped) connect();
    });
    const bool known = told == problem.message;
    told = problem.message;
    events.emplace_back([this, was_connected, known, problem = std::move(problem)] {
        if (!known && self.on_error) self.on_error(problem);
        if (was_connected && self.on_connection) self.on_connection(false);
    });
}

// --- what the server says

/// What a message says is read first and told second: what a callback throws is the host's own.
void PreviewClient::Impl::take(const std::string& text) {
    std::function<void()> news;
    try {
        news = read_message(text);
    } catch (const std::exception& error) {
        return lose(connection_problem(std::string("its message cannot be understood: ") + error.what()),
                    false);
    }
    if (news) news();
}

std::function<void()> PreviewClient::Impl::read_message(const std::string& text) {
    Json message = Json::parse(text);
    const auto type = message.at("type").get<std::string>();
    if (type == "welcome") return read_welcome(message);
    if (type == "state") return read_state(std::move(message), true);
    if (type == "patch" && connected) return read_state(std::move(message), false);
    if (type == "error") return read_error(message);
    if (type == "loading") {
        return
            [this, loading = Loading{message.at("scene").get<std::string>(), message.value("fraction", 0.0),
                                     message.value("done", false), message.value("refused", "")}] {
                if (self.on_loading) self.on_loading(loading);
            };
    }
    if (type == "pointed") return read_pointed(message);
    return [this, type, text] {
        if (self.on_message) self.on_message(type, text);
    };
}

std::function<void()> PreviewClient::Impl::read_welcome(const Json& message) {
    if (message.at("version") != 1) throw std::runtime_error("it does not speak version 1");
    message.at("client").get_to(client);
    const auto limit = message.at("limits").value("maxServerMessage", options.max_message);
    if (limit > 0)
        connection->with(
            [&](auto& stream) { stream.read_message_max((std::min)(options.max_message, limit)); });
    connection->welcomed = true;
    last_id = last_shown = 0;
    return nullptr;
}

std::function<void()> PreviewClient::Impl::read_state(Json message, bool whole) {
    Json& changes = message.at(whole ? "state" : "patch");
    std::string text = self.on_state ? changes.dump() : std::string();
    const bool mine = message.value("by", "") == client;
    message.at("revision").get_to(revision);
    if (whole)
        state = std::move(changes);
    else
        state.merge_patch(changes);
    const Camera before = std::exchange(camera, read_camera(state.at("camera")));
    const bool moved = whole || camera != before;
    const Json& selected = state.at("selection");
    selection.reset();
    if (selected.contains("node")) selection = selected["node"].get<std::int64_t>();
    const bool joined = !std::exchange(connected, true);
    next_retry = kFirstRetry;
    told.clear();
    return [this, text = std::move(text), whole, mine, moved, joined] {
        if (joined && self.on_connection) self.on_connection(true);
        if (self.on_state) self.on_state(text, whole);
        if (moved && self.on_camera) self.on_camera(camera, mine);
    };
}

std::function<void()> PreviewClient::Impl::read_pointed(const Json& message) {
    Pointed pointed;
    message.at("client").get_to(pointed.client);
    pointed.name = message.value("name", "");
    if (message.contains("point")) {
        pointed.point = message["point"].get<Vector3>();
        message.at("normal").get_to(pointed.normal);
    }
    return [this, pointed = std::move(pointed)] {
        if (self.on_pointed) self.on_pointed(pointed);
    };
}

std::function<void()> PreviewClient::Impl::read_error(const Json& message) {
    Problem problem{message.at("code").get<std::string>(), message.at("message").get<std::string>(), {}};
    if (message.contains("id")) problem.id = message["id"].get<std::int64_t>();
    if (!connection->welcomed) {
        connection->refusal = std::move(problem);  // told when the server has closed
        return nullptr;
    }
    return [this, problem = std::move(problem)] {
        if (self.on_error) self.on_error(problem);
    };
}

// --- what is said to the server

/// The newest report or pose takes the place of one that waits, unless a patch came between them.
bool PreviewClient::Impl::enqueue(Kind kind, const Json& message) {
    std::string text = message.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (text.size() > kMaxMessage) return false;
    const auto barrier =
        std::find_if(queue.rbegin(), queue.rend(), [](const auto& w) { return w.kind == Kind::patch; });
    const auto same = std::find_if(queue.rbegin(), barrier, [kind](const auto& w) { return w.kind == kind; });
    if (same != barrier) {
        same->text = std::move(text);
    } else {
        if (queue.size() >= kMaxQueue) return false;
        queue.push_back({kind, std::move(text)});
    }
    write();
    return true;
}

void PreviewClient::Impl::write() {
    if (connection->writing || queue.empty()) return;
    connection->writing = true;
    connection->outgoing = std::move(queue.front().text);
    queue.pop_front();
    connection->with([this](auto& stream) {
        stream.text(true);
        stream.async_write(asio::buffer(connection->outgoing),
                           on_present([this](error_code error, std::size_t) {
                               connection->writing = false;
                               if (!error) write();  // async_read reports the error
                           }));
    });
}

std::int64_t PreviewClient::Impl::steer(Kind kind, const Json& patch) {
    if (!connected) return 0;
    const std::int64_t id = last_id + 1;
    if (!enqueue(kind, {{"type", "patch"}, {"id", id}, {"patch", patch}})) return 0;
    return last_id = id;
}

// --- the interface

PreviewClient::PreviewClient(Options options) : impl_(std::make_unique<Impl>(*this, std::move(options))) {}
PreviewClient::~PreviewClient() = default;

bool PreviewClient::poll(std::chrono::milliseconds wait) { return impl_->poll(wait); }
bool PreviewClient::connected() const { return impl_->connected; }
std::int64_t PreviewClient::revision() const { return impl_->revision; }
const Camera& PreviewClient::camera() const { return impl_->camera; }
const std::string& PreviewClient::client() const { return impl_->client; }
std::optional<std::int64_t> PreviewClient::selection() const { return impl_->selection; }

std::string PreviewClient::state_json(const std::string& pointer) const {
    if (impl_->state.is_null()) return {};
    try {
        return impl_->state.at(Json::json_pointer(pointer)).dump();
    } catch (const Json::exception&) {
        return {};
    }
}

void PreviewClient::report_shown(std::int64_t revision) {
    // A revision from before a reconnection may be one that a restarted server has not reached.
    if (!impl_->connected || revision == impl_->last_shown || revision > impl_->revision) return;
    if (impl_->enqueue(Impl::Kind::shown, {{"type", "shown"}, {"revision", revision}}))
        impl_->last_shown = revision;
}

std::int64_t PreviewClient::lead(const Camera& camera) {
    if (!is_finite(camera)) return 0;
    return impl_->steer(Impl::Kind::lead, {{"camera",
                                            {{"eye", camera.eye},
                                             {"focus", camera.focus},
                                             {"up", camera.up},
                                             {"center", camera.center},
                                             {"fov", camera.fov}}}});
}

std::int64_t PreviewClient::patch(const std::string& json) {
    const Json patch = Json::parse(json, nullptr, false);
    return patch.is_object() ? impl_->steer(Impl::Kind::patch, patch) : 0;
}

}  // namespace vrut::client
