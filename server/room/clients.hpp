#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "messages.hpp"
#include "rights.hpp"
#include "state.hpp"

namespace vrut::server::room {

/// Somebody who is connected.
struct Client {
    protocol::Role role = protocol::Role::view;
    std::optional<protocol::Resize> wanted = {};
    std::string name = {};           ///< as others see it; empty: none
    std::string resume_key = {};     ///< as it gave it; empty: none
    std::uint64_t arrival = 0;       ///< rises
    bool knows_not_allowed = false;  ///< of input without an id
    bool knows_no_pointing = false;  ///< likewise of pointing, while that is not allowed
};

/// Who is here.
class Clients {
public:
    void add(const std::string& id, const Client& client);
    void erase(const std::string& id) { clients_.erase(id); }

    bool contains(const std::string& id) const { return clients_.contains(id); }
    Client* find(const std::string& id);
    const Client* find(const std::string& id) const;
    Client& at(const std::string& id) { return clients_.at(id); }
    const Client& at(const std::string& id) const { return clients_.at(id); }
    auto begin() { return clients_.begin(); }
    auto end() { return clients_.end(); }
    auto begin() const { return clients_.begin(); }
    auto end() const { return clients_.end(); }

    bool any_may(protocol::Right right) const;
    /// `name`, with the first free number behind it where another client has that name. Who comes with the
    /// same key may have it: its connection of before may not have ended yet.
    std::string free_name(const std::string& name, const std::string& resume_key) const;
    /// As others see it; none: it has no name, or is not here.
    std::optional<std::string> shown_name(const std::string& id) const;
    /// For the state: who presents first, then the audience that has a name.
    std::map<std::string, protocol::ClientState> listed() const;

private:
    std::map<std::string, Client> clients_;
    std::uint64_t arrivals_ = 0;
};

}  // namespace vrut::server::room
