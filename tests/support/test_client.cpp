#include "test_client.hpp"

#include <doctest/doctest.h>
#include <spdlog/spdlog.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <cmath>
#include <random>

#include "engine/frame_quality.hpp"
#include "frame_header.hpp"
#include "io/vrut/text_reader.hpp"
#include "plan/render_job.hpp"
#include "plan/view.hpp"
#include "temporary_folder.hpp"

namespace vrut::test {

namespace asio = boost::asio;
namespace beast = boost::beast;
using asio::ip::tcp;

namespace {

constexpr const char* kScene = R"(vrut-text 1
geometry 1 vertices 3 -1 -1 0  1 -1 0  0 1 1 triangles 1 0 1 2 end
node 1 "Triangle" geometry geometry 1 hinge 0 1 0 90 end
node 2 "Studio" background active 0 end
)";

Json header_of(const std::string& jpeg) {
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(jpeg.data()), jpeg.size());
    const std::size_t at = protocol::comment_offset(bytes);
    REQUIRE(bytes[at] == 0xFF);
    REQUIRE(bytes[at + 1] == 0xFE);
    const std::size_t length = static_cast<std::size_t>(bytes[at + 2]) << 8 | bytes[at + 3];
    return Json::parse(jpeg.substr(at + 4, length - 2));
}

}  // namespace

server::scenes::LoadedScene scene_of(const std::string& text, const std::string& name) {
    auto scene = io::read_vrut_text(text, name);
    REQUIRE_MESSAGE(scene.has_value(), scene.error());
    return {name, "", std::make_shared<const scene::PlacedScene>(scene::place(*std::move(scene))), {}};
}

/// Copied from what is made once: byte by byte it would take long under the sanitizers.
static void fill_with_noise(std::vector<std::uint8_t>& bytes, std::size_t seed) {
    constexpr std::size_t kPiece = 1 << 16;
    static const std::vector<std::uint8_t> noise = [] {
        std::vector<std::uint8_t> made(2 * kPiece);
        std::generate(made.begin(), made.end(), [random = std::minstd_rand()]() mutable {
            return static_cast<std::uint8_t>(random());
        });
        return made;
    }();
    const auto from = noise.begin() + static_cast<std::ptrdiff_t>(seed % kPiece);
    for (std::size_t at = 0; at < bytes.size(); at += kPiece)
        std::copy_n(from, std::min(kPiece, bytes.size() - at),
                    bytes.begin() + static_cast<std::ptrdiff_t>(at));
}

server::engine::FrameRendererFactory FakeRenderer::factory() const {
    return [*this] {
        server::engine::FrameRenderer renderer{"fake", false, 16384, {}};
        renderer.step = [*this](plan::RenderJob& rendering) {
            if (rendering.samples == 0 || rendering.samples < rendering.view.samples) {
                if (takes.count() > 0) std::this_thread::sleep_for(takes);
                if (++rendering.samples < rendering.view.samples) return false;
            }
            scene::Image& image = rendering.image;
            image.resize(rendering.view.width, rendering.view.height);
            const double x = std::abs(rendering.view.camera.eye.x);
            std::fill(image.rgba.begin(), image.rgba.end(),
                      static_cast<std::uint8_t>(std::fmod(x * 40, 256)));
            if (noise) fill_with_noise(image.rgba, static_cast<std::size_t>(x * 1000));
            return true;
        };
        return renderer;
    };
}

server::net::ServerOptions with_tls() {
    const TemporaryFolder folder;
    server::net::ServerOptions options;
    options.tls = std::make_shared<server::net::Tls>(
        server::net::CertificateAuthority(folder.path() / "authority.pem"));
    return options;
}

TestServer::TestServer(const FakeRenderer& renderer, const server::net::ServerOptions& options)
    : TestServer(scene_of(kScene, "triangle.vrut"), renderer.factory(), options) {}

TestServer::TestServer(server::scenes::LoadedScene scene,
                       const server::engine::FrameRendererFactory& renderer,
                       server::net::ServerOptions options) {
    spdlog::set_level(spdlog::level::off);
    options.listen.port = 0;
    server_ = std::make_unique<server::net::Server>(std::move(options), std::move(scene), renderer);
    thread_ = std::thread([this] { server_->run(); });
}

TestServer::~TestServer() { stop(); }

std::chrono::milliseconds TestServer::stop() {
    const auto start = std::chrono::steady_clock::now();
    if (thread_.joinable()) {
        server_->stop();
        thread_.join();
    }
    return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - start);
}

struct TestClient::Impl {
    asio::io_context context{1};
    beast::websocket::stream<tcp::socket> socket{context};
    beast::flat_buffer buffer;
    beast::websocket::response_type response;
    bool reading = false, arrived = false, ended = false;
    beast::error_code error;
};

TestClient::TestClient(std::uint16_t port, const ConnectOptions& options) : impl_(std::make_unique<Impl>()) {
    tcp::socket& tcp_socket = impl_->socket.next_layer();
    tcp_socket.open(tcp::v4());
    if (options.receive_buffer > 0)
        tcp_socket.set_option(asio::socket_base::receive_buffer_size(options.receive_buffer));
    tcp_socket.connect({asio::ip::make_address("127.0.0.1"), port});
    tcp_socket.set_option(tcp::no_delay(true));
    impl_->socket.set_option(
        beast::websocket::stream_base::decorator([&](beast::websocket::request_type& request) {
            if (!options.subprotocol.empty())
                request.set(beast::http::field::sec_websocket_protocol, options.subprotocol);
            if (!options.origin.empty()) request.set(beast::http::field::origin, options.origin);
        }));
    impl_->socket.read_message_max(std::size_t{1} << 28);
    const std::string host = options.host.empty() ? "127.0.0.1:" + std::to_string(port) : options.host;
    beast::error_code refused;
    impl_->socket.handshake(impl_->response, host, "/ws", refused);
}

