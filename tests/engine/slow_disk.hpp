#pragma once

#include <doctest/doctest.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <string>

#include "engine/file_work.hpp"

/// A disk that answers when a test lets it, and the thread that gets what was done on it.
namespace slow_disk {

using namespace vrut::server::engine;
using namespace std::chrono_literals;
using Clock = vrut::server::base::Clock;

/// Waits for what must come, and fails where it does not.
template <class Condition>
void await(std::condition_variable& changed, std::unique_lock<std::mutex>& lock, const Condition& condition) {
    REQUIRE(changed.wait_for(lock, 10s, condition));
}

/// The same of what nobody notifies.
template <class Condition>
void await(const Condition& condition) {
    const Clock::time_point end = Clock::now() + 10s;
    while (!condition())
        if (Clock::now() > end) FAIL("it does not come");
}

/// What a render thread would do with results.
class Results {
public:
    Results() { spdlog::set_level(spdlog::level::off); }
    ~Results() { spdlog::set_level(spdlog::level::info); }
    std::shared_ptr<ResultPost> post() {
        return std::make_shared<ResultPost>([inbox = inbox_](FileWorkDone done) {
            const std::lock_guard lock(inbox->mutex);
            inbox->done.push_back(std::move(done));
            inbox->changed.notify_all();
        });
    }
    /// Waits for a result, and uses it.
    void use_next() {
        std::unique_lock lock(inbox_->mutex);
        await(inbox_->changed, lock, [&] { return !inbox_->done.empty(); });
        const FileWorkDone done = std::move(inbox_->done.front());
        inbox_->done.pop_front();
        lock.unlock();
        done.use();
    }

private:
    struct Inbox {
        std::mutex mutex;
        std::condition_variable changed;
        std::deque<FileWorkDone> done;
    };
    std::shared_ptr<Inbox> inbox_ = std::make_shared<Inbox>();
};

/// A disk that tests let go on, shared with the threads that wait for it.
struct Disk {
    std::mutex mutex;
    std::condition_variable changed;
    bool blocks = false, blocks_closing = false;
    int waiting = 0;  ///< calls in it
    std::string text, error;
    bool closed = false, removed = false;

    void pass() {
        std::unique_lock lock(mutex);
        ++waiting;
        changed.notify_all();
        changed.wait(lock, [&] { return !blocks; });
        --waiting;
        changed.notify_all();
    }
    void block(bool whether) {
        const std::lock_guard lock(mutex);
        blocks = whether;
        changed.notify_all();
    }
    /// Until a call stands in it.
    void await_call() {
        std::unique_lock lock(mutex);
        await(changed, lock, [&] { return waiting > 0; });
    }
    void await_no_call() {
        std::unique_lock lock(mutex);
        await(changed, lock, [&] { return waiting == 0; });
    }
    void await_closed() {
        std::unique_lock lock(mutex);
        await(changed, lock, [&] { return closed; });
    }
    std::string written() {
        const std::lock_guard lock(mutex);
        return text;
    }
};

}  // namespace slow_disk
