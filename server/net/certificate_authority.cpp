#include "net/certificate_authority.hpp"

#include <fcntl.h>
#include <openssl/bio.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace vrut::server::net {

namespace fs = std::filesystem;

namespace {

using Bio = OpenSslPointer<BIO, BIO_free_all>;
using Number = OpenSslPointer<BIGNUM, BN_free>;

constexpr long kDay = 24L * 3600;  // seconds
/// Clocks of devices may be behind.
constexpr long kSince = -kDay, kAuthorityUntil = 3650 * kDay, kUntil = 397 * kDay;

template <class Result>
Result checked(Result result) {
    if (!result) throw std::runtime_error("OpenSSL cannot make a certificate");
    return result;
}

void add_extension(X509& certificate, const X509& issuer, int kind, const std::string& value) {
    X509V3_CTX context{};
    X509V3_set_ctx(&context, const_cast<X509*>(&issuer), &certificate, nullptr, nullptr, 0);
    const OpenSslPointer<X509_EXTENSION, X509_EXTENSION_free> extension(
        checked(X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str())));
    checked(X509_add_ext(&certificate, extension.get(), -1));
}

/// Of this machine, up to the first dot; "server" where it is none that can be written in a certificate.
std::string host_name() {
    std::array<char, 256> whole{};
    gethostname(whole.data(), whole.size() - 1);
    std::string name = whole.data();
    name.resize(std::min(name.find('.'), name.size()));
    const auto fits = [](unsigned char c) { return c < 0x80 && (std::isalnum(c) || c == '-'); };
    return !name.empty() && name.size() < 50 && std::ranges::all_of(name, fits) ? name : "server";
}

void set_name(X509& certificate, const std::string& name) {
    checked(X509_NAME_add_entry_by_txt(X509_get_subject_name(&certificate), "CN", MBSTRING_UTF8,
                                       reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0));
}

/// Not signed yet.
Certificate new_certificate(const std::string& name, long until) {
    Certificate made{decltype(Certificate::x509)(checked(X509_new())),
                     decltype(Certificate::key)(checked(EVP_EC_gen("P-256")))};
    X509& x509 = *made.x509;
    checked(X509_set_version(&x509, X509_VERSION_3));
    const Number serial(checked(BN_new()));
    checked(BN_rand(serial.get(), 127, BN_RAND_TOP_ONE, BN_RAND_BOTTOM_ANY));
    checked(BN_to_ASN1_INTEGER(serial.get(), X509_get_serialNumber(&x509)));
    checked(X509_gmtime_adj(X509_getm_notBefore(&x509), kSince));
    checked(X509_gmtime_adj(X509_getm_notAfter(&x509), until));
    checked(X509_set_pubkey(&x509, made.key.get()));
    set_name(x509, name);
    return made;
}

Certificate new_authority() {
    Certificate made = new_certificate("VRUT Preview " + host_name(), kAuthorityUntil);
    X509& x509 = *made.x509;
    checked(X509_set_issuer_name(&x509, X509_get_subject_name(&x509)));
    add_extension(x509, x509, NID_basic_constraints, "critical,CA:TRUE,pathlen:0");
    add_extension(x509, x509, NID_key_usage, "critical,keyCertSign,cRLSign");
    add_extension(x509, x509, NID_subject_key_identifier, "hash");
    add_extension(x509, x509, NID_name_constraints, "critical,permitted;DNS:localhost,permitted;DNS:local");
    checked(X509_sign(&x509, made.key.get(), EVP_sha256()));
    return made;
}

/// What `write` puts into a file.
template <class Write>
std::string text_of(const Write& write) {
    const Bio bio(checked(BIO_new(BIO_s_mem())));
    checked(write(bio.get()));
    const char* data = nullptr;
    const long size = BIO_get_mem_data(bio.get(), &data);
    return {data, static_cast<std::size_t>(size)};
}

