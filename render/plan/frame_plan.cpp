#include "plan/frame_plan.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "math/frustum.hpp"
#include "mesh/simplification.hpp"
#include "plan/cut_cache.hpp"
#include "plan/detail_plan.hpp"
#include "plan/draw_budget.hpp"
#include "plan/draw_groups.hpp"
#include "plan/mirror_plan.hpp"
#include "plan/transparency_cache.hpp"
#include "plan/transparency_plan.hpp"

namespace vrut::plan {

namespace {

/// What it takes to plan a node that is shown, and its place among the others, in units of DrawBudget.
constexpr std::int64_t kListed = 20, kOrdered = 20;

bool flattens(double relative_determinant) { return !(std::abs(relative_determinant) > 1e-12); }

/// Adds the item of a drawable node, unless it lies too far from the eye.
void add_item(const scene::PlacedScene& placed, scene::Index node, const glm::dmat4& view,
              const scene::Style& style, std::vector<DrawItem>& items) {
    const auto at = static_cast<std::size_t>(node);
    const scene::Scene& scene = *placed.scene;
    const scene::Index geometry = std::get<scene::GeometryData>(scene.nodes()[at].data).geometry;
    const glm::dmat4 view_from_node = view * placed.world[at];
    const math::Bounds in_view =
        transformed(view_from_node, scene.geometries()[static_cast<std::size_t>(geometry)].bounds);
    if (!(glm::length(in_view.min) < scene::kMaxDrawDistance &&
          glm::length(in_view.max) < scene::kMaxDrawDistance))
        return;
    DrawItem& item = items.emplace_back();
    item.node = node;
    item.geometry = geometry;
    item.material = placed.nodes[at].material;
    item.view_from_node = view_from_node;
    const double determinant = scene::relative_determinant(glm::dmat3(item.view_from_node));
    const bool mirror = !style.override_material && mirror_plane(scene, item);
    const bool both = flattens(determinant) || mirror || scene.material(item.material).two_sided;
    item.cull_mode = both ? CullMode::none : CullMode::back;
    item.mirrored = determinant < 0;
}

scene::Side side_of(const DrawItem& item, const scene::Scene& scene, const glm::dvec4& equation) {
    return scene::side_of(scene.geometries()[static_cast<std::size_t>(item.geometry)].bounds, equation);
}

/// Returns false if the view's clip planes leave nothing of the item.
bool clip(DrawItem& item, const View& view) {
    if (view.scene->scene->is_presentation(item.node)) return true;
    for (const scene::ClipPlane& plane : view.clip_planes) {
        const glm::dvec4 equation =
            scene::clip_equation(plane, view.scene->world[static_cast<std::size_t>(item.node)]);
        const scene::Side side = side_of(item, *view.scene->scene, equation);
        if (side == scene::Side::hidden) return false;
        if (side == scene::Side::crossed) item.clip_planes.push_back(equation);
    }
    return true;
}

/// Where the dot product with (point, 1) is 0. The same for all parts, to the last bit.
glm::dvec4 in_view(const scene::ClipPlane& plane, const scene::Camera& camera) {
    const glm::dvec3 normal = glm::dmat3(scene::view_from_world(camera)) * plane.normal;
    return {normal, glm::dot(plane.normal, camera.eye) - plane.distance};
}

/// Of an item that planes cross: a cut for each, which the others clip. Where one leaves the item open, it is
/// seen from both sides.
void add_cuts(DrawItem& item, const View& view, CutCache& cuts, DrawBudget& budget,
              std::vector<DrawItem>& added) {
    for (std::size_t i = 0; i < view.clip_planes.size(); ++i) {
        const glm::dvec4 equation =
            scene::clip_equation(view.clip_planes[i], view.scene->world[static_cast<std::size_t>(item.node)]);
        if (side_of(item, *view.scene->scene, equation) != scene::Side::crossed) continue;
        DrawItem cut;
        cut.cut = cuts.find(view, item.node, i, budget);
        if (cut.cut->cut.contours.empty()) continue;
        if (!cut.cut->capped && item.cull_mode == CullMode::back) item.cull_mode = CullMode::none;
        cut.node = item.node;
        cut.geometry = item.geometry;
        cut.material = item.material;
        cut.view_from_node = item.view_from_node;
        cut.mirrored = item.mirrored;
        cut.clip_planes = item.clip_planes;
        std::erase(cut.clip_planes, equation);
        cut.cut_plane = in_view(view.clip_planes[i], view.camera);
        added.push_back(std::move(cut));
    }
}

/// Puts cuts behind the items of the same nodes, in whose order they are.
void insert_cuts(std::vector<DrawItem>& items, std::vector<DrawItem> cuts) {
    if (cuts.empty()) return;
    std::vector<DrawItem> merged;
    merged.reserve(items.size() + cuts.size());
    auto cut = cuts.begin();
    for (DrawItem& item : items) {
        merged.push_back(std::move(item));
        for (; cut != cuts.end() && cut->node == merged.back().node; ++cut) merged.push_back(std::move(*cut));
    }
    items = std::move(merged);
}

std::vector<DrawItem> cuts_among(const std::vector<DrawItem>& items) {
    std::vector<DrawItem> cuts;
    for (const DrawItem& item : items)
        if (item.cut) cuts.push_back(item);
    return cuts;
}

/// Finds what their surfaces show besides their materials' own colours.
void assign_surfaces(std::vector<DrawItem>& items, const View& view) {
    const scene::Scene& scene = *view.scene->scene;
    for (DrawItem& item : items) {
        const scene::Material& material = scene.material(item.material);
        const scene::Geometry& geometry = scene.geometries()[static_cast<std::size_t>(item.geometry)];
        item.emissive = material.emissive != glm::dvec3(0);
        item.metallic_roughness = material.metallic_roughness && view.background.cube_map;
        item.coated = item.metallic_roughness &&
                      (material.metallic_roughness->clear_coat > 0 || material.reflectivity > 0);
        if (!geometry.texcoords.empty()) {
            item.texture = material.texture;
            if (item.emissive) item.emissive_texture = material.emissive_texture;
            if (item.metallic_roughness)
                item.occlusion_roughness_metallic_texture = material.occlusion_roughness_metallic_texture;
            item.normal_texture = material.normal_texture;
        }
        item.colored = !geometry.colors.empty();
        item.environment = view.background.cube_map && material.reflectivity > 0 &&
                           !scene.is_mirror(material, item.geometry);
    }
}

/// Reflective geometry nodes, mirrors or others, in the materials of their file.
std::size_t count_reflective(const scene::Scene& scene, bool mirrors) {
    std::size_t count = 0;
    for (const scene::Node& node : scene.nodes())
        if (const auto* data = std::get_if<scene::GeometryData>(&node.data);
            data && data->geometry != scene::kNone && scene.material(data->material).reflectivity > 0)
            count += scene.is_mirror(scene.material(data->material), data->geometry) == mirrors;
    return count;
}

bool has_cube_map(const scene::Scene& scene) {
    return std::any_of(scene.nodes().begin(), scene.nodes().end(), [](const scene::Node& node) {
        const auto* data = std::get_if<scene::BackgroundData>(&node.data);
        return data && data->cube_textures;
    });
}

/// Of items by rising id; mirrors among them are ordinary surfaces.
DrawLists draw_lists_in_mirror(std::vector<DrawItem> items, const View& view, TransparencyCache& shapes) {
    const scene::PlacedScene& placed = *view.scene;
    const scene::Scene& scene = *placed.scene;
    const auto is_opaque = [&](const DrawItem& item) { return !is_transparent(item, scene); };
    DrawLists lists;
    lists.cut_lines = cuts_among(items);
    std::erase_if(items, [](const DrawItem& item) { return item.cut && item.cut->cut.triangles.empty(); });
    if (style_of(view).override_material || std::all_of(items.begin(), items.end(), is_opaque)) {
        lists.opaque = std::move(items);
        return lists;
    }
    std::vector<DrawItem> transparent;
    for (const DrawItem& item : items) (is_opaque(item) ? lists.opaque : transparent).push_back(item);
    mark_occluded_by_coincident(transparent, lists.opaque, scene);
    lists.transparent = order_transparent(transparent, view, shapes);
    return lists;
}

/// Of items by rising id. What mirrors show is taken from `all`; those that show none of it reflect the
/// environment map, where there is one.
DrawLists draw_lists_of(std::vector<DrawItem> items, const std::vector<DrawItem>& all, const View& view,
                        TransparencyCache& shapes) {
    DrawLists lists = draw_lists_in_mirror(std::move(items), view, shapes);
    if (style_of(view).override_material) return lists;
    lists.mirrors = extract_mirrors(lists.opaque, all, view);
    for (MirrorItem& mirror : lists.mirrors)
        mirror.reflected = draw_lists_in_mirror(std::move(mirror.reflected.opaque), view, shapes);
    if (!view.background.cube_map) return lists;
    for (DrawItem& item : lists.opaque)
        if (mirror_plane(*view.scene->scene, item)) item.environment = true;
    return lists;
}

/// Removes the items of these nodes and returns them, in the same order.
std::vector<DrawItem> extract(std::vector<DrawItem>& items, const std::vector<bool>& nodes) {
    const auto kept = [&](const DrawItem& item) { return !nodes[static_cast<std::size_t>(item.node)]; };
    const auto first = std::stable_partition(items.begin(), items.end(), kept);
    std::vector<DrawItem> extracted(first, items.end());
    items.erase(first, items.end());
    return extracted;
}

/// The margin is needed because samples lie up to half a pixel off the pixel's centre, edges are one pixel
/// wide, and outlines grow from pixels inside the image.
math::Frustum frustum_of(const View& view, double margin) {
    return math::frustum_of(
        math::cropped(projection_of(view), math::ndc_with_margin(view.width, view.height, margin)));
}

void cull_frustum(std::vector<DrawItem>& items, const View& view) {
    const math::Frustum frustum = frustum_of(view, 1);
    const auto& geometries = view.scene->scene->geometries();
    std::erase_if(items, [&](const DrawItem& item) {
        return math::is_outside(frustum, item.view_from_node,
                                geometries[static_cast<std::size_t>(item.geometry)].bounds);
    });
}

/// Those before the eye whose sign reaches into the image.
std::vector<glm::dvec3> markers_of(const View& view, const glm::dmat4& view_matrix) {
    std::vector<glm::dvec3> markers;
    if (!view.markers) return markers;
    const math::Frustum frustum = frustum_of(view, marker_radius(view.height) + 1);
    for (const PlacedMarker& marker : *view.markers) {
        const glm::dvec3 point(view_matrix * glm::dvec4(marker.point, 1));
        if (!(glm::length(point) < scene::kMaxDrawDistance && point.z < 0)) continue;
        if (!math::is_outside(frustum, glm::dmat4(1), {point, point})) markers.push_back(point);
    }
    std::stable_sort(markers.begin(), markers.end(),
                     [](const glm::dvec3& a, const glm::dvec3& b) { return a.z < b.z; });
    return markers;
}

}  // namespace

std::vector<DrawItem> visible_items(const View& view) {
    const scene::PlacedScene& placed = *view.scene;
    std::vector<bool> shown;  // empty: all that is drawable
    if (placed.scene->has_lods()) shown = scene::shown_nodes(placed, view.camera.eye);
    const glm::dmat4 view_matrix = scene::view_from_world(view.camera);
    const scene::Style style = style_of(view);
    std::vector<DrawItem> items;
    items.reserve(placed.drawable.size());
    for (const scene::Index node : placed.drawable)  // at equal depth the last one is in front
        if ((shown.empty() || shown[static_cast<std::size_t>(node)]) &&
            (style.presentation || !placed.scene->is_presentation(node)))
            add_item(placed, node, view_matrix, style, items);
    if (!view.clip_planes.empty()) std::erase_if(items, [&](DrawItem& item) { return !clip(item, view); });
    if (style.faces && !style.override_material) assign_surfaces(items, view);
    return items;
}

const scene::Material& material_of(const DrawItem& item, const scene::Scene& scene) {
    return item.cut ? item.cut->material : scene.material(item.material);
}

bool is_transparent(const DrawItem& item, const scene::Scene& scene) {
    return !item.cut && scene.is_transparent(scene.material(item.material), item.geometry);
}

std::size_t triangle_count(const DrawItem& item, const scene::Scene& scene) {
    if (item.cut) return item.cut->cut.triangles.size();
    return item.level ? item.level->triangles.size()
                      : scene.geometries()[static_cast<std::size_t>(item.geometry)].triangles.size();
}

double marker_radius(int picture_height) { return std::max(picture_height / 120.0, 3.0); }

bool is_flattened(const glm::dmat4& view_from_node) {
    return flattens(scene::relative_determinant(glm::dmat3(view_from_node)));
}

bool has_transparent(const DrawLists& lists) {
    return !lists.transparent.empty() ||
           std::any_of(lists.mirrors.begin(), lists.mirrors.end(),
                       [](const MirrorItem& mirror) { return has_transparent(mirror.reflected); });
}

bool has_exact_group(const DrawLists& lists) {
    return std::any_of(lists.transparent.begin(), lists.transparent.end(),
                       [](const TransparentGroup& group) { return group.exact; }) ||
           std::any_of(lists.mirrors.begin(), lists.mirrors.end(),
                       [](const MirrorItem& mirror) { return has_exact_group(mirror.reflected); });
}

void FramePlanner::find_items(const View& view, CutCache& cuts) {
    cuts.begin_image();
    const scene::PlacedScene& placed = *view.scene;
    items_ = visible_items(view);
    if (std::any_of(items_.begin(), items_.end(), [&](const DrawItem& item) {
            return placed.scene->is_mirror(placed.scene->material(item.material), item.geometry);
        }))
        unculled_items_ = items_;  // a mirror can show items outside of the frustum
    cull_frustum(items_, view);
    plan_.markers = markers_of(view, scene::view_from_world(view.camera));
}

/// Of items, and then of what mirrors may show.
bool FramePlanner::find_cuts(const View& view, CutCache& cuts, DrawBudget& budget) {
    if (view.clip_planes.empty()) return true;
    const std::size_t count = items_.size() + unculled_items_.size();
    for (; cuts_found_ < count && !budget.is_spent(); ++cuts_found_) {
        const bool culled = cuts_found_ >= items_.size();
        DrawItem& item = culled ? unculled_items_[cuts_found_ - items_.size()] : items_[cuts_found_];
        if (!item.clip_planes.empty()) add_cuts(item, view, cuts, budget, culled ? unculled_cuts_ : cuts_);
    }
    return cuts_found_ == count;
}

void FramePlanner::sort_items(const View& view) {
    insert_cuts(items_, std::move(cuts_));
    insert_cuts(unculled_items_, std::move(unculled_cuts_));
    const scene::Style style = style_of(view);
    if (!style.faces) plan_.scene.cut_lines = cuts_among(items_);
    if (view.selected != scene::kNone)
        plan_.selected = extract(items_, scene::subtree(*view.scene->scene, view.selected));
    if (style.edges) plan_.edges = items_;
}

/// Of glass, which will be put in order; what only mirrors show is left to that.
bool FramePlanner::find_shapes(const View& view, TransparencyCache& shapes, DrawBudget& budget) {
    const scene::Style style = style_of(view);
    if (!style.faces || style.override_material) return true;
    if (view.methods.transparency == Methods::Transparency::per_pixel_lists) return true;
    const scene::Scene& scene = *view.scene->scene;
    const std::size_t count = items_.size() + plan_.selected.size();
    for (; shapes_found_ < count && !budget.is_spent(); ++shapes_found_) {
        const DrawItem& item = shapes_found_ < items_.size() ? items_[shapes_found_]
                                                             : plan_.selected[shapes_found_ - items_.size()];
        if (is_transparent(item, scene)) budget.spend(shapes.find(item));
    }
    return shapes_found_ == count;
}

void FramePlanner::find_draw_lists(const View& view, TransparencyCache& shapes,
                                   const IsResident& is_resident) {
    if (!style_of(view).faces) return;
    plan_.scene = draw_lists_of(std::move(items_), unculled_items_, view, shapes);
    plan_.overlay = draw_lists_of(plan_.selected, unculled_items_, view, shapes);
    select_levels(plan_, view, is_resident);
    cull_backfaces(plan_, view);
    if (!style_of(view).edges) group_for_draws(plan_.scene.opaque, *view.scene, view.camera.eye);
}

bool FramePlanner::step(const View& view, const PlanCaches& caches, DrawBudget& budget,
                        const IsResident& is_resident) {
    while (stage_ != PlanStage::done && !budget.is_spent()) {
        switch (stage_) {
            case PlanStage::items:
                budget.spend(kListed * static_cast<std::int64_t>(view.scene->nodes.size()));
                find_items(view, caches.cuts);
                stage_ = PlanStage::cuts;
                break;
            case PlanStage::cuts:
                if (!find_cuts(view, caches.cuts, budget)) break;
                sort_items(view);
                stage_ = PlanStage::shapes;
                break;
            case PlanStage::shapes:
                if (find_shapes(view, caches.shapes, budget)) stage_ = PlanStage::draw_lists;
                break;
            case PlanStage::draw_lists:
                budget.spend(kOrdered * static_cast<std::int64_t>(items_.size() + plan_.selected.size()));
                find_draw_lists(view, caches.shapes, is_resident);
                stage_ = PlanStage::done;
                break;
            case PlanStage::done:
                break;
        }
    }
    return stage_ == PlanStage::done;
}

FramePlan plan_frame(const View& view) {
    if (!view.scene) return {};
    TransparencyCache shapes(*view.scene->scene);
    CutCache cuts;
    FramePlanner planner;
    for (DrawBudget budget(false); !planner.step(view, {shapes, cuts}, budget);) budget = DrawBudget(false);
    return planner.plan();
}

std::vector<DrawItem> visible_faces(const View& view, CutCache& cuts) {
    if (!view.scene || !style_of(view).faces) return {};
    std::vector<DrawItem> items = visible_items(view), caps;
    cull_frustum(items, view);
    DrawBudget unlimited(false);
    for (DrawItem& item : items)
        if (!item.clip_planes.empty()) add_cuts(item, view, cuts, unlimited, caps);
    insert_cuts(items, std::move(caps));
    return items;
}

ClassCounts count_classes(const scene::PlacedScene& placed) {
    ClassCounts counts;
    for (std::size_t i = 0; i < placed.nodes.size(); ++i) {
        const auto* data = std::get_if<scene::GeometryData>(&placed.scene->nodes()[i].data);
        if (!data) continue;
        const scene::Material& material = placed.scene->material(placed.nodes[i].material);
        ++(placed.scene->is_transparent(material, data->geometry) ? counts.transparent
           : material.reflectivity > 0                            ? counts.reflective
                                                                  : counts.solid);
    }
    return counts;
}

std::vector<std::string> unsupported_features(const scene::Scene& scene) {
    std::vector<std::string> notices;
    const std::size_t mirrors = count_reflective(scene, true), others = count_reflective(scene, false);
    if (mirrors > kMaxMirrors)
        notices.push_back(std::to_string(mirrors) + " planar mirrors: only the " +
                          std::to_string(kMaxMirrors) + " largest in the image show reflections");
    if (others > 0 && !has_cube_map(scene))
        notices.push_back(
            std::to_string(others) +
            " curved or transparent reflective parts reflect nothing: the scene has no cube map");
    return notices;
}

}  // namespace vrut::plan
