#include "net/share_address.hpp"

#include <doctest/doctest.h>

using namespace vrut;
using namespace vrut::server::net;

namespace {

const std::string kToken = "view-token-16-b+";

Access tokens() {
    Access access;
    access.control_token = "control-token-16";
    access.view_token = kToken;
    return access;
}

protocol::SharedAddress shared(const std::string& listen, const Access& access, const std::string& page,
                               bool secure = false) {
    const auto result = share_address({listen, 0}, 8080, secure, access)(page);
    REQUIRE_MESSAGE(result.has_value(), result.error().message);
    return *result;
}

}  // namespace

TEST_CASE("others watch where the page was opened, with the view token") {
    for (const char* listen : {"0.0.0.0", "192.0.2.7", "127.0.0.1"}) {
        const auto proxied = shared(listen, tokens(), "https://preview.example/car/");
        CHECK(proxied.address == "https://preview.example/car/#watch&token=view-token-16-b%2B");
        CHECK_FALSE(proxied.loopback);
    }
    CHECK(shared("0.0.0.0", tokens(), "http://192.0.2.8").address.starts_with("http://192.0.2.8/#watch&"));
}

TEST_CASE("a page that was opened on the server's own machine is shared by its address in the network") {
    for (const char* page : {"", "http://localhost:8080/", "http://127.0.0.1:8080/", "http://[::1]:8080/"}) {
        const auto told = shared("192.0.2.7", tokens(), page);
        CHECK(told.address.starts_with("http://192.0.2.7:8080/#watch&token="));
        CHECK_FALSE(told.loopback);
        CHECK(shared("192.0.2.7", tokens(), page, true).address.starts_with("https://192.0.2.7:8080/#"));
    }
}

TEST_CASE("where the server listens on loopback, or through a tunnel, only this machine watches") {
    CHECK(shared("127.0.0.1", {}, "").address == "http://127.0.0.1:8080/#watch");
    const auto tunnel = shared("127.0.0.1", {}, "http://localhost:9000/");
    CHECK(tunnel.address == "http://localhost:9000/#watch");
    CHECK(tunnel.loopback);
}

TEST_CASE("the QR code is that of the address") {
    const auto told = shared("192.0.2.7", tokens(), "");
    CHECK(told.qr == qr_rows(told.address));
    CHECK(told.qr.size() >= 21);
    for (const std::string& row : told.qr) CHECK(row.size() == told.qr.size());
    CHECK(told.qr[0].starts_with("11111110"));  // a corner
    CHECK(told.qr[1].starts_with("10000010"));
}

TEST_CASE("what is no address, and a server whose only token lets steer, are refused") {
    const auto code = [](const Access& access, const std::string& page) {
        const auto result = share_address({"127.0.0.1", 0}, 8080, false, access)(page);
        return result ? "" : result.error().code;
    };
    for (const char* page :
         {"preview.example", "file:///etc/passwd", "javascript:alert(1)", "http://", "https:///x",
          "http://x/#y", "http://x/?y", "http://x y/", "http://x/\n", "http://příklad/"})
        CHECK_MESSAGE(code({}, page) == "out-of-range", page);
    Access steering;
    steering.control_token = "control-token-16";
    CHECK(code(steering, "") == "failed");
    Access endless = tokens();
    endless.view_token = std::string(1000, '+');
    CHECK(code(endless, "") == "failed");
}