/// Writes it there, unless somebody else has been faster.
void keep(const Certificate& authority, const fs::path& file) {
    const auto fail = [&](const std::string& what) {
        throw std::runtime_error("the certificate authority cannot be kept: " + what + ": " +
                                 std::strerror(errno));
    };
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    const std::string text = text_of([&](BIO* bio) {
        return PEM_write_bio_PKCS8PrivateKey(bio, authority.key.get(), nullptr, nullptr, 0, nullptr,
                                             nullptr) &&
               PEM_write_bio_X509(bio, authority.x509.get());
    });
    const std::string beside = file.string() + "." + std::to_string(getpid());
    const int descriptor =
        ::open(beside.c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, S_IRUSR | S_IWUSR);
    if (descriptor < 0) fail(beside);
    const bool written = ::write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    const bool kept = (::close(descriptor) == 0) && written &&
                      (::link(beside.c_str(), file.c_str()) == 0 || errno == EEXIST);
    const int reason = errno;
    ::unlink(beside.c_str());
    errno = reason;
    if (!kept) fail(file.string());
}

Certificate read(const fs::path& file) {
    const std::string remedy = "; remove it for a new one, which devices must trust anew";
    struct stat status {};
    if (::stat(file.c_str(), &status) == 0 && (status.st_mode & (S_IRWXG | S_IRWXO)) != 0)
        throw std::runtime_error("the certificate authority " + file.string() +
                                 " can be read by others: chmod 600 it");
    const Bio bio(BIO_new_file(file.c_str(), "r"));
    if (!bio) throw std::runtime_error("the certificate authority " + file.string() + " cannot be opened");
    Certificate found{
        nullptr, decltype(Certificate::key)(PEM_read_bio_PrivateKey(bio.get(), nullptr, nullptr, nullptr))};
    found.x509.reset(PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr));
    if (!found.key || !found.x509 || X509_check_private_key(found.x509.get(), found.key.get()) != 1)
        throw std::runtime_error(file.string() + " is not a certificate authority" + remedy);
    if (X509_cmp_current_time(X509_get0_notAfter(found.x509.get())) <= 0)
        throw std::runtime_error("the certificate authority " + file.string() + " has expired" + remedy);
    return found;
}

}  // namespace

CertificateAuthority::CertificateAuthority(const fs::path& file) {
    std::error_code error;
    if (!fs::exists(file, error)) keep(new_authority(), file);
    own_ = read(file);
}

Certificate CertificateAuthority::issue(const std::vector<std::string>& addresses) const {
    Certificate made = new_certificate("VRUT Preview", kUntil);
    X509& x509 = *made.x509;
    X509& issuer = *own_.x509;
    checked(X509_set_issuer_name(&x509, X509_get_subject_name(&issuer)));
    std::string names = "DNS:localhost,DNS:" + host_name() + ".local,IP:127.0.0.1,IP:::1";
    for (const std::string& address : addresses) names += ",IP:" + address;
    add_extension(x509, issuer, NID_basic_constraints, "critical,CA:FALSE");
    add_extension(x509, issuer, NID_key_usage, "critical,digitalSignature");
    add_extension(x509, issuer, NID_ext_key_usage, "serverAuth");
    add_extension(x509, issuer, NID_authority_key_identifier, "keyid");
    add_extension(x509, issuer, NID_subject_alt_name, names);
    checked(X509_sign(&x509, own_.key.get(), EVP_sha256()));
    return made;
}

std::string CertificateAuthority::certificate() const {
    return text_of([&](BIO* bio) { return PEM_write_bio_X509(bio, own_.x509.get()); });
}

std::string CertificateAuthority::fingerprint() const {
    std::array<unsigned char, EVP_MAX_MD_SIZE> hash{};
    unsigned size = 0;
    checked(X509_digest(own_.x509.get(), EVP_sha256(), hash.data(), &size));
    constexpr char kDigits[] = "0123456789ABCDEF";
    std::string text;
    for (unsigned i = 0; i < size; ++i) {
        if (i > 0) text += ':';
        text += {kDigits[hash[i] >> 4], kDigits[hash[i] & 15]};
    }
    return text;
}

}  // namespace vrut::server::net
