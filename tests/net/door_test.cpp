#include <doctest/doctest.h>

#include <list>

#include "net/connection_limit.hpp"
#include "net/descriptors.hpp"
#include "net/http_request.hpp"
#include "net/view_pictures.hpp"

using namespace vrut;
using namespace vrut::server::net;
using namespace std::chrono_literals;

TEST_CASE("connections are limited in all and for each address; in IPv6 a network is one") {
    const auto address = [](const char* text) { return boost::asio::ip::make_address(text); };
    ConnectionLimit limit(4, 2);
    std::list<ConnectionLimit::Place> places;
    const auto enters = [&](const char* peer) {
        auto place = limit.enter(address(peer));
        if (place) places.push_back(*std::move(place));
        return place.has_value();
    };
    CHECK(enters("192.0.2.1"));
    CHECK(enters("::ffff:192.0.2.1"));
    CHECK_FALSE(enters("192.0.2.1"));
    CHECK(enters("2001:db8::1"));
    CHECK(enters("2001:db8::2"));
    CHECK_FALSE(enters("192.0.2.2"));  // four in all
    places.pop_front();
    CHECK(limit.count() == 3);
    CHECK_FALSE(enters("2001:db8::ffff:1"));
    CHECK(enters("2001:db8:0:1::1"));
    places.clear();
    CHECK(limit.count() == 0);
}

TEST_CASE("more descriptors than the system has are refused with a sentence") {
    CHECK_NOTHROW(allow_descriptors(16));
    CHECK_THROWS_WITH(allow_descriptors(std::size_t{1} << 40), doctest::Contains("lower --max-clients"));
}

TEST_CASE("a host is a name or a number, and a port") {
    for (const char* good :
         {"localhost", "a-b.example:80", "127.0.0.1:8080", "[::1]", "[::1]:65535", "my_pc"})
        CHECK_MESSAGE(is_host(good), good);
    for (const char* bad :
         {"",   ":80",  "a:",      "a:80:80", "a:123456", "a:-1",      "a b", "a;b", "a'b", "a/b", "a@b",
          "[]", "[::1", "[::1]80", "[::g]",   "a,b",      "a\xc3\xa4", "*.a", "a?b", "a#b", "a\"b"})
        CHECK_FALSE_MESSAGE(is_host(bad), bad);
}

TEST_CASE("a list of entity tags names one of them") {
    for (const char* list : {"\"a\"", "W/\"a\"", "\"b\", \"a\"", " \"b\" ,\t\"a\" ", "*"})
        CHECK_MESSAGE(names_tag(list, "\"a\""), list);
    for (const char* list : {"", "a", "\"A\"", "\"b\"", "\"aa\"", "w/\"a\"", ",,"})
        CHECK_FALSE_MESSAGE(names_tag(list, "\"a\""), list);
}
