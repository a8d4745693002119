#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "messages.hpp"

namespace vrut::server::net {

/// Who may come in. Empty tokens mean that none is asked for.
struct Access {
    std::string control_token, view_token;
    std::vector<std::string>
        allowed_origins;  ///< besides the server's own, as normalized_origin() gives them

    bool needs_token() const { return !control_token.empty() || !view_token.empty(); }
    /// The role that a client gets who asks for `wanted` with this token; none where it may not come in. The
    /// control token gives every role, the view token `view`.
    std::optional<protocol::Role> role_for(protocol::Role wanted, std::string_view token) const;
    /// Where no token is asked for, a page of another site could otherwise reach the server by a name of its
    /// own that leads to this machine: the request must name the loopback interface.
    bool accepts_host(std::string_view host) const;
    /// `origin` as a browser sends it, in a request to `host`: the server's own, behind TLS or not, or
    /// allowed.
    bool accepts_origin(std::string_view origin, std::string_view host) const;
};

/// An origin of HTTP (RFC 6454: scheme://host[:port]) in small letters, without the scheme's own port. None
/// where it is none.
std::optional<std::string> normalized_origin(std::string_view origin);

/// Tokens from a JSON file {"control": …, "view": …} that nobody else can read, or from the environment
/// (VRUT_PREVIEW_CONTROL_TOKEN, VRUT_PREVIEW_VIEW_TOKEN). Throws std::runtime_error.
Access read_access(const std::filesystem::path& token_file);

/// 128 random bits as text. Throws std::runtime_error.
std::string make_token();

/// Compares in a time that does not tell where they differ.
bool equal_in_constant_time(std::string_view a, std::string_view b);

}  // namespace vrut::server::net
