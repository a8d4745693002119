#include <iostream>
#include <map>
#include <set>
#include <stdexcept>

#include "base/files.hpp"
#include "commands/commands.hpp"
#include "commands/cue_film.hpp"
#include "commands/film.hpp"
#include "commands/film_writer.hpp"
#include "commands/image_output.hpp"
#include "commands/stop_signals.hpp"
#include "engine/images.hpp"
#include "io/image/image_file.hpp"
#include "nats/render_queue.hpp"
#include "observe/log.hpp"
#include "reference/reference.hpp"
#include "report.hpp"
#include "scenes/library.hpp"

namespace vrut::server::commands {

namespace fs = std::filesystem;

namespace {

/// Node ids as 24-bit RGB, white for none. Throws std::runtime_error where one is too high.
scene::Image picture_of_ids(const plan::View& view, const std::vector<scene::Index>& nodes) {
    constexpr scene::Id kNobody = 0xffffff;
    scene::Image image;
    image.resize(view.width, view.height);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        scene::Id id = kNobody;
        if (nodes[i] != scene::kNone) {
            id = view.scene->scene->nodes()[static_cast<std::size_t>(nodes[i])].id;
            if (id >= kNobody)
                throw std::runtime_error("--ids: node " + std::to_string(id) +
                                         " has an id beyond 16777214, the highest that 24 bits can hold");
        }
        for (unsigned k = 0; k < 3; ++k)
            image.rgba[4 * i + k] = static_cast<std::uint8_t>(id >> (16 - 8 * k));
        image.rgba[4 * i + 3] = 255;
    }
    return image;
}

ImageOutput output_of(const RenderArguments& arguments, const Film& film) {
    return ImageOutput({arguments.output, arguments.width, arguments.height,
                        arguments.fps.value_or(kImagesPerSecond), arguments.jpeg_quality, film.cameras.size(),
                        !arguments.keyframes.empty(), !arguments.stats});
}

void write_ids(const RenderArguments& arguments, const plan::View& view,
               const std::vector<scene::Index>& nodes) {
    base::write_file(arguments.ids, io::encode_png(picture_of_ids(view, nodes)));
}

/// Throws std::invalid_argument where the view shows what the reference leaves out (reference::trace()).
void require_surfaces_only(const plan::View& view) {
    const bool edges = view.wireframe || view.mode == plan::DrawMode::stylized;
    const bool marks = view.selected != scene::kNone || (view.markers && !view.markers->empty());
    if (edges || marks)
        throw std::invalid_argument(
            "--reference draws surfaces alone, without edges, outlines and markers: leave it out, or what "
            "asks for these (" +
            std::string(edges ? "--wireframe, --mode stylized" : "--select, markers") + ")");
}

void trace_film(const RenderArguments& arguments, Film film) {
    plan::View& view = film.view;
    require_surfaces_only(view);
    ImageOutput output = output_of(arguments, film);
    for (const scene::Camera& camera : film.cameras) {
        view.camera = camera;
        const reference::ReferenceImage picture = reference::trace(view);
        if (!arguments.ids.empty()) write_ids(arguments, view, picture.node);
        scene::Image image = reference::image_of(picture);
        output.add(image);
        if (!arguments.unrounded.empty())
            base::write_file(arguments.unrounded,
                             engine::encode_pfm(picture.width, picture.height, picture.color));
    }
    output.finish();
}

void print_stats(const std::string& device, const plan::View& view, const plan::FrameStats& stats) {
    std::cout << protocol::encode(protocol::RenderReport{device, view.width, view.height, view.samples,
                                                         stats.passes, stats.draws, stats.triangles,
                                                         stats.render_ms, stats.readback_ms})
              << std::endl;
}

void draw_film(const RenderArguments& arguments, Film film) {
    plan::View& view = film.view;
    add_levels(view);
    renderer::Renderer renderer(arguments.device);
    require_size(view.width, view.height, renderer);
    ImageOutput output = output_of(arguments, film);
    scene::Image image;
    for (const scene::Camera& camera : film.cameras) {
        view.camera = camera;
        if (!arguments.ids.empty()) write_ids(arguments, view, renderer.node_ids(view));
        plan::FrameStats stats;
        renderer.render(view, image, stats);
        output.add(image);
        if (arguments.stats) print_stats(renderer.description(), view, stats);
    }
    output.finish();
}

/// All that workers need to draw it.
std::vector<protocol::RenderJob> jobs_of(const RenderArguments& arguments, const Film& film,
                                         const std::string& run) {
    protocol::RenderJob job;
    job.run = run;
    job.scene = arguments.scene.filename().string();
    job.sha256 = scenes::sha256_of_scene(*film.view.scene->scene);
    job.up_axis = arguments.read.z_up ? protocol::UpAxis::z : protocol::UpAxis::y;
    job.studio = static_cast<protocol::RenderJob::Studio>(arguments.read.studio);
    job.width = arguments.width;
    job.height = arguments.height;
    job.samples = arguments.samples;
    job.detail = arguments.detail;
    job.format = is_film(arguments.output) ? protocol::ImageFormat::png : format_of(arguments.output);
    job.jpeg_quality = arguments.jpeg_quality;
    job.patches.push_back(arguments.set.empty() ? "{}" : arguments.set);
    for (const auto& [option, patch] : arguments.patches) job.patches.push_back(patch);
    std::vector<protocol::RenderJob> jobs;
    for (const scene::Camera& camera : film.cameras) {
        job.image = static_cast<int>(jobs.size()) + 1;
        job.camera = protocol::overlay_of(room::pose_of(camera));
        jobs.push_back(job);
    }
    return jobs;
}

/// Takes the files of images in any order: into one film, or each into its own file at once.
class ImageCollector {
public:
    explicit ImageCollector(const RenderArguments& arguments) : arguments_(arguments) {
        if (is_film(arguments.output))
            film_.emplace(arguments.output, arguments.width, arguments.height,
                          arguments.fps.value_or(kImagesPerSecond));
    }

