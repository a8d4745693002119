#include "net/access.hpp"

#include <sys/random.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "net/addresses.hpp"
#include "tokens.hpp"

namespace vrut::server::net {

namespace {

/// Rights that nobody may have to a file of tokens. What lies in the folder of credentials is for this
/// service alone; systemd 254 and later give it to the service by an access list, which shows as rights of
/// the group.
mode_t forbidden_rights(const std::filesystem::path& file) {
    const char* credentials = std::getenv("CREDENTIALS_DIRECTORY");
    const bool credential = credentials && file.parent_path() == credentials;
    return credential ? S_IRWXO : S_IRWXG | S_IRWXO;
}

}  // namespace

bool equal_in_constant_time(std::string_view a, std::string_view b) {
    unsigned difference = a.size() == b.size() ? 0 : 1;
    for (std::size_t i = 0; i < a.size(); ++i)
        difference |= static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^
                                            static_cast<unsigned char>(i < b.size() ? b[i] : 0));
    return difference == 0;
}

std::optional<protocol::Role> Access::role_for(protocol::Role wanted, std::string_view token) const {
    if (!needs_token()) return wanted;
    // Both are compared whatever the first says.
    const bool control = !control_token.empty() && equal_in_constant_time(token, control_token);
    const bool view = !view_token.empty() && equal_in_constant_time(token, view_token);
    if (control) return wanted;
    return view ? std::optional(protocol::Role::view) : std::nullopt;
}

bool Access::accepts_host(std::string_view host) const {
    if (needs_token()) return true;
    return names_loopback(host);
}

bool Access::accepts_origin(std::string_view origin, std::string_view host) const {
    const auto asked = normalized_origin(origin);
    if (!asked) return false;
    if (std::ranges::find(allowed_origins, *asked) != allowed_origins.end()) return true;
    return asked == normalized_origin("http://" + std::string(host)) ||
           asked == normalized_origin("https://" + std::string(host));
}

std::optional<std::string> normalized_origin(std::string_view origin) {
    std::string text(origin);
    std::ranges::transform(text, text.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c; });
    const std::string_view scheme = text.starts_with("https://") ? "https://" : "http://";
    if (!text.starts_with(scheme)) return std::nullopt;
    const std::string_view rest = std::string_view(text).substr(scheme.size());
    const bool is_v6 = rest.starts_with('[');
    const std::size_t end = is_v6 ? rest.find(']') + 1 : std::min(rest.find(':'), rest.size());
    const std::string_view host = rest.substr(0, end);
    std::string_view port = rest.substr(end);
    const auto all_of = [](std::string_view part, std::string_view others) {
        return std::ranges::all_of(part, [&](char c) {
            return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || others.find(c) != others.npos;
        });
    };
    const bool is_host =
        is_v6 ? host.size() > 2 && all_of(host, "[]:.") : !host.empty() && all_of(host, "-._");
    if (!is_host) return std::nullopt;
    if (port.empty()) return text;
    port.remove_prefix(1);
    int number = 0;
    const auto [stop, error] = std::from_chars(port.data(), port.data() + port.size(), number);
    if (error != std::errc() || stop != port.data() + port.size() || number < 1 || number > 65'535 ||
        port.starts_with('0'))
        return std::nullopt;
    const bool is_schemes_own = number == (scheme == "https://" ? 443 : 80);
    return std::string(scheme) + std::string(host) + (is_schemes_own ? "" : ":" + std::string(port));
}

Access read_access(const std::filesystem::path& token_file) {
    Access access;
    if (const char* token = std::getenv("VRUT_PREVIEW_CONTROL_TOKEN")) access.control_token = token;
    if (const char* token = std::getenv("VRUT_PREVIEW_VIEW_TOKEN")) access.view_token = token;
    for (const auto& [variable, token] : {std::pair("VRUT_PREVIEW_CONTROL_TOKEN", &access.control_token),
                                          std::pair("VRUT_PREVIEW_VIEW_TOKEN", &access.view_token)})
        if (!token->empty() && !protocol::is_token(*token))
            throw std::runtime_error(std::string(variable) + " must be 16 to 1000 bytes long");
    if (token_file.empty()) return access;

    struct stat status {};
    if (::stat(token_file.c_str(), &status) != 0)
        throw std::runtime_error("token file " + token_file.string() +
                                 " cannot be opened: " + std::strerror(errno));
    if ((status.st_mode & forbidden_rights(token_file)) != 0)
        throw std::runtime_error("token file " + token_file.string() +
                                 " can be read by others: chmod 600 it");
    std::ifstream stream(token_file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const auto tokens = protocol::parse_tokens(text);
    if (!tokens)
        throw std::runtime_error("token file " + token_file.string() + ": " + tokens.error().message);
    if (!tokens->control.empty()) access.control_token = tokens->control;
    if (!tokens->view.empty()) access.view_token = tokens->view;
    return access;
}

std::string make_token() {
    std::array<std::uint8_t, 16> bytes{};
    if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
        throw std::runtime_error("the system gives no random numbers for a token");
    constexpr char kDigits[] = "0123456789abcdef";
    std::string token;
    for (const std::uint8_t byte : bytes) {
        token += kDigits[byte >> 4];
        token += kDigits[byte & 15];
    }
    return token;
}

}  // namespace vrut::server::net
