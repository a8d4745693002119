#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>

#include "engine/frame_renderer.hpp"
#include "net/server.hpp"
#include "page_client.hpp"
#include "slow_link.hpp"

namespace vrut::stability {

/// Draws shaded balls, turned with the camera: as much to encode as in a picture of the car.
server::engine::FrameRenderer renderer_of_balls();
inline constexpr double kSmallestScale = 0.25;  ///< of its smallest frame for the page to the view
inline constexpr double kSmallest = 8450;       ///< bytes of such a frame as the drag begins, with the header

/// A server, a slow link, and the page at its other end, with a finger that turns the view on and on; and
/// somebody who watches without a link between.
class Journey {
public:
    /// The port of what stands between the link and the server, of which it is given the port.
    using Between = std::function<std::uint16_t(std::uint16_t)>;
    explicit Journey(const test_support::LinkQuality& quality, const server::net::Deadlines& deadlines = {},
                     const Between& between = {});
    ~Journey();
    Journey(const Journey&) = delete;
    Journey& operator=(const Journey&) = delete;

    const PageClient& page() const { return *page_; }
    const PageClient& watcher() const { return *watcher_; }
    test_support::SlowLink& link() { return *link_; }
    void go_on(double seconds);
    /// Until so many pictures have come over this connection, or for so long.
    void go_on_until(std::size_t pictures, double seconds);
    /// The longest that a move of a drag of so many seconds waits for its picture, in ms; kNothing where
    /// there is no move, one has no picture after `patience` more seconds, or the connection was lost.
    double longest_lag(double seconds, double patience);

private:
    std::int64_t handled() const;
    double longest_lag(const std::vector<PageClient::Move>& moves) const;

    server::net::Server server_;
    std::thread thread_;
    boost::asio::io_context context_{1};
    std::unique_ptr<test_support::SlowLink> link_;
    std::unique_ptr<PageClient> page_, watcher_;
};

}  // namespace vrut::stability
