#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "messages.hpp"

namespace vrut::protocol {

/// One image of a film, as it waits in a queue for a worker: all that its pixels depend on.
struct RenderJob {
    /// When a scene is shown in a studio: `automatic` if its file has no light, and is no scene text.
    enum class Studio { automatic, on, off };

    std::string run;     ///< by which the images of one film are known
    int image = 1;       ///< its number in the film
    std::string scene;   ///< the name of its file in the workers' folder of scenes
    std::string sha256;  ///< of all that the scene shows
    UpAxis up_axis = UpAxis::y;
    Studio studio = Studio::automatic;
    int width = 0, height = 0;
    int samples = 1;    ///< a pixel
    double detail = 0;  ///< by how many pixels surfaces may lie off
    ImageFormat format = ImageFormat::jpeg;
    int jpeg_quality = 90;
    std::vector<std::string> patches;  ///< of the state, in this order
    CameraOverlay camera;              ///< the whole camera
};

inline constexpr int kMaxFilmImages = 100'000;

std::string encode(const RenderJob& job);
/// Or a sentence that tells what is wrong with the text.
tl::expected<RenderJob, std::string> parse_render_job(std::string_view text);

}  // namespace vrut::protocol
