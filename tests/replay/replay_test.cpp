// A recorded session leads to the camera that its clients saw at the end: to the last bit however often it is
// played, however its moves were merged, and whenever frames were drawn.
#include "room/replay.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "engine/mailbox.hpp"
#include "recorded_session.hpp"

using namespace vrut;
using namespace vrut::server::base;
using namespace vrut::server::room;
using namespace vrut::server::engine;
using namespace vrut::test;
using nlohmann::json;
using protocol::ClientMessage;
using protocol::LogLine;
using protocol::Pointer;

namespace {

std::array<double, 15> numbers(const protocol::CameraState& camera) {
    const auto& [eye, focus, up, center] = std::tie(camera.eye, camera.focus, camera.up, camera.center);
    return {eye.x, eye.y,    eye.z,    focus.x,  focus.y,    focus.z,     up.x,      up.y,
            up.z,  center.x, center.y, center.z, camera.fov, camera.near, camera.far};
}

using Bits = std::array<std::uint64_t, 15>;

Bits bits(const protocol::CameraState& camera) { return std::bit_cast<Bits>(numbers(camera)); }

Room played(const EventLog& log) {
    auto room = replay(log, find_scene);
    REQUIRE_MESSAGE(room, room.error());
    return *std::move(room);
}

/// As numbers() gives them, from the camera that the recording client knew.
std::array<double, 15> seen_live(const json& camera) {
    std::array<double, 15> result{};
    std::size_t next = 0;
    for (const char* member : {"eye", "focus", "up", "center"})
        for (const json& coordinate : camera.at(member)) result.at(next++) = coordinate;
    for (const char* member : {"fov", "near", "far"}) result.at(next++) = camera.at(member);
    return result;
}

/// Whether what this message points at depends on which frame is the newest.
bool looks_at_newest(const ClientMessage& message) {
    if (const auto* pick = std::get_if<protocol::Pick>(&message.payload)) return !pick->frame;
    const auto* pointer = std::get_if<Pointer>(&message.payload);
    return pointer && pointer->event == Pointer::Event::up && !pointer->frame;
}

/// Without the frames that nobody names: more moves stand side by side then.
EventLog without_unnamed_frames(const EventLog& log) {
    EventLog result{log.header, {}};
    std::set<std::int64_t> named;
    bool newest_named = false;
    for (auto line = log.lines.rbegin(); line != log.lines.rend(); ++line) {
        if (const auto* message = std::get_if<ClientMessage>(&line->what)) {
            if (const auto* pick = std::get_if<protocol::Pick>(&message->payload); pick && pick->frame)
                named.insert(*pick->frame);
            if (const auto* pointer = std::get_if<Pointer>(&message->payload); pointer && pointer->frame)
                named.insert(*pointer->frame);
            newest_named |= looks_at_newest(*message);
        }
        if (const auto* drawn = std::get_if<LogLine::Drawn>(&line->what)) {
            if (!newest_named && !named.contains(drawn->frame)) continue;
            newest_named = false;
        }
        result.lines.push_back(*line);
    }
    std::reverse(result.lines.begin(), result.lines.end());
    return result;
}

/// As a slow server would have got it: all that clients said between two other things waits in the mailbox at
/// once.
EventLog merged(const EventLog& log) {
    EventLog result{log.header, {}};
    Mailbox mailbox;
    const auto take = [&] {
        for (const EngineEvent& event : mailbox.wait(Clock::now())) {
            const auto& received = std::get<MessageReceived>(event);
            const auto at = std::chrono::duration_cast<SessionTime>(received.arrival.time_since_epoch());
            result.lines.push_back({at, received.client, *received.message});
        }
    };
    for (const LogLine& line : log.lines) {
        if (const auto* message = std::get_if<ClientMessage>(&line.what)) {
            mailbox.push(MessageReceived{line.client, *message, Clock::time_point(line.at)});
            continue;
        }
        take();
        result.lines.push_back(line);
    }
    take();
    return result;
}

std::ptrdiff_t moves_of(const EventLog& log) {
    return std::count_if(log.lines.begin(), log.lines.end(), [](const LogLine& line) {
        const auto* message = std::get_if<ClientMessage>(&line.what);
        const auto* pointer = message ? std::get_if<Pointer>(&message->payload) : nullptr;
        return pointer && pointer->event == Pointer::Event::move;
    });
}

/// One line, as replay() does it.
struct Play {
    Room& room;
    const LogLine& line;

