#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "test_client.hpp"

namespace vrut::test {

/// A connection over which a test sends the bytes that it likes. Non-blocking.
class RawSocket {
public:
    struct Options {
        int receive_buffer = 0;  ///< bytes; 0: the system's choice
        unsigned source = 1;     ///< it comes from the address 127.0.0.0 + this
    };
    RawSocket(std::uint16_t port, const Options& options);
    ~RawSocket();
    RawSocket(RawSocket&& other) noexcept;
    RawSocket(const RawSocket&) = delete;

    int descriptor() const { return descriptor_; }
    /// What fits into the socket; false where it is closed.
    bool send(std::string_view bytes) const;
    /// Reads what is there, at most so much; empty where nothing is, and when it has ended.
    std::string read(std::size_t most = 65536) const;
    /// Reads what is there; true when the server has closed it.
    bool ended() const;
    /// Closes it with a reset, as a machine does that has lost its memory of it.
    void reset();

private:
    int descriptor_ = -1;
};

/// The request that opens a WebSocket.
std::string upgrade_request(const std::string& path = "/ws");
/// Where a room is to be had.
struct Door {
    std::uint16_t port = 0;
    std::string path = "/ws";
};
/// A WebSocket whose handshake is done.
RawSocket websocket(std::uint16_t port, const RawSocket::Options& options);
/// Of a watcher who has joined and asked for frames, and reads nothing.
RawSocket standing_client(std::uint16_t port, unsigned source);
/// A client's message on the wire, masked with zeros; of fewer than 65,536 bytes.
std::string client_frame(std::string_view payload, int opcode = 1);

/// WebSocket clients by the hundred, on one thread and at a cost that does not hide the server's: of frames
/// only the beginning, which holds the header, is copied out of the socket. Each asks for another frame when
/// it has got one.
class Swarm {
public:
    struct Frame {
        std::size_t client = 0;
        std::int64_t number = 0;
        double fov = 0;  ///< of its camera
        std::chrono::steady_clock::time_point at;
    };
    using OnFrame = std::function<void(const Frame&)>;

    explicit Swarm(std::uint16_t port);
    /// The clients come by these in turn.
    explicit Swarm(std::vector<Door> doors);
    ~Swarm();
    Swarm(const Swarm&) = delete;
    Swarm& operator=(const Swarm&) = delete;

    /// Another client, who has said hello and asked for two frames; its number.
    std::size_t join(const std::string& role);
    std::size_t size() const { return clients_.size(); }
    void send(std::size_t client, const Json& message);
    /// Reads until then, or until `enough`, which is looked at after each turn.
    void read_until(std::chrono::steady_clock::time_point end, const OnFrame& on_frame,
                    const std::function<bool()>& enough = {});
    std::uint64_t bytes() const { return bytes_; }  ///< that have come

private:
    struct Client {
        RawSocket socket;
        bool upgraded = false;
        std::string start{};   ///< of what is being read: the answer's to the handshake, then a message's
        std::size_t skip = 0;  ///< bytes of the message before, which come first and are not looked at
        Frame frame{};         ///< to which those belong
    };
    void read(std::size_t index, const OnFrame& on_frame);
    bool take(std::size_t index, const OnFrame& on_frame);
    bool take_handshake(Client& client);
    void deliver(Client& client, const OnFrame& on_frame);

    std::vector<Door> doors_;
    int epoll_;
    std::deque<Client> clients_;
    std::uint64_t bytes_ = 0;
};

}  // namespace vrut::test
