#pragma once

#include <boost/asio/ip/address.hpp>
#include <boost/asio/ssl/context.hpp>
#include <chrono>
#include <filesystem>
#include <optional>
#include <set>

#include "net/certificate_authority.hpp"

namespace vrut::server::net {

/// What a server proves itself with to those who speak TLS. Versions before 1.2, ciphers without forward
/// secrecy, and renegotiation are off. On the net thread only.
class Tls {
public:
    /// With a chain of certificates, the server's own first, and its key, both in PEM. Throws
    /// std::runtime_error.
    Tls(const std::filesystem::path& certificates, const std::filesystem::path& key);
    /// With certificates that `authority` issues for the addresses by which the server is reached.
    explicit Tls(CertificateAuthority authority);

    /// For a connection to `local`, an address of this machine.
    boost::asio::ssl::context& context_for(const boost::asio::ip::address& local);
    /// Null where the certificates are of files.
    const CertificateAuthority* authority() const { return authority_ ? &*authority_ : nullptr; }
    /// Reads the files again, for connections that begin from here on. Throws std::runtime_error, and then
    /// goes on with what it has.
    void reload();

private:
    /// In PEM.
    struct Files {
        std::filesystem::path certificates, key;
    };
    void issue();

    std::optional<CertificateAuthority> authority_;
    Files files_;  // without an authority
    boost::asio::ssl::context context_;
    std::set<std::string> addresses_;  // that the certificate names
    std::chrono::system_clock::time_point renew_at_ = std::chrono::system_clock::time_point::max();
};

}  // namespace vrut::server::net
