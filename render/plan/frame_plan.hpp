#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "math/pixel_box.hpp"
#include "plan/view.hpp"
#include "scene/scene.hpp"

namespace vrut::mesh {
struct DetailLevel;
}

namespace vrut::plan {

/// Which faces are culled. `hidden_back`: a two-sided, watertight item whose back faces are hidden by its own
/// front faces; it is still lit as two-sided.
enum class CullMode { back, none, hidden_back };

/// One geometry node to be drawn.
struct DrawItem {
    scene::Index node = scene::kNone, geometry = scene::kNone, material = scene::kNone;
    glm::dmat4 view_from_node{1};
    CullMode cull_mode = CullMode::back;
    bool mirrored = false;                ///< the matrix turns counter-clockwise triangles clockwise
    scene::Index texture = scene::kNone;  ///< whose colour stands in the place of the material's diffuse one
    bool environment = false;             ///< mixed with the panorama that it reflects
    /// An opaque item has the same geometry, the same matrix and a higher id: it hides this one.
    bool occluded_by_coincident = false;
    /// Only points of the node's space whose product with this is not negative are drawn.
    std::optional<glm::dvec4> clip_plane;
    /// Its triangles from far to near, numbered as TriangleOrder does; null: as in the file.
    std::shared_ptr<const std::vector<unsigned>> order;
    /// What is drawn of the geometry, of the view's; null: every triangle.
    const mesh::DetailLevel* level = nullptr;
};

/// Transparent items that are drawn together. Items of a sorted group are ordered back to front; items of an
/// exact group, whose order differs from pixel to pixel, by rising id.
struct TransparentGroup {
    std::vector<DrawItem> items;
    bool exact = false;
};

struct MirrorItem;

/// Faces that are drawn from one sight, in this order.
struct DrawLists {
    std::vector<DrawItem> opaque;               ///< by rising id
    std::vector<MirrorItem> mirrors;            ///< by rising id
    std::vector<TransparentGroup> transparent;  ///< from far to near
};

/// Whether a matrix leaves no volume: such parts are drawn from both sides.
bool is_flattened(const glm::dmat4& view_from_node);

/// A surface and what is seen in it.
struct MirrorItem {
    DrawItem surface;
    glm::dmat4 reflection{1};  ///< about its plane, in view space
    math::PixelBox box;        ///< all that it can cover
    DrawLists reflected;
};

/// Whether something is blended, and something of it pixel by pixel; in mirrors too.
bool has_transparent(const DrawLists& lists);
bool has_exact_group(const DrawLists& lists);

/// Everything that one frame draws. A pass without items does not run; items outside of the frustum are
/// culled. Edges and selected items are ordered by rising id.
struct FramePlan {
    DrawLists scene;
    std::vector<DrawItem> edges;      ///< with edges
    DrawLists overlay;                ///< over everything before: the faces of what is selected
    std::vector<DrawItem> selected;   ///< that itself, in no other list
    std::vector<glm::dvec3> markers;  ///< in view space, from far to near
    /// Levels that the view wants and that are not resident: finer ones stand in their place.
    std::vector<std::pair<scene::Index, const mesh::DetailLevel*>> missing_levels;
};

/// Whether a geometry's level of detail is on the GPU; empty: it does not matter.
using IsResident = std::function<bool(scene::Index, const mesh::DetailLevel&)>;

/// Whether a geometry in that material is a planar mirror; other reflective ones reflect the panorama.
bool is_mirror(const scene::Scene& scene, scene::Index geometry, scene::Index material);

class TransparencyCache;
class DrawBudget;

/// Finds the plan of a view in steps. It is empty where the view has no scene.
class FramePlanner {
public:
    /// Continues until `work` is spent. Returns true when the plan is complete. All calls must pass the same
    /// view; `shapes` must belong to its scene and caches what is computed for later frames.
    /// Of the levels of detail, it plans with those that are resident.
    bool step(const View& view, TransparencyCache& shapes, DrawBudget& budget,
              const IsResident& is_resident = {});
    /// Once it is whole. It stays where it is.
    const FramePlan& plan() const { return plan_; }

private:
    enum class PlanStage { items, shapes, draw_lists, done };
    void find_items(const View& view);
    bool find_shapes(const View& view, TransparencyCache& shapes, DrawBudget& budget);
    void find_draw_lists(const View& view, TransparencyCache& shapes, const IsResident& is_resident);

    PlanStage stage_ = PlanStage::items;
    std::vector<DrawItem> items_,
        unculled_items_;            // in the picture, not selected; with what may be seen in mirrors
    std::size_t shapes_found_ = 0;  // of so many items
    FramePlan plan_;
};

/// In one go.
FramePlan plan_frame(const View& view);

/// The items of all faces that a view of a scene shows or has beside it, opaque or not, by rising id.
std::vector<DrawItem> visible_items(const View& view);

/// The items of all faces that a view shows, opaque or not, by rising id.
std::vector<DrawItem> visible_faces(const View& view);

/// Radius of a marker in a picture of that height, in pixels.
double marker_radius(int picture_height);

/// Geometry nodes of a scene by what their material is.
struct ClassCounts {
    std::uint64_t solid = 0;
    std::uint64_t transparent = 0;  ///< as Scene::is_transparent()
    std::uint64_t reflective = 0;   ///< opaque, with reflectivity above 0

    bool operator==(const ClassCounts&) const = default;
};
ClassCounts count_classes(const scene::PlacedScene& placed);

/// A sentence for each thing that the scene holds and the renderer does not draw, or not always.
std::vector<std::string> unsupported_features(const scene::Scene& scene);

}  // namespace vrut::plan
