#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/clock.hpp"
#include "messages.hpp"

namespace vrut::stability {

/// A client as the page is (web-client/connection.js): it takes control, turns the view with one finger that
/// moves on and on, grants two pictures, gives each grant back when its picture has come, and connects anew
/// after a loss. With the role `view` it only listens, and takes no pictures. On its context's thread.
class PageClient {
public:
    struct Move {
        std::int64_t id = 0;
        server::base::Clock::time_point sent;
    };
    struct Shown {
        server::base::Clock::time_point at;
        std::int64_t handled = 0;  ///< the last of its messages that the picture shows
        double scale = 0;          ///< of the picture to the view
        bool moving = false;
    };

    struct Patch {
        server::base::Clock::time_point at;
        std::int64_t revision = 0;
    };

    PageClient(boost::asio::io_context& context, std::uint16_t port, protocol::Role role);
    ~PageClient();
    PageClient(const PageClient&) = delete;
    PageClient& operator=(const PageClient&) = delete;

    const std::vector<Move>& moves() const;     ///< of this connection
    const std::vector<Shown>& shown() const;    ///< of this connection
    const std::vector<Patch>& patches() const;  ///< of this connection
    int connections() const;                    ///< that came as far as a state

private:
    struct Impl;
    std::shared_ptr<Impl> impl_;
};

}  // namespace vrut::stability
