#include "nats/render_queue.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <string_view>

#include "nats/stream.hpp"
#include "observe/log.hpp"

namespace vrut::server::nats {

namespace {

using namespace std::chrono_literals;

constexpr const char *kJobs = "VRUT_JOBS", *kWorkers = "workers";
constexpr std::size_t kImagePartBytes = std::size_t{512} << 10;  // a NATS server takes messages of a megabyte
constexpr std::size_t kMostImageParts = 4096;
constexpr std::chrono::milliseconds kQueuePoll{500};
constexpr int kPollsOfCheck = 4;  // after so many without a message it is asked whether the queue is there
constexpr auto kFilmKept = 24h;

std::string jobs_subject(const std::string& run) { return "vrut.jobs." + run; }
std::string images_subject(const std::string& run) { return "vrut.images." + run; }
std::string images_stream(const std::string& run) { return "VRUT_IMAGES_" + run; }

Stream stream_of_jobs() { return {kJobs, jobs_subject("*"), js_WorkQueuePolicy, kFilmKept}; }

/// False where the server says so, not where it says nothing.
bool has_stream(const Connection& connection, const std::string& name) {
    jsStreamInfo* info = nullptr;
    jsErrCode error{};
    js_GetStreamInfo(&info, connection.jetstream(), name.c_str(), nullptr, &error);
    jsStreamInfo_Destroy(info);
    return error != JSStreamNotFoundErr;
}

std::string_view text_of(natsMsg* message) {
    return {natsMsg_GetData(message), static_cast<std::size_t>(natsMsg_GetDataLength(message))};
}

}  // namespace

// --- the worker's side

TakenJob::TakenJob(const Connection& connection, Message message, protocol::RenderJob job, int delivery)
    : connection_(connection),
      message_(std::move(message)),
      job_(std::move(job)),
      delivery_(delivery),
      heartbeat_([raw = message_.get()](const std::stop_token& stop) {
          std::mutex mutex;
          std::condition_variable_any stopped;
          std::unique_lock lock(mutex);
          while (!stopped.wait_for(lock, stop, kJobPatience / 4, [&] { return stop.stop_requested(); }))
              natsMsg_InProgress(raw, nullptr);
      }) {}

/// False where nobody collects the run any more.
bool TakenJob::publish(std::span<const std::byte> bytes, const std::map<std::string, std::string>& headers) {
    natsMsg* created = nullptr;
    std::string data(bytes.size(), 0);
    std::ranges::transform(bytes, data.begin(), [](std::byte byte) { return static_cast<char>(byte); });
    connection_.require(natsMsg_Create(&created, images_subject(job_.run).c_str(), nullptr, data.data(),
                                       static_cast<int>(data.size())),
                        "an image cannot be sent");
    const Message message(created);
    for (const auto& [name, value] : headers) natsMsgHeader_Set(created, name.c_str(), value.c_str());
    jsErrCode error{};
    const natsStatus status = js_PublishMsg(nullptr, connection_.jetstream(), created, nullptr, &error);
    // Nobody takes an image while JetStream starts, either.
    if (status == NATS_NO_RESPONDERS && !has_stream(connection_, images_stream(job_.run))) return false;
    connection_.require(status, "an image cannot be sent", error);
    return true;
}

void TakenJob::finish(std::span<const std::uint8_t> file) {
    const std::size_t parts = std::max<std::size_t>((file.size() + kImagePartBytes - 1) / kImagePartBytes, 1);
    const std::string sender = random_id();
    for (std::size_t i = 0; i < parts; ++i) {
        const std::size_t first = i * kImagePartBytes;
        const bool wanted =
            publish(std::as_bytes(file.subspan(first, std::min(kImagePartBytes, file.size() - first))),
                    {{"Image", std::to_string(job_.image)},
                     {"Sender", sender},
                     {"Part", std::to_string(i)},
                     {"Parts", std::to_string(parts)}});
        if (!wanted) break;
    }
    heartbeat_ = {};
    natsMsg_AckSync(message_.get(), nullptr, nullptr);
}

/// To whoever collects the film. False where nobody does; true, too, where the server is away: then the job
/// waits there.
bool TakenJob::report(const std::string& sentence, bool last) {
    try {
        return publish(std::as_bytes(std::span(sentence)),
                       {{"Image", std::to_string(job_.image)}, {"Problem", "1"}, {"Last", last ? "1" : "0"}});
    } catch (const std::exception&) {
        return true;
    }
}

void TakenJob::give_back(const std::string& sentence) {
    const bool last = delivery_ >= kMostDeliveries;
    const bool wanted = report(sentence, last);
    heartbeat_ = {};
    if (wanted && !last)
        natsMsg_NakWithDelay(message_.get(), std::chrono::milliseconds(1s).count(), nullptr);
    else
        natsMsg_Term(message_.get(), nullptr);
}

/// A new message has had no delivery. If it cannot be sent, the old one stays.
void TakenJob::hand_on(const std::string& sentence) {
    const bool wanted = report(sentence, false);
    const std::string_view text = text_of(message_.get());
    const natsStatus status =
        wanted ? js_Publish(nullptr, connection_.jetstream(), jobs_subject(job_.run).c_str(), text.data(),
                            static_cast<int>(text.size()), nullptr, nullptr)
               : NATS_OK;
    heartbeat_ = {};
    if (status == NATS_OK) natsMsg_AckSync(message_.get(), nullptr, nullptr);
}

JobQueue::JobQueue(const Connection& connection) : connection_(connection) { subscribe(); }

void JobQueue::subscribe() {
    add_stream(connection_, stream_of_jobs());
    jsSubOptions options;
    jsSubOptions_Init(&options);
    options.Stream = kJobs;
    options.Config.AckPolicy = js_AckExplicit;
    options.Config.AckWait = std::chrono::nanoseconds(kJobPatience).count();
    jsErrCode error{};
    natsSubscription* subscription = nullptr;
    const natsStatus status =
        js_PullSubscribe(&subscription, connection_.jetstream(), jobs_subject("*").c_str(), kWorkers, nullptr,
                         &options, &error);
    connection_.require(status, "the queue of jobs cannot be read", error);
    subscription_.reset(subscription);
}

/// A server that has lost a queue answers as one whose queue is empty.
bool JobQueue::is_lost() {
    jsConsumerInfo* info = nullptr;
    jsErrCode error{};
    const natsStatus status = natsSubscription_GetConsumerInfo(&info, subscription_.get(), nullptr, &error);
    jsConsumerInfo_Destroy(info);
    return status != NATS_OK && status != NATS_TIMEOUT;
}

std::unique_ptr<TakenJob> JobQueue::take() {
    natsMsgList list{};
    const natsStatus status =
        natsSubscription_Fetch(&list, subscription_.get(), 1, kQueuePoll.count(), nullptr);
    Message message(status == NATS_OK && list.Count > 0 ? std::exchange(list.Msgs[0], nullptr) : nullptr);
    natsMsgList_Destroy(&list);
    if (message) return take_message(std::move(message));
    if (status != NATS_OK && status != NATS_TIMEOUT) std::this_thread::sleep_for(kQueuePoll);
    if (++empty_polls_ % kPollsOfCheck != 0 || !is_lost()) return {};
    try {
        subscribe();
    } catch (const std::exception& error) {
        observe::log_debug("queue_unreachable",
                           {{"reason", error.what()}});  // the connection's loss is logged
    }
    return {};
}

std::unique_ptr<TakenJob> JobQueue::take_message(Message message) {
    auto job = protocol::parse_render_job(text_of(message.get()));
    if (job && jobs_subject(job->run) != natsMsg_GetSubject(message.get()))
        job = tl::unexpected<std::string>("'run' is not that of its subject");
    if (!job) {
        observe::log_warning("invalid_job", {{"reason", job.error()}});
        natsMsg_Term(message.get(), nullptr);
        return {};
    }
    jsMsgMetaData* meta = nullptr;
    const bool has_meta = natsMsg_GetMetaData(&meta, message.get()) == NATS_OK;
    const int delivery = has_meta ? static_cast<int>(meta->NumDelivered) : 1;
    jsMsgMetaData_Destroy(meta);
    auto taken = std::make_unique<TakenJob>(connection_, std::move(message), *std::move(job), delivery);
    if (delivery <= kMostDeliveries) return taken;
    taken->give_back("the image was given to " + std::to_string(kMostDeliveries) +
                     " workers, and none finished it");
    return {};
}

// --- the film's side

FilmQueue::FilmQueue(const Connection& connection, std::string run)
    : connection_(connection), run_(std::move(run)), stream_(images_stream(run_)) {
    add_stream(connection, stream_of_jobs());
    add_stream(connection, {stream_, images_subject(run_), js_LimitsPolicy, kFilmKept});
    jsSubOptions options;
    jsSubOptions_Init(&options);
    options.Stream = stream_.c_str();
    options.Ordered = true;
    jsErrCode error{};
    natsSubscription* subscription = nullptr;
    const natsStatus status = js_SubscribeSync(&subscription, connection.jetstream(),
                                               images_subject(run_).c_str(), nullptr, &options, &error);
    connection.require(status, "the images cannot be read", error);
    subscription_.reset(subscription);
}

FilmQueue::~FilmQueue() {
    js_DeleteStream(connection_.jetstream(), stream_.c_str(), nullptr, nullptr);
    take_back_jobs();
}

/// How many of the film's jobs the queue has; 0, too, where the server does not answer.
std::uint64_t FilmQueue::jobs_left() const {
    const std::string subject = jobs_subject(run_);
    jsOptions options;
    jsOptions_Init(&options);
    options.Stream.Info.SubjectsFilter = subject.c_str();
    jsStreamInfo* info = nullptr;
    js_GetStreamInfo(&info, connection_.jetstream(), kJobs, &options, nullptr);
    const Handle<jsStreamInfo, jsStreamInfo_Destroy> queue(info);
    const jsStreamStateSubjects* const subjects = info ? info->State.Subjects : nullptr;
    return subjects && subjects->Count > 0 ? subjects->List[0].Msgs : 0;
}

/// One by one: where a subject is purged, NATS 2.9 makes the workers' consumer skip the jobs of other films.
void FilmQueue::take_back_jobs() const {
    std::uint64_t left = jobs_left();
    for (auto job = jobs_.rbegin(); left > 0 && job != jobs_.rend(); ++job) {
        const natsStatus status = js_DeleteMsg(connection_.jetstream(), kJobs, *job, nullptr, nullptr);
        if (status == NATS_OK)
            --left;
        else if (!has_refused(status))
            return;  // it does not answer any more
    }
}

void FilmQueue::post(const protocol::RenderJob& job) {
    const std::string text = protocol::encode(job);
    jsErrCode error{};
    jsPubAck* acknowledged = nullptr;
    const natsStatus status = js_Publish(&acknowledged, connection_.jetstream(), jobs_subject(run_).c_str(),
                                         text.data(), static_cast<int>(text.size()), nullptr, &error);
    const Handle<jsPubAck, jsPubAck_Destroy> acknowledgement(acknowledged);
    connection_.require(status, "a job cannot be sent", error);
    posted_ = std::max(posted_, job.image);
    jobs_.push_back(acknowledged->Sequence);
}

/// What has come needs no place in the server, up to this message.
void FilmQueue::forget_received(natsMsg* last) const {
    jsMsgMetaData* meta = nullptr;
    if (natsMsg_GetMetaData(&meta, last) == NATS_OK) {
        jsOptions options;
        jsOptions_Init(&options);
        options.Stream.Purge.Sequence = meta->Sequence.Stream + 1;
        js_PurgeStream(connection_.jetstream(), stream_.c_str(), &options, nullptr);
    }
    jsMsgMetaData_Destroy(meta);
}

std::optional<FilmQueue::Result> FilmQueue::next() {
    natsMsg* received = nullptr;
    if (natsSubscription_NextMsg(&received, subscription_.get(), kQueuePoll.count()) != NATS_OK) {
        if (++empty_polls_ % kPollsOfCheck == 0 && !has_stream(connection_, stream_))
            throw std::runtime_error("--nats: " + connection_.name() +
                                     ": the server has lost the film's queue; start the film again");
        return {};
    }
    const Message message(received);
    const auto image = number_of(header_of(received, "Image"));
    if (!image || *image == 0 || *image > static_cast<std::size_t>(posted_)) return {};
    Result result;
    result.image = static_cast<int>(*image);
    if (complete_.contains(result.image)) return {};
    if (header_of(received, "Problem") == "1") {
        result.problem = text_of(received);
        result.given_up = header_of(received, "Last") == "1";
        return result;
    }
    const auto part = number_of(header_of(received, "Part")), parts = number_of(header_of(received, "Parts"));
    if (!part || !parts || *parts > kMostImageParts || *part >= *parts) return {};
    Parts& incomplete = incomplete_[{result.image, header_of(received, "Sender")}];
    if (incomplete.parts.empty()) incomplete = {std::vector<std::vector<std::uint8_t>>(*parts), *parts};
    if (incomplete.parts.size() != *parts || !incomplete.parts[*part].empty()) return {};
    const std::string_view text = text_of(received);
    incomplete.parts[*part].assign(text.begin(), text.end());
    if (--incomplete.missing > 0) return {};
    for (const std::vector<std::uint8_t>& bytes : incomplete.parts)
        result.file.insert(result.file.end(), bytes.begin(), bytes.end());
    std::erase_if(incomplete_, [&](const auto& entry) { return entry.first.first == result.image; });
    complete_.insert(result.image);
    forget_received(received);
    return result;
}

}  // namespace vrut::server::nats
