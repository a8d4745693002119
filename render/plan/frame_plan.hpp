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

struct CutSurface;

/// One geometry node to be drawn, or its cut by a clip plane.
struct DrawItem {
    scene::Index node = scene::kNone, geometry = scene::kNone, material = scene::kNone;
    glm::dmat4 view_from_node{1};
    CullMode cull_mode = CullMode::back;
    bool mirrored = false;                ///< the matrix turns counter-clockwise triangles clockwise
    scene::Index texture = scene::kNone;  ///< replaces the material's diffuse colour
    bool colored = false;                 ///< by the colours of its vertices
    bool emissive = false;                ///< sends light by itself
    scene::Index emissive_texture = scene::kNone;
    bool metallic_roughness = false;  ///< lit by it, not by Phong's equation
    bool coated = false;              ///< mirrors the environment above that
    scene::Index occlusion_roughness_metallic_texture = scene::kNone, normal_texture = scene::kNone;
    bool environment = false;  ///< mixed with the environment map that it reflects
    /// An opaque item has the same geometry, the same matrix and a higher id: it hides this one.
    bool occluded_by_coincident = false;
    /// The item's faces are the cap of this cut, with its material; null: the geometry's. The bounds of the
    /// geometry hold for both.
    std::shared_ptr<const CutSurface> cut;
    /// The plane of the cut in view space: its points' dot product with (point, 1) is 0.
    glm::dvec4 cut_plane{0};
    /// In node space: only points whose dot products with all of them are not negative are drawn.
    std::vector<glm::dvec4> clip_planes;
    /// The triangles back to front, numbered as in TriangleOrder; null: in file order.
    std::shared_ptr<const std::vector<unsigned>> order;
    /// The view's level of detail to draw; null: every triangle.
    const mesh::DetailLevel* level = nullptr;
};

/// The item's surface changes from pixel to pixel by more than its colour's texture.
inline bool is_mapped(const DrawItem& item) {
    return item.occlusion_roughness_metallic_texture != scene::kNone || item.normal_texture != scene::kNone;
}

/// Returns how many triangles the item draws: those of its level, if it has one.
std::size_t triangle_count(const DrawItem& item, const scene::Scene& scene);

/// Transparent items that are drawn together. Items of a sorted group are ordered back to front; items of an
/// exact group, whose order differs from pixel to pixel, by rising id.
struct TransparentGroup {
    std::vector<DrawItem> items;
    bool exact = false;
};

struct MirrorItem;

/// The material of the item's faces.
const scene::Material& material_of(const DrawItem& item, const scene::Scene& scene);
/// Returns true if something can be seen through the item's faces.
bool is_transparent(const DrawItem& item, const scene::Scene& scene);

/// Faces that are drawn with one set of camera matrices, in this order.
struct DrawLists {
    std::vector<DrawItem> opaque;               ///< by rising id, or as group_for_draws() leaves them
    std::vector<DrawItem> cut_lines;            ///< items with a cut, whose lines are drawn on them
    std::vector<MirrorItem> mirrors;            ///< by rising id
    std::vector<TransparentGroup> transparent;  ///< back to front
};

/// Returns true if the matrix is singular or nearly so; such items are drawn from both sides.
bool is_flattened(const glm::dmat4& view_from_node);

/// A planar mirror and the items that it reflects.
struct MirrorItem {
    DrawItem surface;
    glm::dmat4 reflection{1};  ///< about its plane, in view space
    math::PixelBox box;        ///< bounds of the surface in the image
    DrawLists reflected;
};

/// Returns true if the lists or their mirrors have a transparent group, or an exact one.
bool has_transparent(const DrawLists& lists);
bool has_exact_group(const DrawLists& lists);

/// Everything that one frame draws. A pass without items does not run; items outside of the frustum are
/// culled. Edges and selected items are ordered by rising id.
struct FramePlan {
    DrawLists scene;
    std::vector<DrawItem> edges;      ///< items whose edges are drawn
    DrawLists overlay;                ///< drawn over everything before: the selected faces
    std::vector<DrawItem> selected;   ///< the selected items; they are in no other list
    std::vector<glm::dvec3> markers;  ///< in view space, back to front
    /// Levels that the view asks for and that are not resident. The items have finer ones instead.
    std::vector<std::pair<scene::Index, const mesh::DetailLevel*>> missing_levels;
};

/// Returns true if a geometry's level of detail is on the GPU. Empty: all levels may be used.
using IsResident = std::function<bool(scene::Index, const mesh::DetailLevel&)>;

class CutCache;
class TransparencyCache;
class DrawBudget;

/// What is computed for one image and serves later ones of the same scene.
struct PlanCaches {
    TransparencyCache& shapes;
    CutCache& cuts;
};

/// Computes the plan of a view in steps. The plan is empty if the view has no scene.
class FramePlanner {
public:
    /// Continues until `budget` is spent. Returns true when the plan is complete. All calls must pass the
    /// same view; the caches must belong to its scene. An item's level is one for which `is_resident` returns
    /// true.
    bool step(const View& view, const PlanCaches& caches, DrawBudget& budget,
              const IsResident& is_resident = {});
    /// The complete plan. Its address does not change.
    const FramePlan& plan() const { return plan_; }

private:
    enum class PlanStage { items, cuts, shapes, draw_lists, done };
    void find_items(const View& view, CutCache& cuts);
    bool find_cuts(const View& view, CutCache& cuts, DrawBudget& budget);
    void sort_items(const View& view);
    bool find_shapes(const View& view, TransparencyCache& shapes, DrawBudget& budget);
    void find_draw_lists(const View& view, TransparencyCache& shapes, const IsResident& is_resident);

    PlanStage stage_ = PlanStage::items;
    std::vector<DrawItem> items_,
        unculled_items_;  // in the frustum, not selected; and those that mirrors may show
    std::vector<DrawItem> cuts_, unculled_cuts_;  // of these
    std::size_t cuts_found_ = 0;                  // the number of items whose cuts are computed
    std::size_t shapes_found_ = 0;                // the number of items whose shapes are computed
    FramePlan plan_;
};

/// Computes the whole plan at once.
FramePlan plan_frame(const View& view);

/// Returns the items of all visible faces, opaque or not, inside of the frustum or outside, by rising id.
std::vector<DrawItem> visible_items(const View& view);

/// Returns the items of all faces inside of the frustum, opaque or not, by rising id, and their cuts.
std::vector<DrawItem> visible_faces(const View& view, CutCache& cuts);

/// Returns the radius in pixels of a marker in an image of that height.
double marker_radius(int picture_height);

/// Counts of a scene's geometry nodes by kind of material.
struct ClassCounts {
    std::uint64_t solid = 0;
    std::uint64_t transparent = 0;  ///< as Scene::is_transparent()
    std::uint64_t reflective = 0;   ///< opaque, with reflectivity above 0

    bool operator==(const ClassCounts&) const = default;
};
ClassCounts count_classes(const scene::PlacedScene& placed);

/// Returns a sentence for each feature of the scene that the renderer does not draw, or not always.
std::vector<std::string> unsupported_features(const scene::Scene& scene);

}  // namespace vrut::plan
