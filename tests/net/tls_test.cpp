// A server that speaks TLS: what it proves itself with, what it refuses, and that its deadlines hold.
#include "net/tls.hpp"

#include <doctest/doctest.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>

#include "net/addresses.hpp"
#include "net/descriptors.hpp"
#include "pem_files.hpp"
#include "raw_websocket.hpp"
#include "temporary_folder.hpp"

using namespace vrut;
using namespace vrut::server::net;
using namespace vrut::test;
using boost::asio::ip::tcp;
using std::chrono::steady_clock;

namespace {

OpenSslPointer<X509, X509_free> certificate_of(const std::string& pem) {
    const OpenSslPointer<BIO, BIO_free_all> bio(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
    return OpenSslPointer<X509, X509_free>(PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr));
}

/// Why a client that trusts this authority alone refuses the certificate; X509_V_OK if it does not.
int verdict(const CertificateAuthority& authority, X509* certificate) {
    const auto root = certificate_of(authority.certificate());
    const OpenSslPointer<X509_STORE, X509_STORE_free> store(X509_STORE_new());
    X509_STORE_add_cert(store.get(), root.get());
    const OpenSslPointer<X509_STORE_CTX, X509_STORE_CTX_free> context(X509_STORE_CTX_new());
    X509_STORE_CTX_init(context.get(), store.get(), certificate, nullptr);
    X509_STORE_CTX_set_purpose(context.get(), X509_PURPOSE_SSL_SERVER);
    X509_verify_cert(context.get());
    return X509_STORE_CTX_get_error(context.get());
}

ServerOptions with_tls_within(Deadlines deadlines) {
    ServerOptions options = with_tls();
    options.deadlines = deadlines;
    return options;
}

/// A client of one version of TLS whose handshake a test makes by itself.
struct Handshake {
    Handshake(std::uint16_t port, int version) {
        socket.connect({boost::asio::ip::make_address("127.0.0.1"), port});
        SSL_CTX_set_security_level(context.get(), 0);  // or it would not offer old versions
        SSL_CTX_set_min_proto_version(context.get(), version);
        SSL_CTX_set_max_proto_version(context.get(), version);
        tls.reset(SSL_new(context.get()));
        SSL_set_fd(tls.get(), socket.native_handle());
        succeeds = SSL_connect(tls.get()) == 1;
    }
    boost::asio::io_context io;
    tcp::socket socket{io};
    OpenSslPointer<SSL_CTX, SSL_CTX_free> context{SSL_CTX_new(TLS_client_method())};
    OpenSslPointer<SSL, SSL_free> tls;
    bool succeeds = false;
};

const std::string kGetHealth = "GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";

}  // namespace

TEST_CASE("an authority is made once, kept, and readable by its owner alone") {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "state" / "authority.pem";
    const CertificateAuthority made(file), found(file);
    CHECK(made.certificate() == found.certificate());
    CHECK(made.fingerprint().size() == 32 * 3 - 1);
    struct stat status {};
    REQUIRE(::stat(file.c_str(), &status) == 0);
    CHECK((status.st_mode & 0777) == 0600);
    CHECK(std::distance(std::filesystem::directory_iterator(file.parent_path()), {}) == 1);

    REQUIRE(::chmod(file.c_str(), 0640) == 0);
    CHECK_THROWS_WITH(CertificateAuthority{file},
                      doctest::Contains("authority.pem can be read by others: chmod 600 it"));
    const auto other = folder.write("other.pem", "no authority");
    REQUIRE(::chmod(other.c_str(), 0600) == 0);
    CHECK_THROWS_WITH(CertificateAuthority{other},
                      doctest::Contains("is not a certificate authority; remove it for a new one"));
    CHECK(folder.read("other.pem") == "no authority");
    CHECK_THROWS_WITH(CertificateAuthority{other / "below"}, doctest::Contains("cannot be kept"));
}

