#include "engine/recording_writer.hpp"

#include <condition_variable>
#include <deque>
#include <vector>

#include "observe/log.hpp"

namespace vrut::server::engine {

/// Lines on their way to a file, shared by who makes them and the thread that writes them.
struct RecordingWriter::Queue {
    std::mutex mutex;
    std::condition_variable changed;
    struct Line {
        std::string text;
        base::Clock::time_point since;
    };
    std::deque<Line> waiting;
    std::size_t waiting_bytes = 0;                         ///< and of those in hand
    std::optional<base::Clock::time_point> in_hand_since;  ///< of the oldest that is being written
    bool complete = false;                                 ///< no more come
    base::Clock::time_point ended_at{};                    ///< then; the file is still to be closed
    bool given_up = false;
    bool done = false;  ///< the thread is about to end

    std::optional<base::Clock::time_point> oldest() const {
        if (in_hand_since) return in_hand_since;
        return waiting.empty() ? std::nullopt : std::optional(waiting.front().since);
    }
    void add(std::string text, base::Clock::time_point now) {
        waiting_bytes += text.size();
        waiting.push_back({std::move(text), now});
    }
    /// All lines that wait, once there are some; none at the end.
    std::vector<std::string> take() {
        std::unique_lock lock(mutex);
        waiting_bytes = 0;
        for (const Line& line : waiting) waiting_bytes += line.text.size();
        in_hand_since.reset();
        changed.wait(lock, [&] { return given_up || complete || !waiting.empty(); });
        std::vector<std::string> lines;
        if (given_up) return lines;
        in_hand_since = waiting.empty() ? ended_at : waiting.front().since;
        for (Line& line : waiting) lines.push_back(std::move(line.text));
        waiting.clear();
        return lines;
    }
    void finish() {
        const std::lock_guard lock(mutex);
        done = true;
        changed.notify_all();
    }
    bool is_given_up() {
        const std::lock_guard lock(mutex);
        return given_up;
    }
};

namespace {

/// Whole lines, up to the one that makes the file too large; why no more can be written.
tl::expected<void, std::string> append_lines(LogFile& file, const std::vector<std::string>& lines,
                                             std::uintmax_t& left) {
    std::string text;
    bool full = false;
    for (auto line = lines.begin(); line != lines.end() && !full; ++line) {
        text += *line + '\n';
        full = text.size() >= left;
    }
    left -= full ? left : text.size();
    if (auto written = file.append(text); !written) return written;
    if (full) return tl::unexpected(std::string("it has grown too large"));
    return {};
}

}  // namespace

RecordingWriter::RecordingWriter(Open open, std::shared_ptr<ResultPost> post, OnOpened on_opened,
                                 OnEnded on_ended, Limits limits)
    : open_(std::move(open)),
      post_(std::move(post)),
      on_opened_(std::move(on_opened)),
      on_ended_(std::move(on_ended)),
      limits_(limits) {}

RecordingWriter::~RecordingWriter() {
    end_all(base::Clock::now());
    for (const auto& entry : logs_) {
        Queue& queue = *entry.second.queue;
        std::unique_lock lock(queue.mutex);
        queue.changed.wait_until(lock, queue.ended_at + std::chrono::seconds(1), [&] { return queue.done; });
        queue.given_up = true;
    }
}

void RecordingWriter::begin(std::int64_t recording, const std::string& name,
                            const room::RecordingSink::Header& header, base::Clock::time_point now) {
    auto queue = std::make_shared<Queue>();
    queue->in_hand_since = now;
    logs_[recording] = {queue, {}};
    const auto work = [=, this_ = this, open = open_, post = post_, threads = threads_,
                       left = limits_.file_bytes]() mutable {
        struct Leaving {
            Queue& queue;
            std::atomic<int>& threads;
            ~Leaving() {
                --threads;
                queue.finish();
            }
        } leaving{*queue, *threads};
        auto log = open(name);
        if (log && queue->is_given_up()) return log->file->remove();
        if (!log)
            return post->send([=, why = log.error()] { this_->opened(recording, tl::unexpected(why)); });
        const auto end = [&](const std::optional<std::string>& why) {
            log->file.reset();  // closed before anything is reported
            post->send([=] { this_->ended(recording, why); });
        };
        std::vector<std::string> lines{header(log->name, iso_time_now())};
        auto written = append_lines(*log->file, lines, left);
        if (!written) {
            log->file->remove();
            const std::string why = log->name + ".jsonl cannot be written: " + written.error();
            return post->send([=] { this_->opened(recording, tl::unexpected(why)); });
        }
        post->send([=, opened = log->name] { this_->opened(recording, opened); });
        while (written && !(lines = queue->take()).empty()) written = append_lines(*log->file, lines, left);
        if (queue->is_given_up()) return;  // who gave it up has reported it
        end(written ? std::nullopt : std::optional(written.error()));
    };
    const bool may_start = ++*threads_ <= limits_.threads;
    if (may_start && run_file_work(work)) return;
    --*threads_;
    queue->done = true;
    const std::string why = may_start ? "no thread can be had for the recording"
                                      : "the disk has not taken earlier recordings yet";
    post_->send([=, this] { opened(recording, tl::unexpected(why)); });
}

void RecordingWriter::write(std::int64_t recording, std::string line, base::Clock::time_point now) {
    const auto log = logs_.find(recording);
    if (log == logs_.end()) return;
    Queue& queue = *log->second.queue;
    bool too_many = false;
    {
        const std::lock_guard lock(queue.mutex);
        if (queue.given_up) return;
        queue.add(std::move(line), now);
        too_many = queue.waiting_bytes > limits_.waiting_bytes;
        queue.changed.notify_all();
    }
    if (too_many) give_up(recording, "its disk is too slow");
}

void RecordingWriter::end_all(base::Clock::time_point now) {
    for (const auto& [recording, log] : logs_) end(recording, now);
}

void RecordingWriter::end(std::int64_t recording, base::Clock::time_point now) {
    const auto log = logs_.find(recording);
    if (log == logs_.end()) return;
    Queue& queue = *log->second.queue;
    const std::lock_guard lock(queue.mutex);
    if (std::exchange(queue.complete, true)) return;
    queue.ended_at = now;
    queue.changed.notify_all();
}

std::optional<base::Clock::time_point> RecordingWriter::due() const {
    std::optional<base::Clock::time_point> first;
    for (const auto& [recording, log] : logs_) {
        const std::lock_guard lock(log.queue->mutex);
        if (const auto oldest = log.queue->oldest(); oldest && !log.queue->given_up)
            first = std::min(first.value_or(*oldest + limits_.oldest), *oldest + limits_.oldest);
    }
    return first;
}

void RecordingWriter::check(base::Clock::time_point now) {
    std::vector<std::int64_t> slow;
    for (const auto& [recording, log] : logs_) {
        const std::lock_guard lock(log.queue->mutex);
        const auto oldest = log.queue->oldest();
        if (oldest && !log.queue->given_up && now >= *oldest + limits_.oldest) slow.push_back(recording);
    }
    for (const std::int64_t recording : slow) give_up(recording, "its disk is too slow");
}

void RecordingWriter::opened(std::int64_t recording, const tl::expected<std::string, std::string>& name) {
    const auto log = logs_.find(recording);
    if (log == logs_.end()) return;  // given up
    if (name) {
        log->second.name = *name;
        observe::log_info("recording_begun", {{"name", *name}});
    } else {
        logs_.erase(log);
    }
    on_opened_(recording, name);
}

void RecordingWriter::ended(std::int64_t recording, const std::optional<std::string>& why) {
    auto log = logs_.extract(recording);
    if (log.empty()) return;  // given up
    if (why)
        observe::log_warning("recording_ended", {{"name", log.mapped().name.value_or("")}, {"reason", *why}});
    on_ended_(recording, why);
}

void RecordingWriter::give_up(std::int64_t recording, const std::string& why) {
    Queue& queue = *logs_.at(recording).queue;
    {
        const std::lock_guard lock(queue.mutex);
        queue.given_up = true;
        queue.changed.notify_all();
    }
    post_->send([=, this] {
        const auto log = logs_.find(recording);
        if (log == logs_.end()) return;
        if (log->second.name) return ended(recording, why);
        opened(recording, tl::unexpected("the recording cannot be begun: " + why));
    });
}

}  // namespace vrut::server::engine