    void operator()(const ClientMessage& message) const {
        CHECK(room.handle_message(line.client, message, line.at));
    }
    void operator()(const LogLine::Connected& connected) const {
        room.join(line.client, connected.role, line.at);
    }
    void operator()(const LogLine::Disconnected&) const { room.leave(line.client, line.at); }
    void operator()(const LogLine::ControlPassed&) const { room.pass_control(line.client, line.at); }
    void operator()(const LogLine::Opened& opened) const {
        room.show(*find_scene(opened.scene, opened.sha256), line.at);
    }
    void operator()(const LogLine::Revised& revised) const { room.follow(revised, line.at); }
    void operator()(const LogLine::Drawn& drawn) const {
        room.advance(line.at);
        room.remember(drawn.frame);
    }
};

/// Played by a server that looks at the time, and tells its clients of it, at whatever moments it likes.
protocol::CameraState played_restlessly(const EventLog& log, std::mt19937& dice) {
    RoomOptions options;
    options.policy = kReplay;
    Room room(*find_scene(log.header.scene, log.header.scene_sha256), options);
    REQUIRE(room.restore(log.header));
    SessionTime now{0};
    for (const LogLine& line : log.lines) {
        for (int looks = static_cast<int>(dice() % 4); looks > 0 && now < line.at; --looks) {
            now += SessionTime(static_cast<std::int64_t>(dice()) % ((line.at - now).count() + 1));
            room.advance(now);
            if (dice() % 2 == 0) room.document();
        }
        std::visit(Play{room, line}, line.what);
        now = std::max(now, line.at);
    }
    return room.state().camera;
}

using WallsPose = std::array<double, 9>;

/// The cameras that hosts had while they were behind, in a room that is advanced by `step` each time.
std::vector<WallsPose> walls_of(const EventLog& log, SessionTime step) {
    RoomOptions options;
    options.policy = kReplay;
    Room room(*find_scene(log.header.scene, log.header.scene_sha256), options);
    REQUIRE(room.restore(log.header));
    std::vector<WallsPose> poses;
    const auto look = [&] {
        room.document();
        const auto& walls = room.state().walls;
        if (!walls) return;
        const auto& [eye, focus, up] = std::tie(walls->eye, walls->focus, walls->up);
        const WallsPose pose{eye.x, eye.y, eye.z, focus.x, focus.y, focus.z, up.x, up.y, up.z};
        if (poses.empty() || poses.back() != pose) poses.push_back(pose);
    };
    SessionTime now{0};
    const auto go_to = [&](SessionTime end) {
        for (now += step; now < end; now += step) {
            room.advance(now);
            look();
        }
        now = std::max(end, room.time());
    };
    for (const LogLine& line : log.lines) {
        go_to(line.at);
        std::visit(Play{room, line}, line.what);
        look();
    }
    go_to(now + SessionTime(10'000'000));
    return poses;
}

/// How far two lie apart in any number.
double apart(const WallsPose& a, const WallsPose& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

}  // namespace

TEST_CASE("hosts come by the cameras that they had, to the last bit however often the time is looked at") {
    std::ifstream file(session_file(".walls.json"));
    if (!file) return;  // a session without hosts
    const std::vector<WallsPose> seen = json::parse(file), all = walls_of(read_session(), SessionTime(1000));
    CHECK(walls_of(read_session(), SessionTime(4000)) == all);
    const std::vector<WallsPose> some = walls_of(read_session(), SessionTime(70'000));
    CHECK(
        std::ranges::all_of(some, [&](const WallsPose& pose) { return std::ranges::count(all, pose) > 0; }));
    CHECK(some.size() < all.size() / 2);
    CHECK(seen.size() > 10);
    auto from = all.begin();
    for (const WallsPose& pose : seen) {
        from = std::find_if(from, all.end(), [&](const WallsPose& each) { return apart(each, pose) < 1e-9; });
        REQUIRE(from != all.end());
    }
}

TEST_CASE("a session ends at the camera that its clients saw, each time to the last bit") {
    const EventLog log = read_session();
    const protocol::CameraState camera = played(log).state().camera;
    CHECK(bits(played(log).state().camera) == bits(camera));

    const json live = json::parse(std::ifstream(session_file(".camera.json")));
    const std::array<double, 15> is = numbers(camera), should = seen_live(live);
    for (std::size_t i = 0; i < is.size(); ++i) {
        INFO("number " << i);
        CHECK(std::abs(is[i] - should[i]) <= 1e-12 * std::max(1.0, std::abs(should[i])));
    }
    CHECK(camera.node.value_or(-1) == live.value("node", std::int64_t{-1}));
}

TEST_CASE("measures come to what the clients saw, to the last bit") {
    std::ifstream file(session_file(".measured.json"));
    if (!file) return;  // a session without measures
    CHECK(protocol::document_of(played(read_session()).state())->at("measured") == json::parse(file));
}

TEST_CASE("merged moves and other frames lead to the same camera, to the last bit") {
    const EventLog log = read_session();
    const Bits expected = bits(played(log).state().camera);
    const EventLog fewer_frames = without_unnamed_frames(log);
    CHECK(bits(played(fewer_frames).state().camera) == expected);
    CHECK(bits(played(merged(log)).state().camera) == expected);
    const EventLog few_moves = merged(fewer_frames);
    CHECK(bits(played(few_moves).state().camera) == expected);
    CHECK(moves_of(few_moves) < moves_of(log));
    if (session_name() == "orbit") {
        CHECK(moves_of(log) >= 60);
        // One of each of its three drags, two where the release names a frame that was drawn in between.
        CHECK(moves_of(few_moves) <= 6);
    }
}

TEST_CASE("at any speed, however often the time is looked at, the camera is the same to the last bit") {
    const EventLog log = read_session();
    const Bits expected = bits(played(log).state().camera);
    std::mt19937 dice(5);
    for (int run = 0; run < 20; ++run) {
        INFO("run " << run);
        CHECK(bits(played_restlessly(log, dice)) == expected);
    }
}
