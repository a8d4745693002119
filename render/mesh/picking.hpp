#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "mesh/picking_trees.hpp"
#include "scene/clip_plane.hpp"
#include "scene/scene.hpp"
#include "scene/style.hpp"

namespace vrut::mesh {

/// A half-line in world space; `direction` is unit.
struct Ray {
    glm::dvec3 origin{0}, direction{0, 0, -1};
};

/// What a ray meets first.
struct Hit {
    scene::Index node = scene::kNone;
    glm::dvec3 point{0};  ///< world space
    /// The triangle's own or a cap's, in world space: unit, towards the ray's origin.
    glm::dvec3 normal{0};
    double distance = 0;  ///< from the ray's origin, above 0, in the scene's unit
};

struct PickOptions {
    bool through_transparent = false;     ///< transparent materials are passed
    const PickingTrees* trees = nullptr;  ///< of the same scene; null: none
    scene::DrawMode mode = scene::DrawMode::realistic;
    std::span<const scene::ClipPlane> clip_planes = {};
    std::function<bool(scene::Index geometry)> is_solid = {};  ///< is_watertight(); null: none is known to be
};

/// Returns the nearest triangle or cap along the ray among what an image of this mode from `ray.origin`
/// shows: nodes that are active and chosen by their switches and LODs, front faces, and back faces where they
/// are drawn, but no glass of alpha 0 and no presentation (scene::Node). At exactly equal distance the node
/// of higher id is hit. With `through_transparent` transparent materials are passed, whatever the alpha of
/// their texture is there. Edges and corners belong to their triangles, so that a closed surface has no gaps;
/// a triangle without area, or seen exactly along its plane, is missed. Nothing is hit by a ray that is not
/// finite or has no direction. Edge test: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT
/// 2(1), 2013. What lies beyond a clip plane is passed. Where the ray comes through one with caps into a
/// solid part that is not flattened, it hits the cap, whatever the part's material: the winding number there,
/// of the triangles beyond, is not 0. `trees` change the time that it takes, and no bit of the result: a
/// geometry without a tree is searched triangle by triangle.
std::optional<Hit> pick(const scene::PlacedScene& placed, const Ray& ray, const PickOptions& options = {});

}  // namespace vrut::mesh
