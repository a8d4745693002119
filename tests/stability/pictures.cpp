#include "pictures.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "difference.hpp"

namespace vrut::stability {

Image drawn(const Laboratory& laboratory, const View& view) {
    Image image;
    FrameStats stats;
    laboratory.renderer.render(view, image, stats);
    return image;
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

std::string times_the_time(double successor, double method) {
    char text[64];
    std::snprintf(text, sizeof text, "%.2g times the time", successor / method);
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

double percent_off(const Image& a, const Image& b) { return 100 * difference(a, b).share_above(8); }

}  // namespace vrut::stability