    /// `number`: from 1. Throws std::runtime_error with a sentence.
    void take(int number, const std::vector<std::uint8_t>& file) {
        if (film_) return take_for_film(number, file);
        base::write_file(arguments_.keyframes.empty()
                             ? arguments_.output
                             : numbered(arguments_.output, static_cast<std::size_t>(number) - 1),
                         file);
    }
    void finish() {
        if (film_) film_->finish();
    }

private:
    void take_for_film(int number, const std::vector<std::uint8_t>& file) {
        early_.emplace(number, file);
        for (auto next = early_.begin(); next != early_.end() && next->first == added_ + 1; ++added_) {
            const auto image =
                io::decode_image({reinterpret_cast<const char*>(next->second.data()), next->second.size()});
            if (!image)
                throw std::runtime_error("image " + std::to_string(next->first) + ": " + image.error());
            film_->add(*image);
            next = early_.erase(next);
        }
    }

    const RenderArguments& arguments_;
    std::optional<FilmWriter> film_;
    std::map<int, std::vector<std::uint8_t>> early_;  // by number: those before them are not in the film yet
    int added_ = 0;
};

/// By workers.
void collect_film(const RenderArguments& arguments) {
    const StopSignals stop;
    const nats::Connection connection(arguments.nats);
    nats::FilmQueue queue(connection, nats::random_id());
    const Film film = film_of(arguments);
    ImageCollector collector(arguments);
    for (const protocol::RenderJob& job : jobs_of(arguments, film, queue.run())) queue.post(job);
    const std::size_t images = film.cameras.size();
    std::set<std::string> known_problems;
    for (std::size_t written = 0; written < images;) {
        if (stop.came())
            throw std::runtime_error("a signal stopped the film: " + std::to_string(written) + " of " +
                                     std::to_string(images) + " images are drawn");
        const std::optional<nats::FilmQueue::Result> result = queue.next();
        if (!result) continue;
        if (result->given_up)
            throw std::runtime_error("image " + std::to_string(result->image) + ": " + result->problem);
        if (!result->problem.empty()) {
            if (known_problems.insert(result->problem).second)
                observe::log_warning("worker_problem", {{"reason", result->problem}});
            continue;
        }
        collector.take(result->image, result->file);
        ++written;
    }
    collector.finish();
}

/// Before anything is read: throws where the output cannot be what the arguments say.
void require_render_output(const RenderArguments& arguments) {
    const std::string& name = arguments.output.string();
    const bool is_one_image = arguments.keyframes.empty() && arguments.cues.empty();
    if (is_one_image && arguments.fps)
        throw std::invalid_argument("--fps: one image has no speed; give --keyframes or --cues too");
    if (!is_film(arguments.output)) {
        format_of(arguments.output);
        if (arguments.frames > 0 && arguments.fps)
            throw std::invalid_argument("--fps: " + std::to_string(arguments.frames) +
                                        " numbered images have no speed; leave out --fps or --frames");
        return;
    }
    if (is_one_image)
        throw std::invalid_argument(name +
                                    ": a film needs --keyframes or --cues; name a single image .png or .jpg");
    require_film(arguments.output, arguments.width, arguments.height);
}

}  // namespace

void render_command(const RenderArguments& arguments) {
    require_render_output(arguments);
    if (!arguments.cues.empty()) return draw_cues(arguments);
    if (!arguments.nats.empty()) return collect_film(arguments);
    Film film = film_of(arguments);
    if (arguments.reference)
        trace_film(arguments, std::move(film));
    else
        draw_film(arguments, std::move(film));
}

}  // namespace vrut::server::commands
