#include "engine/mailbox.hpp"

#include <doctest/doctest.h>

#include <thread>

using namespace vrut;
using namespace vrut::server::base;
using namespace vrut::server::engine;
using protocol::Pointer;

namespace {

EngineEvent pointer(const char* client, Pointer::Event event, std::int64_t id, double x, int button = -1,
                    unsigned buttons = 1, std::int64_t pointer_id = 1) {
    Pointer payload;
    payload.event = event;
    payload.pointer_id = pointer_id;
    payload.x = x;
    payload.button = button;
    payload.buttons = buttons;
    MessageReceived said;
    said.client = client;
    said.message = protocol::ClientMessage{id, payload};
    said.bytes = 100;
    return said;
}

EngineEvent move(const char* client, std::int64_t id, double x) {
    return pointer(client, Pointer::Event::move, id, x);
}

std::vector<EngineEvent> take(Mailbox& mailbox) { return mailbox.wait(Clock::now()); }

}  // namespace

TEST_CASE("adjacent moves of one pointer become one, with the last place, the last id and all their bytes") {
    Mailbox mailbox;
    for (int i = 1; i <= 50; ++i) mailbox.push(move("a", i, i));
    const auto events = take(mailbox);
    REQUIRE(events.size() == 1);
    const auto& said = std::get<MessageReceived>(events[0]);
    CHECK(said.message->id == 50);
    CHECK(std::get<Pointer>(said.message->payload).x == 50);
    CHECK(said.bytes == 5000);
}

TEST_CASE("nothing else is merged") {
    Mailbox mailbox;
    mailbox.push(pointer("a", Pointer::Event::down, 1, 0, 0));
    mailbox.push(move("a", 2, 1));
    mailbox.push(move("b", 1, 1));                                     // another client
    mailbox.push(move("a", 3, 2));                                     // not adjacent
    mailbox.push(pointer("a", Pointer::Event::move, 4, 3, 2, 3));      // a chord
    mailbox.push(pointer("a", Pointer::Event::move, 5, 4, -1, 3));     // other buttons held
    mailbox.push(pointer("a", Pointer::Event::move, 6, 5, -1, 3, 9));  // another pointer
    mailbox.push(pointer("a", Pointer::Event::up, 7, 6, 0, 0));
    mailbox.push(SnapshotSent{"a"});
    mailbox.push(SnapshotSent{"a"});
    CHECK(take(mailbox).size() == 10);
    CHECK(take(mailbox).empty());
}

TEST_CASE("moves of two fingers that take turns become one of each, ids rising") {
    Mailbox mailbox;
    for (int i = 1; i <= 50; ++i) mailbox.push(pointer("a", Pointer::Event::move, i, i, -1, 1, i % 2));
    const auto events = take(mailbox);
    REQUIRE(events.size() == 2);
    for (const std::int64_t i : {0, 1}) {
        const auto& said = std::get<MessageReceived>(events[static_cast<std::size_t>(i)]);
        CHECK(said.message->id == 49 + i);
        CHECK(std::get<Pointer>(said.message->payload).x == 49.0 + static_cast<double>(i));
        CHECK(said.bytes == 2500);
    }
}

TEST_CASE("of the frames that a client wants the newest wish counts") {
    Mailbox mailbox;
    mailbox.push(FramesWanted{"a", 1, 2});
    mailbox.push(move("a", 1, 0));
    mailbox.push(FramesWanted{"b", 1, 1});
    mailbox.push(FramesWanted{"a", 2, 1});
    const auto events = take(mailbox);
    REQUIRE(events.size() == 3);
    CHECK(std::get<FramesWanted>(events[2]) == FramesWanted{"a", 2, 1});
}

TEST_CASE("moves of a client that may not steer are not merged: each has its answer") {
    Mailbox mailbox;
    for (int i = 1; i <= 3; ++i) {
        EngineEvent event = move("a", i, i);
        std::get<MessageReceived>(event).may_steer = false;
        mailbox.push(event);
    }
    CHECK(take(mailbox).size() == 3);
}

TEST_CASE("what a client said and left is dropped") {
    Mailbox mailbox;
    mailbox.push(move("a", 1, 0));
    mailbox.push(move("b", 1, 0));
    mailbox.push(ClientLeft{"a"});
    const auto events = take(mailbox);
    REQUIRE(events.size() == 2);
    CHECK(std::get<MessageReceived>(events[0]).client == "b");
    CHECK(std::get<ClientLeft>(events[1]).client == "a");
}

TEST_CASE("a wait ends by an event, a wake, its time and the end") {
    Mailbox mailbox;
    CHECK(mailbox.wait(Clock::now()).empty());
    mailbox.wake();
    CHECK(mailbox.wait(std::nullopt).empty());
    std::thread other([&] { mailbox.push(ClientLeft{"a"}); });
    CHECK(mailbox.wait(std::nullopt).size() == 1);
    other.join();
    mailbox.close();
    CHECK(mailbox.closed());
    CHECK(mailbox.wait(std::nullopt).empty());
}

TEST_CASE("moves whose ids do not rise are not merged: the second is wrong") {
    Mailbox mailbox;
    const auto said = [](std::int64_t id) {
        protocol::Pointer move;
        move.event = protocol::Pointer::Event::move;
        move.buttons = 1;
        return MessageReceived{"a", protocol::ClientMessage{id, move}, {}, 1};
    };
    mailbox.push(said(6));
    mailbox.push(said(5));
    CHECK(mailbox.wait(std::nullopt).size() == 2);
    mailbox.push(said(7));
    mailbox.push(said(8));
    CHECK(mailbox.wait(std::nullopt).size() == 1);
}
