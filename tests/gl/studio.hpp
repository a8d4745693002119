#pragma once

#include <doctest/doctest.h>

#include "expected_picture.hpp"
#include "handles.hpp"
#include "renderer.hpp"
#include "shapes.hpp"

namespace vrut {

/// A renderer whose driver must have no complaints and which gives everything back at the end.
class Studio {
public:
    Studio() : renderer_(std::in_place, std::nullopt, true) {}
    ~Studio() {
        for (const std::string& message : renderer_->take_messages()) FAIL_CHECK(message);
        renderer_.reset();
        CHECK(live_gl_objects() == 0);
    }

    Renderer& renderer() { return *renderer_; }

    Image draw(const std::shared_ptr<const PlacedScene>& scene, const View& view) {
        Image image;
        View shown = view;
        shown.scene = scene;
        renderer_->render(shown, image, stats);
        return image;
    }

    /// Draws and compares with what is computed, at all pixels but those at edges.
    Difference check(const std::shared_ptr<const PlacedScene>& scene, const View& view) {
        Difference result = difference(ExpectedPicture(*scene, view), draw(scene, view));
        CHECK_MESSAGE(result.worst <= 1, result.where);
        return result;
    }

    FrameStats stats;

private:
    std::optional<Renderer> renderer_;
};

/// A small view from `eye` towards `focus`.
inline View view_from(const glm::dvec3& eye, const glm::dvec3& focus = glm::dvec3(0)) {
    View view;
    view.camera.eye = eye;
    view.camera.focus = focus;
    view.camera = with_orthogonal_up(view.camera);
    view.width = 96;
    view.height = 64;
    return view;
}

inline std::shared_ptr<const std::vector<Mark>> marks_at(const std::vector<glm::dvec3>& points) {
    std::vector<Mark> marks;
    for (const glm::dvec3& point : points) marks.push_back({point});
    return std::make_shared<const std::vector<Mark>>(std::move(marks));
}

/// Straight on to the plane z = 0, before white; a unit is a pixel.
inline View pixel_view(int width, int height) {
    View view;
    view.camera.fov = 90;
    view.camera.eye = {0, 0, height / 2.0};
    view.camera.focus = {0, 0, 0};
    view.width = width;
    view.height = height;
    view.background.color = {1, 1, 1};
    return view;
}

/// In that plane, in pixels from the picture's top left.
inline Geometry rectangle(double left, double top, double right, double bottom, const View& view) {
    const double w = view.width / 2.0, h = view.height / 2.0;
    Geometry geometry;
    geometry.positions = {{left - w, h - bottom, 0},
                          {right - w, h - bottom, 0},
                          {right - w, h - top, 0},
                          {left - w, h - top, 0}};
    geometry.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (const glm::dvec3& position : geometry.positions) geometry.bounds.add(position);
    return geometry;
}

}  // namespace vrut
