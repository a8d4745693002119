#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <memory>

#include "link_schedule.hpp"

namespace vrut::test_support {

/// A link between clients and a server on this machine: a port that passes on what it gets, as slowly as the
/// link is, at 15 MB/s at most. All its connections share the link. It buffers no more than a real
/// bottleneck: what is on its way during the delay, a queue of 16 KiB, and some 8 KiB in the kernel's buffers
/// of each of its sockets; then it takes nothing, so that its ends feel how slow it is. The end of one
/// direction is passed on after all bytes before it. It is used on its context's thread. Throws
/// boost::system::system_error where no port can be had.
class SlowLink {
public:
    SlowLink(boost::asio::io_context& context, std::uint16_t server_port, const LinkQuality& quality);
    ~SlowLink();
    SlowLink(const SlowLink&) = delete;
    SlowLink& operator=(const SlowLink&) = delete;

    std::uint16_t port() const;
    /// Of all that is sent from now on, as for a client that roams to another network.
    void set_quality(const LinkQuality& quality);
    /// Nothing leaves and nothing arrives, either way, until then.
    void stall_until(Clock::time_point end);
    /// Resets all connections; new ones may come.
    void cut();

private:
    struct Impl;
    std::shared_ptr<Impl> impl_;
};

}  // namespace vrut::test_support
