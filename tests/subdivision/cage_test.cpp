#include "cage.hpp"

#include <doctest/doctest.h>

using namespace vrut;

namespace {

const std::string kGood = R"({"unit": 0.001,
 "materials": [{"name": "Red", "diffuse": [0.6, 0.1, 0.1, 1], "twoSided": true, "image": "a.png"}],
 "meshes": [{"name": "Strip", "points": [[0,0,0],[1000,0,0],[2000,0,0],[0,1000,0],[1000,1000,0],[2000,1000,0]],
   "texcoords": [[0,0],[1,0],[2,0],[0,1],[1,1],[2,1]], "quads": [[0,1,4,3],[1,2,5,4]], "creases": [[1,4,2.5]]}],
 "skins": [{"mesh": 0, "cuts": [{"name": "Door", "gap": 0.004, "within":
   [{"from": "left", "outline": [[0,0,0.1],[1,0,0.1],[1,1,0]]}]}]}],
 "nodes": [{"id": 1, "name": "All", "type": "assembly", "hinge": [0,1,0,-65], "presentation": true, "matrix": [1,0,0,7, 0,1,0,8, 0,0,1,9, 0,0,0,1]},
  {"id": 2, "name": "Part", "type": "geometry", "parent": 1, "mesh": 0, "material": "Red", "tolerance": 3},
  {"id": 3, "name": "Panel", "type": "geometry", "parent": 1, "material": "Red",
   "panel": {"skin": 0, "cut": "Door", "lift": 0.001, "thickness": 0.02, "edge": 0.002}},
  {"id": 4, "name": "Again", "type": "geometry", "geometryOf": 3, "active": false},
  {"id": 5, "name": "Paint", "type": "switch", "activeChild": -1},
  {"id": 6, "name": "Far", "type": "lod", "ranges": [1, 2.5]},
  {"id": 7, "name": "Lamp", "type": "light", "lightType": "spot", "color": [1, 1, 0, 1], "angle": 30},
  {"id": 8, "name": "Eye", "type": "camera", "eye": [1, 2, 3], "fov": 50, "look": 0.5},
  {"id": 9, "name": "Sky", "type": "background", "image": "sky.png", "cubeMap": ["a","b","c","d","e","f"]}]})";

/// What is said of the good file with one piece of it replaced.
std::string fault(const std::string& piece, const std::string& other) {
    std::string text = kGood;
    const std::size_t at = text.find(piece);
    REQUIRE(at != std::string::npos);
    const auto result = read_cage_scene(text.replace(at, piece.size(), other));
    return result ? "none" : result.error();
}

}  // namespace

TEST_CASE("a file of cages") {
    const auto scene = read_cage_scene(kGood);
    REQUIRE_MESSAGE(scene, scene.error());
    REQUIRE(scene->materials.size() == 2);
    CHECK(scene->materials[0].two_sided);
    CHECK(scene->materials[1].image == "sky.png");
    REQUIRE(scene->meshes.size() == 1);
    CHECK(scene->meshes[0].points[5] == glm::dvec3(2, 1, 0));
    CHECK(scene->meshes[0].creases[0].sharpness == 2.5);
    CHECK(scene->skins[0].cuts[0].within[0].corners[1].place == glm::dvec2(1, 0));
    REQUIRE(scene->nodes.size() == 9);
    CHECK(scene->nodes[0].part.node.matrix[3] == glm::dvec4(7, 8, 9, 1));
    CHECK(scene->nodes[0].part.node.hinge == scene::Hinge{{0, 1, 0}, -65});
    CHECK(scene->nodes[0].part.node.presentation);
    CHECK_FALSE(scene->nodes[1].part.node.hinge);
    CHECK_FALSE(scene->nodes[1].part.node.presentation);
    CHECK(scene->nodes[1].tolerance == 3);
    CHECK(std::get<scene::GeometryData>(scene->nodes[1].part.node.data).material == 0);
    CHECK(scene->nodes[2].panel->cut == 0);
    CHECK(scene->nodes[3].geometry_of == 3);
    CHECK_FALSE(scene->nodes[3].part.node.active);
    CHECK(std::get<scene::SwitchData>(scene->nodes[4].part.node.data).active_child ==
          scene::SwitchData::kNoChild);
    CHECK(std::get<scene::LodData>(scene->nodes[5].part.node.data).ranges == std::vector<double>{1, 2.5});
    CHECK(std::get<scene::LightData>(scene->nodes[6].part.node.data).type == scene::LightData::Type::spot);
    CHECK(std::get<scene::CameraData>(scene->nodes[7].part.node.data).fov == 50);
    CHECK(std::get<scene::BackgroundData>(scene->nodes[8].part.node.data).cube_map->back() == "f");
}

