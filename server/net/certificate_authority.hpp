#pragma once

#include <openssl/evp.h>
#include <openssl/x509.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace vrut::server::net {

template <class Type, void (*free)(Type*)>
using OpenSslPointer = std::unique_ptr<Type, std::integral_constant<decltype(free), free>>;

/// A certificate, and the private key that belongs to it.
struct Certificate {
    OpenSslPointer<X509, X509_free> x509;
    OpenSslPointer<EVP_PKEY, EVP_PKEY_free> key;
};

/// A certificate authority of this server's own, for a network in which no other knows it. Whoever trusts it
/// trusts it for addresses, localhost and names under .local alone (RFC 5280, 4.2.1.10): not for the names of
/// web sites.
class CertificateAuthority {
public:
    /// That of a file; where there is none, a new one, which is kept there, readable by its owner alone.
    /// Throws std::runtime_error.
    explicit CertificateAuthority(const std::filesystem::path& file);

    /// Returns a certificate for these addresses, for localhost and for this machine's name under .local. It
    /// is good for 397 days, which is as long as browsers accept.
    Certificate issue(const std::vector<std::string>& addresses) const;
    /// Its own, in PEM.
    std::string certificate() const;
    /// SHA-256 of that, as devices show it: "0A:1B:…".
    std::string fingerprint() const;

private:
    Certificate own_;
};

}  // namespace vrut::server::net
