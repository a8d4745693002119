#pragma once

#include <boost/asio/ip/address.hpp>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>

namespace vrut::server::net {

/// Counts the open connections, all and those of each peer's address, and rejects more than a limit. In IPv6
/// one peer has a whole /64.
class ConnectionLimit {
public:
    ConnectionLimit(std::size_t most, std::size_t most_of_one) : most_(most), most_of_one_(most_of_one) {}
    ConnectionLimit(const ConnectionLimit&) = delete;
    ConnectionLimit& operator=(const ConnectionLimit&) = delete;

    /// One connection's, as long as it lives. May not outlive what it was taken from.
    class Place {
    public:
        Place(Place&& other) noexcept
            : limit_(std::exchange(other.limit_, nullptr)), peer_(std::move(other.peer_)) {}
        Place& operator=(Place&&) = delete;
        ~Place();

    private:
        friend class ConnectionLimit;
        Place(ConnectionLimit& limit, boost::asio::ip::address peer)
            : limit_(&limit), peer_(std::move(peer)) {}
        ConnectionLimit* limit_;
        boost::asio::ip::address peer_;
    };

    /// None where the limit is reached.
    std::optional<Place> enter(const boost::asio::ip::address& peer);
    std::size_t count() const { return count_; }

private:
    std::size_t most_, most_of_one_, count_ = 0;
    std::map<boost::asio::ip::address, std::size_t> of_peer_;
};

}  // namespace vrut::server::net
