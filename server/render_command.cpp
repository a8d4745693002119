#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>

#include "commands.hpp"
#include "images.hpp"
#include "read_scene.hpp"
#include "renderer.hpp"
#include "report.hpp"
#include "scene_state.hpp"

namespace vrut {

namespace {

std::string read_text(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (!stream) throw std::runtime_error(path.string() + " cannot be read");
    return text;
}

/// The state that the scene starts with, changed by --set, --camera and the camera's own options, in this
/// order.
protocol::State wanted_state(const RenderArguments& arguments, const PlacedScene& placed) {
    const protocol::State starting =
        starting_state(placed, static_cast<double>(arguments.width) / arguments.height, {});
    protocol::State state = starting;
    if (!arguments.set.empty()) {
        auto patched = protocol::patched_by_text(state, starting, arguments.set);
        if (!patched) throw std::runtime_error("--set: " + patched.error().message);
        state = *std::move(patched);
    }
    if (!arguments.camera_file.empty()) {
        auto camera = protocol::parse_camera(read_text(arguments.camera_file), state.camera);
        if (!camera) throw std::runtime_error(arguments.camera_file.string() + ": " + camera.error().message);
        state.camera = *std::move(camera);
    }
    if (arguments.eye) state.camera.eye = *arguments.eye;
    if (arguments.focus) state.camera.focus = *arguments.focus;
    if (arguments.up) state.camera.up = *arguments.up;
    if (arguments.fov) state.camera.fov = *arguments.fov;
    Camera camera = camera_of(state.camera);
    const bool up_is_given = camera.up != starting.camera.up ||
                             std::abs(glm::dot(camera.up, glm::normalize(camera.focus - camera.eye))) < 1e-9;
    if (!up_is_given) camera = with_roll_of(camera_of(starting.camera), camera);
    if (!is_valid_pose(camera, placed.bounds.radius()))
        throw std::runtime_error(
            "the camera sees nothing: eye and focus must be apart, up neither zero nor along the view");
    state.camera = state_of(with_orthogonal_up(camera), placed.bounds);
    return state;
}

}  // namespace

void render_command(const RenderArguments& arguments) {
    const std::string extension = arguments.output.extension().string();
    const bool jpeg = extension == ".jpg" || extension == ".jpeg";
    if (!jpeg && extension != ".png")
        throw std::runtime_error(arguments.output.string() + ": a picture's name ends in .png or .jpg");
    auto scene = read_scene(arguments.scene);
    if (!scene) throw std::runtime_error(scene.error());
    const auto placed = std::make_shared<const PlacedScene>(place(*std::move(scene)));

    View view = view_of(wanted_state(arguments, *placed), placed);
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
