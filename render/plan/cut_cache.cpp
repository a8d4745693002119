#include "plan/cut_cache.hpp"

#include <algorithm>
#include <tuple>

#include "plan/frame_plan.hpp"

namespace vrut::plan {

namespace {

/// Lines of hatching lie so far apart, of the radius of what the scene shows.
constexpr double kHatchingSpacing = 1.0 / 128;

scene::Index geometry_of(const View& view, scene::Index node) {
    return std::get<scene::GeometryData>(view.scene->scene->nodes()[static_cast<std::size_t>(node)].data)
        .geometry;
}

std::shared_ptr<const CutSurface> cut_surface(const View& view, scene::Index node,
                                              const scene::ClipPlane& plane, bool cap, double spacing) {
    const auto at = static_cast<std::size_t>(node);
    const scene::Scene& scene = *view.scene->scene;
    const glm::dmat4& world = view.scene->world[at];
    const glm::dvec4 equation = scene::clip_equation(plane, world);
    auto surface = std::make_shared<CutSurface>();
    surface->cut =
        mesh::cut_of(scene.geometries()[static_cast<std::size_t>(geometry_of(view, node))], equation, cap);
    surface->capped = cap;
    surface->normal = -glm::dvec3(equation);
    surface->material = scene::cap_material(scene.material(view.scene->nodes[at].material));
    if (cap && plane.hatched) mesh::add_hatching(surface->cut, world, plane, spacing, node % 2 != 0);
    return surface;
}

}  // namespace

bool CutCache::is_solid(const View& view, scene::Index node) {
    return !is_flattened(view.scene->world[static_cast<std::size_t>(node)]) &&
           watertight_.is_watertight(view.scene->scene, geometry_of(view, node), view.levels.get());
}

std::shared_ptr<const CutSurface> CutCache::find(const View& view, scene::Index node, std::size_t number,
                                                 DrawBudget& budget) {
    const auto at = static_cast<std::size_t>(node);
    const scene::ClipPlane& plane = view.clip_planes[number];
    Entry entry{node, view.scene->nodes[at].material, number, plane, view.scene->world[at]};
    entry.solid = plane.caps && is_solid(view, node);
    if (entry.solid && plane.hatched) entry.spacing = kHatchingSpacing * view.scene->bounds.radius();
    const auto before = [](const Entry& a, const Entry& b) {
        return std::tie(a.node, a.number) < std::tie(b.node, b.number);
    };
    const auto found = std::lower_bound(entries_.begin(), entries_.end(), entry, before);
    const bool known = found != entries_.end() && found->node == node && found->number == number;
    if (known && found->material == entry.material && found->plane == plane && found->world == entry.world &&
        found->solid == entry.solid && found->spacing == entry.spacing) {
        found->used = true;
        return found->surface;
    }
    budget.spend(static_cast<std::int64_t>(
        view.scene->scene->geometries()[static_cast<std::size_t>(geometry_of(view, node))].triangles.size()));
    entry.surface = cut_surface(view, node, plane, entry.solid, entry.spacing);
    std::shared_ptr<const CutSurface> surface = entry.surface;
    if (known)
        *found = std::move(entry);
    else
        entries_.insert(found, std::move(entry));
    return surface;
}

void CutCache::begin_image() {
    std::erase_if(entries_, [](const Entry& entry) { return !entry.used; });
    for (Entry& entry : entries_) entry.used = false;
}

}  // namespace vrut::plan
