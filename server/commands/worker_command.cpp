#include <chrono>
#include <optional>
#include <stdexcept>
#include <thread>

#include "codec.hpp"
#include "commands/commands.hpp"
#include "commands/film.hpp"
#include "commands/network.hpp"
#include "commands/stop_signals.hpp"
#include "nats/render_queue.hpp"
#include "observe/log.hpp"
#include "scenes/library.hpp"

namespace vrut::server::commands {

namespace {

/// A worker without the scene of a job leaves the queue to others for so long.
constexpr std::chrono::seconds kPause{5};

/// The worker has not the scene of a job.
struct MissingScene : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Draws jobs, and keeps the scene of the last one for the next.
class Worker {
public:
    explicit Worker(const WorkerArguments& arguments)
        : renderer_(arguments.device), library_(arguments.scenes) {}

    std::vector<std::uint8_t> draw(const protocol::RenderJob& job) {
        prepare(job);
        view_.camera = {*job.camera.eye, *job.camera.focus, *job.camera.up, *job.camera.center,
                        *job.camera.fov};
        plan::FrameStats stats;
        renderer_.render(view_, image_, stats);
        return encoded(image_, job.format, job.jpeg_quality);
    }

    const std::string& description() const { return renderer_.description(); }

private:
    /// What the images of one film have in common.
    static std::string film_of_job(protocol::RenderJob job) {
        job.image = 1;
        job.camera = {};
        return protocol::encode(job);
    }

    /// Finds the scene by its file's name, wherever it lies in the folder, and by what it shows.
    void prepare(const protocol::RenderJob& job) {
        const std::string wanted = film_of_job(job);
        if (wanted == prepared_) return;
        prepared_.clear();
        RenderArguments arguments;
        arguments.read.z_up = job.up_axis == protocol::UpAxis::z;
        arguments.read.studio = static_cast<io::Studio>(job.studio);
        arguments.width = job.width;
        arguments.height = job.height;
        arguments.samples = job.samples;
        arguments.detail = job.detail;
        for (const std::string& patch : job.patches) arguments.patches.emplace_back("the job's patch", patch);
        bool has_name = false;
        for (const std::string& name : library_.names()) {
            const auto path = library_.find(name);
            if (!path || path->filename() != job.scene) continue;
            has_name = true;
            arguments.scene = *path;
            view_ = film_of(arguments).view;
            if (scenes::sha256_of_scene(*view_.scene->scene) != job.sha256) continue;
            require_size(view_.width, view_.height, renderer_);
            add_levels(view_);
            prepared_ = wanted;
            return;
        }
        throw MissingScene(
            "'" + job.scene + "' is " +
            (has_name
                 ? "another scene here than where the film was asked for: its file or its textures differ"
                 : "not in the worker's folder of scenes"));
    }

    renderer::Renderer renderer_;
    scenes::SceneLibrary library_;
    std::string prepared_;
    plan::View view_;
    scene::Image image_;
};

void pause(const StopSignals& stop) {
    const auto end = std::chrono::steady_clock::now() + kPause;
    while (!stop.came() && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
}

/// Answers those who monitor the worker, until it is destroyed.
class Monitoring {
public:
    Monitoring(const WorkerArguments& arguments, const nats::Connection& connection,
               const std::string& renderer) {
        net::ServerOptions options = server_options(arguments.network);
        if (!net::is_loopback(options.listen.host) && !options.access.needs_token())
            throw std::runtime_error("--listen: " + options.listen.host +
                                     " is open to other machines: give a token with --token-file");
        const auto is_connected = [&connection] { return connection.is_connected(); };
        options.nats_connected = is_connected;
        server_.emplace(options, net::Monitored{renderer, [is_connected]() -> std::optional<std::string> {
                                                    if (is_connected()) return std::nullopt;
                                                    return "the NATS server cannot be reached";
                                                }});
        observe::log_info("listening",
                          {{"host", options.listen.host}, {"port", std::uint64_t{server_->port()}}});
        thread_ = std::jthread([this] { server_->run(); });
    }
    ~Monitoring() { server_->stop(); }
    Monitoring(const Monitoring&) = delete;
    Monitoring& operator=(const Monitoring&) = delete;

    observe::Metrics& metrics() { return server_->metrics(); }

private:
    std::optional<net::Server> server_;
    std::jthread thread_;  // last: it uses the server
};

}  // namespace

void worker_command(const WorkerArguments& arguments) {
    if (!std::filesystem::is_directory(arguments.scenes))
        throw std::runtime_error("--scenes: " + arguments.scenes.string() + " is no folder");
    const StopSignals stop;
    const nats::Connection connection(arguments.nats);
    nats::JobQueue queue(connection);
    Worker worker(arguments);
    std::optional<Monitoring> monitoring;
    if (!arguments.network.listen.empty()) monitoring.emplace(arguments, connection, worker.description());
    const auto count = [&](std::string_view result) {
        if (monitoring) ++monitoring->metrics().jobs[result];
    };
    observe::log_info("waiting_for_jobs", {{"nats", connection.name()}});
    while (!stop.came()) {
        const std::unique_ptr<nats::TakenJob> taken = queue.take();
        if (!taken) continue;
        try {
            taken->finish(worker.draw(taken->job()));
            count("drawn");
            observe::log_info("image_drawn",
                              {{"run", taken->job().run}, {"image", std::int64_t{taken->job().image}}});
        } catch (const MissingScene& error) {
            observe::log_warning("scene_missing", {{"run", taken->job().run}, {"reason", error.what()}});
            taken->hand_on(error.what());
            count("handed-on");
            pause(stop);
        } catch (const std::exception& error) {
            observe::log_warning("image_returned",
                                 {{"image", std::int64_t{taken->job().image}}, {"reason", error.what()}});
            taken->give_back(error.what());
            count("returned");
        }
    }
}

}  // namespace vrut::server::commands
