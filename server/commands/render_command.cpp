#include <array>
#include <future>
#include <iostream>
#include <stdexcept>

#include "base/files.hpp"
#include "commands/commands.hpp"
#include "commands/film.hpp"
#include "engine/images.hpp"
#include "reference/reference.hpp"
#include "report.hpp"

namespace vrut::server::commands {

namespace {

/// Of image `i`, from 0. Those of films have numbers, from 0001.
std::filesystem::path output_of(const RenderArguments& arguments, std::size_t i) {
    if (arguments.keyframes.empty()) return arguments.output;
    const std::string number = std::to_string(i + 1);
    std::filesystem::path path = arguments.output;
    path.replace_filename(path.stem().string() + "-" +
                          std::string(number.size() < 4 ? 4 - number.size() : 0, '0') + number +
                          path.extension().string());
    return path;
}

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

void write_picture(const RenderArguments& arguments, const std::filesystem::path& output,
                   const scene::Image& image) {
    base::write_file(output, encoded(image, format_of(output), arguments.jpeg_quality));
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
    for (std::size_t i = 0; i < film.cameras.size(); ++i) {
        view.camera = film.cameras[i];
        const reference::ReferenceImage picture = reference::trace(view);
        if (!arguments.ids.empty()) write_ids(arguments, view, picture.node);
        write_picture(arguments, output_of(arguments, i), reference::image_of(picture));
        if (!arguments.unrounded.empty())
            base::write_file(arguments.unrounded,
                             engine::encode_pfm(picture.width, picture.height, picture.color));
    }
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
    require_size(view, renderer);
    std::array<scene::Image, 2> images;  // one is drawn while the other is encoded and written
    std::future<void> written;
    for (std::size_t i = 0; i < film.cameras.size(); ++i) {
        view.camera = film.cameras[i];
        if (!arguments.ids.empty()) write_ids(arguments, view, renderer.node_ids(view));
        scene::Image& image = images[i % 2];
        plan::FrameStats stats;
        renderer.render(view, image, stats);
        if (written.valid()) written.get();
        written = std::async(std::launch::async,
                             [&, i] { write_picture(arguments, output_of(arguments, i), image); });
        if (arguments.stats) print_stats(renderer.description(), view, stats);
    }
    written.get();
}

}  // namespace

void render_command(const RenderArguments& arguments) {
    format_of(arguments.output);
    Film film = film_of(arguments);
    if (arguments.reference)
        trace_film(arguments, std::move(film));
    else
        draw_film(arguments, std::move(film));
}

}  // namespace vrut::server::commands
