#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "cage.hpp"
#include "scene/scene.hpp"

namespace vrut {

struct SubdividedScene {
    scene::Scene scene;
    double shown = 0;      ///< triangles: of a switch those of its active child, of a lod those of its first
    double vertices = 0;   ///< of all geometries
    double tolerance = 0;  ///< the error above which everything was refined, in metres
    std::vector<std::string> lost;  ///< names of nodes of whose mesh or panel no triangle is left
};

/// The scene of a file of control cages, with about as many triangles shown as asked; else one sentence.
tl::expected<SubdividedScene, std::string> subdivide(const CageScene& cages, double triangles);

}  // namespace vrut
