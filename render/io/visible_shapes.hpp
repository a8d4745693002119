#pragma once

#include <vector>

#include "io/conversion_warnings.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// A geometry node that is initially visible: active in the file and chosen by its switches; of a LOD node
/// only the first child counts.
struct ShownShape {
    scene::Index node = scene::kNone;
    const scene::Geometry* geometry = nullptr;  ///< with a triangle at least
    scene::Index material = scene::kNone;
    glm::dmat4 world{1};  ///< world from node
};

/// Returns the initially visible geometry nodes in the order of the nodes, for formats without activity,
/// switches and LOD nodes. Adds a warning for each kind of node that it omits.
std::vector<ShownShape> shown_shapes(const scene::Scene& scene, ConversionWarnings& warnings);

/// Warns of nodes that only VRUT's own format can store.
void report_lost_nodes(const scene::Scene& scene, ConversionWarnings& warnings);
/// Warns of cameras, lights and the scene graph, which a format of triangles alone cannot store.
void report_lost_tree(const scene::Scene& scene, ConversionWarnings& warnings);

}  // namespace vrut::io
