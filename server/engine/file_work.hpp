#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <system_error>

#include "base/detached_thread.hpp"
#include "engine/mailbox.hpp"

namespace vrut::server::engine {

/// Takes results to the render thread, until it is closed: who works on files may outlive the engine.
class ResultPost {
public:
    using Push = std::function<void(FileWorkDone)>;
    explicit ResultPost(Push push) : push_(std::move(push)) {}

    /// From any thread; `use` is called on the render thread.
    void send(std::function<void()> use) {
        const std::lock_guard lock(mutex_);
        if (push_) push_({std::move(use)});
    }
    void close() {
        const std::lock_guard lock(mutex_);
        push_ = nullptr;
    }
    /// Closes a post at its own end.
    class Closing {
    public:
        explicit Closing(std::shared_ptr<ResultPost> post) : post_(std::move(post)) {}
        Closing(const Closing&) = delete;
        Closing& operator=(const Closing&) = delete;
        ~Closing() { post_->close(); }

    private:
        std::shared_ptr<ResultPost> post_;
    };

private:
    std::mutex mutex_;
    Push push_;
};

/// Runs what touches files on a thread of its own; see base::run_detached(). False where no thread can be
/// had.
inline bool run_file_work(std::function<void()> work) {
    try {
        base::run_detached(std::move(work));
        return true;
    } catch (const std::system_error&) {
        return false;
    }
}

}  // namespace vrut::server::engine
