#include "nats/connection.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "observe/log.hpp"

namespace vrut::server::nats {

namespace {

using Options = Handle<natsOptions, natsOptions_Destroy>;

std::vector<std::string> divided(const std::string& urls) {
    std::vector<std::string> list;
    std::istringstream stream(urls);
    for (std::string url; std::getline(stream, url, ',');) list.push_back(url);
    return list;
}

/// Without names and passwords.
std::string public_part(const std::string& urls) {
    std::string list;
    for (const std::string& url : divided(urls)) {
        if (!list.empty()) list += ',';
        const std::size_t scheme = url.find("://"), at = url.rfind('@');
        if (at == std::string::npos)
            list += url;
        else
            list += (scheme == std::string::npos ? "" : url.substr(0, scheme + 3)) + url.substr(at + 1);
    }
    return list;
}

/// By the client's library, on a thread of its own; also when the connection is closed here.
void on_lost(natsConnection* connection, void*) {
    if (!natsConnection_IsClosed(connection)) observe::log_warning("nats_disconnected", {});
}
void on_back(natsConnection*, void*) { observe::log_info("nats_reconnected", {}); }

std::string reason_of(natsStatus status, jsErrCode error) {
    if (error == JSNotEnabledErr || status == NATS_NO_RESPONDERS)
        return "JetStream is off; start nats-server with -js";
    if (status == NATS_NO_SERVER) return "no NATS server answers there";
    if (status == NATS_SSL_ERROR)
        return "TLS fails: this machine does not trust the server's certificate, or it is for another name";
    if (status == NATS_CONNECTION_AUTH_FAILED)
        return "the server refuses the name and the password, or their lack";
    return natsStatus_GetText(status);
}

}  // namespace

std::string header_of(natsMsg* message, const char* name) {
    const char* value = nullptr;
    return natsMsgHeader_Get(message, name, &value) == NATS_OK && value ? value : "";
}

std::optional<std::size_t> number_of(const std::string& text) {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return {};
    return number;
}

std::string random_id() {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::random_device random;
    std::string id;
    for (int i = 0; i < 16; ++i) id += kDigits[random() % kDigits.size()];
    return id;
}

Connection::Connection(const std::string& urls) : name_(public_part(urls)) {
    constexpr std::chrono::milliseconds kPatience{2000}, kReconnect{250}, kPing{500};
    natsOptions* created = nullptr;
    require(natsOptions_Create(&created), "the client cannot start");
    const Options options(created);
    const std::vector<std::string> list = divided(urls);
    std::vector<const char*> servers;
    servers.reserve(list.size());
    for (const std::string& url : list) servers.push_back(url.c_str());
    const bool have_schemes = !list.empty() && std::ranges::all_of(list, [](const std::string& url) {
        return url.starts_with("nats://") || url.starts_with("tls://");
    });
    if (!have_schemes ||
        natsOptions_SetServers(options.get(), servers.data(), static_cast<int>(servers.size())) != NATS_OK)
        throw std::runtime_error("--nats: '" + name_ +
                                 "' is no address of a NATS server, as in nats://HOST:4222");
    natsOptions_SetTimeout(options.get(), kPatience.count());
    natsOptions_SetMaxReconnect(options.get(), -1);
    natsOptions_SetReconnectWait(options.get(), kReconnect.count());
    // A server that hangs is found lost within two seconds.
    natsOptions_SetPingInterval(options.get(), kPing.count());
    natsOptions_SetMaxPingsOut(options.get(), 2);
    natsOptions_SetWriteDeadline(options.get(), kPatience.count());
    natsOptions_SetSendAsap(options.get(), true);
    // Without the name and the password of these they would be of no use.
    natsOptions_SetIgnoreDiscoveredServers(options.get(), true);
    natsOptions_SetName(options.get(), "vrut-preview");
    natsOptions_SetDisconnectedCB(options.get(), on_lost, nullptr);
    natsOptions_SetReconnectedCB(options.get(), on_back, nullptr);
    natsConnection* connected = nullptr;
    require(natsConnection_Connect(&connected, options.get()), "it cannot be reached");
    connection_.reset(connected);
    jsCtx* jetstream = nullptr;
    require(natsConnection_JetStream(&jetstream, connected, nullptr), "it has no JetStream");
    jetstream_.reset(jetstream);
}

bool Connection::is_connected() const {
    return natsConnection_Status(connection_.get()) == NATS_CONN_STATUS_CONNECTED;
}

std::uint64_t Connection::reconnects() const {
    natsStatistics* created = nullptr;
    if (natsStatistics_Create(&created) != NATS_OK) return 0;
    const Handle<natsStatistics, natsStatistics_Destroy> statistics(created);
    std::uint64_t unused = 0, reconnects = 0;
    natsConnection_GetStats(connection_.get(), created);
    natsStatistics_GetCounts(created, &unused, &unused, &unused, &unused, &reconnects);
    return reconnects;
}

void Connection::require(natsStatus status, const std::string& what, jsErrCode error) const {
    if (status == NATS_OK) return;
    throw std::runtime_error("--nats: " + name_ + ": " + what + ": " + reason_of(status, error));
}

}  // namespace vrut::server::nats
