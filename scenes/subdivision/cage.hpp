#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "scene/scene.hpp"

namespace vrut {

struct Crease {
    int a = 0, b = 0;
    double sharpness = 0;  ///< kHard and above: sharp at every level
};
inline constexpr double kHard = 10;

/// A mesh of quads, counter-clockwise from outside, whose Catmull-Clark limit is the surface meant.
struct Cage {
    std::string name;
    std::vector<glm::dvec3> points;     ///< metres
    std::vector<glm::dvec2> texcoords;  ///< one for each point, or none
    std::vector<std::array<int, 4>> quads;
    std::vector<Crease> creases;
    bool smooth = true;  ///< false: the quads themselves are the surface
};

/// A closed outline in a projection of the car along one of its axes.
struct Outline {
    enum class From { left, right, sides, top, front, rear };
    struct Corner {
        glm::dvec2 place{0};
        double radius = 0;
    };
    From from = From::left;
    std::vector<Corner> corners;
};

/// Takes the points that lie in all its outlines.
struct Cut {
    std::string name;
    double gap = 0;  ///< between its piece and whatever surrounds it
    std::vector<Outline> within;
    double detail = 0;  ///< as a node's
};

/// A cage in car coordinates, cut like sheet metal: the first cut that holds a point takes it.
struct Skin {
    int mesh = 0;
    std::vector<Cut> cuts;
};

/// A cut's piece of a skin, as a closed shell or one of the two layers that close together.
struct Panel {
    enum class Layer {
        whole,
        outside,  ///< the sheet and its rounded edge
        inside,   ///< the rim and the back
        back,     ///< the back alone
    };
    int skin = 0;
    int cut = scene::kNone;  ///< kNone: all that no cut took
    double lift = 0;         ///< outward, of all of it
    double thickness = 0.001;
    double edge = 0;  ///< radius of its outer edge
    double grow = 0;  ///< how far it reaches beyond its cut, under what surrounds it
    Layer layer = Layer::whole;
};

struct CageNode {
    scene::SceneParts::PartNode part;  ///< complete but for GeometryData::geometry
    int mesh = scene::kNone;           ///< where the geometry comes from: a mesh, a panel or another node
    std::optional<Panel> panel;
    std::optional<scene::Id> geometry_of;
    double tolerance = 1;  ///< factor on the permitted error
    double detail = 0;     ///< triangles: where fewer are asked for, its geometry is left out
};

struct CageScene {
    std::vector<scene::Material> materials;
    std::vector<Cage> meshes;
    std::vector<Skin> skins;
    std::vector<CageNode> nodes;
};

/// Reads a file of control cages (JSON); else one sentence that names the culprit.
tl::expected<CageScene, std::string> read_cage_scene(std::string_view text);

}  // namespace vrut
