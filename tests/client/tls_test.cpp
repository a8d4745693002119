// The client for hosts, against servers that speak TLS with right certificates and with wrong ones.
#include <doctest/doctest.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <fstream>
#include <thread>

#include "preview_client.hpp"
#include "temporary_folder.hpp"
#include "test_client.hpp"

using namespace vrut;
using namespace vrut::test;
using boost::asio::ip::tcp;
namespace ssl = boost::asio::ssl;

namespace {

constexpr const char* kName = "preview.example";
constexpr long kDay = 24 * 3600;

template <class Type, void (*free)(Type*)>
using Owned = std::unique_ptr<Type, std::integral_constant<decltype(free), free>>;
using Key = Owned<EVP_PKEY, EVP_PKEY_free>;
using X509Pointer = Owned<X509, X509_free>;

/// A certificate and its key.
struct ServerCertificate {
    X509Pointer x509;
    Key key;
};

struct CertificateOptions {
    std::string names = std::string("DNS:") + kName;  ///< subjectAltName
    long from = -kDay, until = kDay;                  ///< seconds from now
};

void add_extension(X509* certificate, int kind, const std::string& value) {
    X509_EXTENSION* const extension = X509V3_EXT_conf_nid(nullptr, nullptr, kind, value.c_str());
    REQUIRE(extension != nullptr);
    X509_add_ext(certificate, extension, -1);
    X509_EXTENSION_free(extension);
}

/// Signed by `issuer`, or by itself, and then an authority.
ServerCertificate certificate_of(const CertificateOptions& options,
                                 const ServerCertificate* issuer = nullptr) {
    ServerCertificate made{X509Pointer(X509_new()), Key(EVP_EC_gen("P-256"))};
    X509* const x509 = made.x509.get();
    X509_set_version(x509, X509_VERSION_3);
    static long serial = 0;
    ASN1_INTEGER_set(X509_get_serialNumber(x509), ++serial);
    X509_gmtime_adj(X509_getm_notBefore(x509), options.from);
    X509_gmtime_adj(X509_getm_notAfter(x509), options.until);
    X509_set_pubkey(x509, made.key.get());
    const std::string title = issuer != nullptr ? "server" : "authority " + std::to_string(serial);
    X509_NAME_add_entry_by_txt(X509_get_subject_name(x509), "CN", MBSTRING_ASC,
                               reinterpret_cast<const unsigned char*>(title.c_str()), -1, -1, 0);
    X509_set_issuer_name(x509, X509_get_subject_name(issuer != nullptr ? issuer->x509.get() : x509));
    if (issuer == nullptr) add_extension(x509, NID_basic_constraints, "critical,CA:TRUE");
    add_extension(x509, NID_subject_alt_name, options.names);
    REQUIRE(X509_sign(x509, issuer != nullptr ? issuer->key.get() : made.key.get(), EVP_sha256()) > 0);
    return made;
}

/// Serves one client by TLS: sends `welcome` and `state`, and counts `shown`.
class TlsServer {
public:
    explicit TlsServer(const ServerCertificate& certificate, int newest_version = TLS1_3_VERSION) {
        SSL_CTX* const native = context_.native_handle();
        SSL_CTX_use_certificate(native, certificate.x509.get());
        SSL_CTX_use_PrivateKey(native, certificate.key.get());
        SSL_CTX_set_security_level(native, 0);  // or it would not speak old versions
        SSL_CTX_set_min_proto_version(native, TLS1_VERSION);
        SSL_CTX_set_max_proto_version(native, newest_version);
        thread_ = std::thread([this] { run(); });
    }
    ~TlsServer() { thread_.join(); }
    std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
    std::string name, version;    ///< that the client asked for, and speaks; once it is connected
    std::atomic<int> reports{0};  ///< `shown`

private:
    void run() {
        boost::beast::websocket::stream<boost::beast::ssl_stream<tcp::socket>> socket(io_, context_);
        boost::beast::error_code error;
        acceptor_.accept(boost::beast::get_lowest_layer(socket));
        socket.next_layer().handshake(ssl::stream_base::server, error);
        if (error) return;
        SSL* const tls = socket.next_layer().native_handle();
        const char* const asked = SSL_get_servername(tls, TLSEXT_NAMETYPE_host_name);
        name = asked != nullptr ? asked : "";
        version = SSL_get_version(tls);
        socket.accept(error);
        for (
            const char* text :
            {R"({"type":"welcome","version":1,"client":"c7","role":"host","limits":{}})",
             R"({"type":"state","revision":5,"state":{"selection":{},"camera":{"eye":[0,0,4],"focus":[0,0,0],"up":[0,1,0],"center":[0,0,0],"fov":40,"near":1,"far":9}}})"})
            if (!error) socket.write(boost::asio::buffer(std::string(text)), error);
        for (boost::beast::flat_buffer buffer; !error; buffer.clear()) {
            socket.read(buffer, error);
            if (!error)
                reports += Json::parse(boost::beast::buffers_to_string(buffer.data()))["type"] == "shown";
        }
    }

