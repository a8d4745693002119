#include "engine/change_keeper.hpp"

#include <algorithm>
#include <condition_variable>
#include <exception>

namespace vrut::server::engine {

namespace {

constexpr std::chrono::seconds kDelay{1};     // many changes, one file
constexpr std::chrono::seconds kPatience{1};  // with the disk, at the end
constexpr std::size_t kRemembered = 8;        // scenes

}  // namespace

/// Shared with the thread, which may outlive the keeper.
struct ChangeKeeper::Writer {
    Store store;
    std::mutex mutex;
    std::condition_variable done;
    bool running = false;

    /// Returns why not.
    std::optional<std::string> write(const std::string& scene, const std::string& patch) {
        try {
            store(scene, patch);
            return std::nullopt;
        } catch (const std::exception& error) {
            return error.what();
        }
    }
    void run(bool runs) {
        const std::lock_guard lock(mutex);
        running = runs;
        done.notify_all();
    }
    bool is_done_by(base::Clock::time_point time) {
        std::unique_lock lock(mutex);
        return done.wait_until(lock, time, [&] { return !running; });
    }
};

ChangeKeeper::ChangeKeeper(Store store, std::shared_ptr<ResultPost> post, OnFailed on_failed)
    : post_(std::move(post)), on_failed_(std::move(on_failed)) {
    if (!store) return;
    writer_ = std::make_shared<Writer>();
    writer_->store = std::move(store);
}

ChangeKeeper::~ChangeKeeper() {
    if (!writer_) return;
    const base::Clock::time_point end = kept_at_ + kPatience;
    // A second from the end, which is when keep() was called last. One after the other, so that an older
    // patch is never written last.
    while (writer_->is_done_by(end) && !waiting_.empty()) {
        write_next();
        if (!writes_) return;
    }
}

void ChangeKeeper::changed(base::Clock::time_point now) {
    if (writer_ && !due_) due_ = now + kDelay;
}

void ChangeKeeper::keep(const std::string& scene, std::string patch) {
    due_.reset();
    if (!writer_) return;
    kept_at_ = base::Clock::now();
    std::erase_if(newest_, [&](const auto& each) { return each.first == scene; });
    newest_.emplace_front(scene, patch);
    if (newest_.size() > kRemembered) newest_.pop_back();
    waiting_[scene] = std::move(patch);
    if (!writes_) write_next();
}

std::optional<std::string> ChangeKeeper::newest(const std::string& scene) const {
    for (const auto& [name, patch] : newest_)
        if (name == scene) return patch;
    return std::nullopt;
}

void ChangeKeeper::write_next() {
    if (waiting_.empty()) return;
    auto next = waiting_.extract(waiting_.begin());
    writer_->run(true);
    writes_ =
        run_file_work([this, writer = writer_, post = post_, scene = next.key(), patch = next.mapped()] {
            const std::optional<std::string> why_not = writer->write(scene, patch);
            writer->run(false);
            post->send([this, why_not] {
                writes_ = false;
                report(why_not);
                write_next();
            });
        });
    if (writes_) return;
    writer_->run(false);
    report("no thread can be had");
}

void ChangeKeeper::report(const std::optional<std::string>& why_not) {
    if (why_not && !failed_) on_failed_(*why_not);
    failed_ = why_not.has_value();
}

}  // namespace vrut::server::engine
