#pragma once

#include <nats/nats.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace vrut::server::nats {

/// An object of the NATS client's library, which the function frees.
template <class Object, auto destroy>
struct Destroy {
    void operator()(Object* object) const { destroy(object); }
};
template <class Object, auto destroy>
using Handle = std::unique_ptr<Object, Destroy<Object, destroy>>;

using Message = Handle<natsMsg, natsMsg_Destroy>;
using Subscription = Handle<natsSubscription, natsSubscription_Destroy>;

/// A header of a message; empty where it has none of that name.
std::string header_of(natsMsg* message, const char* name);
/// A whole number from 0, or none.
std::optional<std::size_t> number_of(const std::string& text);
/// 64 random bits as text.
std::string random_id();

/// A connection to a NATS server with JetStream. When it is lost it comes back by itself, and what is asked
/// meanwhile waits or fails.
class Connection {
public:
    /// `urls`: of one server, or of several of a cluster, between commas. Throws std::runtime_error with a
    /// sentence that names them, without a password in it.
    explicit Connection(const std::string& urls);

    natsConnection* get() const { return connection_.get(); }
    jsCtx* jetstream() const { return jetstream_.get(); }
    const std::string& name() const { return name_; }
    /// Of this connection; no other has it.
    const std::string& id() const { return id_; }
    bool is_connected() const;
    /// How many times it has come back.
    std::uint64_t reconnects() const;
    /// Throws std::runtime_error, naming `what` cannot be done, if it is not OK.
    void require(natsStatus status, const std::string& what, jsErrCode error = {}) const;

private:
    std::string name_;  // the address without a password
    std::string id_ = random_id();
    Handle<natsConnection, natsConnection_Destroy> connection_;
    Handle<jsCtx, jsCtx_Destroy> jetstream_;
};

}  // namespace vrut::server::nats
