#include "net/share_address.hpp"

#include <stdexcept>

namespace vrut::server::net {

namespace {

namespace code = protocol::error_code;

/// The host of an address of HTTP, with its port; empty where it is none, or has more than a path.
std::string_view host_of(std::string_view address) {
    for (const std::string_view scheme : {"http://", "https://"}) {
        if (!address.starts_with(scheme)) continue;
        for (const char c : address)
            if (c <= ' ' || c > '~' || c == '#' || c == '?') return {};
        address.remove_prefix(scheme.size());
        return address.substr(0, address.find('/'));
    }
    return {};
}

}  // namespace

room::ShareAddress share_address(const ListenAddress& listen, std::uint16_t port, bool secure,
                                 const Access& access) {
    return [host = listen.host, port, secure,
            access](std::string page) -> tl::expected<protocol::SharedAddress, protocol::Error> {
        if (!page.empty() && host_of(page).empty())
            return tl::unexpected(
                protocol::Error{{}, code::out_of_range, "'page' must be the address of a page"});
        if (access.needs_token() && access.view_token.empty())
            return tl::unexpected(
                protocol::Error{{}, code::failed, "the server has no token for those who only watch"});
        const std::string own = page_address(page_hosts(host).front(), port, secure);
        if (page.empty() || (names_loopback(host_of(page)) && !names_loopback(host_of(own)))) page = own;
        protocol::SharedAddress shared;
        shared.loopback = names_loopback(host_of(page));
        shared.address = page + (page.ends_with('/') ? "" : "/") + "#watch";
        if (access.needs_token()) shared.address += "&token=" + percent_encoded(access.view_token);
        try {
            shared.qr = qr_rows(shared.address);
        } catch (const std::runtime_error& error) {
            return tl::unexpected(protocol::Error{{}, code::failed, error.what()});
        }
        return shared;
    };
}

}  // namespace vrut::server::net