TEST_CASE("certificates are good for a server's addresses, and the authority for no web site") {
    const TemporaryFolder folder;
    const CertificateAuthority authority(folder.path() / "a.pem"), another(folder.path() / "b.pem");
    const Certificate issued = authority.issue({"192.0.2.7", "2001:db8::7"});
    X509* const x509 = issued.x509.get();
    CHECK(verdict(authority, x509) == X509_V_OK);
    CHECK(verdict(another, x509) != X509_V_OK);
    for (const char* address : {"192.0.2.7", "2001:db8::7", "127.0.0.1", "::1"})
        CHECK_MESSAGE(X509_check_ip_asc(x509, address, 0) == 1, address);
    CHECK(X509_check_host(x509, "localhost", 0, 0, nullptr) == 1);
    CHECK(X509_check_ip_asc(x509, "192.0.2.8", 0) == 0);
    int days = 0, seconds = 0;
    ASN1_TIME_diff(&days, &seconds, nullptr, X509_get0_notAfter(x509));
    CHECK(days <= 397);
    CHECK(days >= 396);

    // Whoever steals its key has no use of it elsewhere.
    std::FILE* const stream = std::fopen((folder.path() / "a.pem").c_str(), "r");
    REQUIRE(stream != nullptr);
    const OpenSslPointer<EVP_PKEY, EVP_PKEY_free> key(PEM_read_PrivateKey(stream, nullptr, nullptr, nullptr));
    std::fclose(stream);
    const auto verdict_on = [&](const std::string& name) {
        const Certificate site = authority.issue({});
        X509* const altered = site.x509.get();
        X509_EXTENSION_free(X509_delete_ext(altered, X509_get_ext_by_NID(altered, NID_subject_alt_name, -1)));
        X509_EXTENSION* const extension =
            X509V3_EXT_conf_nid(nullptr, nullptr, NID_subject_alt_name, name.c_str());
        X509_add_ext(altered, extension, -1);
        X509_EXTENSION_free(extension);
        REQUIRE(X509_sign(altered, key.get(), EVP_sha256()) > 0);
        return verdict(authority, altered);
    };
    CHECK(verdict_on("DNS:localhost") == X509_V_OK);
    CHECK(verdict_on("DNS:preview.local") == X509_V_OK);
    CHECK(verdict_on("IP:192.0.2.7") == X509_V_OK);
    CHECK(verdict_on("DNS:example.org") == X509_V_ERR_PERMITTED_VIOLATION);
    CHECK(verdict_on("DNS:local.example.org") == X509_V_ERR_PERMITTED_VIOLATION);
}

TEST_CASE("certificates and keys that cannot be used are refused with a sentence that names the option") {
    const TemporaryFolder folder;
    const CertificateAuthority authority(folder.path() / "a.pem");
    const auto write = [&](const std::string& name, const Certificate& certificate, bool key) {
        std::FILE* const stream = std::fopen((folder.path() / name).c_str(), "w");
        REQUIRE(stream != nullptr);
        if (key)
            PEM_write_PrivateKey(stream, certificate.key.get(), nullptr, nullptr, 0, nullptr, nullptr);
        else
            PEM_write_X509(stream, certificate.x509.get());
        std::fclose(stream);
        REQUIRE(::chmod((folder.path() / name).c_str(), 0600) == 0);
        return folder.path() / name;
    };
    Certificate good = authority.issue({}), other = authority.issue({});
    const auto certificate = write("good.pem", good, false), key = write("good.key", good, true);
    CHECK_NOTHROW(Tls(certificate, key));
    CHECK_THROWS_WITH(Tls(folder.path() / "none", key),
                      doctest::Contains("none cannot be read as certificates in PEM"));
    CHECK_THROWS_WITH(Tls(key, key), doctest::Contains("--tls-cert"));
    CHECK_THROWS_WITH(Tls(certificate, folder.path() / "none"), doctest::Contains("--tls-key"));
    CHECK_THROWS_WITH(Tls(certificate, write("other.key", other, true)),
                      doctest::Contains("a private key in PEM that belongs to the certificate"));
    REQUIRE(::chmod(key.c_str(), 0644) == 0);
    CHECK_THROWS_WITH(Tls(certificate, key),
                      doctest::Contains("good.key can be read by everybody: chmod o= it"));
    X509_gmtime_adj(X509_getm_notAfter(other.x509.get()), -60);
    CHECK_THROWS_WITH(Tls(write("old.pem", other, false), key), doctest::Contains("old.pem has expired"));
}

