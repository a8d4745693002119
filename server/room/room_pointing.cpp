// What clients point others to. It is no part of the state, steers nothing, and changes nothing that is
// drawn.
#include "room/room.hpp"

namespace vrut::server::room {

namespace code = protocol::error_code;

bool Room::may_point(const std::string& client) const {
    const auto found = clients_.find(client);
    if (found == clients_.end()) return false;
    return may(found->second.role, protocol::Right::hold_control) || state_.pointing.watchers;
}

void Room::apply(const Received& received, const protocol::Point& point) {
    Client& client = clients_[received.client];
    // Who may not point may stop it.
    if (point.x && !may_point(received.client)) {
        if (!received.is_input() || !std::exchange(client.knows_no_pointing, true))
            reject(received, code::not_allowed,
                   "who presents does not let watchers point: 'pointing.watchers' is false");
        return;
    }
    std::optional<mesh::Ray> ray;
    if (point.x) {
        const auto seen = frame_named(received, point.frame);
        if (!seen) return;
        ray = ray_at(*seen, *point.x, *point.y);
    }
    accepted_ = true;
    Pointing& pointing = pointings_[received.client];
    pointing.ray = ray;
    pointing.waits = true;
    send_pointings();
}

void Room::send_pointings() {
    for (auto& [client, pointing] : pointings_) {
        if (!pointing.waits || pointing.due() > time_) continue;
        pointing.waits = false;
        if (!pointing.ray && !pointing.is_shown) continue;
        pointing.last_sent = time_;
        const auto hit = pointing.ray ? hit_along(*pointing.ray, false) : std::nullopt;
        // That it points at nothing is sent once.
        if (hit || pointing.is_shown) pointed_[client] = {client, shown_name(client), {}, {}};
        pointing.is_shown = hit.has_value();
        if (!hit) continue;
        pointed_[client].point = hit->point;
        pointed_[client].normal = hit->normal;
    }
    std::erase_if(pointings_, [&](const auto& entry) {
        const Pointing& pointing = entry.second;
        return !pointing.waits && !pointing.is_shown && pointing.due() <= time_;
    });
}

void Room::stop_pointing(const std::string& client) {
    const auto pointing = pointings_.extract(client);
    if (!pointing.empty() && pointing.mapped().is_shown)
        pointed_[client] = {client, shown_name(client), {}, {}};
}

void Room::stop_all_pointings() {
    for (const auto& [client, known] : clients_) stop_pointing(client);
}

void Room::use_pointing() {
    for (auto& [name, client] : clients_) {
        client.knows_no_pointing = false;
        if (!may_point(name)) stop_pointing(name);
    }
}

std::vector<protocol::Pointed> Room::take_pointed() {
    std::vector<protocol::Pointed> taken;
    for (auto& [client, pointed] : pointed_) taken.push_back(std::move(pointed));
    pointed_.clear();
    return taken;
}

std::optional<SessionTime> Room::pointing_deadline() const {
    std::optional<SessionTime> first;
    for (const auto& [client, pointing] : pointings_)
        if (pointing.waits) first = std::min(first.value_or(pointing.due()), pointing.due());
    return first;
}

}  // namespace vrut::server::room
