#include "commands/film.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "codec.hpp"
#include "engine/images.hpp"
#include "mesh/detail_levels.hpp"
#include "observe/log.hpp"
#include "observe/progress.hpp"
#include "room/room.hpp"
#include "scenes/library.hpp"

namespace vrut::server::commands {

namespace {

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

/// How many there are of a flight of so many milliseconds. Throws std::runtime_error where it is too many.
int images_of(const RenderArguments& arguments, double ms) {
    if (arguments.frames > 0) return arguments.frames;
    const int images_per_second = arguments.fps.value_or(kImagesPerSecond);
    const double images = std::round(ms / 1000 * images_per_second) + 1;
    if (images > kMostImages)
        throw std::runtime_error(
            arguments.keyframes.string() + ": the flight takes " + std::to_string(std::lround(ms / 1000)) +
            " s, which needs more than " + std::to_string(kMostImages) + " images at " +
            std::to_string(images_per_second) + " a second; give --frames or a lower --fps");
    return static_cast<int>(images);
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
    const int last = images_of(arguments, path->duration()) - 1;
    std::vector<scene::Camera> cameras;
    cameras.reserve(static_cast<std::size_t>(last) + 1);
    for (int i = 0; i < last; ++i) cameras.push_back(path->at(path->duration() * i / last));
    cameras.push_back(path->at(path->duration()));
    return cameras;
}

}  // namespace

std::string read_text(const std::string& option, const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (!stream) throw std::runtime_error(option + ": " + path.string() + " cannot be read");
    return text;
}

room::Room room_of(const RenderArguments& arguments) {
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
    return room;
}

Film film_of(const RenderArguments& arguments) {
    const room::Room room = room_of(arguments);
    plan::View view = room.visible();
    view.width = arguments.width;
    view.height = arguments.height;
    view.samples = arguments.samples;
    view.detail = arguments.detail;
    return {view, wanted_cameras(arguments, room)};
}

void add_levels(plan::View& view) {
    if (view.detail == 0) return;
    const auto levels =
        std::make_shared<const mesh::DetailLevels>(view.scene->scene, [](const std::string& reason) {
            observe::log_warning("no_levels_of_detail", {{"reason", reason}});
        });
    levels->wait();
    view.levels = levels;
}

void require_size(int width, int height, const renderer::Renderer& renderer) {
    if (std::max(width, height) > renderer.max_size())
        throw std::runtime_error("--size: this device draws up to " + std::to_string(renderer.max_size()) +
                                 " pixels a side");
}

protocol::ImageFormat format_of(const std::filesystem::path& output) {
    const std::string extension = output.extension().string();
    if (extension == ".png") return protocol::ImageFormat::png;
    if (extension == ".jpg" || extension == ".jpeg") return protocol::ImageFormat::jpeg;
    throw std::runtime_error(output.string() +
                             ": the name of an image ends in .png, .jpg or .jpeg, that of a film in .mp4");
}

std::vector<std::uint8_t> encoded(const scene::Image& image, protocol::ImageFormat format, int jpeg_quality) {
    return format == protocol::ImageFormat::png ? io::encode_png(image)
                                                : engine::JpegEncoder().encode(image, jpeg_quality, false);
}

}  // namespace vrut::server::commands
