#include "pictures.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "compare/difference.hpp"
#include "reference/reference.hpp"

namespace vrut::stability {

Image drawn(const Laboratory& laboratory, const View& view, FrameStats* stats) {
    Image image;
    FrameStats unused;
    laboratory.renderer.render(view, image, stats ? *stats : unused);
    return image;
}

bool is_plain(const Image& image) {
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        if (image.rgba[i] != image.rgba[i % 4]) return false;
    return true;
}

double time_of(const Laboratory& laboratory, const View& view) {
    const int tries = laboratory.form == Form::whole ? 5 : 1;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < tries; ++i) {
        Image image;
        FrameStats stats;
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

View looking(const std::shared_ptr<const PlacedScene>& scene, const glm::dvec3& eye,
             const glm::dvec3& focus) {
    View view;
    view.scene = scene;
    view.camera.eye = eye;
    view.camera.focus = view.camera.center = focus;
    view.camera = with_orthogonal_up(view.camera);
    view.width = 192;
    view.height = 128;
    return view;
}

Image truth_of(const View& view) {
    const ReferenceImage picture = trace(view);
    const bool is_empty =
        std::all_of(picture.node.begin(), picture.node.end(), [](Index node) { return node == kNone; });
    return is_empty ? Image() : image_of(picture);
}

namespace {

bool can_be_compared(const Image& image, const Image& right) {
    return !right.rgba.empty() && image.rgba.size() == right.rgba.size();
}

}  // namespace

double percent_off(const Image& image, const Image& right) {
    return can_be_compared(image, right) ? 100 * difference(image, right).share_above(8) : kNothing;
}

double largest_error(const Image& image, const Image& right) {
    return can_be_compared(image, right) ? difference(image, right).maximum() : kNothing;
}

}  // namespace vrut::stability
