#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <cstdint>
#include <memory>

#include "engine/pacing.hpp"

namespace vrut::stability {

/// What a link is, each way.
struct LinkQuality {
    double bytes_per_second = 1e9;
    std::chrono::milliseconds delay{0};
};

/// A link between a client and a server on this machine: a port that passes on what it gets, as slowly as the
/// link is. It takes nothing while what came before leaves, so that its ends feel how slow it is. Throws
/// boost::system::system_error where no port can be had.
class SlowLink {
public:
    SlowLink(boost::asio::io_context& context, std::uint16_t server_port, const LinkQuality& quality);
    ~SlowLink();
    SlowLink(const SlowLink&) = delete;
    SlowLink& operator=(const SlowLink&) = delete;

    std::uint16_t port() const;
    /// Nothing leaves and nothing arrives, either way, until then.
    void stall_until(server::base::Clock::time_point end);

private:
    struct Impl;
    std::shared_ptr<Impl> impl_;
};

}  // namespace vrut::stability
