#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "commands/commands.hpp"
#include "messages.hpp"
#include "plan/view.hpp"
#include "renderer/renderer.hpp"
#include "room/room.hpp"

namespace vrut::server::commands {

/// What is drawn, but for the camera, and the camera of each image.
struct Film {
    plan::View view;
    std::vector<scene::Camera> cameras;
};

/// The text of the file that an option names. Throws std::runtime_error with a sentence, as all here do.
std::string read_text(const std::string& option, const std::filesystem::path& path);

/// The scene with what the arguments lay over it, but for the camera, in the hands of a client "render".
room::Room room_of(const RenderArguments& arguments);

/// The same, and its cameras.
Film film_of(const RenderArguments& arguments);

/// Computes the levels of detail that the view asks for.
void add_levels(plan::View& view);

/// Throws std::runtime_error where the device cannot draw images of that size.
void require_size(int width, int height, const renderer::Renderer& renderer);

/// By the name's ending. Throws std::runtime_error where it is of another format.
protocol::ImageFormat format_of(const std::filesystem::path& output);

/// The image's file.
std::vector<std::uint8_t> encoded(const scene::Image& image, protocol::ImageFormat format, int jpeg_quality);

}  // namespace vrut::server::commands
