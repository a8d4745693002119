// Pointing others to things, by messages.
#include "room/room.hpp"

namespace vrut::server::room {

namespace code = protocol::error_code;

bool Room::may_point(const std::string& client) const {
    const Client* const found = clients_.find(client);
    return found && (may(found->role, protocol::Right::hold_control) || state_.pointing.watchers);
}

void Room::apply(const Received& received, const protocol::Point& point) {
    Client& client = clients_.at(received.client);
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
        ray = seen->ray_at(*point.x, *point.y);
    }
    accepted_ = true;
    pointings_.point(received.client, clients_.shown_name(received.client), ray);
    send_pointings();
}

void Room::send_pointings() {
    pointings_.send(time_, [this](const mesh::Ray& ray) { return hit_along(ray, false); });
}

void Room::use_pointing() {
    for (auto& [name, client] : clients_) {
        client.knows_no_pointing = false;
        if (!may_point(name)) pointings_.stop(name);
    }
}

}  // namespace vrut::server::room
