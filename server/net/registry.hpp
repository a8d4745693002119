#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "engine/engine.hpp"
#include "net/access.hpp"
#include "net/connection_limit.hpp"
#include "net/deadlines.hpp"
#include "net/document_updates.hpp"
#include "net/tls.hpp"
#include "net/view_pictures.hpp"
#include "observe/metrics.hpp"

namespace vrut::server::net {

class Connection;

/// State shared by all connections. On the net thread only, except the engine's mailbox and the metrics.
struct ConnectionRegistry {
    Access access;
    std::size_t max_clients = 64;
    std::chrono::milliseconds longest_busy{30'000};  ///< of a loop that has something to do
    Deadlines deadlines;
    std::shared_ptr<Tls> tls;              ///< null: none
    std::optional<ConnectionLimit> limit;  ///< of connections of any kind
    observe::Metrics* metrics = nullptr;
    engine::Engine* engine = nullptr;
    DocumentUpdates document;
    std::shared_ptr<const engine::EncodedPicture> newest;
    std::int64_t present_frame = 0;  ///< the frame that shows what is to be seen now; 0: none
    std::shared_ptr<const std::string> stats, loading;  ///< the newest messages for all
    bool loads = false;                                 ///< a scene is being loaded
    engine::PictureSize size;                           ///< of a picture of the view
    ViewPictures pictures;
    std::map<std::string, std::shared_ptr<Connection>> clients;  ///< those that said hello
    std::set<Connection*> connections;                           ///< those, and those that did not yet
    std::int64_t next_client = 1;
    bool stopping = false;
};

/// Cuts the clients for whom the most waits, while more waits for all than the server keeps.
void bound_backlog(ConnectionRegistry& registry);

}  // namespace vrut::server::net
