#include "gl/preparation.hpp"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

namespace vrut::gl {

namespace {

template <class Element>
std::size_t bytes_of(const std::vector<Element>& elements) {
    return elements.size() * sizeof(Element);
}

}  // namespace

std::size_t PreparedData::bytes() const {
    std::size_t bytes = bytes_of(arrays.vertices) + bytes_of(arrays.corners) + bytes_of(arrays.triangles) +
                        bytes_of(clusters) + bytes_of(low_positions) + bytes_of(texcoords) +
                        bytes_of(colors) + bytes_of(edges);
    for (const scene::Image& image : texture.made) bytes += image.rgba.size();
    return bytes;
}

struct Preparation::State {
    struct Task {
        ResourceKey key;
        std::function<PreparedData()> make;
    };
    struct Queue {
        std::deque<Task> tasks;
        bool has_thread = false;
    };

    static Result result_of(const Task& task) {
        try {
            return {task.key, task.make(), nullptr};
        } catch (const std::exception&) {
            return {task.key, {}, std::current_exception()};
        }
    }
    void add(Result result) {
        const std::lock_guard lock(mutex);
        bytes += result.data.bytes();
        results.push_back(std::move(result));
        changed.notify_all();
    }
    void run(Queue& queue);

    std::mutex mutex;  // of all that follows
    std::condition_variable changed;
    std::array<Queue, 2> queues;  // by Need
    std::deque<Result> results;
    std::size_t bytes = 0;  // of the results
    bool stopped = false;
};

void Preparation::State::run(Queue& queue) {
    for (;;) {
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return stopped || (!queue.tasks.empty() && bytes < kMostBytes); });
        if (stopped) return;
        const Task task = std::move(queue.tasks.front());
        queue.tasks.pop_front();
        lock.unlock();
        add(result_of(task));
    }
}

Preparation::Preparation() : state_(std::make_shared<State>()) {}

Preparation::~Preparation() {
    const std::lock_guard lock(state_->mutex);
    state_->stopped = true;
    state_->changed.notify_all();
}

void Preparation::post(const ResourceKey& key, Need need, std::function<PreparedData()> make) {
    State::Queue& queue = state_->queues[need == Need::now ? 0 : 1];
    State::Task task{key, std::move(make)};
    if (!queue.has_thread) {
        try {
            std::thread([state = state_, &queue] { state->run(queue); }).detach();
            queue.has_thread = true;
        } catch (const std::system_error&) {
            return state_->add(State::result_of(task));
        }
    }
    const std::lock_guard lock(state_->mutex);
    queue.tasks.push_back(std::move(task));
    state_->changed.notify_all();
}

std::optional<Preparation::Result> Preparation::take() {
    const std::lock_guard lock(state_->mutex);
    if (state_->results.empty()) return std::nullopt;
    Result result = std::move(state_->results.front());
    state_->results.pop_front();
    state_->bytes -= result.data.bytes();
    state_->changed.notify_all();
    return result;
}

void Preparation::wait(std::chrono::milliseconds patience) const {
    std::unique_lock lock(state_->mutex);
    state_->changed.wait_for(lock, patience, [&] { return !state_->results.empty(); });
}

}  // namespace vrut::gl
