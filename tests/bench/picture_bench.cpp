// /frame.jpg of a view that does not change, over one connection that is kept.
#include <doctest/doctest.h>
#include <poll.h>

#include <cstdio>

#include "audience.hpp"
#include "program.hpp"

using namespace vrut::test;
using Clock = std::chrono::steady_clock;

namespace {

/// One request after the other on a connection.
class Requests {
public:
    explicit Requests(std::uint16_t port) : socket_(port, {}) {}

    void send(const std::string& headers, int times = 1) {
        std::string text;
        for (int i = 0; i < times; ++i)
            text += "GET /frame.jpg HTTP/1.1\r\nHost: 127.0.0.1\r\n" + headers + "\r\n";
        REQUIRE(socket_.send(text));
    }
    /// Head of the next answer, whose body is left out.
    std::string receive() {
        std::size_t end = 0;
        while ((end = buffer_.find("\r\n\r\n")) == std::string::npos) read();
        const std::string head = buffer_.substr(0, end + 4);
        const std::size_t at = head.find("Content-Length: ");
        std::size_t whole = end + 4;
        if (at != std::string::npos && !head.starts_with("HTTP/1.1 304"))
            whole += std::stoul(head.substr(at + 16));
        while (buffer_.size() < whole) read();
        buffer_.erase(0, whole);
        return head;
    }

private:
    void read() {
        pollfd waited{socket_.descriptor(), POLLIN, 0};
        REQUIRE(poll(&waited, 1, 30'000) == 1);
        const std::string more = socket_.read(std::size_t{1} << 18);
        REQUIRE_FALSE(more.empty());
        buffer_ += more;
    }
    RawSocket socket_;
    std::string buffer_;
};

struct Speed {
    std::vector<double> us;           ///< one after the other
    double answers = 0, seconds = 0;  ///< sixteen on their way
};

void measure(Requests& requests, const std::string& headers, const std::string& expected, Speed& speed) {
    constexpr auto kLasts = 1s;
    constexpr int kOnTheirWay = 16;
    const auto receive = [&] {
        const std::string head = requests.receive();
        if (!head.starts_with(expected))
            FAIL("instead of " << expected << " after " << speed.us.size() << ": " << head);
    };
    for (const auto start = Clock::now(); Clock::now() - start < kLasts;) {
        const auto sent = Clock::now();
        requests.send(headers);
        receive();
        speed.us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - sent).count());
    }
    const auto start = Clock::now();
    requests.send(headers, kOnTheirWay);
    int answers = 0;
    for (; Clock::now() - start < kLasts; ++answers) {
        receive();
        requests.send(headers);
    }
    speed.answers += answers;
    speed.seconds += std::chrono::duration<double>(Clock::now() - start).count();
    for (int i = 0; i < kOnTheirWay; ++i) receive();
}

}  // namespace

TEST_CASE("the picture of a view that does not change") {
    Program program({"serve", VRUT_CARS "/car.vrut", "--listen", "127.0.0.1:0", "--log-level", "error"});
    const std::uint16_t port = program.port();
    REQUIRE(eventually([&] { return http(port, "GET", "/readyz").status == 200; }, 60s));
    Requests requests(port);
    requests.send("");
    const std::string head = requests.receive();
    const std::size_t at = head.find("ETag: ") + 6;
    const std::string match = "If-None-Match: " + head.substr(at, head.find("\r\n", at) - at) + "\r\n";
    Speed whole, unchanged;
    for (int round = 0; round < 5; ++round) {
        measure(requests, "", "HTTP/1.1 200", whole);
        measure(requests, match, "HTTP/1.1 304", unchanged);
    }
    std::printf("%-24s %10s %10s %10s %14s\n", "/frame.jpg, us", "p50", "p95", "p99", "16 at a time/s");
    for (auto* speed : {&whole, &unchanged})
        std::printf("%-24s %10.1f %10.1f %10.1f %14.0f\n", speed == &whole ? "200, whole" : "304, unchanged",
                    percentile(speed->us, 0.5), percentile(speed->us, 0.95), percentile(speed->us, 0.99),
                    speed->answers / speed->seconds);
}
