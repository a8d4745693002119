#pragma once

#include <memory>
#include <vector>

#include "plan/view.hpp"
#include "scene/camera.hpp"

namespace vrut {

/// A small view from `eye` towards `focus`.
inline plan::View view_from(const glm::dvec3& eye, const glm::dvec3& focus = glm::dvec3(0)) {
    plan::View view;
    view.camera.eye = eye;
    view.camera.focus = focus;
    view.camera = scene::with_orthogonal_up(view.camera);
    view.width = 96;
    view.height = 64;
    return view;
}

inline std::shared_ptr<const std::vector<plan::PlacedMarker>> markers_at(
    const std::vector<glm::dvec3>& points) {
    std::vector<plan::PlacedMarker> markers;
    for (const glm::dvec3& point : points) markers.push_back({point});
    return std::make_shared<const std::vector<plan::PlacedMarker>>(std::move(markers));
}

/// Straight on to the plane z = 0, before white; a unit is a pixel.
inline plan::View pixel_view(int width, int height) {
    plan::View view;
    view.camera.fov = 90;
    view.camera.eye = {0, 0, height / 2.0};
    view.camera.focus = {0, 0, 0};
    view.width = width;
    view.height = height;
    view.background.color = {1, 1, 1};
    return view;
}

/// In that plane, in pixels from the picture's top left.
inline scene::Geometry rectangle(double left, double top, double right, double bottom,
                                 const plan::View& view) {
    const double w = view.width / 2.0, h = view.height / 2.0;
    scene::Geometry geometry;
    geometry.positions = {{left - w, h - bottom, 0},
                          {right - w, h - bottom, 0},
                          {right - w, h - top, 0},
                          {left - w, h - top, 0}};
    geometry.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (const glm::dvec3& position : geometry.positions) geometry.bounds.add(position);
    return geometry;
}

}  // namespace vrut
