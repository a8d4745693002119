#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mesh/picking.hpp"
#include "room/steering.hpp"
#include "server_messages.hpp"

namespace vrut::server::room {

/// What clients point others to. It is no part of the state, steers nothing, and changes nothing that is
/// drawn.
class Pointings {
public:
    /// What a client points at is sent at most 30 times a second.
    static constexpr SessionTime kApart{33'334};
    /// What lies along a ray now.
    using Hit = std::function<std::optional<mesh::Hit>(const mesh::Ray& ray)>;

    /// From here on `client` points along `ray`; none: at nothing. `name`: as others see it.
    void point(const std::string& client, const std::optional<std::string>& name,
               const std::optional<mesh::Ray>& ray);
    /// Looks at what is hit, where it is time for that.
    void send(SessionTime now, const Hit& hit);
    void stop(const std::string& client);
    void stop_all();
    /// When send() has something to do; none: never.
    std::optional<SessionTime> deadline() const;
    /// What is to be sent to all clients: the newest of each that points, or has pointed.
    std::vector<protocol::Pointed> take();

private:
    struct Pointing {
        std::optional<std::string> name = {};
        std::optional<mesh::Ray> ray = {};
        bool waits = false;     ///< others do not know it yet
        bool is_shown = false;  ///< they know a point
        std::optional<SessionTime> last_sent = {};
        /// When the next may be sent.
        SessionTime due() const { return last_sent ? *last_sent + kApart : SessionTime{0}; }
    };

    std::map<std::string, Pointing> pointings_;        ///< by client
    std::map<std::string, protocol::Pointed> newest_;  ///< to be sent, by client
};

}  // namespace vrut::server::room
