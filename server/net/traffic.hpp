#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <cstdint>
#include <limits>
#include <optional>

#include "base/clock.hpp"

namespace vrut::server::net {

/// A stream's rate policy that limits nothing, and counts the bytes that go over it.
class Traffic {
public:
    std::uint64_t taken = 0;                            ///< bytes that the socket has taken
    std::optional<base::Clock::time_point> unfinished;  ///< arrival of the first byte since it was last reset

private:
    friend class boost::beast::rate_policy_access;
    static constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
    static std::size_t available_read_bytes() { return all; }
    static std::size_t available_write_bytes() { return all; }
    void transfer_read_bytes(std::size_t size) {
        if (size > 0 && !unfinished) unfinished = base::Clock::now();
    }
    void transfer_write_bytes(std::size_t size) { taken += size; }
    static void on_timer() {}
};

using Stream = boost::beast::basic_stream<boost::asio::ip::tcp, boost::asio::any_io_executor, Traffic>;

}  // namespace vrut::server::net
