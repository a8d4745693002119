#include "net/addresses.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <qrencode.h>

#include <charconv>
#include <memory>
#include <stdexcept>

namespace vrut::server::net {

namespace asio = boost::asio;

namespace {

bool is_numeric(const std::string& host) {
    in6_addr buffer{};
    return inet_pton(AF_INET, host.c_str(), &buffer) == 1 || inet_pton(AF_INET6, host.c_str(), &buffer) == 1;
}

}  // namespace

ListenAddress parse_listen_address(std::string_view text) {
    const auto fail = [&]() -> ListenAddress {
        throw std::invalid_argument("--listen: expected ADDR:PORT, as 127.0.0.1:8080 or [::1]:8080, found '" +
                                    std::string(text) + "'");
    };
    const std::size_t colon = text.rfind(':');
    if (colon == std::string_view::npos) return fail();
    std::string_view host = text.substr(0, colon);
    const std::string_view port = text.substr(colon + 1);
    if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
    ListenAddress address{std::string(host), 0};
    if (address.host == "localhost") address.host = "127.0.0.1";
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
    if (error != std::errc() || end != port.data() + port.size() || !is_numeric(address.host)) return fail();
    return address;
}

bool is_loopback(const std::string& host) { return host == "::1" || host.starts_with("127."); }

bool is_loopback(const asio::ip::address& address) {
    return address.is_loopback() || (address.is_v6() && address.to_v6().is_v4_mapped() &&
                                     make_address_v4(asio::ip::v4_mapped, address.to_v6()).is_loopback());
}

bool is_any(const std::string& host) { return host == "0.0.0.0" || host == "::"; }

std::vector<std::string> network_addresses() {
    ifaddrs* list = nullptr;
    if (getifaddrs(&list) != 0) return {};
    const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(list, freeifaddrs);
    std::vector<std::string> addresses;
    for (const ifaddrs* entry = list; entry; entry = entry->ifa_next) {
        if (!entry->ifa_addr || entry->ifa_addr->sa_family != AF_INET) continue;
        if ((entry->ifa_flags & IFF_LOOPBACK) != 0 || (entry->ifa_flags & IFF_UP) == 0) continue;
        char text[INET_ADDRSTRLEN] = "";
        const auto* address = reinterpret_cast<const sockaddr_in*>(entry->ifa_addr);
        if (inet_ntop(AF_INET, &address->sin_addr, text, sizeof text)) addresses.emplace_back(text);
    }
    return addresses;
}

std::vector<std::string> page_hosts(const std::string& listen) {
    if (!is_any(listen)) return {listen};
    std::vector<std::string> hosts = network_addresses();
    if (hosts.empty()) hosts = {"127.0.0.1"};
    return hosts;
}

std::string page_address(const std::string& host, std::uint16_t port, bool secure) {
    const std::string name = host.find(':') == std::string::npos ? host : "[" + host + "]";
    return (secure ? "https://" : "http://") + name + ":" + std::to_string(port) + "/";
}

bool names_loopback(std::string_view host) {
    const std::size_t colon = host.starts_with('[') ? host.find(']') + 1 : host.find(':');
    const std::string_view name = host.substr(0, colon);
    in_addr address{};
    // Only a number is one: "127.example.org" is a name, and may lead anywhere.
    const bool loopback_number =
        inet_pton(AF_INET, std::string(name).c_str(), &address) == 1 && ntohl(address.s_addr) >> 24 == 127;
    return name == "localhost" || name == "[::1]" || loopback_number;
}

std::string percent_encoded(const std::string& text) {
    constexpr char kDigits[] = "0123456789ABCDEF";
    std::string result;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (letter || c == '-' || c == '.' || c == '_' || c == '~')
            result += c;
        else
            result += {'%', kDigits[byte >> 4], kDigits[byte & 15]};
    }
    return result;
}

std::vector<std::string> qr_rows(const std::string& text) {
    const std::unique_ptr<QRcode, void (*)(QRcode*)> code(
        QRcode_encodeString8bit(text.c_str(), 0, QR_ECLEVEL_L), QRcode_free);
    if (!code) throw std::runtime_error("the address does not fit into a QR code");
    const auto width = static_cast<std::size_t>(code->width);
    std::vector<std::string> rows(width, std::string(width, '0'));
    for (std::size_t i = 0; i < width * width; ++i)
        if ((code->data[i] & 1) != 0) rows[i / width][i % width] = '1';
    return rows;
}

std::string qr_code(const std::string& text) {
    const std::vector<std::string> rows = qr_rows(text);
    constexpr int kQuietZone = 2;
    const int width = static_cast<int>(rows.size());
    const auto dark = [&](int x, int y) {
        const bool inside = x >= 0 && y >= 0 && x < width && y < width;
        return inside && rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] == '1';
    };
    std::string out;
    for (int y = -kQuietZone; y < width + kQuietZone; y += 2) {
        out += "\x1b[30;107m";  // black on white
        for (int x = -kQuietZone; x < width + kQuietZone; ++x) {
            const bool upper = dark(x, y), lower = dark(x, y + 1);
            out += upper && lower ? "█" : upper ? "▀" : lower ? "▄" : " ";
        }
        out += "\x1b[0m\n";
    }
    return out;
}

}  // namespace vrut::server::net
