#include "net/bodies_sent.hpp"

#include <doctest/doctest.h>

#include <numeric>
#include <vector>

#include "raw_connection.hpp"

using namespace vrut;
using namespace vrut::test;
using server::net::BodiesSent;

namespace {

BodiesSent::Body body_of(std::size_t bytes) { return std::make_shared<const std::string>(bytes, 'x'); }

}  // namespace

TEST_CASE(
    "bodies that are sent: the oldest is cut where they would be too many, and a shared one counts once") {
    BodiesSent bodies(100);
    std::vector<int> cut;
    const auto add = [&](const BodiesSent::Body& body, int number) {
        return bodies.add(body, [&cut, number] { cut.push_back(number); });
    };
    const auto shared = body_of(60);
    auto first = add(shared, 1), second = add(shared, 2), third = add(body_of(40), 3);
    CHECK(bodies.bytes() == 100);
    CHECK(cut.empty());
    second.reset();
    CHECK(bodies.bytes() == 100);
    auto fourth = add(body_of(1), 4);
    CHECK(cut == std::vector{1});
    CHECK(bodies.bytes() == 41);
    first.reset();  // it was cut: it does not count twice
    CHECK(bodies.bytes() == 41);
    auto large = add(body_of(500), 5);  // one alone may be larger
    CHECK(cut == std::vector{1, 3, 4});
    CHECK(bodies.bytes() == 500);
    large.reset();
    third.reset();
    fourth.reset();
    CHECK(bodies.bytes() == 0);
}

TEST_CASE("who takes no image is cut before many of them hold the server's memory, and others get theirs") {
    TestServer server({.noise = true});
    constexpr int kImages = 40, kSide = 1500;
    std::vector<std::unique_ptr<RawConnection>> idle;
    std::vector<std::size_t> sizes;
    for (int i = 0; i < kImages; ++i) {
        const std::string request = "GET /frame.jpg?width=" + std::to_string(kSide + i) +
                                    "&height=" + std::to_string(kSide) +
                                    " HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";
        RawConnection reader(server.port());
        idle.push_back(std::make_unique<RawConnection>(server.port()));
        idle.back()->send(request);
        reader.send(request);
        const HttpAnswer answer = reader.answer();
        REQUIRE(answer.status == 200);
        sizes.push_back(answer.body.size());
    }
    REQUIRE(std::accumulate(sizes.begin(), sizes.end(), std::size_t{0}) > std::size_t{150} << 20);
    CHECK(idle.front()->answer().body.size() < sizes.front());
    CHECK(idle.back()->answer().body.size() == sizes.back());
}
