// What RFC 9112 lets a server refuse, and what a request could be hidden in, over raw sockets.
#include <doctest/doctest.h>

#include "raw_connection.hpp"

using namespace vrut;
using namespace vrut::test;

namespace {

const std::string kHost = "Host: 127.0.0.1\r\n";
const std::string kKey = "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
const std::string kUpgrade =
    kHost + "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n";

std::string get_of(const std::string& fields, const std::string& line = "GET /healthz HTTP/1.1") {
    return line + "\r\n" + fields + "\r\n";
}

struct RequestCase {
    std::string what, request;
    int status;
};

std::vector<RequestCase> lines_and_bytes() {
    const std::string nul(1, '\0');
    return {
        {"bare LF everywhere", "GET /healthz HTTP/1.1\nHost: 127.0.0.1\n\n", 400},
        {"bare LF behind the first line", "GET /healthz HTTP/1.1\n" + kHost + "\r\n", 400},
        {"bare LF behind a field", get_of("Host: 127.0.0.1\nX: 1\r\n"), 400},
        {"bare LF at the end", "GET /healthz HTTP/1.1\r\n" + kHost + "\n", 400},
        {"bare CR in a value", get_of(kHost + "X: a\rb\r\n"), 400},
        {"bare CR behind the first line", "GET /healthz HTTP/1.1\r" + kHost + "\r\n", 400},
        {"CR CR LF", get_of("Host: 127.0.0.1\r\r\n"), 400},
        {"an empty line before the request", "\r\n" + get_of(kHost), 400},
        {"a folded field", get_of(kHost + "X: a\r\n b\r\n"), 400},
        {"a field folded by a tab", get_of(kHost + "X: a\r\n\tb\r\n"), 400},
        {"a folded first field", get_of(" X: a\r\n" + kHost), 400},
        {"a space before the colon", get_of("Host : 127.0.0.1\r\n"), 400},
        {"a tab before the colon", get_of("Host\t: 127.0.0.1\r\n"), 400},
        {"a field without a colon", get_of(kHost + "Nonsense\r\n"), 400},
        {"a field without a name", get_of(kHost + ": 1\r\n"), 400},
        {"a space in a field's name", get_of(kHost + "X Y: 1\r\n"), 400},
        {"NUL in a value", get_of(kHost + "X: a" + nul + "b\r\n"), 400},
        {"NUL in the address", "GET /heal" + nul + "thz HTTP/1.1\r\n" + kHost + "\r\n", 400},
        {"a bell in a value", get_of(kHost + "X: \a\r\n"), 400},
        {"delete in a value", get_of(kHost + "X: \x7f\r\n"), 400},
        {"a letter beyond ASCII in a name", get_of(kHost + "X\xc3\xa4: 1\r\n"), 400},
        {"what TLS begins with", "\x16\x03\x01\x02" + nul + "\x01", 400},
    };
}

std::vector<RequestCase> first_lines() {
    const auto line = [](const std::string& first) { return get_of(kHost, first); };
    return {
        {"HTTP/0.9", "GET /healthz\r\n\r\n", 400},
        {"HTTP/2.0", line("GET /healthz HTTP/2.0"), 505},
        {"HTTP/2's preface", "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", 505},
        {"HTTP/1.2", line("GET /healthz HTTP/1.2"), 505},
        {"HTTP/0.9 said", line("GET /healthz HTTP/0.9"), 505},
        {"a version in small letters", line("GET /healthz http/1.1"), 400},
        {"a version of three numbers", line("GET /healthz HTTP/1.1.1"), 400},
        {"another protocol", line("GET /healthz RTSP/1.0"), 400},
        {"two spaces", line("GET  /healthz HTTP/1.1"), 400},
        {"a tab", line("GET\t/healthz HTTP/1.1"), 400},
        {"a space in the address", line("GET /health z HTTP/1.1"), 400},
        {"a space at the end", line("GET /healthz HTTP/1.1 "), 400},
        {"no address", line("GET HTTP/1.1"), 400},
        {"a whole URL", line("GET http://127.0.0.1/healthz HTTP/1.1"), 400},
        {"an authority", line("GET 127.0.0.1:80 HTTP/1.1"), 400},
        {"an asterisk", line("GET * HTTP/1.1"), 400},
        {"a fragment", line("GET /healthz#x HTTP/1.1"), 400},
        {"a letter beyond ASCII", line("GET /\xc3\xa4 HTTP/1.1"), 400},
        {"a method in small letters", line("get /healthz HTTP/1.1"), 501},
        {"an unknown method", line("DANCE /healthz HTTP/1.1"), 501},
        {"POST", line("POST /healthz HTTP/1.1"), 405},
        {"OPTIONS of the server", line("OPTIONS * HTTP/1.1"), 405},
        {"CONNECT", line("CONNECT 127.0.0.1:80 HTTP/1.1"), 405},
        {"TRACE", line("TRACE /healthz HTTP/1.1"), 405},
        {"a long address", line("GET /" + std::string(5000, 'x') + " HTTP/1.1"), 414},
        {"an address without end", "GET /" + std::string(9000, 'x'), 414},
        {"a long field", get_of(kHost + "X: " + std::string(9000, 'x') + "\r\n"), 431},
        {"fields without end", "GET / HTTP/1.1\r\nX: " + std::string(9000, 'x'), 431},
    };
}

std::vector<RequestCase> fields() {
    const std::string smuggled = "0\r\n\r\nGET /metrics HTTP/1.1\r\n" + kHost + "\r\n";
    return {
        {"no Host", get_of(""), 400},
        {"two Hosts", get_of(kHost + "Host: evil.example\r\n"), 400},
        {"the same Host twice", get_of(kHost + kHost), 400},
        {"an empty Host", get_of("Host:\r\n"), 400},
        {"a Host with a path", get_of("Host: 127.0.0.1/x\r\n"), 400},
        {"a Host with a user", get_of("Host: me@127.0.0.1\r\n"), 400},
        {"a Host that is a list", get_of("Host: 127.0.0.1, evil.example\r\n"), 400},
        {"a Host that would end a policy", get_of("Host: 127.0.0.1;script-src\r\n"), 400},
        {"a Host with a port of letters", get_of("Host: 127.0.0.1:http\r\n"), 400},
        {"a Host with an empty port", get_of("Host: 127.0.0.1:\r\n"), 400},
        {"a Host with an open bracket", get_of("Host: [::1\r\n"), 400},
        {"two Origins", get_of(kHost + "Origin: http://127.0.0.1\r\nOrigin: http://evil.example\r\n"), 400},
        {"two Authorizations", get_of(kHost + "Authorization: Bearer a\r\nAuthorization: Bearer b\r\n"), 400},
        {"two lengths", get_of(kHost + "Content-Length: 0\r\nContent-Length: 3\r\n") + "abc", 400},
        {"the same length twice", get_of(kHost + "Content-Length: 0\r\nContent-Length: 0\r\n"), 400},
        {"a list of lengths", get_of(kHost + "Content-Length: 0, 0\r\n"), 400},
        {"a signed length", get_of(kHost + "Content-Length: +0\r\n"), 400},
        {"a length in hexadecimal", get_of(kHost + "Content-Length: 0x0\r\n"), 400},
        {"an empty length", get_of(kHost + "Content-Length:\r\n"), 400},
        {"a length beyond 64 bits", get_of(kHost + "Content-Length: 18446744073709551616\r\n"), 400},
        {"length and coding",
         get_of(kHost + "Content-Length: 0\r\nTransfer-Encoding: chunked\r\n") + smuggled, 400},
        {"coding and length",
         get_of(kHost + "Transfer-Encoding: chunked\r\nContent-Length: 5\r\n") + smuggled, 400},
        {"a coding", get_of(kHost + "Transfer-Encoding: chunked\r\n") + smuggled, 501},
        {"a coding's look-alike", get_of(kHost + "Transfer-Encoding: xchunked\r\n") + smuggled, 501},
        {"the coding of none", get_of(kHost + "Transfer-Encoding: identity\r\n"), 501},
        {"two codings", get_of(kHost + "Transfer-Encoding: chunked\r\nTransfer-Encoding: x\r\n") + smuggled,
         400},
        {"a coding in HTTP/1.0",
         get_of(kHost + "Transfer-Encoding: chunked\r\n", "GET / HTTP/1.0") + smuggled, 400},
        {"a body", get_of(kHost + "Content-Length: 3\r\n") + "abc", 413},
        {"a body to POST", get_of(kHost + "Content-Length: 3\r\n", "POST /healthz HTTP/1.1") + "abc", 405},
        {"a huge body", get_of(kHost + "Content-Length: 9999999999\r\n"), 413},
        {"an expectation", get_of(kHost + "Expect: 100-continue\r\n"), 417},
    };
}

std::vector<RequestCase> handshakes() {
    const std::string line = "GET /ws HTTP/1.1";
    return {
        {"two keys", get_of(kUpgrade + kKey + kKey, line), 400},
        {"a short key", get_of(kUpgrade + "Sec-WebSocket-Key: dGhl\r\n", line), 400},
        {"a key that is no base64",
         get_of(kUpgrade + "Sec-WebSocket-Key: !!!!!!!!!!!!!!!!!!!!!!==\r\n", line), 400},
        {"two versions", get_of(kUpgrade + kKey + "Sec-WebSocket-Version: 13\r\n", line), 400},
        {"bytes before the answer", get_of(kUpgrade + kKey, line) + "\x81\x80 ", 400},
        {"a body", get_of(kUpgrade + kKey + "Content-Length: 2\r\n", line) + "ab", 413},
        {"an expectation", get_of(kUpgrade + kKey + "Expect: 100-continue\r\n", line), 417},
        {"another method", get_of(kUpgrade + kKey, "POST /ws HTTP/1.1"), 405},
    };
}

}  // namespace

