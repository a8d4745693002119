#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/images.hpp"
#include "measure/settings.hpp"
#include "renderer/renderer.hpp"
#include "scene/image.hpp"

namespace vrut::server::measure {

/// Called now and then with the part, 0 to 1, of the work in hand that is done.
using PartDone = std::function<void(double)>;

/// Of repeated measurements: mean, and percentiles between the nearest two.
struct Spread {
    double mean = 0, median = 0, p5 = 0, p95 = 0;
};
/// Zeros without values.
Spread spread_of(std::vector<double> values);

/// `home` on its way around what it turns about: step `step` of `steps`.
plan::View on_orbit(const plan::View& home, int step, int steps);

/// The picture in another size, each pixel from the four nearest, as a page enlarges it.
scene::Image resized(const scene::Image& image, int width, int height);

/// What pictures cost, drawn, read back and encoded one after the other, as frame headers report it.
struct Cost {
    Spread ms, bytes;
    double triangles = 0;  ///< mean of what was drawn
};

/// What pictures are worth beside others.
struct Error {
    Spread flip;      ///< means over a picture; over the pictures
    int maximum = 0;  ///< of a channel of any, in steps of 1/255
};

/// Draws and encodes as a server would, in one thread.
class Studio {
public:
    explicit Studio(renderer::Renderer& renderer) : renderer_(renderer) {}

    /// Of `frames` pictures of each setting, on one turn around `home`: those of all settings from one place,
    /// then from the next, so that whatever else the machine does befalls all alike. Drawings are shared by
    /// settings that differ in their encoding. Pictures that bring something to the GPU are drawn again, and
    /// the first of another size than the last, as a server that stays at a level makes no buffers.
    std::vector<Cost> costs(const plan::View& home, std::span<const Setting> settings, int frames,
                            const PartDone& done = {});
    /// Of each setting's pictures of `views`, enlarged to the size of their judges, one for each view.
    std::vector<Error> errors(std::span<const plan::View> views, std::span<const Setting> settings,
                              std::span<const scene::Image> judges, const PartDone& done = {});

    /// What a page would show of a view: encoded, and decoded again.
    scene::Image picture(const plan::View& view, const Setting& setting);
    /// Every triangle, the exact methods, `samples` samples, not encoded.
    scene::Image exact_picture(const plan::View& view, int samples);

private:
    double draw(const plan::View& view);
    /// Draws where the last picture was of another size.
    void make_buffers(const plan::View& view);

    renderer::Renderer& renderer_;
    engine::JpegEncoder jpeg_;
    std::optional<plan::View> drawn_;  ///< what `image_` shows
    scene::Image image_;
    plan::FrameStats stats_;
};

/// From a few places of the orbit, as pictures are judged from.
std::vector<plan::View> judged_views(const plan::View& home, int count);

}  // namespace vrut::server::measure
