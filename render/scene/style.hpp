#pragma once

#include <optional>

#include "scene/scene.hpp"

namespace vrut::scene {

/// The plain background: 230/255, 235/255, 242/255.
inline constexpr glm::dvec3 kDefaultBackground{230.0 / 255, 235.0 / 255, 242.0 / 255};

/// Realistic: in materials. Stylized: dark blue faces and light blue edges, to bring out shapes.
enum class DrawMode { realistic, stylized };

/// How surfaces are drawn.
struct Style {
    bool faces = true;
    bool presentation = true;  ///< what presents the product is drawn, too (Node::presentation)
    /// Of all faces, static; in the place of their own, with its texture, transparency and reflections. Null:
    /// none.
    const Material* override_material = nullptr;
    bool edges = false;  ///< of all triangles; where there are faces, these hide them and give way to them
    /// Of all edges; none: they are lit as their materials are.
    std::optional<glm::dvec3> edge_color;
};

/// Under the same light as realistic ones.
inline const Material& stylized_faces() {
    static const Material material = [] {
        Material blue;
        blue.ambient = {0.03, 0.05, 0.15, 1};
        blue.diffuse = {0.10, 0.18, 0.45, 1};
        return blue;
    }();
    return material;
}

/// `wireframe`: edges alone.
inline Style style_of(DrawMode mode, bool wireframe) {
    Style style;
    style.faces = !wireframe;
    style.edges = wireframe || mode == DrawMode::stylized;
    style.presentation = !style.edges;
    if (mode == DrawMode::stylized) {
        style.override_material = &stylized_faces();
        style.edge_color = {0.55, 0.78, 1};
    }
    return style;
}

/// What marks the selection: orange.
inline constexpr glm::dvec3 kSelection{1, 0.6, 0};

/// What markers are: crimson, with a white rim.
inline constexpr glm::dvec3 kMarkerColor{0.8, 0.04, 0.32};

}  // namespace vrut::scene
