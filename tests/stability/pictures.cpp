#include "pictures.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "compare/difference.hpp"
#include "reference/reference.hpp"

namespace vrut::stability {

scene::Image drawn(const Laboratory& laboratory, const plan::View& view, plan::FrameStats* stats) {
    scene::Image image;
    plan::FrameStats unused;
    laboratory.renderer.render(view, image, stats ? *stats : unused);
    return image;
}

bool is_plain(const scene::Image& image) {
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        if (image.rgba[i] != image.rgba[i % 4]) return false;
    return true;
}

double time_of(const Laboratory& laboratory, const plan::View& view) {
    const int tries = laboratory.form == Form::whole ? 5 : 1;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < tries; ++i) {
        scene::Image image;
        plan::FrameStats stats;
        laboratory.renderer.render(view, image, stats);
        least = std::min(least, stats.render_ms);
    }
    return least;
}

std::string times_the_time(double method, double baseline) {
    char text[64];
    std::snprintf(text, sizeof text, "%.2g times the time", method / baseline);
    return text;
}

plan::View looking(const std::shared_ptr<const scene::PlacedScene>& scene, const glm::dvec3& eye,
                   const glm::dvec3& focus) {
    plan::View view;
    view.scene = scene;
    view.camera.eye = eye;
    view.camera.focus = view.camera.center = focus;
    view.camera = scene::with_orthogonal_up(view.camera);
    view.width = 192;
    view.height = 128;
    return view;
}

scene::Image truth_of(const plan::View& view) {
    const reference::ReferenceImage picture = reference::trace(view);
    const bool is_empty = std::all_of(picture.node.begin(), picture.node.end(),
                                      [](scene::Index node) { return node == scene::kNone; });
    return is_empty ? scene::Image() : reference::image_of(picture);
}

namespace {

bool can_be_compared(const scene::Image& image, const scene::Image& right) {
    return !right.rgba.empty() && image.rgba.size() == right.rgba.size();
}

}  // namespace

double percent_off(const scene::Image& image, const scene::Image& right) {
    return can_be_compared(image, right) ? 100 * compare::difference(image, right).share_above(8) : kNothing;
}

double largest_error(const scene::Image& image, const scene::Image& right) {
    return can_be_compared(image, right) ? compare::difference(image, right).maximum() : kNothing;
}

}  // namespace vrut::stability
