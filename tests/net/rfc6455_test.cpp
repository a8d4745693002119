// What RFC 6455 asks of a server, after the list of cases of the Autobahn test suite, over raw sockets.
#include <doctest/doctest.h>

#include <algorithm>

#include "raw_websocket.hpp"

using namespace vrut;
using namespace vrut::test;

namespace {

constexpr int kGoesOn = 0, kRsv1 = 0x40, kRsv2 = 0x20, kRsv3 = 0x10;

/// What a client sends when it has joined.
struct Case {
    std::string what, bytes;
    std::vector<int> ends = {kGoesOn};    ///< the close codes that may answer it
    std::vector<std::string> pongs = {};  ///< that come before
};

std::string text(const std::string& payload) { return frame(kFinal | kText, payload); }
std::string close(int code, const std::string& reason = {}) {
    return frame(kFinal | kClose, big_endian(static_cast<std::uint64_t>(code), 2) + reason);
}
std::string ping(const std::string& payload) { return frame(kFinal | kPing, payload); }
const std::string kMessage = R"({"type":"tree","more":"µ€😀"})";

/// A text whose fragments end behind each of `cuts`.
std::string fragments(const std::string& payload, const std::vector<std::size_t>& cuts,
                      const std::string& between = {}) {
    std::string bytes;
    std::size_t at = 0;
    for (const std::size_t cut : cuts) {
        bytes +=
            frame(at == 0 && bytes.empty() ? kText : kContinuation, payload.substr(at, cut - at)) + between;
        at = cut;
    }
    return bytes + frame(kFinal | kContinuation, payload.substr(at));
}

std::vector<Case> framing() {
    std::vector<Case> cases{
        {"text", text(kMessage)},
        {"a text of no bytes", text("")},
        {"text that is no JSON", text("Hello-µ@ßöäüàá-UTF-8!!")},
        {"an unmasked text", frame_head(kFinal | kText, false, 2) + "{}", {1002}},
        {"an unmasked ping", frame_head(kFinal | kPing, false, 0), {1002}},
        {"an unmasked close", frame_head(kFinal | kClose, false, 0), {1002}},
        {"5 bytes in a 16-bit length", frame_head(kFinal | kText, true, 126, big_endian(5, 2)), {1002}},
        {"5 bytes in a 64-bit length", frame_head(kFinal | kText, true, 127, big_endian(5, 8)), {1002}},
        {"65,535 bytes in a 64-bit length",
         frame_head(kFinal | kText, true, 127, big_endian(65535, 8)),
         {1002}},
        {"a length with the top bit",
         frame_head(kFinal | kText, true, 127, big_endian(1ull << 63, 8)),
         {1002, 1009}},
        {"the largest length", frame_head(kFinal | kText, true, 127, big_endian(~0ull, 8)), {1002, 1009}},
        {"a terabyte", frame_head(kFinal | kText, true, 127, big_endian(1ull << 40, 8)), {1009}},
        {"a terabyte in a second fragment",
         frame(kText, "{") + frame_head(kFinal | kContinuation, true, 127, big_endian(1ull << 40, 8)),
         {1009}},
        {"65,536 bytes", text(R"({"type":"tree","x":")" + std::string(65536 - 22, 'x') + "\"}")},
        {"65,537 bytes", text(std::string(65537, ' ')), {1009}},
        {"65,537 bytes in fragments", fragments(std::string(65537, ' '), {40000}), {1009}},
        {"binary", frame(kFinal | kBinary, "x"), {1003}},
    };
    for (const int bits : {kRsv1, kRsv2, kRsv3, kRsv1 | kRsv2 | kRsv3}) {
        const std::string of = " with reserved bits " + std::to_string(bits >> 4);
        cases.push_back({"text" + of, frame(kFinal | kText | bits, "{}"), {1002}});
        cases.push_back({"ping" + of, frame(kFinal | kPing | bits, ""), {1002}});
        cases.push_back({"close" + of, frame(kFinal | kClose | bits, ""), {1002}});
        cases.push_back(
            {"second fragment" + of, frame(kText, "{") + frame(kFinal | kContinuation | bits, "}"), {1002}});
    }
    for (const int opcode : {3, 4, 5, 6, 7, 11, 12, 13, 14, 15}) {
        const std::string what = "opcode " + std::to_string(opcode);
        cases.push_back({what, frame(kFinal | opcode, ""), {1002}});
        cases.push_back(
            {what + " with bytes, behind a text", text(kMessage) + frame(kFinal | opcode, "x"), {1002}});
        cases.push_back(
            {what + " between fragments", frame(kText, "{") + frame(kFinal | opcode, ""), {1002}});
    }
    return cases;
}

