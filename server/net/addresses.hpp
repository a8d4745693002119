#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vrut::server::net {

struct ListenAddress {
    std::string host;  ///< numeric, IPv6 without brackets
    std::uint16_t port = 0;
};

/// "127.0.0.1:8080" or "[::1]:8080". Throws std::invalid_argument with a sentence.
ListenAddress parse_listen_address(std::string_view text);

bool is_loopback(const std::string& host);
/// "0.0.0.0" or "::".
bool is_any(const std::string& host);
/// Numeric IPv4 addresses under which others reach this machine, as its interfaces say.
std::vector<std::string> network_addresses();

/// A QR code for a terminal, in half blocks, dark on light whatever the terminal's colours.
std::string qr_code(const std::string& text);

}  // namespace vrut::server::net
