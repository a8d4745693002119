#include "engine/change_keeper.hpp"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <set>

#include "engine/log_file.hpp"

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

    std::map<std::string, std::string> unusable;  // texts by scene
    std::set<std::string> looked_at;              // scenes: what is kept of them can be written over

    Result write(const std::string& scene, const std::optional<std::string>& patch) {
        Result result;
        try {
            result.set_aside = set_aside(scene);
            if (patch) store.write(scene, *patch);
        } catch (const std::exception& error) {
            result.why_not = error.what();
        }
        return result;
    }
    /// Of a scene that was not looked at, too, since another server may have shown it until now.
    std::string set_aside(const std::string& scene) {
        std::string text;
        {
            const std::lock_guard lock(mutex);
            if (looked_at.contains(scene)) return {};
            text = unusable[scene];
        }
        std::string file = store.set_aside(scene, text, iso_time_now());
        const std::lock_guard lock(mutex);
        if (unusable[scene] != text) return file;  // it has been found unusable since, and is the next one's
        looked_at.insert(scene);
        unusable.erase(scene);
        return file;
    }
    void add_unusable(const std::string& scene, const std::string& text) {
        const std::lock_guard lock(mutex);
        looked_at.erase(scene);
        unusable[scene] = text;
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

ChangeKeeper::ChangeKeeper(Store store, std::shared_ptr<ResultPost> post, Events events)
    : post_(std::move(post)), events_(std::move(events)) {
    if (!store.write) return;
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

void ChangeKeeper::set_aside(const std::string& scene, const std::string& unusable) {
    if (!writer_) return;
    kept_at_ = base::Clock::now();
    writer_->add_unusable(scene, unusable);
    waiting_.try_emplace(scene);
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
            const Result result = writer->write(scene, patch);
            writer->run(false);
            post->send([this, result] {
                writes_ = false;
                report(result);
                write_next();
            });
        });
    if (writes_) return;
    writer_->run(false);
    report({{}, "no thread can be had"});
}

void ChangeKeeper::report(const Result& result) {
    if (!result.set_aside.empty()) events_.set_aside(result.set_aside);
    if (result.why_not && result.why_not != failed_) events_.failed(*result.why_not);
    failed_ = result.why_not;
}

}  // namespace vrut::server::engine