TEST_CASE(
    "certificate and key are read again when they were renewed; where they cannot be, the old ones stay") {
    const TemporaryFolder folder;
    const CertificateAuthority authority(folder.path() / "a.pem");
    const auto certificate = folder.path() / "c.pem", key = folder.path() / "k.pem";
    const Certificate first = authority.issue({}), second = authority.issue({"198.51.100.9"});
    write_pem(first, certificate, key);
    Tls tls(certificate, key);
    const auto shows = [&](const Certificate& issued) {
        SSL_CTX* const context = tls.context_for(boost::asio::ip::make_address("127.0.0.1")).native_handle();
        return X509_cmp(SSL_CTX_get0_certificate(context), issued.x509.get()) == 0;
    };
    CHECK(shows(first));
    write_pem(second, certificate, key);
    CHECK(shows(first));
    tls.reload();
    CHECK(shows(second));
    std::filesystem::remove(key);
    CHECK_THROWS_WITH(tls.reload(), doctest::Contains("--tls-key"));
    CHECK(shows(second));
}

TEST_CASE(
    "a certificate of an authority names the address by which a client has come, also one that is new") {
    const TemporaryFolder folder;
    Tls tls{CertificateAuthority(folder.path() / "a.pem")};
    const auto names = [&](const char* local, const char* address) {
        SSL_CTX* const context = tls.context_for(boost::asio::ip::make_address(local)).native_handle();
        return X509_check_ip_asc(SSL_CTX_get0_certificate(context), address, 0) == 1;
    };
    CHECK(names("127.0.0.1", "127.0.0.1"));
    CHECK_FALSE(names("127.0.0.1", "198.51.100.9"));
    CHECK(names("198.51.100.9", "198.51.100.9"));
    CHECK(names("::ffff:198.51.100.10", "198.51.100.10"));
    CHECK(names("fe80::1%1", "fe80::1"));
    CHECK(names("127.0.0.1", "198.51.100.9"));  // they stay
}

