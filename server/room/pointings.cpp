#include "room/pointings.hpp"

#include <algorithm>

namespace vrut::server::room {

void Pointings::point(const std::string& client, const std::optional<std::string>& name,
                      const std::optional<mesh::Ray>& ray) {
    Pointing& pointing = pointings_[client];
    pointing.name = name;
    pointing.ray = ray;
    pointing.waits = true;
}

void Pointings::send(SessionTime now, const Hit& hit) {
    for (auto& [client, pointing] : pointings_) {
        if (!pointing.waits || pointing.due() > now) continue;
        pointing.waits = false;
        if (!pointing.ray && !pointing.is_shown) continue;
        pointing.last_sent = now;
        const auto found = pointing.ray ? hit(*pointing.ray) : std::nullopt;
        // That it points at nothing is sent once.
        if (found || pointing.is_shown) newest_[client] = {client, pointing.name, {}, {}};
        pointing.is_shown = found.has_value();
        if (!found) continue;
        newest_[client].point = found->point;
        newest_[client].normal = found->normal;
    }
    std::erase_if(pointings_, [&](const auto& entry) {
        const Pointing& pointing = entry.second;
        return !pointing.waits && !pointing.is_shown && pointing.due() <= now;
    });
}

void Pointings::stop(const std::string& client) {
    const auto pointing = pointings_.extract(client);
    if (!pointing.empty() && pointing.mapped().is_shown)
        newest_[client] = {client, pointing.mapped().name, {}, {}};
}

void Pointings::stop_all() {
    while (!pointings_.empty()) stop(std::string(pointings_.begin()->first));
}

std::optional<SessionTime> Pointings::deadline() const {
    std::optional<SessionTime> first;
    for (const auto& [client, pointing] : pointings_)
        if (pointing.waits) first = std::min(first.value_or(pointing.due()), pointing.due());
    return first;
}

std::vector<protocol::Pointed> Pointings::take() {
    std::vector<protocol::Pointed> taken;
    for (auto& [client, pointed] : newest_) taken.push_back(std::move(pointed));
    newest_.clear();
    return taken;
}

}  // namespace vrut::server::room
