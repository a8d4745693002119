#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "nats/connection.hpp"
#include "render_job.hpp"

/// The queue of images that workers draw: JetStream keeps the jobs until they are done, and the images until
/// they are collected. Subjects: vrut.jobs.RUN, in a stream of all runs; vrut.images.RUN, in one for each.
namespace vrut::server::nats {

/// A job goes to another worker if nothing is heard of it for so long.
inline constexpr std::chrono::seconds kJobPatience{5};
/// A job is given up after so many deliveries.
inline constexpr int kMostDeliveries = 20;

/// A job that this worker has, until it is destroyed. Meanwhile a thread tells the queue that it is worked
/// on.
class TakenJob {
public:
    TakenJob(const Connection& connection, Message message, protocol::RenderJob job, int delivery);
    TakenJob(const TakenJob&) = delete;
    TakenJob& operator=(const TakenJob&) = delete;

    const protocol::RenderJob& job() const { return job_; }
    /// Sends the image's file, and takes the job out of the queue. If the film is no longer wanted, the image
    /// is dropped.
    void finish(std::span<const std::uint8_t> file);
    /// Gives the job back, for another worker or a later try. The sentence goes to whoever collects the film,
    /// where it can be sent.
    void give_back(const std::string& sentence);
    /// The same for a worker that lacks what the job needs: this delivery does not count.
    void hand_on(const std::string& sentence);

private:
    bool report(const std::string& sentence, bool last);
    bool publish(std::span<const std::byte> bytes, const std::map<std::string, std::string>& headers);

    const Connection& connection_;
    Message message_;
    protocol::RenderJob job_;
    int delivery_;
    std::jthread heartbeat_;
};

/// The worker's side.
class JobQueue {
public:
    /// Throws std::runtime_error where the queue can be neither found nor made.
    explicit JobQueue(const Connection& connection);
    /// Waits for a job for half a second. Takes out of the queue what is no job, and logs it. Makes the queue
    /// anew if the server has lost it.
    std::unique_ptr<TakenJob> take();

private:
    void subscribe();
    std::unique_ptr<TakenJob> take_message(Message message);
    bool is_lost();

    const Connection& connection_;
    Subscription subscription_;
    int empty_polls_ = 0;
};

/// The client's side: posts the jobs of a film, and receives its images. The destructor removes from the
/// server what is left of the film.
class FilmQueue {
public:
    struct Result {
        int image = 0;
        std::vector<std::uint8_t> file;
        std::string problem;    ///< why a worker gave the image back; empty: it is drawn
        bool given_up = false;  ///< after kMostDeliveries
    };

    /// Makes the queue's part for this run. Throws std::runtime_error.
    FilmQueue(const Connection& connection, std::string run);
    ~FilmQueue();
    FilmQueue(const FilmQueue&) = delete;
    FilmQueue& operator=(const FilmQueue&) = delete;

    const std::string& run() const { return run_; }
    void post(const protocol::RenderJob& job);
    /// Waits for a result for half a second. Each image comes once, whole. Throws std::runtime_error where
    /// the server has lost the queue.
    std::optional<Result> next();

private:
    void forget_received(natsMsg* last) const;
    std::uint64_t jobs_left() const;
    void take_back_jobs() const;

    struct Parts {
        std::vector<std::vector<std::uint8_t>> parts;
        std::size_t missing = 0;
    };

    const Connection& connection_;
    std::string run_, stream_;
    int posted_ = 0;                   // the highest number of an image
    std::vector<std::uint64_t> jobs_;  // their places in the queue
    int empty_polls_ = 0;
    Subscription subscription_;
    std::map<std::pair<int, std::string>, Parts> incomplete_;  // by image and delivery
    std::set<int> complete_;
};

}  // namespace vrut::server::nats
