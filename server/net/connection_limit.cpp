#include "net/connection_limit.hpp"

#include <algorithm>

namespace vrut::server::net {

namespace {

boost::asio::ip::address network_of(const boost::asio::ip::address& peer) {
    if (!peer.is_v6()) return peer;
    const auto v6 = peer.to_v6();
    if (v6.is_v4_mapped()) return boost::asio::ip::make_address_v4(boost::asio::ip::v4_mapped, v6);
    auto bytes = v6.to_bytes();
    std::fill(bytes.begin() + 8, bytes.end(), std::uint8_t{0});
    return boost::asio::ip::address_v6(bytes);
}

}  // namespace

std::optional<ConnectionLimit::Place> ConnectionLimit::enter(const boost::asio::ip::address& peer) {
    const auto network = network_of(peer);
    const auto known = of_peer_.find(network);
    if (count_ >= most_ || (known != of_peer_.end() && known->second >= most_of_one_)) return std::nullopt;
    ++count_;
    ++of_peer_[network];
    return Place(*this, network);
}

ConnectionLimit::Place::~Place() {
    if (!limit_) return;
    --limit_->count_;
    const auto known = limit_->of_peer_.find(peer_);
    if (--known->second == 0) limit_->of_peer_.erase(known);
}

}  // namespace vrut::server::net