    boost::asio::io_context io_;
    ssl::context context_{ssl::context::tls_server};
    tcp::acceptor acceptor_{io_, {boost::asio::ip::make_address("127.0.0.1"), 0}};
    std::thread thread_;
};

/// An authority, and its certificate's file.
struct Authority {
    ServerCertificate certificate = certificate_of({.names = "DNS:authority"});
    TemporaryFolder folder;
    std::string file = (folder.path() / "ca.pem").string();
    Authority() {
        std::FILE* const stream = std::fopen(file.c_str(), "w");
        REQUIRE(stream != nullptr);
        PEM_write_X509(stream, certificate.x509.get());
        std::fclose(stream);
    }
};

struct Outcome {
    bool connected = false;
    std::vector<std::string> problems;
};

client::Options options_for(std::uint16_t port, const client::Tls& tls) {
    client::Options options;
    options.port = port;
    options.tls = tls;
    return options;
}

/// Polls until the client is connected or reports a problem.
Outcome outcome_of(const client::Options& options) {
    client::PreviewClient client(options);
    Outcome outcome;
    client.on_error = [&](const client::Problem& problem) {
        CHECK(problem.code == "connection");
        outcome.problems.push_back(problem.message);
    };
    eventually([&] {
        client.poll(5ms);
        return client.connected() || !outcome.problems.empty();
    });
    outcome.connected = client.connected();
    return outcome;
}

void check_refused(const Outcome& outcome, std::uint16_t port, const std::string& why) {
    CHECK_FALSE(outcome.connected);
    REQUIRE(outcome.problems.size() == 1);
    CHECK(outcome.problems[0] == "VRUT Preview at 127.0.0.1:" + std::to_string(port) + ": " + why);
}

}  // namespace

TEST_CASE("a host follows by TLS, having verified the server's name by an authority of its own") {
    const Authority authority;
    TlsServer server(certificate_of({}, &authority.certificate));
    client::PreviewClient client(options_for(server.port(), {authority.file, kName}));
    REQUIRE(eventually([&] {
        client.poll(5ms);
        return client.connected();
    }));
    CHECK(server.name == kName);
    CHECK(server.version == "TLSv1.3");
    CHECK(client.camera().eye == client::Vector3{0, 0, 4});
    client.report_shown(5);
    CHECK(eventually([&] {
        client.poll(5ms);
        return server.reports == 1;
    }));
}

TEST_CASE("a certificate may be one of an address, and TLS 1.2 is spoken") {
    const Authority authority;
    const ServerCertificate certificate = certificate_of({.names = "IP:127.0.0.1"}, &authority.certificate);
    for (const int version : {TLS1_3_VERSION, TLS1_2_VERSION}) {
        TlsServer server(certificate, version);
        CHECK(outcome_of(options_for(server.port(), {authority.file, ""})).connected);
        CHECK(server.name.empty());  // an address is no name to ask for
    }
}

TEST_CASE("a wrong certificate is refused in a sentence that tells what to do") {
    const Authority authority, other;
    const auto check = [&](const ServerCertificate& certificate, const client::Tls& tls,
                           const std::string& why) {
        CAPTURE(why);
        TlsServer server(certificate);
        check_refused(outcome_of(options_for(server.port(), tls)), server.port(), why);
    };
    const ServerCertificate* const issuer = &authority.certificate;
    check(certificate_of({.from = -2 * kDay, .until = -kDay}, issuer), {authority.file, kName},
          "its certificate has expired: renew it, or set the clock of this machine");
    check(certificate_of({.from = kDay, .until = 2 * kDay}, issuer), {authority.file, kName},
          "its certificate is not valid yet: set the clock of this machine");
    check(certificate_of({}, issuer), {authority.file, "other.example"},
          "its certificate is not for 'other.example': connect by a name that it has, or set the server name "
          "to "
          "one");
    check(certificate_of({}, issuer), {authority.file, ""},
          "its certificate is not for '127.0.0.1': connect by a name that it has, or set the server name to "
          "one");
    const std::string untrusted =
        "its certificate is not signed by an authority that is trusted here: name the file of its authority";
    check(certificate_of({}), {authority.file, kName}, untrusted);
    check(certificate_of({}, issuer), {other.file, kName}, untrusted);
    check(certificate_of({}, issuer), {"", kName}, untrusted);
}

TEST_CASE("a CA file that cannot be read is reported before a connection is made") {
    const TemporaryFolder folder;
    const std::string none = (folder.path() / "none.pem").string();
    check_refused(outcome_of(options_for(1, {none, ""})), 1,
                  "the authorities in '" + none + "' cannot be read: No such file or directory");
    const std::string garbage = folder.write("garbage.pem", "no certificate").string();
    const Outcome outcome = outcome_of(options_for(1, {garbage, ""}));
    REQUIRE(outcome.problems.size() == 1);
    CHECK(outcome.problems[0].find("the authorities in '" + garbage + "' cannot be read: ") !=
          std::string::npos);
}

TEST_CASE("a server without TLS, with an old version or without an answer is reported in time") {
    const Authority authority;
    const client::Tls tls{authority.file, kName};
    TlsServer old(certificate_of({}, &authority.certificate), TLS1_1_VERSION);
    const Outcome outcome = outcome_of(options_for(old.port(), tls));
    REQUIRE(outcome.problems.size() == 1);
    CHECK(outcome.problems[0].find(": TLS fails: ") != std::string::npos);

    TestServer plain;
    const Outcome without = outcome_of(options_for(plain.port(), tls));
    REQUIRE(without.problems.size() == 1);
    CHECK(without.problems[0].find(": TLS fails: ") != std::string::npos);

    boost::asio::io_context io;
    const tcp::acceptor silent(io, {boost::asio::ip::make_address("127.0.0.1"), 0});  // by the system alone
    client::Options options = options_for(silent.local_endpoint().port(), tls);
    options.connect_timeout = 300ms;
    const Outcome late = outcome_of(options);
    CHECK_FALSE(late.connected);
    CHECK(late.problems.size() == 1);
}