std::vector<Case> fragmentation() {
    std::vector<std::size_t> each(kMessage.size() - 1);
    for (std::size_t i = 0; i < each.size(); ++i) each[i] = i + 1;
    return {
        {"two fragments", fragments(kMessage, {7})},
        {"each byte a fragment", fragments(kMessage, each)},
        {"each byte a fragment, with empty ones", fragments(kMessage, each, frame(kContinuation, ""))},
        {"an empty first fragment", frame(kText, "") + frame(kFinal | kContinuation, kMessage)},
        {"an empty last fragment", frame(kText, kMessage) + frame(kFinal | kContinuation, "")},
        {"fragments of nothing",
         frame(kText, "") + frame(kContinuation, "") + frame(kFinal | kContinuation, "")},
        {"a ping between fragments", fragments(kMessage, {7}, ping("here")), {kGoesOn}, {"here"}},
        {"pings between fragments", fragments(kMessage, {3, 7}, ping("here")), {kGoesOn}, {"here", "here"}},
        {"a pong between fragments", fragments(kMessage, {7}, frame(kFinal | kPong, "there"))},
        {"a close between fragments", frame(kText, "{") + close(1000), {1000}},
        {"a continuation of nothing", frame(kFinal | kContinuation, "x"), {1002}},
        {"an unfinished continuation of nothing", frame(kContinuation, "x"), {1002}},
        {"a continuation behind the end",
         fragments(kMessage, {7}) + frame(kFinal | kContinuation, "x"),
         {1002}},
        {"a text inside another", frame(kText, "{") + text("}"), {1002}},
        {"a binary inside a text", frame(kText, "{") + frame(kFinal | kBinary, "}"), {1002}},
        {"a fragmented ping", frame(kPing, "a") + frame(kFinal | kContinuation, "b"), {1002}},
        {"a fragmented pong", frame(kPong, "a") + frame(kFinal | kContinuation, "b"), {1002}},
        {"a fragmented close", frame(kClose, ""), {1002}},
        {"fragments of a binary", frame(kBinary, "a") + frame(kFinal | kContinuation, "b"), {1003}},
    };
}

std::vector<Case> pings() {
    const std::string most(125, '\xfe');
    std::string ten;
    std::vector<std::string> answers;
    for (int i = 0; i < 10; ++i) {
        ten += ping("ping " + std::to_string(i));
        answers.push_back("ping " + std::to_string(i));
    }
    return {
        {"an empty ping", ping(""), {kGoesOn}, {""}},
        {"a ping", ping("Hello"), {kGoesOn}, {"Hello"}},
        {"a ping that is no UTF-8", ping("\x00\xff\xfe\xfd"), {kGoesOn}, {"\x00\xff\xfe\xfd"}},
        {"a ping of 125 bytes", ping(most), {kGoesOn}, {most}},
        {"a ping of 126 bytes", ping(most + "x"), {1002}},
        {"a pong of 126 bytes", frame(kFinal | kPong, most + "x"), {1002}},
        {"a pong to nothing", frame(kFinal | kPong, "")},
        {"a pong to nothing with bytes, and a ping",
         frame(kFinal | kPong, "x") + ping("y"),
         {kGoesOn},
         {"y"}},
        {"ten pings", ten, {kGoesOn}, answers},
    };
}

std::vector<Case> encoding() {
    std::vector<Case> cases;
    for (const std::string valid :
         {"\x7f", "\xc2\x80", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf", "\xee\x80\x80", "\xef\xbf\xbd",
          "\xef\xbf\xbe", "\xef\xbf\xbf", "\xf0\x90\x80\x80", "\xf0\x9f\xbf\xbf", "\xf4\x8f\xbf\xbf",
          "\xce\xba\xe1\xbd\xb9\xcf\x83\xce\xbc\xce\xb5"}) {
        cases.push_back({"valid", text(valid)});
        for (std::size_t cut = 1; cut < valid.size(); ++cut)
            cases.push_back({"valid in fragments", fragments(valid, {cut})});
    }
    for (const std::string invalid :
         {"\x80",
          "\xbf",
          "\xc0\x80",
          "\xc0\xaf",
          "\xc1\xbf",
          "\xe0\x80\xaf",
          "\xe0\x9f\xbf",
          "\xf0\x80\x80\xaf",
          "\xf0\x8f\xbf\xbf",
          "\xf8\x88\x80\x80\x80",
          "\xfc\x84\x80\x80\x80\x80",
          "\xed\xa0\x80",
          "\xed\xaf\xbf",
          "\xed\xb0\x80",
          "\xed\xbf\xbf",
          "\xed\xa0\x80\xed\xb0\x80",
          "\xf4\x90\x80\x80",
          "\xf7\xbf\xbf\xbf",
          "\xfe",
          "\xff",
          "\xc2",
          "\xe2\x82",
          "\xf0\x9f\x98",
          "\xc3\x28",
          "\xe2\x28\xa1",
          "\xf0\x28\x8c\xbc",
          "\xce\xba\xe1\xbd\xb9\xcf\x83\xce\xbc\xce\xb5\xed\xa0\x80\x65\x64\x69\x74\x65\x64"}) {
        cases.push_back({"invalid", text(invalid), {1007}});
        cases.push_back(
            {"invalid behind valid", text("{\"type\":\"tree\",\"x\":\"" + invalid + "\"}"), {1007}});
        for (std::size_t cut = 1; cut < invalid.size(); ++cut)
            cases.push_back({"invalid in fragments", fragments(invalid, {cut}), {1007}});
        cases.push_back({"invalid, with an empty last fragment",
                         frame(kText, invalid) + frame(kFinal | kContinuation, ""),
                         {1007}});
    }
    return cases;
}

