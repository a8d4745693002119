#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <string>

namespace vrut::server::net {

/// The bodies of answers that are being sent, on the net thread. A body that several get counts once. Where
/// they would come to more than there may be, those are cut that have been sent for longest: who takes what
/// it gets is done in moments.
class BodiesSent {
public:
    using Body = std::shared_ptr<const std::string>;
    /// While it lives, a body is being sent. It must not outlive the BodiesSent.
    using Sending = std::shared_ptr<void>;

    explicit BodiesSent(std::size_t most) : most_(most) {}
    BodiesSent(const BodiesSent&) = delete;
    BodiesSent& operator=(const BodiesSent&) = delete;

    /// `cut` is called at most once, and must end what is sent.
    Sending add(const Body& body, std::function<void()> cut);
    /// Of all that are sent and not cut.
    std::size_t bytes() const { return bytes_; }

private:
    struct Entry;
    void remove(Entry& entry);

    const std::size_t most_;
    std::size_t bytes_ = 0;
    std::map<Body, std::size_t> senders_;
    std::list<Entry*> entries_;  ///< the oldest first
};

}  // namespace vrut::server::net
