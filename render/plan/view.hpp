#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera.hpp"
#include "scene/light.hpp"
#include "scene/scene.hpp"

namespace vrut::mesh {
class DetailLevels;
}

namespace vrut::plan {

/// The plain background: 230/255, 235/255, 242/255.
inline constexpr glm::dvec3 kDefaultBackground{230.0 / 255, 235.0 / 255, 242.0 / 255};

/// What stands behind everything: a cube map, else a picture stretched over the view, else a colour. Textures
/// are the scene's.
struct Background {
    glm::dvec3 color = kDefaultBackground;
    scene::Index texture = scene::kNone;
    std::optional<std::array<scene::Index, 6>> cube_map;  ///< px nx py ny pz nz

    bool operator==(const Background&) const = default;
};

/// A sign on a surface, in world space, and the name by which clients know it.
struct PlacedMarker {
    glm::dvec3 point{0};
    std::string name = {};

    bool operator==(const PlacedMarker&) const = default;
};

/// Realistic: in materials. Stylized: dark blue faces and light blue edges, to bring out shapes.
enum class DrawMode { realistic, stylized };

/// Trade-offs between cost and accuracy. The defaults are the most accurate methods.
struct Methods {
    enum class Lighting { pixel, vertex };      ///< where Phong's equation is evaluated
    enum class Transparency { exact, sorted };  ///< right at each pixel, or part by part from far to near
    Lighting light = Lighting::pixel;
    Transparency transparency = Transparency::exact;

    bool operator==(const Methods&) const = default;
};

/// What a picture shows, in pixels of the picture.
struct View {
    std::shared_ptr<const scene::PlacedScene>
        scene;  ///< null: the background only; views are equal by its address
    scene::Camera camera;
    int width = 1280, height = 720;
    int samples = 1;  ///< positions in a pixel whose colours are averaged; 1 is its centre
    double detail =
        0;  ///< how far, in pixels, the surfaces drawn may lie from the scene's; 0: every triangle
    /// Of the scene, for `detail`, and to leave out triangles that are hidden; null: none are made.
    std::shared_ptr<const mesh::DetailLevels> levels;
    Methods methods;
    scene::Light light;
    DrawMode mode = DrawMode::realistic;
    bool wireframe = false;  ///< the edges of all triangles, and no faces
    /// A node whose subtree is drawn over everything, with an outline; in a wireframe by its edges.
    scene::Index selected = scene::kNone;
    Background background;
    std::shared_ptr<const std::vector<PlacedMarker>> markers;  ///< null: none; views are equal by its address

    bool operator==(const View&) const = default;
};

/// What the view's camera sees in its picture.
inline math::Projection projection_of(const View& view) {
    return scene::projection_of(view.camera, static_cast<double>(view.width) / view.height);
}

/// Distance of the near plane: a 128th of the near distance that hosts are told (scene::fit_clip_range).
/// Reversed float depth is as precise with a nearer plane.
double near_distance(const View& view);

/// What a picture took.
struct FrameStats {
    int passes = 0;
    int draws = 0;
    int samples = 0;    ///< drawn
    int readbacks = 0;  ///< of pixels, from the GPU into memory
    std::uint64_t triangles = 0;
    std::uint64_t edges = 0;
    int substitutes = 0;     ///< items without their edges, which were not uploaded yet
    int uploads = 0;         ///< geometries, edges, textures and cube maps brought to the GPU
    double render_ms = 0;    ///< from the first command to the fence behind the last
    double readback_ms = 0;  ///< from the GPU into memory
};

}  // namespace vrut::plan
