#pragma once

#include "raw_connection.hpp"

namespace vrut::test {

/// Of RFC 6455, 5.2: the first byte of a frame.
constexpr int kText = 1, kBinary = 2, kContinuation = 0, kClose = 8, kPing = 9, kPong = 10, kFinal = 0x80;

/// A client's frame, masked; `first` is its first byte.
std::string frame(int first, const std::string& payload);
/// A frame's head of any kind: `length` is its second byte without the mask's bit.
std::string frame_head(int first, bool masked, int length, const std::string& extended_length = {});
std::string big_endian(std::uint64_t value, int bytes);

struct Frame {
    bool final = false;
    int opcode = 0;
    std::string payload;
};

/// A WebSocket of which a test sees and sends the bytes.
class RawWebSocket {
public:
    explicit RawWebSocket(std::uint16_t port, const std::string& fields = {}, Over over = Over::tcp);
    void join(const std::string& role = "view");
    /// What the server sends next; none at the end.
    std::optional<Frame> receive();
    RawConnection connection;
    HttpAnswer handshake;
};

}  // namespace vrut::test
