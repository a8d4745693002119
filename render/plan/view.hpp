#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera.hpp"
#include "scene/clip_plane.hpp"
#include "scene/light.hpp"
#include "scene/scene.hpp"
#include "scene/style.hpp"

namespace vrut::mesh {
class DetailLevels;
}

namespace vrut::plan {

using scene::kDefaultBackground;

/// The background: a cube map, else a texture stretched over the view, else a colour. Indices refer to the
/// scene's textures. A cube map is also what surfaces reflect.
struct Background {
    glm::dvec3 color = kDefaultBackground;
    scene::Index texture = scene::kNone;
    std::optional<std::array<scene::Index, 6>> cube_map = {};  ///< px nx py ny pz nz
    bool only_reflected = false;                               ///< not seen behind the surfaces

    bool shows_cube_map() const { return cube_map && !only_reflected; }
    bool operator==(const Background&) const = default;
};

/// A marker on a surface, in world space, and its name in the protocol.
struct PlacedMarker {
    glm::dvec3 point{0};
    std::string name = {};

    bool operator==(const PlacedMarker&) const = default;
};

using scene::DrawMode;

/// Trade-offs between cost and accuracy. The server draws with the defaults; the others are measured.
struct Methods {
    enum class Lighting { pixel, vertex };  ///< where Phong's equation is evaluated
    enum class Transparency {
        exact,            ///< sorted at each pixel where no order of items and triangles is right
        sorted,           ///< item by item back to front
        per_pixel_lists,  ///< sorted at each pixel everywhere
    };
    enum class TextureFilter { trilinear, anisotropic };  ///< of materials' textures
    enum class Culling {
        frustum,    ///< items outside of the frustum
        occlusion,  ///< opaque items behind others, too
    };
    Lighting light = Lighting::pixel;
    Transparency transparency = Transparency::exact;
    TextureFilter texture_filter = TextureFilter::trilinear;
    Culling culling = Culling::occlusion;

    bool operator==(const Methods&) const = default;
};

/// Everything that an image depends on; sizes are in pixels of the image.
struct View {
    std::shared_ptr<const scene::PlacedScene>
        scene;  ///< null: the background only; views are equal by its address
    scene::Camera camera;
    int width = 1280, height = 720;
    int samples = 1;    ///< per pixel, averaged; a single one is at its centre
    double detail = 0;  ///< largest error of levels of detail in pixels; 0: every triangle
    /// Levels of detail of the scene, for `detail`, and its watertight geometries, for backface culling and
    /// caps; null: not available.
    std::shared_ptr<const mesh::DetailLevels> levels;
    Methods methods;
    scene::Light light;
    DrawMode mode = DrawMode::realistic;
    bool wireframe = false;  ///< the edges of all triangles, and no faces
    /// The node whose subtree is drawn over everything, with an outline; in a wireframe by its edges.
    scene::Index selected = scene::kNone;
    Background background;
    std::vector<scene::ClipPlane> clip_planes;                 ///< up to kMostClipPlanes
    std::shared_ptr<const std::vector<PlacedMarker>> markers;  ///< null: none; views are equal by its address

    bool operator==(const View&) const = default;
};

/// What the view's camera sees in its image.
inline math::Projection projection_of(const View& view) {
    return scene::projection_of(view.camera, static_cast<double>(view.width) / view.height);
}

/// Distance of the near plane: a 128th of the near distance that hosts are told (scene::fit_clip_range).
/// Reversed float depth is as precise with a nearer plane.
double near_distance(const View& view);

inline scene::Style style_of(const View& view) { return scene::style_of(view.mode, view.wireframe); }

/// Costs of an image.
struct FrameStats {
    int passes = 0;
    int draws = 0;  ///< of items, of which one draw call may draw several, and of the passes over all pixels
    int samples = 0;    ///< drawn
    int readbacks = 0;  ///< of pixels, from the GPU into memory
    std::uint64_t triangles = 0;
    std::uint64_t edges = 0;
    int substitutes = 0;     ///< items drawn without their edges, which are not resident yet
    int uploads = 0;         ///< geometries, edges, textures and cube maps uploaded to the GPU
    int programs = 0;        ///< compiled
    double render_ms = 0;    ///< from the first command to the fence behind the last
    double readback_ms = 0;  ///< from the GPU into memory
};

}  // namespace vrut::plan
