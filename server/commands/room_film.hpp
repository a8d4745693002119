#pragma once

#include <cstddef>
#include <optional>

#include "commands/image_output.hpp"
#include "plan/view.hpp"
#include "renderer/renderer.hpp"
#include "room/room.hpp"

namespace vrut::server::commands {

/// How many images show what happens from 0 to `end`, or behind it.
std::size_t images_until(room::SessionTime end, int images_per_second);

/// Draws what a room shows, in equal steps of its time. Errors are std::runtime_error with a sentence.
class RoomFilm {
public:
    /// Throws where the device cannot draw images of that size.
    RoomFilm(const ImageOutput::Options& options, int samples, std::optional<int> device);

    /// What is shown at each step before `at`, behind which the room stands.
    void draw_until(room::SessionTime at, room::Room& room);
    /// What is shown at the end.
    void finish(room::Room& room);

private:
    room::SessionTime time_of(std::size_t image) const;
    void draw_next(room::Room& room);

    const ImageOutput::Options options_;
    const int samples_;
    renderer::Renderer renderer_;
    std::optional<ImageOutput> output_;  // once it is known that the device can draw them
    std::size_t next_ = 0;               // image
    scene::Image image_;
    std::optional<plan::View> drawn_;  // last
};

}  // namespace vrut::server::commands
