#include "engine/fair_queue.hpp"

#include <doctest/doctest.h>

using namespace vrut;
using namespace vrut::server::engine;

namespace {

EngineEvent message(const char* client, std::uint64_t sequence) {
    MessageReceived received;
    received.client = client;
    received.sequence = sequence;
    return received;
}

/// What is popped, in order: a client's name and what came of it.
std::string popped(FairQueue& queue) {
    std::string text;
    while (!queue.empty()) {
        const EngineEvent event = queue.pop();
        if (!text.empty()) text += ' ';
        if (const auto* joined = std::get_if<ClientJoined>(&event))
            text += joined->client + " joined";
        else if (const auto* left = std::get_if<ClientLeft>(&event))
            text += left->client + " left";
        else if (const auto* received = std::get_if<MessageReceived>(&event))
            text += received->client + std::to_string(received->sequence);
        else
            text += "other";
    }
    return text;
}

}  // namespace

TEST_CASE("clients take turns, whoever says more, and each one's events keep their order") {
    FairQueue queue;
    for (int i = 1; i <= 4; ++i) queue.push(message("a", static_cast<std::uint64_t>(i)));
    queue.push(FrameEncoded{});
    queue.push(message("b", 1));
    queue.push(message("b", 2));
    queue.push(message("c", 1));
    CHECK(queue.size() == 8);
    CHECK(popped(queue) == "a1 b1 c1 other a2 b2 a3 a4");
    CHECK(queue.size() == 0);
}

TEST_CASE("of a client that left, its coming and going are still handled, and nothing else") {
    FairQueue queue;
    queue.push(ClientJoined{"a", protocol::Role::view, ""});
    queue.push(message("a", 1));
    queue.push(FramesWanted{"a", 0, 1});
    queue.push(message("b", 1));
    queue.push(ClientLeft{"a"});
    CHECK(queue.size() == 3);
    CHECK(popped(queue) == "a joined b1 a left");
    queue.push(message("a", 2));  // one that joined long before
    queue.push(ClientLeft{"a"});
    CHECK(popped(queue) == "a left");
}
