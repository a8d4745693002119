#pragma once

#include <doctest/doctest.h>
#include <openssl/pem.h>
#include <sys/stat.h>

#include <filesystem>

#include "net/certificate_authority.hpp"

namespace vrut::test {

/// What a server is given by --tls-cert and --tls-key.
inline void write_pem(const server::net::Certificate& certificate, const std::filesystem::path& chain,
                      const std::filesystem::path& key) {
    std::FILE* const public_part = std::fopen(chain.c_str(), "w");
    REQUIRE(public_part != nullptr);
    PEM_write_X509(public_part, certificate.x509.get());
    std::fclose(public_part);
    std::FILE* const secret = std::fopen(key.c_str(), "w");
    REQUIRE(secret != nullptr);
    PEM_write_PrivateKey(secret, certificate.key.get(), nullptr, nullptr, 0, nullptr, nullptr);
    std::fclose(secret);
    REQUIRE(::chmod(key.c_str(), 0600) == 0);
}

}  // namespace vrut::test
