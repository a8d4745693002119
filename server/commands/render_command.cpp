#include <array>
#include <cmath>
#include <fstream>
#include <future>
#include <iostream>
#include <iterator>
#include <stdexcept>

#include "base/files.hpp"
#include "codec.hpp"
#include "commands/commands.hpp"
#include "engine/images.hpp"
#include "mesh/detail_levels.hpp"
#include "observe/log.hpp"
#include "observe/progress.hpp"
#include "reference/reference.hpp"
#include "renderer/renderer.hpp"
#include "report.hpp"
#include "room/room.hpp"
#include "scenes/library.hpp"

namespace vrut::server::commands {

namespace {

std::string read_text(const std::string& option, const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (!stream) throw std::runtime_error(option + ": " + path.string() + " cannot be read");
    return text;
}

/// What one client of a server would do to change the state. Throws std::runtime_error.
void say(room::Room& room, const std::string& option, decltype(protocol::ClientMessage::payload) payload) {
    room.handle_message("render", {1, std::move(payload)}, room::SessionTime(0));
    for (const room::Answer& answer : room.take_answers())
        if (!answer.rejection.empty()) throw std::runtime_error(option + ": " + answer.rejection);
}

void patch(room::Room& room, const std::string& option, const std::string& text) {
    auto patch = protocol::parse_patch(text);
    if (!patch) throw std::runtime_error(option + ": " + patch.error().message);
    say(room, option, *std::move(patch));
}

/// The camera that the options give: the file's members, then the single ones.
scene::Camera wanted_camera(const RenderArguments& arguments, const room::Room& room) {
    protocol::CameraOverlay overlay;
    if (!arguments.camera_file.empty()) {
        auto camera = protocol::parse_camera(read_text("--camera", arguments.camera_file));
        if (!camera) throw std::runtime_error(arguments.camera_file.string() + ": " + camera.error().message);
        overlay = *camera;
        if (overlay.eye && overlay.focus) overlay.node.reset();  // a whole pose, maybe of another scene
    }
    if (arguments.eye) overlay.eye = arguments.eye;
    if (arguments.focus) overlay.focus = arguments.focus;
    if (arguments.up) overlay.up = arguments.up;
    if (arguments.fov) overlay.fov = arguments.fov;
    const auto camera =
        room::overlaid(room::camera_of(room.state().camera), overlay, room.scene(), "the camera");
    if (!camera) throw std::runtime_error(camera.error().message);
    return *camera;
}

/// Of each image: the one that the options give, or those of a flight that begins there, in equal times.
std::vector<scene::Camera> wanted_cameras(const RenderArguments& arguments, const room::Room& room) {
    const scene::Camera first = wanted_camera(arguments, room);
    if (arguments.keyframes.empty()) return {first};
    const auto fail = [&](const protocol::Error& error) {
        throw std::runtime_error(arguments.keyframes.string() + ": " + error.message);
    };
    const auto flight = protocol::parse_flight(read_text("--keyframes", arguments.keyframes));
    if (!flight) fail(flight.error());
    const auto path = room::flight_path(*flight, first, room.scene());
    if (!path) fail(path.error());
    std::vector<scene::Camera> cameras;
    cameras.reserve(static_cast<std::size_t>(arguments.frames));
    const int last = arguments.frames - 1;
    for (int i = 0; i < last; ++i) cameras.push_back(path->at(path->duration() * i / last));
    cameras.push_back(path->at(path->duration()));
    return cameras;
}

/// What is drawn, but for the camera, and the camera of each image.
struct Film {
    plan::View view;
    std::vector<scene::Camera> cameras;
};

Film film_of(const RenderArguments& arguments) {
    const std::string name = arguments.scene.filename().string();
    auto scene = scenes::load_scene(arguments.scene, name, observe::loading_bar(name), {{}, arguments.read});
    if (!scene) throw std::runtime_error(scene.error());
    for (const protocol::Notice& notice : scene->notices)
        observe::log_warning("notice", {{"text", notice.message}});
    room::Room room(*std::move(scene));
    room.join("render", protocol::Role::control, room::SessionTime(0));
    const protocol::Resize size{static_cast<double>(arguments.width), static_cast<double>(arguments.height),
                                1};
    say(room, "--size", size);
    patch(room, "--set", arguments.set.empty() ? "{}" : arguments.set);
    for (const auto& [option, text] : arguments.patches) patch(room, option, text);

    plan::View view = room.visible();
    view.width = arguments.width;
    view.height = arguments.height;
    view.samples = arguments.samples;
    view.detail = arguments.detail;
    return {view, wanted_cameras(arguments, room)};
}

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
    base::write_file(output, output.extension() == ".png"
                                 ? io::encode_png(image)
                                 : engine::JpegEncoder().encode(image, arguments.jpeg_quality, false));
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
    if (view.detail > 0) {
        const auto levels =
            std::make_shared<const mesh::DetailLevels>(view.scene->scene, [](const std::string& reason) {
                observe::log_warning("no_levels_of_detail", {{"reason", reason}});
            });
        levels->wait();
        view.levels = levels;
    }
    renderer::Renderer renderer(arguments.device);
    if (std::max(view.width, view.height) > renderer.max_size())
        throw std::runtime_error("--size: this device draws up to " + std::to_string(renderer.max_size()) +
                                 " pixels a side");
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
    const std::string extension = arguments.output.extension().string();
    if (extension != ".png" && extension != ".jpg" && extension != ".jpeg")
        throw std::runtime_error(arguments.output.string() +
                                 ": the name of an image ends in .png, .jpg or .jpeg");
    Film film = film_of(arguments);
    if (arguments.reference)
        trace_film(arguments, std::move(film));
    else
        draw_film(arguments, std::move(film));
}

}  // namespace vrut::server::commands
