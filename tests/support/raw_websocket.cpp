#include "raw_websocket.hpp"

#include <doctest/doctest.h>

namespace vrut::test {

std::string big_endian(std::uint64_t value, int bytes) {
    std::string text;
    for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
        text += static_cast<char>(value >> shift & 0xFF);
    return text;
}

std::string frame_head(int first, bool masked, int length, const std::string& extended_length) {
    std::string head{static_cast<char>(first), static_cast<char>(length | (masked ? 0x80 : 0))};
    head += extended_length;
    if (masked) head += "mask";
    return head;
}

std::string frame(int first, const std::string& payload) {
    const std::size_t size = payload.size();
    std::string bytes = size < 126     ? frame_head(first, true, static_cast<int>(size))
                        : size < 65536 ? frame_head(first, true, 126, big_endian(size, 2))
                                       : frame_head(first, true, 127, big_endian(size, 8));
    for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(payload[i] ^ "mask"[i % 4]);
    return bytes;
}

RawWebSocket::RawWebSocket(std::uint16_t port, const std::string& fields, Over over)
    : connection(port, over) {
    connection.send(
        "GET /ws HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
        fields + "\r\n");
    handshake = connection.answer();
}

void RawWebSocket::join(const std::string& role) {
    REQUIRE(handshake.status == 101);
    connection.send(frame(kFinal | kText, R"({"type":"hello","role":")" + role + "\"}"));
    for (const char* type : {"welcome", "state"}) {
        auto message = receive();
        while (message && message->opcode == kPing) message = receive();
        REQUIRE(message.has_value());
        REQUIRE(Json::parse(message->payload)["type"] == type);
    }
}

std::optional<Frame> RawWebSocket::receive() {
    const std::string head = connection.receive(2);
    if (head.size() < 2) return std::nullopt;
    const int first = static_cast<unsigned char>(head[0]), second = static_cast<unsigned char>(head[1]);
    CHECK((first & 0x70) == 0);
    CHECK(second < 128);  // a server masks nothing
    std::size_t size = static_cast<std::size_t>(second);
    if (second >= 126) {
        size = 0;
        for (const char byte : connection.receive(second == 126 ? 2 : 8))
            size = size << 8 | static_cast<unsigned char>(byte);
    }
    return Frame{(first & kFinal) != 0, first & 15, connection.receive(size)};
}

}  // namespace vrut::test