std::vector<Case> closes() {
    constexpr int kNoCode = 1005;  // 1000 says the same
    std::vector<Case> cases{
        {"close without a code", frame(kFinal | kClose, ""), {kNoCode, 1000}},
        {"close of one byte", frame(kFinal | kClose, "x"), {1002}},
        {"close with a reason", close(1000, "done"), {1000}},
        {"close with a reason of 123 bytes", close(1000, std::string(123, 'x')), {1000}},
        {"close with a reason of 124 bytes", close(1000, std::string(124, 'x')), {1002}},
        {"close with a reason that is no UTF-8", close(1000, "\xce\xba\xed\xa0\x80"), {1002, 1007}},
        {"close, then a text", close(1000) + text(kMessage), {1000}},
        {"close, then a ping", close(1000) + ping("x"), {1000}},
        {"close twice", close(1000) + close(1001), {1000}},
    };
    for (const int code : {1000, 1001, 1002, 1003, 1007, 1008, 1009, 1010, 1011, 3000, 3999, 4000, 4999})
        cases.push_back({"close with " + std::to_string(code), close(code), {code}});
    for (const int code : {0, 999, 1004, 1005, 1006, 1014, 1015, 1016, 1100, 2000, 2999, 5000, 65535})
        cases.push_back({"close with " + std::to_string(code), close(code), {1002}});
    return cases;
}

int code_of(const Frame& close_frame) {
    if (close_frame.payload.empty()) return 1005;
    REQUIRE(close_frame.payload.size() >= 2);
    return static_cast<unsigned char>(close_frame.payload[0]) << 8 |
           static_cast<unsigned char>(close_frame.payload[1]);
}

/// The close code, or kGoesOn where a message behind all of it is answered.
int end_of(RawWebSocket& client, std::vector<std::string>& pongs) {
    while (const auto next = client.receive()) {
        CHECK(next->final);
        if (next->opcode == kPong) pongs.push_back(next->payload);
        if (next->opcode == kClose) return code_of(*next);
        if (next->opcode == kText && Json::parse(next->payload).value("id", 0) == 99) return kGoesOn;
    }
    return 1006;
}

void check(const std::vector<Case>& cases, Over over) {
    TestServer server({}, over == Over::tls ? with_tls() : server::net::ServerOptions());
    for (const Case& each : cases) {
        CAPTURE(each.what);
        RawWebSocket client(server.port(), {}, over);
        client.join();
        client.connection.send(each.bytes);
        if (each.ends[0] == kGoesOn) client.connection.send(text(R"({"type":"tree","id":99})"));
        std::vector<std::string> pongs;
        const int end = end_of(client, pongs);
        CAPTURE(end);
        CHECK(std::find(each.ends.begin(), each.ends.end(), end) != each.ends.end());
        CHECK(pongs == each.pongs);
        if (end == kGoesOn) continue;
        client.connection.send(close(1000));  // where the server waits for it
        CHECK(client.connection.ended());
    }
}

}  // namespace

TEST_CASE("RFC 6455: framing, masks, lengths, reserved bits and opcodes") { check(framing(), Over::tcp); }
TEST_CASE("RFC 6455: fragments, with control frames between them") { check(fragmentation(), Over::tcp); }
TEST_CASE("RFC 6455: pings and pongs") { check(pings(), Over::tcp); }
TEST_CASE("RFC 6455: UTF-8, whole and cut by fragments") { check(encoding(), Over::tcp); }
TEST_CASE("RFC 6455: ends of a connection") { check(closes(), Over::tcp); }
TEST_CASE("RFC 6455: all of that by TLS") {
    for (const auto& cases : {framing(), fragmentation(), pings(), encoding(), closes()})
        check(cases, Over::tls);
}

TEST_CASE("RFC 6455: bytes that come one by one are the same messages") {
    TestServer server;
    RawWebSocket client(server.port());
    client.join();
    for (const char byte : ping("slow") + fragments(kMessage, {7}) + text(R"({"type":"tree","id":99})"))
        client.connection.send({&byte, 1});
    std::vector<std::string> pongs;
    CHECK(end_of(client, pongs) == kGoesOn);
    CHECK(pongs == std::vector<std::string>{"slow"});
}

TEST_CASE("an offer of compression is not taken, the answer to the key is the right one") {
    TestServer server;
    RawWebSocket client(server.port(),
                        "Sec-WebSocket-Extensions: permessage-deflate; client_max_window_bits\r\n");
    CHECK(client.handshake.status == 101);
    CHECK(client.handshake.headers.find("Extensions") == std::string::npos);
    CHECK(client.handshake.headers.find("Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n") !=
          std::string::npos);
    client.join();
}
