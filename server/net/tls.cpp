#include "net/tls.hpp"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>

#include <stdexcept>

#include "net/addresses.hpp"

namespace vrut::server::net {

namespace asio = boost::asio;
namespace ssl = asio::ssl;

namespace {

constexpr std::chrono::hours kRenewedAfter{24 * 300};

ssl::context new_context() {
    ssl::context context(ssl::context::tls_server);
    SSL_CTX* const native = context.native_handle();
    SSL_CTX_set_min_proto_version(native, TLS1_2_VERSION);
    SSL_CTX_set_cipher_list(native, "ECDHE+AESGCM:ECDHE+CHACHA20");  // of TLS 1.2; all of 1.3 are good
    SSL_CTX_set_options(native, SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION |
                                    SSL_OP_CIPHER_SERVER_PREFERENCE | SSL_OP_PRIORITIZE_CHACHA);
    SSL_CTX_set_mode(native, SSL_MODE_RELEASE_BUFFERS);
    return context;
}

[[noreturn]] void fail(const std::string& option, const std::filesystem::path& file,
                       const std::string& what) {
    ERR_clear_error();
    throw std::runtime_error(option + ": " + file.string() + " " + what);
}

std::string without_scope(const asio::ip::address& address) {
    if (!address.is_v6()) return address.to_string();
    if (address.to_v6().is_v4_mapped())
        return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6()).to_string();
    return asio::ip::address_v6(address.to_v6().to_bytes()).to_string();
}

ssl::context context_of(const std::filesystem::path& certificates, const std::filesystem::path& key) {
    ssl::context context = new_context();
    SSL_CTX* const native = context.native_handle();
    if (SSL_CTX_use_certificate_chain_file(native, certificates.c_str()) != 1)
        fail("--tls-cert", certificates, "cannot be read as certificates in PEM");
    if (X509_cmp_current_time(X509_get0_notAfter(SSL_CTX_get0_certificate(native))) <= 0)
        fail("--tls-cert", certificates, "has expired: devices would refuse it");
    struct stat status {};
    if (::stat(key.c_str(), &status) == 0 && (status.st_mode & S_IRWXO) != 0)
        fail("--tls-key", key, "can be read by everybody: chmod o= it");
    if (SSL_CTX_use_PrivateKey_file(native, key.c_str(), SSL_FILETYPE_PEM) != 1)
        fail("--tls-key", key, "cannot be read as a private key in PEM that belongs to the certificate");
    return context;
}

}  // namespace

Tls::Tls(const std::filesystem::path& certificates, const std::filesystem::path& key)
    : files_{certificates, key}, context_(context_of(certificates, key)) {}

Tls::Tls(CertificateAuthority authority) : authority_(std::move(authority)), context_(new_context()) {
    for (const std::string& address : network_addresses()) addresses_.insert(address);
    issue();
}

void Tls::reload() {
    if (authority_) return;
    context_ = context_of(files_.certificates, files_.key);  // connections keep what they have
}

ssl::context& Tls::context_for(const asio::ip::address& local) {
    if (!authority_) return context_;
    const bool is_new = !local.is_loopback() && addresses_.insert(without_scope(local)).second;
    if (is_new || std::chrono::system_clock::now() >= renew_at_) issue();
    return context_;
}

void Tls::issue() {
    const Certificate issued = authority_->issue({addresses_.begin(), addresses_.end()});
    context_ = new_context();  // connections keep what they have
    SSL_CTX* const native = context_.native_handle();
    if (SSL_CTX_use_certificate(native, issued.x509.get()) != 1 ||
        SSL_CTX_use_PrivateKey(native, issued.key.get()) != 1)
        throw std::runtime_error("OpenSSL does not take the certificate that it made");
    renew_at_ = std::chrono::system_clock::now() + kRenewedAfter;
}

}  // namespace vrut::server::net
