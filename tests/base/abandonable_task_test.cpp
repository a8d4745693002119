#include "base/abandonable_task.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <memory>
#include <thread>

using namespace vrut::server::base;

namespace {

/// A read that hangs until the object ends.
class HangingRead {
public:
    HangingRead() { REQUIRE(pipe2(ends_, O_CLOEXEC) == 0); }
    ~HangingRead() {
        close(ends_[1]);
        close(ends_[0]);
    }
    HangingRead(const HangingRead&) = delete;
    HangingRead& operator=(const HangingRead&) = delete;

    int descriptor() const { return ends_[0]; }
    void answer() const { REQUIRE(write(ends_[1], "x", 1) == 1); }

private:
    int ends_[2] = {};
};

}  // namespace

TEST_CASE("a task gives what its work returns or throws") {
    AbandonableTask<int> task([](const std::stop_token&) { return 7; });
    CHECK(task.get() == 7);
    AbandonableTask<int> failing([](const std::stop_token&) -> int { throw std::runtime_error("no"); });
    CHECK_THROWS_WITH(failing.get(), "no");
}

TEST_CASE("work that heeds it is stopped, and is done with the task") {
    const auto done = std::make_shared<std::atomic<bool>>(false);
    {
        const AbandonableTask<void> task([done](const std::stop_token& stop) {
            while (!stop.stop_requested()) std::this_thread::yield();
            *done = true;
        });
        CHECK_FALSE(*done);
    }
    CHECK(*done);
}

TEST_CASE("work that hangs is left behind, with what it owns") {
    const HangingRead read_hangs;
    auto owned = std::make_shared<int>(0);
    const std::weak_ptr<int> seen = owned;
    {
        const AbandonableTask<void> task(
            [moved = std::move(owned), from = read_hangs.descriptor()](const std::stop_token&) {
                char byte = 0;
                *moved = static_cast<int>(read(from, &byte, 1));
            });
    }
    CHECK_FALSE(seen.expired());
    CHECK(detached_threads() == 1);
    read_hangs.answer();
    while (detached_threads() > 0 || !seen.expired()) std::this_thread::yield();
}