TestClient::~TestClient() = default;

int TestClient::status() const { return static_cast<int>(impl_->response.result_int()); }

std::string TestClient::subprotocol() const {
    return std::string(impl_->response[beast::http::field::sec_websocket_protocol]);
}

void TestClient::send(const Json& message) {
    if (message.contains("id") && message["id"].is_number_integer())
        last_id_ = std::max(last_id_, message["id"].get<std::int64_t>());
    send_text(message.dump());
}

void TestClient::send_text(const std::string& text) {
    impl_->socket.text(true);
    beast::error_code ignored;  // the server may have closed; the test sees that when it reads
    impl_->socket.write(asio::buffer(text), ignored);
}

void TestClient::send_binary(const std::string& bytes) {
    impl_->socket.binary(true);
    beast::error_code ignored;
    impl_->socket.write(asio::buffer(bytes), ignored);
}

Json TestClient::Message::json() const { return binary ? header_of(data) : Json::parse(data); }

std::optional<TestClient::Message> TestClient::receive(std::chrono::milliseconds timeout) {
    Impl& impl = *impl_;
    if (impl.ended) return std::nullopt;
    if (!impl.reading) {
        impl.reading = true;
        impl.arrived = false;
        impl.socket.async_read(impl.buffer, [&impl](beast::error_code error, std::size_t) {
            impl.reading = false;
            impl.arrived = true;
            impl.error = error;
        });
    }
    impl.context.restart();
    const auto end = std::chrono::steady_clock::now() + timeout;
    while (!impl.arrived && std::chrono::steady_clock::now() < end) impl.context.run_one_until(end);
    if (!impl.arrived) return std::nullopt;
    if (impl.error) {
        impl.ended = true;
        return std::nullopt;
    }
    Message message;
    message.binary = impl.socket.got_binary();
    message.data = beast::buffers_to_string(impl.buffer.data());
    impl.buffer.consume(impl.buffer.size());
    if (message.binary && message.data[0] != '\xFF') return message;
    const Json json = message.json();
    if (message.binary && !json.contains("snapshot")) newest_frame = json["frame"];
    if (message.binary) return message;
    if (json["type"] == "stats" && !takes_stats) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
        return receive(std::max(left, 0ms));
    }
    if (json["type"] == "state") state = json["state"];
    if (json["type"] == "patch") state.merge_patch(json["patch"]);
    return message;
}

Json TestClient::wait_for(const std::string& type, std::chrono::milliseconds timeout) {
    takes_stats = takes_stats || type == "stats";
    const auto end = std::chrono::steady_clock::now() + timeout;
    for (;;) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
        const auto message = receive(std::max(left, 0ms));
        REQUIRE_MESSAGE(message.has_value(), "no '" << type << "' came");
        Json json = message->json();
        if (message->binary ? type == "frame" : json["type"] == type) return json;
    }
}

void TestClient::grant() {
    Json message{{"type", "frame"}};
    if (newest_frame > 0) message["shown"] = newest_frame;
    send(message);
}

void TestClient::wait_for_notice(const std::string& sentence) {
    const auto has_come = [&] {
        const Json notices = state.value("notices", Json::array());
        return std::any_of(notices.begin(), notices.end(), [&](const Json& notice) {
            return notice["message"].get<std::string>().starts_with(sentence);
        });
    };
    while (!has_come()) wait_for("patch");
}

int TestClient::wait_for_close(std::chrono::milliseconds timeout) {
    const auto end = std::chrono::steady_clock::now() + timeout;
    while (!impl_->ended) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
        if (left < 0ms) return 0;
        receive(left);
    }
    // Beast tells of another error where the server was quicker to close than the answer to its close frame.
    const int code = impl_->socket.reason().code;
    return code != 0 ? code : 1006;
}

Json TestClient::join(const std::string& role, const std::string& token, const std::string& resume_key) {
    Json hello = {{"type", "hello"}, {"role", role}};
    if (!token.empty()) hello["token"] = token;
    if (!resume_key.empty()) hello["resume"] = resume_key;
    send(hello);
    wait_for("welcome");
    wait_for("state");
    return state;
}

Json TestClient::wait_for_still(std::chrono::milliseconds for_each) {
    for (;;) {
        grant();
        Json header = wait_for("frame", for_each);
        if (header["quality"]["samples"] == server::engine::kRefined.samples) return header;
    }
}

HttpAnswer http(std::uint16_t port, const std::string& method, const std::string& target,
                const std::string& headers) {
    asio::io_context context;
    tcp::socket socket(context);
    socket.connect({asio::ip::make_address("127.0.0.1"), port});
    asio::write(socket, asio::buffer(method + " " + target + " HTTP/1.1\r\n" + headers +
                                     "Connection: close\r\n\r\n"));
    std::string text;
    beast::error_code error;
    asio::read(socket, asio::dynamic_buffer(text), error);
    HttpAnswer answer;
    if (text.size() > 12) answer.status = std::stoi(text.substr(9, 3));
    const std::size_t end = text.find("\r\n\r\n");
    answer.headers = text.substr(0, end);
    if (end != std::string::npos) answer.body = text.substr(end + 4);
    return answer;
}

Json pointer_event(const char* type, double x, double y, const char* device, int button, unsigned buttons,
                   int pointer) {
    return {{"type", type}, {"pointerId", pointer}, {"pointerType", device}, {"x", x},
            {"y", y},       {"button", button},     {"buttons", buttons}};
}

}  // namespace vrut::test
