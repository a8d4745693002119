#pragma once

#include <memory>

#include "net/http_request.hpp"
#include "net/http_response.hpp"
#include "net/registry.hpp"

namespace vrut::server::net {

/// One request while it is answered, on the net thread.
class Exchange {
public:
    virtual ~Exchange() = default;
    /// Once.
    virtual void send(HttpResponse response) = 0;
    /// Its answer takes as long as it takes.
    virtual void wait() = 0;
    /// The peer has closed, or the server stops.
    virtual bool is_gone() = 0;
    /// Instead of an answer: what follows on the connection are the messages of a client of `room`.
    virtual void open_websocket(const HttpRequest& request, std::shared_ptr<ServedRoom> room) = 0;
};

/// Answers by the table of routes. `insecurely`: the request came by HTTP from another machine, where the
/// server speaks TLS.
void answer(const HttpRequest& request, bool insecurely, std::shared_ptr<Exchange> exchange,
            ConnectionRegistry& registry);

}  // namespace vrut::server::net