TEST_CASE("page, WebSocket and streaming by TLS, and plain HTTP for this machine on the same port") {
    TestServer server({.noise = true}, with_tls());
    RawConnection secure(server.port(), Over::tls), plain(server.port());
    for (RawConnection* connection : {&secure, &plain})
        for (int i = 0; i < 2; ++i) {  // and the connection is kept
            connection->send(kGetHealth);
            CHECK(connection->answer().body == "ok\n");
        }
    // What does not fit into a record of TLS.
    const auto get = [&](RawConnection& from, const std::string& path) {
        from.send("GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
        return from.answer().body;
    };
    const std::string page = get(secure, "/");
    const std::size_t script = page.rfind('"', page.find("/app.js")) + 1;
    const std::string large = "/" + page.substr(script, page.find('"', script) - script);
    const std::string text = get(plain, large);
    CHECK(text.size() > 20'000);
    CHECK(get(secure, large) == text);
    RawWebSocket client(server.port(), {}, Over::tls);
    client.join();
    client.connection.send(frame(kFinal | kText, R"({"type":"snapshot","width":500,"height":400,"id":1})"));
    std::optional<Frame> next = client.receive();
    while (next && next->opcode != kBinary) next = client.receive();
    REQUIRE(next.has_value());
    CHECK(next->payload.size() > 100'000);
    CHECK(next->payload.ends_with("\xff\xd9"));

    secure.send("GET /authority.crt HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
    const HttpAnswer authority = secure.answer();
    CHECK(authority.status == 200);
    CHECK(authority.headers.find("Content-Type: application/x-x509-ca-cert\r\n") != std::string::npos);
    CHECK(certificate_of(authority.body) != nullptr);
    // The end is said by TLS, too: nothing was cut off.
    secure.send("GET /trust HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n");
    CHECK(secure.answer().body.find("authority.crt") != std::string::npos);
    CHECK(secure.ended(2s));
    CHECK((SSL_get_shutdown(secure.tls()) & SSL_RECEIVED_SHUTDOWN) != 0);

    TestServer without;
    for (const char* path : {"/trust", "/authority.crt"})
        CHECK_MESSAGE(http(without.port(), "GET", path).status == 404, path);
}

TEST_CASE("other machines are sent to HTTPS, but for what they need to trust it") {
    const std::vector<std::string> addresses = network_addresses();
    if (addresses.empty()) {
        MESSAGE("skipped: this machine has no address but loopback");
        return;
    }
    ServerOptions options = with_tls();
    options.listen.host = "0.0.0.0";
    options.access.control_token = options.access.view_token = "a token of 24 characters";
    TestServer server({}, options);
    boost::asio::io_context io;
    const auto get = [&](const std::string& head) {
        tcp::socket socket(io);
        socket.connect({boost::asio::ip::make_address(addresses[0]), server.port()});
        boost::asio::write(socket, boost::asio::buffer(head + "Connection: close\r\n\r\n"));
        std::string answer;
        boost::system::error_code end;
        boost::asio::read(socket, boost::asio::dynamic_buffer(answer), end);
        return answer;
    };
    const std::string host = addresses[0] + ":" + std::to_string(server.port());
    const auto request = [&](const std::string& target) {
        return get("GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n");
    };
    for (const char* target :
         {"/", "/index.html", "/frame.jpg?width=1&height=1", "/metrics", "/none", "/ws"}) {
        CAPTURE(target);
        const std::string answer = request(target);
        CHECK(answer.starts_with("HTTP/1.1 308 "));
        CHECK(answer.find("\r\nLocation: https://" + host + target + "\r\n") != std::string::npos);
    }
    CHECK(get("GET /ws HTTP/1.1\r\nHost: " + host +
              "\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
              "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n")
              .starts_with("HTTP/1.1 308 "));
    for (const char* target : {"/trust", "/trust.css", "/authority.crt", "/icon-192.png"})
        CHECK_MESSAGE(request(target).starts_with("HTTP/1.1 200 "), target);
}

TEST_CASE("old versions, renegotiation and bytes that are no TLS end a connection and nothing else") {
    TestServer server({}, with_tls());
    for (const int version : {TLS1_VERSION, TLS1_1_VERSION})
        CHECK_FALSE(Handshake(server.port(), version).succeeds);
    CHECK(Handshake(server.port(), TLS1_3_VERSION).succeeds);
    Handshake client(server.port(), TLS1_2_VERSION);
    REQUIRE(client.succeeds);
    const std::string cipher = SSL_get_cipher_name(client.tls.get());
    CHECK_MESSAGE(cipher.starts_with("ECDHE-ECDSA-"), cipher);
    SSL_renegotiate(client.tls.get());
    CHECK(SSL_do_handshake(client.tls.get()) != 1);

    RawConnection garbage(server.port());
    garbage.send(std::string("\x16\x03\x01\x00\x05", 5) + "12345");
    CHECK(garbage.ended(2s));
    RawWebSocket cut(server.port(), {}, Over::tls);
    cut.join();
    cut.connection.send_below_tls(std::string("\x17\x03\x03\x00\x20", 5) + std::string(32, 'x'));
    CHECK(cut.connection.ended(5s));
    CHECK(eventually([&] { return server.metrics().tls_handshakes_failed == 3; }));
    CHECK(http(server.port(), "GET", "/healthz").status == 200);
}

TEST_CASE(
    "handshakes and records that do not come to their end are cut at the deadlines of what they carry") {
    TestServer server({}, with_tls_within({.request = 1s, .message = 1s}));
    RawWebSocket client(server.port(), {}, Over::tls), patient(server.port(), {}, Over::tls);
    for (RawWebSocket* each : {&client, &patient}) each->join();
    RawConnection silent(server.port()), first(server.port()), half(server.port());
    RawConnection shaken(server.port(), Over::tls);  // and no request
    first.send("\x16");
    half.send("\x16\x03\x01\x02");
    client.connection.send_below_tls(std::string("\x17\x03\x03\x00\x20", 5) + "xx");
    for (RawConnection* each : {&silent, &first, &half, &shaken, &client.connection}) CHECK(each->ended(5s));
    CHECK_FALSE(patient.connection.ended(100ms));
}

TEST_CASE("500 handshakes that stop half way are cut within 5 s, and others feel nothing of them") {
    allow_descriptors(4096);
    TestServer server({}, with_tls());
    const auto start = steady_clock::now();
    std::vector<std::unique_ptr<RawConnection>> slow;
    for (int i = 0; i < 500; ++i) {
        slow.push_back(std::make_unique<RawConnection>(server.port()));
        slow.back()->send(std::string("\x16\x03\x01\x02\x00\x01", 6));
    }
    RawWebSocket client(server.port(), {}, Over::tls);
    client.join();
    for (int i = 1; i <= 20; ++i) {
        const auto sent = steady_clock::now();
        client.connection.send(frame(kFinal | kText, R"({"type":"tree","id":)" + std::to_string(i) + "}"));
        std::optional<Frame> next = client.receive();
        while (next && (next->opcode != kText || Json::parse(next->payload).value("id", 0) != i))
            next = client.receive();
        CHECK(next.has_value());
        CHECK(steady_clock::now() - sent < 1s);
    }
    for (const auto& each : slow) CHECK(each->ended(std::chrono::seconds(5)));
    CHECK(steady_clock::now() - start < 7s);  // 5 s, and what a busy machine adds
}
