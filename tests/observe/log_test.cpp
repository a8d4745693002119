#include "observe/log.hpp"

#include <doctest/doctest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "temporary_folder.hpp"
#include "test_client.hpp"

using namespace vrut;
using namespace vrut::server::observe;
using namespace vrut::server::scenes;
using namespace vrut::server::net;
using namespace vrut::test;

namespace {

/// Everything that is logged while it lives.
class Log {
public:
    explicit Log(spdlog::level::level_enum level = spdlog::level::debug) {
        auto logger = std::make_shared<spdlog::logger>(
            "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(stream_));
        logger->set_level(level);
        logger->set_pattern(kLogPattern);
        spdlog::set_default_logger(std::move(logger));
    }
    ~Log() { spdlog::set_default_logger(before_); }
    Log(const Log&) = delete;
    Log& operator=(const Log&) = delete;

    /// Once nobody writes any more.
    std::string text() const { return stream_.str(); }
    std::vector<std::string> lines() const {
        std::istringstream stream(text());
        std::vector<std::string> lines;
        for (std::string line; std::getline(stream, line);) lines.push_back(line);
        return lines;
    }
    std::vector<std::string> lines_of(const std::string& event) const {
        std::vector<std::string> all = lines();
        std::erase_if(all, [&](const std::string& line) {
            return line.find(" event=" + event + " ") == std::string::npos;
        });
        return all;
    }

private:
    std::shared_ptr<spdlog::logger> before_ = spdlog::default_logger();
    std::ostringstream stream_;
};

/// Each line is of fields alone, in printable ASCII, each name once.
void check_lines(const Log& log) {
    static const std::regex field(R"re(([a-z_]+)=([-A-Za-z0-9._:/@+]+|"(?:[^"\\]|\\.)*")( |$))re");
    for (std::string line : log.lines()) {
        CAPTURE(line);
        CHECK(line.starts_with("time="));
        CHECK(std::all_of(line.begin(), line.end(), [](char c) { return c >= ' ' && c <= '~'; }));
        std::set<std::string> names;
        std::smatch match;
        for (std::string rest = line; !rest.empty(); rest = match.suffix()) {
            REQUIRE(std::regex_search(rest, match, field, std::regex_constants::match_continuous));
            CHECK(names.insert(match[1]).second);
        }
    }
}

const std::string kHostile =
    "\"x\" \n\r\ttime=1 level=error event=forged \x1b[31mred\x7f \u202Eltr \u2066 \u2028 \u009B31m";

}  // namespace

TEST_CASE("no text ends a line, makes up a field or steers a terminal") {
    const Log log;
    log_info("test_hostile", {{"text", kHostile}, {"empty", ""}, {"plain", "a/b-c_d.e:1@2+3"}});
    log_info("test_hostile", {{"text", "\xff\xfe \xc3"}, {"long", std::string(100'000, 'x')}});
    log_info("test_hostile", {{"text", std::string("a\0b", 3)}, {"cut", std::string(299, 'x') + "ěě"}});
    log_info("test_hostile", {{"number", std::int64_t{-1}}, {"part", 0.5}, {"size", std::size_t{7}}});
    check_lines(log);
    const auto lines = log.lines();
    REQUIRE(lines.size() == 4);
    CHECK(lines[0].find(R"( empty="" plain=a/b-c_d.e:1@2+3)") != std::string::npos);
    CHECK(lines[0].find(R"(\u202eltr \u2066 \u2028 \u009b31m)") != std::string::npos);
    CHECK(lines[1].find(R"(text="\ufffd\ufffd \ufffd")") != std::string::npos);
    CHECK(lines[1].size() < 500);
    CHECK(lines[2].ends_with("x\\u2026\""));
    CHECK(lines[3].ends_with(" event=test_hostile number=-1 part=0.5 size=7"));
}

TEST_CASE("nobody fills a disk: of one event come few lines, and the next tells how many were left out") {
    const Log log(spdlog::level::info);
    for (int i = 0; i < 5000; ++i) log_info("test_flood", {{"i", i}});
    log_info("test_other", {});
    const std::size_t lines = log.lines().size();
    CHECK(lines >= 101);
    CHECK(lines < 150);
    CHECK(log.lines().back().ends_with("event=test_other"));
    const std::regex told("event=test_flood left_out=[0-9]{4,}$");
    CHECK(eventually([&] {
        log_info("test_flood", {});
        return std::regex_search(log.lines().back(), told);
    }));
}

TEST_CASE("what comes over the wire cannot forge a line, and what is refused is told at debug level alone") {
    for (const auto level : {spdlog::level::debug, spdlog::level::info}) {
        Log log(level);
        {
            TestServer server;
            spdlog::set_level(level);
            TestClient client(server.port());
            client.send({{"type", "hello"}, {"role", "control"}, {"name", kHostile.substr(0, 60)}});
            client.wait_for("state");
            for (int i = 0; i < 200; ++i) {
                client.send({{"type", "open"}, {"scene", kHostile}});
                client.send({{"type", kHostile}});
                client.send({{"type", "patch"}, {"patch", {{kHostile, 1}}}});
                for (int answer = 0; answer < 3; ++answer) client.wait_for("error");
            }
            client.wait_for_still();
            TestClient refused(server.port());
            refused.send({{"type", "hello"}, {"role", kHostile}});
            refused.wait_for_close();
            TestClient foreign(server.port(), {.origin = "http://evil.example\" level=error"});
        }
        check_lines(log);
        const bool debug = level == spdlog::level::debug;
        CHECK(log.lines_of("message_refused").size() == (debug ? 600 : 0));
        CHECK(log.lines_of("frame_sent").empty() == !debug);
        CHECK(log.lines_of("frame_drawn").empty() == !debug);
        CHECK(log.lines_of("joined").size() == 1);
        CHECK(log.lines_of("left").size() == 1);
        CHECK(log.lines_of("refused").size() == 1);
        CHECK(log.lines_of("origin_refused").size() == 1);
        if (!debug) CHECK(log.lines().size() < 20);
    }
}

TEST_CASE("what stands in a scene's file, or in its name, cannot forge a line") {
    const TemporaryFolder folder;
    const std::string name = "b\nlevel=error\u202E.vrut";
    std::ofstream(folder.path() / name) << "vrut-text 1\n" << kHostile;
    Log log;
    {
        ServerOptions options;
        options.library = SceneLibrary(folder.path());
        TestServer server({}, options);
        spdlog::set_level(spdlog::level::debug);
        TestClient client(server.port());
        client.join();
        client.send({{"type", "open"}, {"scene", name}});
        while (!client.wait_for("loading").contains("refused")) {
        }
    }
    check_lines(log);
    CHECK(log.lines_of("scene_refused").size() == 1);
}

TEST_CASE("no token is logged at any level, not even a wrong one") {
    const std::string control = "control-secret-1234", view = "view-secret-123456",
                      wrong = "wrong-secret-12345";
    Log log;
    {
        ServerOptions options;
        options.access.control_token = control;
        options.access.view_token = view;
        TestServer server({}, options);
        spdlog::set_level(spdlog::level::debug);
        for (const auto& [role, token] : {std::pair("control", control), std::pair("view", view)})
            TestClient(server.port()).join(role, token);
        TestClient refused(server.port());
        refused.send({{"type", "hello"}, {"role", "view"}, {"token", wrong}});
        CHECK(refused.wait_for_close() == 1008);
        TestClient malformed(server.port());
        malformed.send_text(R"({"type":"hello","role":7,"token":")" + wrong + "\"}");
        malformed.wait_for_close();
        TestClient early(server.port());
        early.send({{"type", "frame"}, {"token", wrong}});
        early.wait_for_close();
        for (const std::string& token : {control, wrong})
            http(server.port(), "GET", "/metrics?token=" + token,
                 "Host: 127.0.0.1\r\nAuthorization: Bearer " + token + "\r\n");
    }
    CHECK(log.lines_of("joined").size() == 2);
    CHECK(log.text().find("secret") == std::string::npos);
}