TEST_CASE("what is wrong with a file of cages is told in one sentence") {
    CHECK(fault("{\"unit\"", "{unit") == "expected JSON, found an error at byte 2");
    CHECK(fault("\"unit\": 0.001", "\"unit\": \"m\"") == "the file: expected a number as unit, found \"m\"");
    CHECK(fault("[1,2,5,4]", "[1,2,6,4]") ==
          "mesh 0 \"Strip\": expected an integer from 0 to 5 as a point of quad 1, found 6");
    CHECK(fault("[1,2,5,4]", "[1,2,5]") == "mesh 0 \"Strip\": expected four points as quad 1, found [1,2,5]");
    CHECK(fault("[1,2,5,4]", "[1,2,2,4]") == "mesh 0 \"Strip\": quad 1 has point 2 twice");
    CHECK(fault("[1,2,5,4]", "[4,5,2,1]") ==
          "mesh 0 \"Strip\": the two faces at edge 1-4 wind opposite ways");
    CHECK(fault("[1,2,5,4]]", "[1,2,5,4],[4,1,3,5]]") ==
          "mesh 0 \"Strip\": expected one or two faces at edge 1-4, found 3");
    CHECK(fault("[1,4,2.5]", "[1,5,2.5]") == "mesh 0 \"Strip\": crease 1-5 is no edge of a quad");
    CHECK(fault("[1,4,2.5]", "[1,4,11]") ==
          "mesh 0 \"Strip\": expected a sharpness from 0 to 10 at crease 1-4, found 11");
    CHECK(fault("[2,0],[0,1]", "[0,1]") ==
          "mesh 0 \"Strip\": expected as many texcoords as points (6), found 5");
    CHECK(fault("\"skins\": [{\"mesh\": 0", "\"skins\": [{\"mesh\": 1") ==
          "skin 0: expected an integer from 0 to 0 as mesh, found 1");
    CHECK(fault("\"from\": \"left\"", "\"from\": \"below\"") ==
          "skin 0, cut \"Door\": expected left, right, sides, top, front or rear as from, found \"below\"");
    CHECK(fault(",[1,1,0]]", "]") ==
          "skin 0, cut \"Door\": expected three or more corners in an outline, found 2");
    CHECK(fault("[1,1,0]]", "[1,1,0],[0,0,0]]") ==
          "skin 0, cut \"Door\": expected an outline's corners apart from each other, found two at 0 0");
    CHECK(fault("\"cut\": \"Door\"", "\"cut\": \"Dor\"") == "node 3 \"Panel\", panel: unknown cut \"Dor\"");
    CHECK(fault("\"thickness\": 0.02", "\"thickness\": 0.001") ==
          "node 3 \"Panel\", panel: expected an edge of 0 or more and a thickness above it");
    CHECK(fault("\"mesh\": 0, \"material\": \"Red\"", "\"mesh\": 0, \"material\": \"Rot\"") ==
          "node 2 \"Part\": unknown material \"Rot\"");
    CHECK(fault("\"mesh\": 0, \"material\"", "\"mesh\": 4, \"material\"") ==
          "node 2 \"Part\": expected an integer from 0 to 0 as mesh, found 4");
    CHECK(fault("\"parent\": 1", "\"parent\": 77") == "node 2 \"Part\": unknown parent 77");
    CHECK(fault("\"id\": 4", "\"id\": 3") == "node 3 \"Again\": there are two nodes of this id");
    CHECK(fault("\"geometryOf\": 3", "\"geometryOf\": 1") ==
          "node 4 \"Again\": geometryOf names node 1, which has no mesh or panel of its own");
    CHECK(fault("\"geometryOf\": 3", "\"geometryOf\": 4") ==
          "node 4 \"Again\": geometryOf names node 4, which has no mesh or panel of its own");
    CHECK(fault("\"geometryOf\": 3, ", "") == "node 4 \"Again\": expected one of mesh, panel and geometryOf");
    CHECK(fault("\"type\": \"lod\"", "\"type\": \"lot\"") ==
          "node 6 \"Far\": expected assembly, geometry, switch, lod, light, camera or background as type, "
          "found "
          "\"lot\"");
    CHECK(fault("\"activeChild\"", "\"activChild\"") == "node 5 \"Paint\": unknown member \"activChild\"");
    CHECK(fault("0,0,0,1]}", "0,0,0,2]}") == "node 1 \"All\": expected 0 0 0 1 as the matrix's last row");
    CHECK(fault("\"unit\": 0.001", "\"unit\": 1e999") ==
          "expected numbers in the range of double, found another");
    CHECK(fault("[0,1,0,-65]", "[0,1,0]") == "node 1 \"All\": expected 4 numbers as a hinge, found [0,1,0]");
    CHECK(fault("[0,1,0,-65]", "[0,0,0,-65]") ==
          "node 1 \"All\": expected a hinge's axis that is not zero, found [0,0,0,-65]");
    CHECK(fault("[0,1,0,-65]", "[0,1,0,361]") ==
          "node 1 \"All\": expected a hinge's degrees from -360 to 360, found [0,1,0,361]");
    CHECK(fault("\"fov\": 50", "\"hinge\": [0,1,0,5]") == "node 8 \"Eye\": unknown member \"hinge\"");
    // What scene text does not hold.
    CHECK(fault("[0.6, 0.1, 0.1, 1]", "[0.6, 0.1, 0.1, 2]") ==
          "material \"Red\": expected a number from 0 to 1 as diffuse, found 2");
    CHECK(fault("\"fov\": 50", "\"fov\": 0") ==
          "node 8 \"Eye\": expected a number from 1 to 170 as fov, found 0");
    CHECK(fault("[1, 2.5]", "[-1, 2.5]") ==
          "node 6 \"Far\": expected a number from 0 to 1e+09 as a range, found -1");
    CHECK(fault("\"angle\": 30", "\"angle\": 181") ==
          "node 7 \"Lamp\": expected a number from 0 to 180 as angle, found 181");
    CHECK(fault("\"Lamp\"", "\"La\\nmp\"") ==
          "node at place 6: expected no control characters in name, found \"La\\nmp\"");
    CHECK(fault("\"gap\": 0.004", "\"gap\": 1e300") ==
          "skin 0, cut \"Door\": expected a number from -1e+09 to 1e+09 as gap, found 1e+300");
    CHECK(fault("\"activeChild\": -1", "\"activeChild\": 18446744073709551615") ==
          "node 5 \"Paint\": expected an integer from -2 to 1073741824 as activeChild, found "
          "18446744073709551615");
    CHECK(fault("\"name\": \"Red\", ", "") == "material 0: expected the member \"name\", found none");
}

TEST_CASE("lists without end are told of, too") {
    for (const std::string start :
         {"", "{\"unit\": ", "{\"unit\": 1, \"nodes\": ", "{\"unit\": 1, \"meshes\": "}) {
        CAPTURE(start);
        const std::size_t deep = 200000;
        const std::string text =
            start + std::string(deep, '[') + std::string(deep, ']') + (start.empty() ? "" : "}");
        const auto result = read_cage_scene(text);
        REQUIRE_FALSE(result);
        CHECK(result.error().size() < 100);
    }
}
