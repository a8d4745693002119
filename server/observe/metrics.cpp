#include "observe/metrics.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "observe/process_usage.hpp"

namespace vrut::server::observe {

namespace {

constexpr std::string_view kPrefix = "vrut_preview_";

/// A label's value may hold anything.
std::string label(std::string_view name, std::string_view value) {
    std::string text = std::string(name) + "=\"";
    for (const char c : value) {
        if (c == '\\' || c == '"') text += '\\';
        text += c == '\n' ? std::string("\\n") : std::string(1, c);
    }
    return text + '"';
}

/// Writes families one after the other, each with its samples behind its head.
class Exposition {
public:
    void family(std::string name, std::string_view type, std::string_view help) {
        name_ = std::move(name);
        out_ += fmt::format("# HELP {} {}\n# TYPE {} {}\n", name_, help, name_, type);
    }
    template <class Number>
    void sample(Number value, const std::string& labels = {}, std::string_view suffix = {}) {
        out_ += labels.empty() ? fmt::format("{}{} {}\n", name_, suffix, value)
                               : fmt::format("{}{}{{{}}} {}\n", name_, suffix, labels, value);
    }

    void counter(std::string_view name, std::string_view help, std::uint64_t value) {
        family(fmt::format("{}{}", kPrefix, name), "counter", help);
        sample(value);
    }
    void gauge(std::string_view name, std::string_view help, std::uint64_t value) {
        family(fmt::format("{}{}", kPrefix, name), "gauge", help);
        sample(value);
    }
    template <const auto& kWords>
    void words(std::string_view type, std::string_view name, std::string_view key, std::string_view help,
               const Counters<kWords>& counters) {
        family(fmt::format("{}{}", kPrefix, name), type, help);
        for (std::size_t i = 0; i < kWords.size(); ++i) sample(counters.at(i).load(), label(key, kWords[i]));
    }
    void histogram(std::string_view name, std::string_view help) {
        family(fmt::format("{}{}", kPrefix, name), "histogram", help);
    }
    void buckets(const Histogram& histogram, const std::string& labels = {}) {
        const std::string before = labels.empty() ? "" : labels + ",";
        const Histogram::Counts counts = histogram.counts();
        std::uint64_t count = 0;
        for (std::size_t i = 0; i < counts.size(); ++i) {
            count += counts[i];
            const bool last = i == Histogram::kBounds.size();
            const std::string bound = last ? "+Inf" : fmt::format("{}", Histogram::kBounds[i]);
            sample(count, before + label("le", bound), "_bucket");
        }
        sample(histogram.sum(), labels, "_sum");
        sample(count, labels, "_count");
    }
    std::string take() { return std::move(out_); }

private:
    std::string out_, name_;
};

void add_state(Exposition& to, const Metrics::Readings& readings) {
    to.family(fmt::format("{}build_info", kPrefix), "gauge", "1; the version, and what draws.");
    to.sample(1, label("version", VRUT_VERSION) + "," + label("renderer", readings.renderer));

    to.gauge("healthy", "1 where /healthz answers 200, else 0.", readings.healthy);
    to.gauge("ready", "1 where /readyz answers 200, else 0.", readings.ready);
    to.gauge("events_waiting", "What has come and the render thread has not handled.",
             readings.events_waiting);
    if (readings.nats_connected)
        to.gauge("nats_connected", "1 while the NATS server can be reached, else 0.",
                 *readings.nats_connected);
    if (readings.room_owner)
        to.gauge("room_owner", "1 while this server draws its shared room, 0 while it stands by.",
                 *readings.room_owner);
    if (readings.rooms) to.gauge("rooms_open", "Rooms of other servers that are open here.", *readings.rooms);
}

void add_clients(Exposition& to, const Metrics& metrics) {
    to.words("gauge", "clients", "role", "Clients connected now.", metrics.clients);
    const std::uint64_t closed = metrics.closes.sum();  // before the other, which it never exceeds
    to.gauge("connections", "WebSocket connections now, with those that have not said hello.",
             metrics.connections_opened - closed);
    to.counter("connections_opened_total", "WebSocket connections ever.", metrics.connections_opened);
    to.words("counter", "closes_total", "reason", "WebSocket connections that ended.", metrics.closes);
    to.counter("tls_handshakes_failed_total", "TLS handshakes that did not come to their end.",
               metrics.tls_handshakes_failed);
    to.counter("messages_received_total", "Messages that clients sent.", metrics.messages_received);
    to.counter("received_bytes_total", "Bytes of messages that clients sent.", metrics.bytes_received);
    to.words("counter", "errors_total", "code", "Messages answered by an error.", metrics.errors);
}

void add_frames(Exposition& to, const Metrics& metrics) {
    to.counter("frames_granted_total", "Frames that clients asked for.", metrics.frames_granted);
    to.family(fmt::format("{}frames_rendered_total", kPrefix), "counter",
              "Frames drawn, while things moved and at rest.");
    to.sample(metrics.frames_rendered_moving.load(), label("level", "moving"));
    to.sample(metrics.frames_rendered_still.load(), label("level", "still"));
    to.counter("frames_interrupted_total", "Frames whose drawing stopped because the view had changed.",
               metrics.frames_interrupted);
    to.counter("samples_drawn_total", "Samples drawn, for images of any kind.", metrics.samples_drawn);
    to.counter("readbacks_total", "Times that pixels were read back from what draws.", metrics.readbacks);
    to.counter("frames_encoded_total", "Images encoded, snapshots too.", metrics.frames_encoded);
    to.counter("encoded_bytes_total", "Bytes of encoded images.", metrics.bytes_encoded);
    to.counter("frames_sent_total", "Frames handed to sockets.", metrics.frames_sent);
    to.counter("frames_replaced_total", "Frames that gave way to newer ones before they were sent.",
               metrics.frames_replaced);
    to.counter("sent_bytes_total", "Bytes of messages handed to sockets.", metrics.bytes_sent);
    to.counter("snapshots_rendered_total", "Snapshots drawn.", metrics.snapshots_rendered);
    to.counter("snapshots_sent_total", "Snapshots handed to sockets.", metrics.snapshots_sent);
    to.gauge("held_bytes", "Bytes of encoded images and of messages that wait for clients.",
             metrics.bytes_held);
    to.gauge("pictures_held", "Encoded images in memory.", metrics.pictures_held);
    to.gauge("pictures_held_most", "The most encoded images that were ever in memory.",
             metrics.pictures_held_most);
}

void add_jobs(Exposition& to, const Metrics& metrics) {
    to.words("counter", "jobs_total", "result", "Images that the worker took from the queue.", metrics.jobs);
}

void add_times(Exposition& to, const Metrics& metrics) {
    to.histogram("render_seconds", "Drawing of a frame, while things moved and at rest.");
    to.buckets(metrics.render_moving, label("level", "moving"));
    to.buckets(metrics.render_still, label("level", "still"));
    to.histogram("readback_seconds", "Reading a frame's pixels back from what draws.");
    to.buckets(metrics.readback);
    to.histogram("encode_seconds", "Encoding of an image.");
    to.buckets(metrics.encode);
    to.histogram(
        "input_to_frame_seconds",
        "From an input's arrival until a client's first frame that shows it is handed to its socket.");
    to.buckets(metrics.input_to_frame);
    to.histogram(
        "input_to_grant_seconds",
        "From an input's arrival until a client acknowledges the first frame sent to it that shows it.");
    to.buckets(metrics.input_to_grant);
}

void add_scene(Exposition& to, const Metrics& metrics) {
    to.gauge("scene_nodes", "Nodes of the scene.", metrics.scene_nodes);
    to.gauge("scene_triangles", "Triangles of the scene.", metrics.scene_triangles);
    to.gauge("gl_objects", "GL objects that lived after the last frame.", metrics.gl_objects);
}

/// By the names that Prometheus' own libraries give them.
void add_process(Exposition& to) {
    const ProcessUsage usage = process_usage();
    to.family("process_start_time_seconds", "gauge", "When the process started, since 1970.");
    to.sample(usage.started);
    to.family("process_cpu_seconds_total", "counter", "Processor time spent.");
    to.sample(usage.cpu_seconds);
    to.family("process_resident_memory_bytes", "gauge", "Memory in use.");
    to.sample(usage.resident_bytes);
    to.family("process_open_fds", "gauge", "Open file descriptors.");
    to.sample(usage.descriptors);
    to.family("process_max_fds", "gauge", "File descriptors that may be open at most.");
    to.sample(usage.most_descriptors);
}

}  // namespace

void Histogram::observe(double seconds) {
    const auto bucket = std::lower_bound(kBounds.begin(), kBounds.end(), seconds);
    ++counts_[static_cast<std::size_t>(bucket - kBounds.begin())];
    nanoseconds_ += static_cast<std::uint64_t>(std::max(seconds, 0.0) * 1e9);
}

Histogram::Counts Histogram::counts() const {
    Counts counts{};
    std::transform(counts_.begin(), counts_.end(), counts.begin(), [](const Counter& c) { return c.load(); });
    return counts;
}

std::string Metrics::text(const Readings& readings) const {
    Exposition to;
    add_state(to, readings);
    if (readings.has_rooms) {
        add_clients(to, *this);
        add_frames(to, *this);
        add_times(to, *this);
        add_scene(to, *this);
    } else {
        add_jobs(to, *this);
    }
    add_process(to);
    return to.take();
}

}  // namespace vrut::server::observe
