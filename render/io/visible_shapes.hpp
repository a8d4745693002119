#pragma once

#include <vector>

#include "io/conversion_warnings.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// A geometry node that is drawn at the start: by its file it is active, and its switches choose it; of a
/// level of detail, the first child.
struct ShownShape {
    scene::Index node = scene::kNone;
    const scene::Geometry* geometry = nullptr;  ///< with a triangle at least
    scene::Index material = scene::kNone;
    glm::dmat4 world{1};  ///< world from node
};

/// What a format without activity, switches and levels of detail shows of a scene, in the order of the nodes;
/// what it leaves out is told.
std::vector<ShownShape> shown_shapes(const scene::Scene& scene, ConversionWarnings& warnings);

/// Tells of what neither of the formats but VRUT's own holds.
void report_lost_nodes(const scene::Scene& scene, ConversionWarnings& warnings);
/// Tells of cameras, lights and the tree, which a format of triangles alone does not hold.
void report_lost_tree(const scene::Scene& scene, ConversionWarnings& warnings);

}  // namespace vrut::io
