#include "event_log.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "codec.hpp"
#include "examples.hpp"
#include "state_document.hpp"

using namespace vrut::protocol;
using nlohmann::json;

namespace {

LogLine line(const std::string& text) {
    auto result = decode_log_line(text);
    INFO(text);
    REQUIRE_MESSAGE(result.has_value(), result.error().message);
    return *result;
}

LogHeader header(const std::string& text) {
    auto result = decode_log_header(text);
    REQUIRE_MESSAGE(result.has_value(), result.error().message);
    return *result;
}

/// What stands in the same bytes is the same number.
std::uint64_t bits(double number) {
    std::uint64_t result = 0;
    std::memcpy(&result, &number, sizeof result);
    return result;
}

const std::string kHeader =
    R"({"log":"vrut-preview","version":1,"scene":"car","sceneSha256":"ab12","started":"2026-01-02T03:04:05Z",)"
    R"("state":{"camera":{"fov":40}},"view":{"width":1280,"height":720,"pixelRatio":1},)"
    R"("clients":[{"client":"c1","role":"control","width":800,"height":600.5,"pixelRatio":2},)"
    R"({"client":"c2","role":"view","name":"Wall"}]})";

const std::string kCamera =
    R"({"node":4,"name":"Driver","eye":[0.1,0.2,0.30000000000000004],"focus":[1,2,3],"up":[0,0,1],)"
    R"("center":[4,5,6],"fov":33.3,"near":0.001,"far":1e9})";

const std::string kFlight =
    R"({"client":"c1","id":9,"since":12.345,"from":)" + kCamera +
    R"(,"fly":{"keyframes":[{"at":0,"camera":{"eye":[1,2,3]}},{"at":1000.5,"camera":{}}],"easing":"linear"}})";

std::string full_header() {
    return kHeader.substr(0, kHeader.size() - 1) +
           R"(,"upAxis":"z","atHome":true,"home":{"eye":[1,2,3],"focus":[4,5,6],"up":[0,1,0],"center":[7,8,9],"fov":33},"frames":[{"frame":17,"camera":)" +
           kCamera + R"(,"view":{"width":640,"height":480,"pixelRatio":0.5}}],"flight":)" + kFlight + "}";
}

}  // namespace

TEST_CASE("a log's header begins with what it is, and has what the replay needs") {
    LogHeader written;
    written.scene = "car";
    written.scene_sha256 = "ab12";
    written.started = "2026-01-02T03:04:05Z";
    written.state = std::make_shared<const json>(json::parse(R"({"camera":{"fov":40}})"));
    written.clients = {{"c1", Role::control, Resize{800, 600.5, 2}}, {"c2", Role::view, {}, "Wall"}};
    const std::string text = encode(written);
    CHECK(text.starts_with(R"({"log":"vrut-preview","version":1,)"));
    CHECK(text.find('\n') == std::string::npos);
    CHECK(json::parse(text) == json::parse(kHeader));
}

TEST_CASE("every member of a log's header is read") {
    const LogHeader read = header(full_header());
    CHECK(read.scene == "car");
    CHECK(read.scene_sha256 == "ab12");
    CHECK(read.up_axis == UpAxis::z);
    CHECK(read.started == "2026-01-02T03:04:05Z");
    CHECK((*read.state)["camera"]["fov"] == 40);
    REQUIRE(read.clients.size() == 2);
    CHECK(read.clients[0].client == "c1");
    CHECK(read.clients[0].role == Role::control);
    CHECK(read.clients[0].wanted == Resize{800, 600.5, 2});
    CHECK(read.clients[1].role == Role::view);
    CHECK_FALSE(read.clients[1].wanted.has_value());
    CHECK(read.clients[0].name.empty());
    CHECK(read.clients[1].name == "Wall");
    CHECK(read.view == Resize{1280, 720, 1});
    CHECK(read.at_home);
    CHECK(read.home == ViewState{{{1, 2, 3}, {4, 5, 6}, {0, 1, 0}, {7, 8, 9}, 33}, {}});
    REQUIRE(read.frames.size() == 1);
    CHECK(read.frames[0].frame == 17);
    CHECK(read.frames[0].view == Resize{640, 480, 0.5});
    const CameraState camera{
        {{0.1, 0.2, 0.30000000000000004}, {1, 2, 3}, {0, 0, 1}, {4, 5, 6}, 33.3}, 4, "Driver", 0.001, 1e9};
    CHECK(read.frames[0].camera == camera);
    REQUIRE(read.flight.has_value());
    CHECK(read.flight->client == "c1");
    CHECK(read.flight->id == 9);
    CHECK(read.flight->since == 12.345);
    CHECK(read.flight->from == camera);
    CHECK(read.flight->fly.easing == Fly::Easing::linear);
    REQUIRE(read.flight->fly.keyframes.size() == 2);
    CHECK(read.flight->fly.keyframes[1].at == 1000.5);

    const LogHeader plain = header(kHeader);
    CHECK_FALSE(plain.at_home);
    CHECK_FALSE(plain.home.has_value());
    CHECK(plain.frames.empty());
    CHECK_FALSE(plain.flight.has_value());
}

