#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>

#include "commands.hpp"
#include "images.hpp"
#include "presentation.hpp"
#include "renderer.hpp"
#include "report.hpp"
#include "scene_library.hpp"

namespace vrut {

namespace {

std::string read_text(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (!stream) throw std::runtime_error(path.string() + " cannot be read");
    return text;
}

/// What one client of a server would do to change the state. Throws std::runtime_error.
void say(Presentation& presentation, const std::string& option,
         decltype(protocol::ClientMessage::payload) payload) {
    presentation.say("render", {1, std::move(payload)}, Time(0));
    for (const Answer& answer : presentation.take_answers())
        if (!answer.refusal.empty()) throw std::runtime_error(option + ": " + answer.refusal);
}

void patch(Presentation& presentation, const std::string& option, const std::string& text) {
    auto patch = protocol::parse_patch(text);
    if (!patch) throw std::runtime_error(option + ": " + patch.error().message);
    say(presentation, option, *std::move(patch));
}

/// The camera that the options give: the file's members, then the single ones.
Camera wanted_camera(const RenderArguments& arguments, const Presentation& presentation) {
    protocol::CameraOverlay overlay;
    if (!arguments.camera_file.empty()) {
        auto camera = protocol::parse_camera(read_text(arguments.camera_file));
        if (!camera) throw std::runtime_error(arguments.camera_file.string() + ": " + camera.error().message);
        overlay = *camera;
        if (overlay.eye && overlay.focus) overlay.node.reset();  // a whole pose, maybe of another scene
    }
    if (arguments.eye) overlay.eye = arguments.eye;
    if (arguments.focus) overlay.focus = arguments.focus;
    if (arguments.up) overlay.up = arguments.up;
    if (arguments.fov) overlay.fov = arguments.fov;
    const auto camera =
        overlaid(camera_of(presentation.state().camera), overlay, presentation.scene(), "the camera");
    if (!camera) throw std::runtime_error(camera.error().message);
    return *camera;
}

}  // namespace

void render_command(const RenderArguments& arguments) {
    const std::string extension = arguments.output.extension().string();
    const bool jpeg = extension == ".jpg" || extension == ".jpeg";
    if (!jpeg && extension != ".png")
        throw std::runtime_error(arguments.output.string() + ": a picture's name ends in .png or .jpg");
    auto scene = load_scene(arguments.scene, arguments.scene.filename().string());
    if (!scene) throw std::runtime_error(scene.error());
    Presentation presentation(*std::move(scene));
    presentation.join("render", protocol::Role::control, Time(0));
    const protocol::Resize size{static_cast<double>(arguments.width), static_cast<double>(arguments.height),
                                1};
    say(presentation, "--size", size);
    patch(presentation, "--set", arguments.set.empty() ? "{}" : arguments.set);
    for (const auto& [option, text] : arguments.patches) patch(presentation, option, text);

    View view = presentation.visible();
    view.camera = wanted_camera(arguments, presentation);
    view.width = arguments.width;
    view.height = arguments.height;
    view.samples = arguments.samples;

    Renderer renderer(arguments.device);
    if (std::max(view.width, view.height) > renderer.max_size())
        throw std::runtime_error("--size: this device draws up to " + std::to_string(renderer.max_size()) +
                                 " pixels a side");
    Image image;
    FrameStats stats;
    renderer.render(view, image, stats);
    write_file(arguments.output,
               jpeg ? JpegEncoder().encode(image, arguments.jpeg_quality, false) : encode_png(image));
    if (arguments.stats)
        std::cout << protocol::encode(protocol::RenderReport{
                         renderer.description(), view.width, view.height, view.samples, stats.passes,
                         stats.draws, stats.triangles, stats.render_ms, stats.readback_ms})
                  << std::endl;
}

}  // namespace vrut
