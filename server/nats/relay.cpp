#include "nats/relay.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "observe/log.hpp"

namespace vrut::server::nats {

namespace {

constexpr std::size_t kPartBytes = std::size_t{512} << 10;  // a NATS server takes messages of a megabyte
constexpr std::size_t kMostParts = 256;
constexpr std::size_t kMostIncomplete = 16;  // packets
constexpr std::size_t kMostWaiting = 4096;   // packets to be made

}  // namespace

std::string subject_to(const std::string& room) { return "vrut.rooms." + room + ".in"; }
std::string subject_from(const std::string& room) { return "vrut.rooms." + room + ".out"; }

Outbox::Outbox(const Connection& connection, std::string subject)
    : connection_(connection),
      subject_(std::move(subject)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

Outbox::~Outbox() {
    thread_.request_stop();
    thread_.join();
}

void Outbox::post(Make make) {
    {
        const std::lock_guard lock(mutex_);
        if (waiting_.size() >= kMostWaiting) waiting_.pop_front();
        waiting_.push_back(std::move(make));
    }
    posted_.notify_one();
}

void Outbox::run(const std::stop_token& stop) {
    for (;;) {
        Make make;
        {
            std::unique_lock lock(mutex_);
            // What was posted before the end goes out, too.
            if (!posted_.wait(lock, stop, [&] { return !waiting_.empty(); })) return;
            make = std::move(waiting_.front());
            waiting_.pop_front();
        }
        const auto packet = make();
        if (packet && connection_.is_connected()) send(*packet);
    }
}

void Outbox::send(const Packet& packet) {
    std::string body = packet.json;
    if (!packet.bytes.empty()) {
        body += '\n';
        body.append(packet.bytes.begin(), packet.bytes.end());
    }
    natsConnection* const nats = connection_.get();
    if (body.size() <= kPartBytes) {
        natsConnection_Publish(nats, subject_.c_str(), body.data(), static_cast<int>(body.size()));
        return;
    }
    const std::size_t parts = (body.size() + kPartBytes - 1) / kPartBytes;
    const std::string name = connection_.id() + "." + std::to_string(next_packet_++);
    for (std::size_t part = 0; part < parts; ++part) {
        const std::string_view bytes = std::string_view(body).substr(part * kPartBytes, kPartBytes);
        natsMsg* created = nullptr;
        if (natsMsg_Create(&created, subject_.c_str(), nullptr, bytes.data(),
                           static_cast<int>(bytes.size())) != NATS_OK)
            return;
        const Message message(created);
        natsMsgHeader_Set(created, "Packet", name.c_str());
        natsMsgHeader_Set(created, "Part", std::to_string(part).c_str());
        natsMsgHeader_Set(created, "Parts", std::to_string(parts).c_str());
        if (natsConnection_PublishMsg(nats, created) != NATS_OK) return;
    }
}

Inbox::Inbox(const Connection& connection, const std::string& subject) : connection_(connection) {
    natsSubscription* subscription = nullptr;
    connection_.require(natsConnection_SubscribeSync(&subscription, connection.get(), subject.c_str()),
                        "the subject " + subject + " cannot be read");
    subscription_.reset(subscription);
}

/// What a message completes. Parts of one packet come in their order; where one is missing the packet is
/// lost.
std::optional<std::string> Inbox::complete(natsMsg* message) {
    std::string_view bytes(natsMsg_GetData(message),
                           static_cast<std::size_t>(natsMsg_GetDataLength(message)));
    const std::string name = header_of(message, "Packet");
    if (name.empty()) return std::string(bytes);
    const auto part = number_of(header_of(message, "Part")), parts = number_of(header_of(message, "Parts"));
    if (!part || !parts || *parts > kMostParts || *part >= *parts) return {};
    if (incomplete_.size() >= kMostIncomplete && !incomplete_.contains(name)) incomplete_.clear();
    Incomplete& packet = incomplete_[name];
    if (*part == 0) packet = {0, *parts, {}};
    if (packet.parts != *parts || packet.next_part != *part) {
        incomplete_.erase(name);
        return {};
    }
    packet.body += bytes;
    if (++packet.next_part < *parts) return {};
    std::string body = std::move(packet.body);
    incomplete_.erase(name);
    return body;
}

std::optional<Packet> Inbox::next(std::chrono::milliseconds patience) {
    natsMsg* received = nullptr;
    const natsStatus status = natsSubscription_NextMsg(&received, subscription_.get(), patience.count());
    const Message message(received);
    if (status == NATS_SLOW_CONSUMER) return {};
    if (status != NATS_OK) {
        if (status != NATS_TIMEOUT) std::this_thread::sleep_for(patience);
        return {};
    }
    const auto body = complete(received);
    if (!body) return {};
    const std::size_t line = std::min(body->find('\n'), body->size());
    Packet packet{body->substr(0, line)};
    if (line < body->size())
        packet.bytes.assign(body->begin() + static_cast<std::ptrdiff_t>(line) + 1, body->end());
    return packet;
}

}  // namespace vrut::server::nats
