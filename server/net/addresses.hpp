#pragma once

#include <boost/asio/ip/address.hpp>
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
bool is_loopback(const boost::asio::ip::address& address);
/// "0.0.0.0" or "::".
bool is_any(const std::string& host);
/// Numeric IPv4 addresses under which others reach this machine, as its interfaces say.
std::vector<std::string> network_addresses();

/// Hosts under which the page is reached where the server listens at `listen`, the best one first.
std::vector<std::string> page_hosts(const std::string& listen);
/// "http://HOST:PORT/", or with "https:".
std::string page_address(const std::string& host, std::uint16_t port, bool secure);
/// True if a request's host, with or without a port, is the loopback interface: "localhost:8080".
bool names_loopback(std::string_view host);
/// RFC 3986: all but unreserved characters as %XX.
std::string percent_encoded(const std::string& text);

/// A QR code: rows of 0 (light) and 1 (dark), without a quiet zone. Throws std::runtime_error where the text
/// does not fit.
std::vector<std::string> qr_rows(const std::string& text);
/// A QR code for a terminal, in half blocks, dark on light whatever the terminal's colours.
std::string qr_code(const std::string& text);

}  // namespace vrut::server::net
