// A room that an engine follows, and then draws itself.
#include <doctest/doctest.h>

#include <condition_variable>
#include <future>
#include <mutex>

#include "engine/engine.hpp"
#include "test_client.hpp"

using namespace vrut;
using namespace vrut::server::engine;
using namespace vrut::test;

namespace {

constexpr const char* kAtAnEdge = "c1.edge";

class FollowedRoom {
public:
    void follow(decltype(protocol::LogLine::what) what, std::uint64_t sequence = 0) {
        engine_.push(Follow{{protocol::LogTime{0}, kAtAnEdge, std::move(what), sequence}});
    }
    void take_over(std::map<std::string, std::uint64_t> sequences) {
        std::promise<void> done;
        engine_.push(TakeOver{1, std::move(sequences), [&] { done.set_value(); }});
        done.get_future().wait();
    }
    void push(EngineEvent event) { engine_.push(std::move(event)); }

    /// Of the client's last message that a frame shows of a view of this width.
    std::uint64_t sequence_shown(double width) {
        std::unique_lock lock(mutex_);
        while (!picture_ || picture_->header.view.width != width) {
            const std::int64_t newest = picture_ ? picture_->header.frame : 0;
            engine_.push(FramesWanted{kAtAnEdge, newest, 1});
            REQUIRE(arrived_.wait_for(lock, 5s, [&] { return picture_ && picture_->header.frame > newest; }));
        }
        return picture_->applied.at(kAtAnEdge).sequence;
    }

private:
    EngineOptions options() const {
        EngineOptions options;
        options.scene = scene_of(
            "vrut-text 1\ngeometry 1 vertices 3 -1 -1 0  1 -1 0  0 1 1 triangles 1 0 1 2 end\n"
            "node 1 \"Triangle\" geometry geometry 1 end\n");
        options.shared = SharedHooks{[](const auto&) {}, [](const auto&) {}, [](const auto&) {}};
        return options;
    }
    void take(std::shared_ptr<const EncodedPicture> picture) {
        {
            const std::lock_guard lock(mutex_);
            picture_ = std::move(picture);
        }
        arrived_.notify_one();
    }

    std::mutex mutex_;
    std::condition_variable arrived_;
    std::shared_ptr<const EncodedPicture> picture_;
    server::observe::Metrics metrics_;
    Engine engine_{options(),
                   FakeRenderer{}.factory(),
                   metrics_,
                   {[](const EngineOutput&) {}, [this](auto picture) { take(std::move(picture)); },
                    [](const std::string& why) { FAIL(why); }}};  // last: its threads use all of the above
};

protocol::ClientMessage resize(double width) {
    protocol::ClientMessage message;
    message.payload = protocol::Resize{width, 100, 1};
    return message;
}

}  // namespace

TEST_CASE(
    "frames of who takes a room over show what its clients had said, also where some of it comes again") {
    FollowedRoom room;
    room.follow(protocol::LogLine::Connected{protocol::Role::control});
    room.follow(resize(200), 7);
    room.take_over({{kAtAnEdge, 7}});
    CHECK(room.sequence_shown(200) == 7);
    room.push(MessageReceived{kAtAnEdge, resize(210), server::base::Clock::now(), 0, true, 6});
    CHECK(room.sequence_shown(210) == 7);
    room.push(MessageReceived{kAtAnEdge, resize(220), server::base::Clock::now(), 0, true, 8});
    CHECK(room.sequence_shown(220) == 8);
}

TEST_CASE("a client that comes back after its edge was lost has said what it had said before") {
    FollowedRoom room;
    room.take_over({});
    room.push(ClientJoined{kAtAnEdge, protocol::Role::control, "", 0, "", "", 5});
    room.push(MessageReceived{kAtAnEdge, resize(200), server::base::Clock::now(), 0, true, 4});
    CHECK(room.sequence_shown(200) == 5);
}
