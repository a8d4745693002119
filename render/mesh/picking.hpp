#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "mesh/picking_trees.hpp"
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
    glm::dvec3 point{0};   ///< world space
    glm::dvec3 normal{0};  ///< the triangle's own, in world space: unit, towards the ray's origin
    double distance = 0;   ///< from the ray's origin, above 0, in the scene's unit
};

/// Returns the nearest triangle along the ray among what an image of this mode from `ray.origin` shows:
/// nodes that are active and chosen by their switches and LODs, front faces, and back faces where they are
/// drawn, but no glass of alpha 0 and no presentation (scene::Node). At exactly equal distance the node of
/// higher id is hit. With `through_transparent` transparent materials are passed, whatever the alpha of their
/// texture is there. Edges and corners belong to their triangles, so that a closed surface has no gaps; a
/// triangle without area, or seen exactly along its plane, is missed. Nothing is hit by a ray that is not
/// finite or has no direction. Edge test: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT
/// 2(1), 2013. `trees`, of the same scene, change the time that it takes, and no bit of the result: a
/// geometry without a tree is searched triangle by triangle.
std::optional<Hit> pick(const scene::PlacedScene& placed, const Ray& ray, bool through_transparent,
                        const PickingTrees* trees = nullptr,
                        scene::DrawMode mode = scene::DrawMode::realistic);

}  // namespace vrut::mesh