TEST_CASE("what cannot be trusted is refused with a sentence, and nothing behind it is answered") {
    TestServer server;
    for (const auto& cases : {lines_and_bytes(), first_lines(), fields(), handshakes()})
        for (const RequestCase& each : cases) {
            CAPTURE(each.what);
            RawConnection connection(server.port());
            connection.send(each.request);
            const HttpAnswer answer = connection.answer();
            CHECK(answer.status == each.status);
            CHECK(answer.headers.find("Connection: close\r\n") != std::string::npos);
            CHECK(answer.body.size() > 10);
            CHECK(answer.body.find('\n') == answer.body.size() - 1);
            CHECK(connection.answer().status == 0);
            CHECK(connection.ended());
        }
    CHECK(http(server.port(), "GET", "/healthz").status == 200);
}

TEST_CASE("what is unusual and right is served") {
    TestServer server;
    for (const RequestCase& each : std::vector<RequestCase>{
             {"no space behind the colon", get_of("Host:127.0.0.1\r\n"), 200},
             {"a tab around a value", get_of("Host:\t127.0.0.1 \t\r\n"), 200},
             {"names in any letters", get_of("hOST: 127.0.0.1\r\n"), 200},
             {"a length of zero", get_of(kHost + "Content-Length: 0\r\n"), 200},
             {"an empty value", get_of(kHost + "X:\r\n"), 200},
             {"letters beyond ASCII in a value", get_of(kHost + "X: \xc3\xa4\r\n"), 200},
             {"a field twice that may be", get_of(kHost + "Accept: a\r\nAccept: b\r\n"), 200},
             {"IPv6", get_of("Host: [::1]:8080\r\n"), 200},
             {"a query", get_of(kHost, "GET /healthz?a=b&c=%20 HTTP/1.1"), 200},
             {"HTTP/1.0", get_of(kHost, "GET /healthz HTTP/1.0"), 200},
             {"an address of 4000 bytes", get_of(kHost, "GET /" + std::string(4000, 'x') + " HTTP/1.1"), 404},
             {"a WebSocket that is none", get_of(kHost, "GET /ws HTTP/1.1"), 426},
             {"a WebSocket of another version",
              get_of(
                  kHost + kKey + "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 8\r\n",
                  "GET /ws HTTP/1.1"),
              426},
             {"a WebSocket", get_of(kUpgrade + kKey, "GET /ws HTTP/1.1"), 101}}) {
        CAPTURE(each.what);
        RawConnection connection(server.port());
        connection.send(each.request);
        CHECK(connection.answer().status == each.status);
    }
}

