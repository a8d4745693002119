#include "net/registry.hpp"

#include <algorithm>

#include "net/connection.hpp"
#include "rights.hpp"

namespace vrut::server::net {

namespace {

constexpr std::size_t kMostHeld = std::size_t{128} << 20;  // bytes

}  // namespace

void bound_backlog(ConnectionRegistry& registry) {
    std::size_t held = registry.metrics->bytes_held;
    if (held <= kMostHeld) return;
    // What was being sent to those who were cut is given up soon.
    for (const Connection* connection : registry.connections)
        if (connection->is_dropped()) held -= std::min(held, connection->backlog());
    while (held > kMostHeld) {
        std::shared_ptr<Connection> most;
        std::size_t most_waits = 0;
        for (const auto& [name, room] : registry.rooms)
            for (const auto& [client, connection] : room->clients)
                if (const std::size_t waits = connection->backlog(); waits > most_waits) {
                    most = connection;
                    most_waits = waits;
                }
        if (!most) return;
        held -= std::min(held, most_waits);
        most->drop("backlog");
    }
}

std::size_t ConnectionRegistry::clients() const {
    std::size_t clients = 0;
    for (const auto& [name, room] : rooms) clients += room->clients.size();
    return clients;
}

bool ConnectionRegistry::has_place_for(protocol::Role role, const protocol::Hello& hello,
                                       const ServedRoom& room) const {
    using protocol::Right;
    const bool controls = may(role, Right::hold_control);
    std::size_t places = max_clients;
    // Where no token is asked for, a whole audience may have this role: then nobody sends one.
    if (may(role, Right::drive_walls) || (controls && !hello.token.empty())) places += kReservedPlaces;
    if (controls && !hello.resume.empty() && hello.resume == room.holder_key)
        places = max_clients + kReservedPlaces + kPlacesToResume;
    return clients() < places;
}

std::shared_ptr<Connection> ServedRoom::find(const std::string& client) const {
    const auto found = clients.find(client);
    return found == clients.end() ? nullptr : found->second;
}

void ServedRoom::take_document(engine::EngineOutput& output) {
    // Of a holder who is gone the key stays.
    const auto holder = output.document->holder();
    const auto connection = holder ? find(*holder) : nullptr;
    if (connection || !holder) holder_key = connection ? connection->resume_key() : "";
    const auto for_hosts = output.document->for_hosts();
    host_document.set(for_hosts ? for_hosts : output.document, output.by, output.by_since);
    document.set(std::move(output.document), std::move(output.by), output.by_since);
    pictures.forget_before(document.newest()->revision());
}

void ServedRoom::take(engine::EngineOutput output) {
    if (output.begins_anew) {
        for (const auto& [name, connection] : std::map(clients))
            connection->close(boost::beast::websocket::close_code::service_restart, "the room begins anew");
        newest.reset();
        present_frame = 0;
    }
    if (output.document) take_document(output);
    if (output.stats) stats = std::move(output.stats);
    if (output.loading) {
        loading = std::move(output.loading);
        loads = output.loads;
    }
    if (output.size) size = *output.size;
    if (output.present_frame) present_frame = *output.present_frame;
    for (auto& answer : output.answers)
        if (const auto connection = find(answer.client)) connection->answer(std::move(answer));
    for (const auto& [client, text] : output.pointed)
        for (const auto& [name, connection] : clients) connection->pointed(client, text);
    for (const std::string& name : output.failed_pictures) pictures.give_up(name);
    for (const auto& [client, handled] : output.handled)
        if (const auto connection = find(client)) connection->handled(handled);
    for (const auto& [name, connection] : clients) connection->pump();
}

void ServedRoom::take(std::shared_ptr<const engine::EncodedPicture> picture) {
    if (!picture->client.empty()) {
        if (pictures.take(*picture)) return;
        if (const auto connection = find(picture->client)) connection->take_snapshot(std::move(picture));
        return;
    }
    const std::int64_t before = newest ? newest->header.frame : 0;
    newest = std::move(picture);
    for (const auto& [name, connection] : clients) connection->newest_changed(before);
}

}  // namespace vrut::server::net
