#pragma once

#include <chrono>
#include <future>
#include <optional>
#include <stop_token>
#include <utility>

#include "base/clock.hpp"
#include "base/detached_thread.hpp"

namespace vrut::server::base {

/// Work on a thread of its own that may hang for ever in a system call. Nobody can join such a thread: the
/// destructor asks it to stop, waits until kPatience has passed since it was asked first, and then leaves it
/// behind.
template <class Result>
class AbandonableTask {
public:
    static constexpr std::chrono::milliseconds kPatience{500};

    /// `work` is called with a std::stop_token, and owns all that it uses. Throws std::system_error where no
    /// thread can be had.
    template <class Work>
    explicit AbandonableTask(Work work) {
        std::packaged_task<Result(std::stop_token)> task(std::move(work));
        result_ = task.get_future();
        run_detached([moved = std::move(task), stop = stop_.get_token()]() mutable {
            moved.make_ready_at_thread_exit(std::move(stop));
        });
    }
    ~AbandonableTask() {
        stop();
        if (result_.valid()) result_.wait_until(*stopped_at_ + kPatience);
    }
    AbandonableTask(const AbandonableTask&) = delete;
    AbandonableTask& operator=(const AbandonableTask&) = delete;

    void stop() {
        stop_.request_stop();
        if (!stopped_at_) stopped_at_ = Clock::now();
    }
    /// Not after get().
    bool is_done_within(std::chrono::milliseconds time) const {
        return result_.wait_for(time) == std::future_status::ready;
    }
    /// Waits for it. Once; throws what the work threw.
    Result get() { return result_.get(); }

private:
    std::stop_source stop_;
    std::optional<Clock::time_point> stopped_at_;
    std::future<Result> result_;
};

}  // namespace vrut::server::base
