#include "slow_link.hpp"

#include <doctest/doctest.h>
#include <poll.h>
#include <sys/socket.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <future>
#include <optional>
#include <string>
#include <thread>

using namespace vrut::test_support;
using namespace std::chrono_literals;
namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

/// A client and a server, and between them a link that runs in a thread of its own.
class Ends {
public:
    explicit Ends(const LinkQuality& quality, std::optional<int> server_buffer = {})
        : acceptor_(context_, {asio::ip::address_v4::loopback(), 0}) {
        if (server_buffer) acceptor_.set_option(asio::socket_base::receive_buffer_size(*server_buffer));
        link_.emplace(link_context_, acceptor_.local_endpoint().port(), quality);
        port_ = link_->port();
        thread_ = std::thread([this] { link_context_.run(); });
        client.connect({asio::ip::address_v4::loopback(), port_});
        server = acceptor_.accept();
    }
    ~Ends() {
        link_context_.stop();
        thread_.join();
    }
    Ends(const Ends&) = delete;
    Ends& operator=(const Ends&) = delete;

    /// Returns when `what` has been done with the link.
    template <class What>
    void on_link(const What& what) {
        std::promise<void> done;
        asio::post(link_context_, [&] {
            what(*link_);
            done.set_value();
        });
        done.get_future().wait();
    }

private:
    asio::io_context context_, link_context_{1};
    tcp::acceptor acceptor_;
    std::optional<SlowLink> link_;
    std::uint16_t port_ = 0;
    std::thread thread_;

public:
    tcp::socket client{context_}, server{context_};
};

std::string bytes(std::size_t count, unsigned seed) {
    std::string all(count, '\0');
    for (char& each : all) each = static_cast<char>((seed = seed * 1664525 + 1013904223) >> 24);
    return all;
}

std::string read(tcp::socket& from, std::size_t count) {
    std::string all(count, '\0');
    asio::read(from, asio::buffer(all));
    return all;
}

error_code error_of_read(tcp::socket& from) {
    char byte = 0;
    error_code error;
    asio::read(from, asio::buffer(&byte, 1), error);
    return error;
}

}  // namespace

TEST_CASE("bytes arrive unchanged and in order, both ways at once") {
    constexpr std::size_t kBytes = 300'000;
    Ends ends({1e8, 1ms});
    const std::string up = bytes(kBytes, 1), down = bytes(kBytes, 2);
    std::thread client([&] { asio::write(ends.client, asio::buffer(up)); });
    std::thread server([&] { asio::write(ends.server, asio::buffer(down)); });
    auto received = std::async(std::launch::async, [&] { return read(ends.client, kBytes); });
    CHECK(read(ends.server, kBytes) == up);
    CHECK(received.get() == down);
    client.join();
    server.join();
}

TEST_CASE("nothing comes faster than the link's rate and delay allow, nor in a stall") {
    Ends ends({200'000, 20ms});
    const std::string sent = bytes(20'000, 1);
    Clock::time_point begin = Clock::now();
    std::thread client([&] { asio::write(ends.client, asio::buffer(sent)); });
    CHECK(read(ends.server, sent.size()) == sent);
    CHECK(Clock::now() - begin >= 100ms - 2ms + 20ms);
    client.join();

    begin = Clock::now();
    asio::write(ends.server, asio::buffer("x", 1));
    read(ends.client, 1);
    CHECK(Clock::now() - begin >= 20ms);

    const Clock::time_point end = Clock::now() + 100ms;
    ends.on_link([&](SlowLink& link) { link.stall_until(end); });
    asio::write(ends.server, asio::buffer("x", 1));
    read(ends.client, 1);
    CHECK(Clock::now() >= end);
}

TEST_CASE("a link's quality changes while bytes are on their way") {
    Ends ends({1000, 0ms});
    const std::string sent = bytes(100'000, 1);  // would take 100 s
    std::thread client([&] { asio::write(ends.client, asio::buffer(sent)); });
    read(ends.server, 64);
    ends.on_link([](SlowLink& link) { link.set_quality({1e8, 0ms}); });
    CHECK(read(ends.server, sent.size() - 64) == sent.substr(64));
    client.join();
}

TEST_CASE("the end of one direction is passed on after its bytes, and the other goes on") {
    Ends ends({1e6, 5ms});
    asio::write(ends.client, asio::buffer("question", 8));
    ends.client.shutdown(tcp::socket::shutdown_send);
    CHECK(read(ends.server, 8) == "question");
    CHECK(error_of_read(ends.server) == asio::error::eof);
    asio::write(ends.server, asio::buffer("answer", 6));
    ends.server.close();
    CHECK(read(ends.client, 6) == "answer");
    CHECK(error_of_read(ends.client) == asio::error::eof);
}

TEST_CASE("a sender whose bytes nobody takes is held back") {
    constexpr int kSmall = 4096;
    constexpr std::size_t kMost = 200'000;  // of the link's 100 kB on their way, and all buffers between
    Ends ends({1e6, 100ms}, kSmall);
    ends.client.set_option(asio::socket_base::send_buffer_size(kSmall));
    ends.client.non_blocking(true);
    const std::string piece = bytes(kSmall, 1);
    std::size_t taken = 0;
    pollfd writable{ends.client.native_handle(), POLLOUT, 0};
    while (taken <= kMost && ::poll(&writable, 1, 300) > 0) {
        error_code error;
        taken += ends.client.write_some(asio::buffer(piece), error);
    }
    CHECK(taken <= kMost);
}

TEST_CASE("a cut resets both ends") {
    Ends ends({1e6, 0ms});
    asio::write(ends.client, asio::buffer("x", 1));
    read(ends.server, 1);
    ends.on_link([](SlowLink& link) { link.cut(); });
    CHECK(error_of_read(ends.client) == asio::error::connection_reset);
    CHECK(error_of_read(ends.server) == asio::error::connection_reset);
}

TEST_CASE("the reset of one end reaches the other") {
    Ends ends({1e6, 0ms});
    asio::write(ends.client, asio::buffer("x", 1));
    read(ends.server, 1);
    ends.client.set_option(asio::socket_base::linger(true, 0));
    ends.client.close();
    CHECK(error_of_read(ends.server) == asio::error::connection_reset);
}