TEST_CASE("requests that come together are answered in order, up to one that cannot be trusted") {
    TestServer server;
    RawConnection connection(server.port());
    connection.send(get_of(kHost) + get_of(kHost, "HEAD / HTTP/1.1") + get_of(kHost, "GET /none HTTP/1.1") +
                    get_of(kHost, "GET /style.css HTTP/1.1") + get_of("") + get_of(kHost));
    CHECK(connection.answer().body == "ok\n");
    const HttpAnswer head = connection.answer(true);
    CHECK(head.status == 200);
    CHECK(head.headers.find("text/html") != std::string::npos);
    CHECK(connection.answer().status == 404);
    CHECK(connection.answer().headers.find("text/css") != std::string::npos);
    CHECK(connection.answer().status == 400);
    CHECK(connection.answer().status == 0);
    CHECK(connection.ended());
}

TEST_CASE("a request that comes byte by byte is one, and a connection is closed when that is asked for") {
    TestServer server;
    RawConnection connection(server.port());
    for (const char byte : get_of(kHost)) connection.send({&byte, 1});
    CHECK(connection.answer().status == 200);
    connection.send(get_of(kHost + "Connection: close\r\n") + get_of(kHost));
    CHECK(connection.answer().headers.find("Connection: close\r\n") != std::string::npos);
    CHECK(connection.answer().status == 0);
    CHECK(connection.ended());
}