TEST_CASE("a header that is written again is the same") {
    for (const std::string& text : {kHeader, full_header()}) {
        CHECK(json::parse(encode(header(text))) == json::parse(text));
        CHECK(encode(header(encode(header(text)))) == encode(header(text)));
    }
    // The document of a state comes back as it was.
    LogHeader written = header(kHeader);
    const auto document = StateDocument::next({}, examples::start());
    written.state = std::make_shared<const json>(document->json());
    const auto state = restored(examples::start(), *header(encode(written)).state);
    REQUIRE(state.has_value());
    CHECK(*state == examples::start());
}

TEST_CASE("each kind of line, as it stands in the file") {
    const auto text = [](const LogLine& written) { return encode(written); };
    CHECK(text({LogTime(12'500), "c1", LogLine::Connected{Role::host}}) ==
          R"({"at":12.5,"client":"c1","event":"connected","role":"host"})");
    CHECK(text({LogTime(0), "c1", LogLine::Connected{Role::view, "Wall"}}) ==
          R"({"at":0.0,"client":"c1","event":"connected","name":"Wall","role":"view"})");
    CHECK(text({LogTime(0), "c1", LogLine::Disconnected{}}) ==
          R"({"at":0.0,"client":"c1","event":"disconnected"})");
    CHECK(text({LogTime(1), "", LogLine::Opened{"car", "ab12"}}) ==
          R"({"at":0.001,"event":"opened","scene":"car","sceneSha256":"ab12"})");
    CHECK(
        text({LogTime(1), "", LogLine::Opened{"car", "ab12", R"({"markers":{"m":null}})"}}) ==
        R"({"at":0.001,"changes":{"markers":{"m":null}},"event":"opened","scene":"car","sceneSha256":"ab12"})");
    CHECK(text({LogTime(1), "", LogLine::Opened{"car", "ab12", "", UpAxis::z}}) ==
          R"({"at":0.001,"event":"opened","scene":"car","sceneSha256":"ab12","upAxis":"z"})");
    CHECK(text({LogTime(-3), "", LogLine::Drawn{7}}) == R"({"at":-0.003,"event":"drawn","frame":7})");
    CHECK(text({LogTime(100), "c2", ClientMessage{5, Fit{4}}}) ==
          R"({"at":0.1,"client":"c2","message":{"id":5,"node":4,"type":"fit"}})");
}

TEST_CASE("each kind of line is read back") {
    const LogLine connected = line(R"({"at":12.5,"client":"c1","event":"connected","role":"host"})");
    CHECK(connected.at == LogTime(12'500));
    CHECK(connected.client == "c1");
    CHECK(std::get<LogLine::Connected>(connected.what).role == Role::host);
    CHECK(std::get<LogLine::Connected>(connected.what).name.empty());
    const LogLine named = line(R"({"at":1,"client":"c1","event":"connected","role":"view","name":"Wall"})");
    CHECK(std::get<LogLine::Connected>(named.what).name == "Wall");
    // Whoever wrote the role with it, as the contract has it, is read as well.
    const LogLine gone = line(R"({"at":0,"client":"c1","event":"disconnected","role":"view"})");
    CHECK(std::holds_alternative<LogLine::Disconnected>(gone.what));
    const LogLine opened = line(R"({"at":1,"event":"opened","scene":"car","sceneSha256":"ab12"})");
    CHECK(opened.client.empty());
    CHECK(std::get<LogLine::Opened>(opened.what).scene == "car");
    CHECK(std::get<LogLine::Opened>(opened.what).sha256 == "ab12");
    CHECK(std::get<LogLine::Opened>(opened.what).changes.empty());
    const LogLine changed =
        line(R"({"at":1,"event":"opened","scene":"car","sceneSha256":"ab12","changes":{"views":{}}})");
    CHECK(std::get<LogLine::Opened>(changed.what).changes == R"({"views":{}})");
    const LogLine upright =
        line(R"({"at":1,"event":"opened","scene":"car","sceneSha256":"ab12","upAxis":"y"})");
    CHECK(std::get<LogLine::Opened>(upright.what).up_axis == UpAxis::y);
    CHECK(std::get<LogLine::Drawn>(line(R"({"at":1,"event":"drawn","frame":7})").what).frame == 7);
    const LogLine message = line(R"({"at":1,"client":"c1","message":{"type":"fit","id":5,"node":4}})");
    CHECK(std::get<ClientMessage>(message.what).id == 5);
    CHECK(std::get<Fit>(std::get<ClientMessage>(message.what).payload).node == 4);
}

TEST_CASE("a message is logged as it came, but for what is secret") {
    const auto decoded = decode(R"({"type":"frame", "later": [1, 2.50],
        "id":7,"token":"secret"})");
    REQUIRE(decoded.has_value());
    CHECK(encode(LogLine{LogTime(5), "c1", *decoded}) ==
          R"({"at":0.005,"client":"c1","message":{"id":7,"later":[1,2.5],"type":"frame"}})");
    ClientMessage merged = *decoded;
    merged.id = 5;
    CHECK(json::parse(encode(LogLine{LogTime(5), "c1", merged}))["message"]["id"] == 5);
}

TEST_CASE("every message can stand in a log") {
    for (const json& message : examples::messages()["valid"]) {
        INFO(message.dump());
        auto decoded = decode(message.dump());
        REQUIRE(decoded.has_value());
        decoded->text.clear();  // which would be written as it came
        const std::string text = encode(LogLine{LogTime(5), "c1", *decoded});
        CHECK(json::parse(text)["message"] == message);
        CHECK(encode(line(text)) == text);
    }
}

TEST_CASE("times are whole microseconds, there and back") {
    std::vector<std::int64_t> times = {0,
                                       1,
                                       -1,
                                       99,
                                       100,
                                       101,
                                       999,
                                       1000,
                                       1001,
                                       33'333,
                                       -66'667,
                                       1'000'000,
                                       123'456'789,
                                       -987'654'321,
                                       100'000'000'000,
                                       100'000'000'001,
                                       999'999'999'999'999};
    std::mt19937_64 random(7);
    for (int i = 0; i < 10'000; ++i) times.push_back(static_cast<std::int64_t>(random() >> (15 + i % 40)));
    for (const std::int64_t time : times) {
        const std::string text = encode(LogLine{LogTime(time), "", LogLine::Drawn{1}});
        if (line(text).at != LogTime(time)) FAIL(text);
    }
    CHECK(encode(LogLine{LogTime(100'000'000'001), "", LogLine::Drawn{1}}) ==
          R"({"at":100000000.001,"event":"drawn","frame":1})");
    CHECK(line(R"({"at":0.0004999,"event":"drawn","frame":1})").at == LogTime(0));
    CHECK(line(R"({"at":0.0005001,"event":"drawn","frame":1})").at == LogTime(1));
}

TEST_CASE("numbers come back to the bit") {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> exponent(-300, 6);
    for (int i = 0; i < 2000; ++i) {
        Wheel wheel;
        wheel.x = std::pow(10, exponent(random)) * (i % 2 == 0 ? 1 : -1);
        wheel.y = i % 3 == 0 ? 5e-324 : -0.0;
        const std::string text = encode(LogLine{LogTime(0), "c1", ClientMessage{{}, wheel}});
        const auto back = std::get<Wheel>(std::get<ClientMessage>(line(text).what).payload);
        if (bits(back.x) != bits(wheel.x) || bits(back.y) != bits(wheel.y)) FAIL(text);
    }
}

TEST_CASE("a wrong line is refused with a sentence") {
    struct Case {
        const char *text, *culprit;
    };
    const Case cases[] = {
        {"", "JSON"},
        {"[]", "'line'"},
        {"{}", "'at'"},
        {R"({"at":"0","event":"drawn","frame":1})", "'at'"},
        {R"({"at":1.1e12,"event":"drawn","frame":1})", "'at'"},
        {R"({"at":-1.1e12,"event":"drawn","frame":1})", "'at'"},
        {R"({"at":0})", "'event'"},
        {R"({"at":0,"event":"danced"})", "'event'"},
        {R"({"at":0,"event":5})", "'event'"},
        {R"({"at":0,"client":5,"event":"disconnected"})", "'client'"},
        {R"({"at":0,"client":"c1","event":"connected"})", "'role'"},
        {R"({"at":0,"client":"c1","event":"connected","role":"king"})", "'role'"},
        {R"({"at":0,"event":"connected","role":"view"})", "'client'"},
        {R"({"at":0,"client":"c1","event":"connected","role":"view","name":5})", "'name'"},
        {R"({"at":0,"event":"disconnected"})", "'client'"},
        {R"({"at":0,"client":"","event":"disconnected"})", "'client'"},
        {R"({"at":0,"event":"opened","scene":"car"})", "'sceneSha256'"},
        {R"({"at":0,"event":"opened","sceneSha256":"ab"})", "'scene'"},
        {R"({"at":0,"event":"drawn"})", "'frame'"},
        {R"({"at":0,"event":"drawn","frame":0})", "'frame'"},
        {R"({"at":0,"message":{"type":"fit"}})", "'client'"},
        {R"({"at":0,"client":"c1","message":5})", "'message'"},
        {R"({"at":0,"client":"c1","message":{}})", "'type'"},
        {R"({"at":0,"client":"c1","message":{"type":"dance"}})", "'dance'"},
        {R"({"at":0,"client":"c1","message":{"type":"fit","node":-1}})", "'node'"},
        {R"({"at":0,"client":"c1","message":{"type":"fit","id":0}})", "'id'"},
        {R"({"at":0,"at":1,"event":"drawn","frame":1})", "'at'"},
    };
    for (const Case& c : cases) {
        INFO(std::string(c.text));
        const auto result = decode_log_line(c.text);
        REQUIRE_FALSE(result.has_value());
        CHECK_MESSAGE(result.error().message.find(c.culprit) != std::string::npos, result.error().message);
        CHECK(result.error().message.size() <= 300);
    }
    const std::string whole = R"({"at":1,"client":"c1","message":{"type":"fit","id":5,"node":4}})";
    for (std::size_t length = 0; length < whole.size(); ++length)
        CHECK_FALSE(decode_log_line(whole.substr(0, length)).has_value());
}

TEST_CASE("a wrong header is refused with a sentence") {
    const auto check = [](const json& text, const char* culprit) {
        INFO(text.dump());
        const auto result = decode_log_header(text.dump());
        REQUIRE_FALSE(result.has_value());
        CHECK_MESSAGE(result.error().message.find(culprit) != std::string::npos, result.error().message);
    };
    for (const char* name :
         {"log", "version", "scene", "sceneSha256", "started", "state", "view", "clients"}) {
        json without = json::parse(kHeader);
        without.erase(name);
        check(without, name);
        without[name] = nullptr;
        check(without, name);
    }
    const auto with = [](const char* pointer, const json& value) {
        json text = json::parse(full_header());
        text[json::json_pointer(pointer)] = value;
        return text;
    };
    check(with("/log", "other"), "'log'");
    check(with("/version", 2), "'version'");
    check(with("/clients/0/role", "king"), "'clients[0].role'");
    check(with("/clients/0/width", 0), "width");
    check(with("/clients/0/name", 5), "'clients[0].name'");
    check(with("/clients/1/width", 100), "height");
    check(with("/clients/1", 5), "'clients[1]'");
    check(with("/atHome", 1), "'atHome'");
    check(with("/frames", json::object()), "'frames'");
    check(with("/frames/0/camera/fov", 171), "'frames[0].camera.fov'");
    check(with("/flight/id", 0.5), "'flight.id'");
    check(with("/flight/since", -1), "'flight.since'");
    check(with("/flight/fly/keyframes/1/at", 0), "'keyframes[1].at'");
    check(json::array(), "'header'");
    for (std::size_t length = 0; length < kHeader.size(); ++length)
        CHECK_FALSE(decode_log_header(kHeader.substr(0, length)).has_value());
}
