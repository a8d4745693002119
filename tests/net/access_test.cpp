#include "net/access.hpp"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

using namespace vrut;
using namespace vrut::server::net;
using protocol::Role;

TEST_CASE("without tokens everybody gets the role that he asks for") {
    const Access access;
    CHECK(access.role_for(Role::control, "") == Role::control);
    CHECK(access.role_for(Role::host, "anything") == Role::host);
}

TEST_CASE("the control token gives every role, the view token the view's, another none") {
    Access access;
    access.control_token = "control-token-16";
    access.view_token = "view-token-16-xx";
    for (const Role role : {Role::control, Role::view, Role::host}) {
        CHECK(access.role_for(role, "control-token-16") == role);
        CHECK(access.role_for(role, "view-token-16-xx") == Role::view);
        for (const char* wrong : {"", "control-token-17", "control-token-16x", "control-token-1"})
            CHECK_FALSE(access.role_for(role, wrong).has_value());
    }
    access.view_token.clear();
    CHECK_FALSE(access.role_for(Role::view, "").has_value());
}

TEST_CASE("comparison in constant time is a comparison") {
    CHECK(equal_in_constant_time("", ""));
    CHECK(equal_in_constant_time("abc", "abc"));
    CHECK_FALSE(equal_in_constant_time("abc", "abd"));
    CHECK_FALSE(equal_in_constant_time("abc", "ab"));
    CHECK_FALSE(equal_in_constant_time("ab", "abc"));
    CHECK_FALSE(equal_in_constant_time("", "abc"));
}

TEST_CASE("origins: its own, allowed ones; nothing that looks alike") {
    Access access;
    access.allowed_origins = {"https://preview.example"};
    const char* host = "127.0.0.1:8080";
    for (const char* good : {"http://127.0.0.1:8080", "https://127.0.0.1:8080", "https://preview.example"})
        CHECK_MESSAGE(access.accepts_origin(good, host), good);
    for (const char* bad :
         {"", "null", "http://", "http://127.0.0.1", "http://127.0.0.1:8081", "http://127.0.0.1:80801",
          "http://evil.example", "http://preview.example", "https://preview.example.evil.example",
          "http://127.0.0.1:8080.evil.example", "file://127.0.0.1:8080"})
        CHECK_FALSE_MESSAGE(access.accepts_origin(bad, host), bad);
}

TEST_CASE("origins are compared as they are meant: any letters, a port that the scheme has anyway") {
    Access access;
    access.allowed_origins = {*normalized_origin("HTTPS://Preview.Example:443")};
    for (const char* good : {"https://preview.example", "https://PREVIEW.example:443", "http://desk",
                             "http://DESK:80", "https://desk"})
        CHECK_MESSAGE(access.accepts_origin(good, "Desk"), good);
    CHECK(access.accepts_origin("http://[::1]:8080", "[::1]:8080"));
    for (const char* bad :
         {"https://preview.example:80", "http://preview.example", "http://desk:443", "http://desk:8080"})
        CHECK_FALSE_MESSAGE(access.accepts_origin(bad, "Desk"), bad);
}

TEST_CASE("what is an origin, and what is none") {
    CHECK(normalized_origin("https://preview.example:8443") == "https://preview.example:8443");
    CHECK(normalized_origin("http://Desk:80") == "http://desk");
    CHECK(normalized_origin("https://[FE80::1]:443") == "https://[fe80::1]");
    CHECK(normalized_origin("http://10.0.0.7:443") == "http://10.0.0.7:443");
    for (const char* none : {"",
                             "*",
                             "null",
                             "preview.example",
                             "https://",
                             "https://:80",
                             "https://preview.example/",
                             "https://preview.example/page",
                             "https://preview.example:",
                             "https://preview.example:0",
                             "https://a:65536",
                             "https://a:080",
                             "https://a:8o",
                             "https://u@a",
                             "https://a b",
                             "ftp://a",
                             "https://[",
                             "https://[]",
                             "https://[::1",
                             "https://[::1]x",
                             "https://a,https://b"})
        CHECK_FALSE_MESSAGE(normalized_origin(none), none);
}

TEST_CASE("without a token the request must name the loopback interface") {
    Access access;
    for (const char* good :
         {"localhost", "localhost:8080", "127.0.0.1:8080", "127.0.0.1", "[::1]:8080", "[::1]"})
        CHECK_MESSAGE(access.accepts_host(good), good);
    for (const char* bad : {"", "evil.example:8080", "localhost.evil.example", "192.0.2.1:8080", "[::2]:8080",
                            "127.evil.example:8080", "127.0.0.1.evil.example", "127.1", "localhost."})
        CHECK_FALSE_MESSAGE(access.accepts_host(bad), bad);
    access.control_token = "control-token-16";
    CHECK(access.accepts_host("cave.example:8080"));
}

TEST_CASE("a token file that others can read is refused, as is none") {
    const std::string path = "access_test_tokens.json";
    std::ofstream(path) << R"({"control":"0123456789abcdef"})";
    REQUIRE(::chmod(path.c_str(), 0640) == 0);
    CHECK_THROWS_WITH(read_access(path), doctest::Contains("can be read by others"));
    REQUIRE(::chmod(path.c_str(), 0600) == 0);
    CHECK(read_access(path).control_token == "0123456789abcdef");
    std::ofstream(path) << "{}";
    CHECK_THROWS_WITH(read_access(path), doctest::Contains(path.c_str()));
    std::remove(path.c_str());
    CHECK_THROWS_WITH(read_access(path), doctest::Contains("cannot be opened"));
}

TEST_CASE(
    "a credential of systemd's may be read by way of an access list, which shows as the group's right") {
    const std::filesystem::path folder = std::filesystem::absolute("access_test_credentials");
    std::filesystem::create_directory(folder);
    const std::filesystem::path file = folder / "tokens";
    std::ofstream(file) << R"({"control":"0123456789abcdef"})";
    REQUIRE(::chmod(file.c_str(), 0440) == 0);
    CHECK_THROWS_WITH(read_access(file), doctest::Contains("can be read by others"));
    ::setenv("CREDENTIALS_DIRECTORY", folder.c_str(), 1);
    CHECK(read_access(file).control_token == "0123456789abcdef");
    REQUIRE(::chmod(file.c_str(), 0444) == 0);
    CHECK_THROWS_WITH(read_access(file), doctest::Contains("can be read by others"));
    ::unsetenv("CREDENTIALS_DIRECTORY");
    std::filesystem::remove_all(folder);
}

TEST_CASE("the environment may hold tokens") {
    ::setenv("VRUT_PREVIEW_VIEW_TOKEN", "from-environment", 1);
    CHECK(read_access({}).view_token == "from-environment");
    ::unsetenv("VRUT_PREVIEW_VIEW_TOKEN");
    CHECK_FALSE(read_access({}).needs_token());
    ::setenv("VRUT_PREVIEW_CONTROL_TOKEN", "short", 1);
    CHECK_THROWS_WITH(read_access({}), doctest::Contains("16 to 1000 bytes"));
    ::unsetenv("VRUT_PREVIEW_CONTROL_TOKEN");
}

TEST_CASE("tokens are long and never the same") {
    CHECK(make_token().size() == 32);
    CHECK(make_token() != make_token());
}
