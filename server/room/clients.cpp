#include "room/clients.hpp"

#include <algorithm>

namespace vrut::server::room {

using protocol::Right;

void Clients::add(const std::string& id, const Client& client) {
    clients_[id] = client;
    clients_[id].arrival = ++arrivals_;
}

Client* Clients::find(const std::string& id) {
    const auto found = clients_.find(id);
    return found == clients_.end() ? nullptr : &found->second;
}

const Client* Clients::find(const std::string& id) const {
    const auto found = clients_.find(id);
    return found == clients_.end() ? nullptr : &found->second;
}

bool Clients::any_may(Right right) const {
    return std::ranges::any_of(clients_, [&](const auto& entry) { return may(entry.second.role, right); });
}

std::string Clients::free_name(const std::string& name, const std::string& resume_key) const {
    const auto is_taken = [&](const std::string& candidate) {
        return std::ranges::any_of(clients_, [&](const auto& entry) {
            const Client& other = entry.second;
            const bool is_same = !resume_key.empty() && other.resume_key == resume_key;
            return other.name == candidate && !is_same;
        });
    };
    if (name.empty() || !is_taken(name)) return name;
    for (int number = 2;; ++number) {
        const std::string suffix = " " + std::to_string(number);
        std::size_t size = std::min(name.size(), protocol::kMaxClientName - suffix.size());
        while (size > 0 && size < name.size() && (name[size] & 0xC0) == 0x80) --size;  // within a character
        std::string candidate = name.substr(0, size) + suffix;
        if (!is_taken(candidate)) return candidate;
    }
}

std::optional<std::string> Clients::shown_name(const std::string& id) const {
    const Client* const client = find(id);
    return client && !client->name.empty() ? std::optional(client->name) : std::nullopt;
}

std::map<std::string, protocol::ClientState> Clients::listed() const {
    using Entry = decltype(clients_)::const_pointer;
    std::vector<Entry> listed;
    for (const auto& entry : clients_)
        if (may(entry.second.role, Right::present) || !entry.second.name.empty()) listed.push_back(&entry);
    std::ranges::sort(listed, {}, [](Entry entry) {
        return std::pair(!may(entry->second.role, Right::present), entry->second.arrival);
    });
    listed.resize(std::min(listed.size(), protocol::kMaxListedClients));
    std::map<std::string, protocol::ClientState> clients;
    for (const Entry entry : listed) clients[entry->first] = {shown_name(entry->first), entry->second.role};
    return clients;
}

}  // namespace vrut::server::room
