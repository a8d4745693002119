#include "net/addresses.hpp"

#include <doctest/doctest.h>

#include <stdexcept>

using namespace vrut;
using namespace vrut::server::net;

TEST_CASE("addresses to listen at") {
    CHECK(parse_listen_address("127.0.0.1:8080").port == 8080);
    CHECK(parse_listen_address("localhost:0").host == "127.0.0.1");
    CHECK(parse_listen_address("[::1]:80").host == "::1");
    for (const char* bad : {"", "8080", ":8080", "127.0.0.1", "127.0.0.1:", "127.0.0.1:x", "127.0.0.1:65536",
                            "127.0.0.1:-1", "300.0.0.1:80", "example.com:80", "127.0.0.1:80 "})
        CHECK_THROWS_AS_MESSAGE(parse_listen_address(bad), std::invalid_argument, bad);
}

TEST_CASE("which addresses are whose") {
    CHECK(is_loopback("127.0.0.1"));
    CHECK(is_loopback("::1"));
    CHECK_FALSE(is_loopback("0.0.0.0"));
    for (const char* address : {"127.0.0.1", "127.9.9.9", "::1", "::ffff:127.0.0.1"})
        CHECK_MESSAGE(is_loopback(boost::asio::ip::make_address(address)), address);
    for (const char* address : {"192.0.2.7", "::ffff:192.0.2.7", "fe80::1"})
        CHECK_FALSE_MESSAGE(is_loopback(boost::asio::ip::make_address(address)), address);
    CHECK(is_any("0.0.0.0"));
    CHECK(is_any("::"));
    for (const std::string& address : network_addresses()) CHECK_FALSE(is_loopback(address));
}

TEST_CASE("the addresses of a page") {
    CHECK(page_address("192.0.2.7", 80, false) == "http://192.0.2.7:80/");
    CHECK(page_address("::1", 8080, true) == "https://[::1]:8080/");
    CHECK(page_hosts("192.0.2.7") == std::vector<std::string>{"192.0.2.7"});
    CHECK_FALSE(page_hosts("0.0.0.0").empty());
    CHECK_FALSE(is_any(page_hosts("0.0.0.0").front()));
    for (const char* host : {"localhost", "localhost:8080", "127.0.0.1", "127.3.2.1:80", "[::1]", "[::1]:80"})
        CHECK_MESSAGE(names_loopback(host), host);
    for (const char* host : {"", "192.0.2.7:8080", "127.example.org", "localhost.example.org", "[::2]"})
        CHECK_FALSE_MESSAGE(names_loopback(host), host);
}

TEST_CASE("a QR code is a square of half blocks") {
    const std::string code = qr_code("http://192.0.2.7:8080/#token=0123456789abcdef0123456789abcdef");
    std::size_t lines = 0, columns = 0;
    for (std::size_t i = 0; i < code.size(); ++i) lines += code[i] == '\n';
    const std::string first = code.substr(0, code.find('\n'));
    for (const char c : first.substr(first.find('m') + 1))
        columns += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    columns -= 4;  // the closing escape sequence
    CHECK(lines * 2 >= columns);
    CHECK(lines * 2 <= columns + 1);
    CHECK(columns >= 25 + 4);
}
