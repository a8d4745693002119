#include <doctest/doctest.h>

#include <cstdlib>
#include <limits>

#include "io/osb/scene.hpp"
#include "needs_folder.hpp"
#include "osb_builder.hpp"
#include "scene_queries.hpp"
#include "temporary_folder.hpp"

using namespace vrut;

namespace {

using B = OsbBuilder;

constexpr unsigned kTriangles = 4, kStrip = 5, kFan = 6, kQuads = 7, kQuadStrip = 8, kPolygon = 9;

scene::Scene read_well(const B& file) {
    auto parts = io::read_osb_parts(file.bytes(), "x.osb");
    REQUIRE_MESSAGE(parts, parts.error());
    auto scene = io::build_scene(*std::move(parts), "x.osb");
    REQUIRE_MESSAGE(scene, scene.error());
    return *std::move(scene);
}

std::string error_of(const std::string& bytes) {
    const auto parts = io::read_osb_parts(bytes, "x.osb");
    return parts ? "" : parts.error();
}

/// A node with one geometry of the primitives, over six points of two rows.
B one_geometry(const std::vector<std::pair<unsigned, unsigned>>& primitives,
               const std::vector<std::uint32_t>& indices = {0, 1, 2, 3, 4, 5}) {
    return B().node(1, 10).geometry(10, primitives, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0},
                                    indices);
}

using Triangles = std::vector<glm::uvec3>;

Triangles triangles_of(const B& file) {
    const scene::Scene scene = read_well(file);
    return scene.geometries().empty() ? Triangles() : scene.geometries()[0].triangles;
}

}  // namespace

TEST_CASE("OSB: primitives become triangles that face as the file says") {
    CHECK(triangles_of(one_geometry({{kTriangles, 6}})) == Triangles{{0, 1, 2}, {3, 4, 5}});
    CHECK(triangles_of(one_geometry({{kStrip, 5}})) == Triangles{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}});
    CHECK(triangles_of(one_geometry({{kFan, 4}})) == Triangles{{0, 1, 2}, {0, 2, 3}});
    CHECK(triangles_of(one_geometry({{kPolygon, 5}})) == Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
    CHECK(triangles_of(one_geometry({{kQuads, 5}})) == Triangles{{0, 1, 2}, {0, 2, 3}});
    CHECK(triangles_of(one_geometry({{kQuadStrip, 6}})) ==
          Triangles{{0, 1, 3}, {0, 3, 2}, {2, 3, 5}, {2, 5, 4}});
    CHECK(triangles_of(one_geometry({{kTriangles, 3}, {kFan, 3}})) == Triangles{{0, 1, 2}, {3, 4, 5}});
    SUBCASE("joined strips leave no triangle without area") {
        CHECK(triangles_of(one_geometry({{kStrip, 6}}, {0, 1, 2, 2, 3, 4})) ==
              Triangles{{0, 1, 2}, {3, 2, 4}});
    }
    SUBCASE("without indices points follow each other") {
        CHECK(triangles_of(one_geometry({{kTriangles, 3}, {kTriangles, 3}}, {})) ==
              Triangles{{0, 1, 2}, {3, 4, 5}});
    }
    SUBCASE("only points that are used become vertices") {
        const scene::Scene scene = read_well(one_geometry({{kTriangles, 3}}, {5, 3, 1}));
        CHECK(scene.geometries()[0].positions == std::vector<glm::dvec3>{{1, 2, 0}, {1, 1, 0}, {1, 0, 0}});
        CHECK(scene.geometries()[0].bounds.max == glm::dvec3(1, 2, 0));
    }
    SUBCASE("points and lines are told") {
        const scene::Scene scene = read_well(one_geometry({{0, 2}, {3, 2}}));
        CHECK(scene.geometries().empty());
        CHECK(has_notice(
            scene, "a primitive of points or lines is ignored: only triangles are supported (2 times)"));
    }
}

TEST_CASE("OSB: a vertex is made for each tuple of indices that occurs") {
    B file;
    file.node(1, 10);
    file.add("Geometry", 10,
             {{"types", "SFGeoPTypesPtr", B::u32(11)},
              {"positions", "SFGeoPositionsPtr", B::u32(12)},
              {"normals", "SFGeoNormalsPtr", B::u32(13)},
              {"texCoords", "SFGeoTexCoordsPtr", B::u32(14)},
              {"indices", "SFGeoIndicesPtr", B::u32(15)},
              {"indexMapping", "MFUInt16", B::many({B::u16(1), B::u16(2 | 16)})}});
    file.add("GeoPTypesUI8", 11, {{"types", "MFUInt8", B::many({B::u8(kTriangles)})}});
    file.add(
        "GeoPositions3f", 12,
        {{"positions", "MFPnt3f",
          B::many({B::reals({0, 0, 0}), B::reals({1, 0, 0}), B::reals({0, 1, 0}), B::reals({1, 1, 0})})}});
    file.add("GeoNormals3s", 13,
             {{"normals", "MFVec3s",
               B::many({B::u16(0) + B::u16(0) + B::u16(32767), B::u16(0) + B::u16(0) + B::u16(0x8001)})}});
    file.add("GeoTexCoords2f", 14,
             {{"TexCoords", "MFVec2f", B::many({B::reals({0, 0}), B::reals({0.5F, 1})})}});
    const std::vector<std::string> tuples = {B::u16(0) + B::u16(0), B::u16(1) + B::u16(0),
                                             B::u16(2) + B::u16(0), B::u16(2) + B::u16(0),
                                             B::u16(1) + B::u16(1), B::u16(3) + B::u16(1)};
    std::string indices;
    for (const std::string& tuple : tuples) indices += tuple;
    file.add("GeoIndicesUI16", 15, {{"indices", "MFUInt16", B::u32(12) + indices}});
    const scene::Scene scene = read_well(file);
    REQUIRE(scene.geometries().size() == 1);
    const scene::Geometry& geometry = scene.geometries()[0];
    CHECK(geometry.triangles == Triangles{{0, 1, 2}, {2, 3, 4}});
    CHECK(geometry.positions ==
          std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}});
    CHECK(geometry.normals[0] == glm::vec3(0, 0, 32767));
    CHECK(geometry.normals[4] == glm::vec3(0, 0, -32767));
    CHECK(geometry.texcoords[3] == glm::vec2(0.5F, 1));
}

TEST_CASE("OSB: hierarchy, names and transforms") {
    B file;
    file.add("Node", 1,
             {{"children", "MFNodePtr", B::ids({2, 3})},
              {"core", "SFNodeCorePtr", B::u32(20)},
              {"attachments", "SFAttachmentMap", B::many({B::u32(30) + B::u16(0)})}});
    file.add("Node", 2, {{"core", "SFNodeCorePtr", B::u32(21)}, {"travMask", "SFUInt32", B::u32(0)}});
    file.node(3, 22, {4}).node(4, 40).geometry(40, {{kTriangles, 3}}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, {});
    file.name(30, "Car");
    file.add("Group", 20);
    file.add("Transform", 21,
             {{"matrix", "SFMatrix", B::reals({1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 5, 6, 7, 1})},
              {"attachments", "SFAttachmentMap", B::ids({31})}});
    file.name(31, "Door");
    file.add("ComponentTransform", 22,
             {{"matrix", "SFMatrix", B::reals({9, 0, 0, 0, 0, 9, 0, 0, 0, 0, 9, 0, 0, 0, 0, 1})},
              {"center", "SFVec3f", B::reals({1, 0, 0})},
              {"rotation", "SFQuaternion", B::reals({0, 0, std::sqrt(0.5F), std::sqrt(0.5F)})},
              {"scale", "SFVec3f", B::reals({2, 2, 2})},
              {"translation", "SFVec3f", B::reals({0, 0, 3})}});
    const scene::Scene scene = read_well(file);
    REQUIRE(scene.nodes().size() == 5);
    CHECK(scene.nodes()[1].name == "Car");
    const scene::Node& door = node_of(scene, "Door");
    CHECK(door.id == 2);
    CHECK_FALSE(door.active);
    CHECK(door.matrix * glm::dvec4(0, 1, 0, 1) == glm::dvec4(5, 6, 8, 1));
    const scene::Node& turned = scene.nodes()[static_cast<std::size_t>(scene.find_node(3))];
    // About (1, 0, 0), by 90 degrees about z and doubled: (2, 0, 0) to (1, 2, 0), and up by 3.
    CHECK(glm::distance(turned.matrix * glm::dvec4(2, 0, 0, 1), glm::dvec4(1, 2, 3, 1)) < 1e-6);
    REQUIRE(turned.children.size() == 1);
    CHECK(scene.nodes()[static_cast<std::size_t>(turned.children[0])].type == scene::NodeType::geometry);
}

TEST_CASE("OSB: nodes that share a core, and geometries that share arrays, share one geometry") {
    B file;
    file.node(1, 0, {2, 3, 4}).node(2, 10).node(3, 10).node(4, 9);
    file.geometry(10, {{kTriangles, 3}}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, {});
    file.add("Geometry", 9,
             {{"types", "SFGeoPTypesPtr", B::u32(11)},
              {"lengths", "SFGeoPLengthsPtr", B::u32(12)},
              {"positions", "SFGeoPositionsPtr", B::u32(13)},
              {"indices", "SFGeoIndicesPtr", B::u32(14)}});
    const scene::Scene scene = read_well(file);
    CHECK(scene.geometries().size() == 1);
    CHECK(scene.triangle_count() == 3);
}

TEST_CASE("OSB: materials, of a geometry or of the topmost group that gives one") {
    B file;
    file.node(1, 20, {2, 3}).node(2, 40).node(3, 21, {4}).node(4, 22, {5}).node(5, 41).add("Group", 20);
    for (const std::uint32_t id : {40U, 41U})
        file.add("Geometry", id,
                 {{"material", "SFMaterialPtr", B::u32(50)},
                  {"types", "SFGeoPTypesPtr", B::u32(61)},
                  {"positions", "SFGeoPositionsPtr", B::u32(63)}});
    file.geometry(60, {{kTriangles, 3}}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, {});
    file.add("MaterialGroup", 21, {{"material", "SFMaterialPtr", B::u32(51)}});
    file.add("MaterialGroup", 22, {{"material", "SFMaterialPtr", B::u32(50)}});
    file.add("SimpleMaterial", 50,
             {{"attachments", "SFAttachmentMap", B::many({B::u32(55) + B::u16(0)})},
              {"ambient", "SFColor3f", B::reals({0.5F, 1, 0})},
              {"diffuse", "SFColor3f", B::reals({0.25F, 0.5F, 0.75F})},
              {"specular", "SFColor3f", B::reals({1, 0.5F, 0})},
              {"emission", "SFColor3f", B::reals({0, 0, 0.5F})},
              {"shininess", "SFReal32", B::f32(20)},
              {"transparency", "SFReal32", B::f32(0.25F)}});
    file.name(55, "Glass");
    file.add("ChunkMaterial", 51, {{"chunks", "MFStateChunkPtr", B::ids({52, 53, 54})}});
    file.add("MaterialChunk", 52,
             {{"diffuse", "SFColor4f", B::reals({1, 0, 0, 0.5F})}, {"lit", "SFBool", B::u8(0)}});
    file.add("PolygonChunk", 53, {{"cullFace", "SFGLenum", B::u32(0x405)}});
    file.add("TextureChunk", 54, {{"image", "SFImagePtr", B::u32(56)}});
    file.add("Image", 56,
             {{"width", "SFInt32", B::u32(1)},
              {"height", "SFInt32", B::u32(2)},
              {"pixelFormat", "SFUInt32", B::u32(0x1907)},
              {"pixel", "MFUInt8", B::u32(6) + std::string("\1\2\3\4\5\6")}});
    const scene::Scene scene = read_well(file);
    REQUIRE(scene.materials().size() == 2);
    const scene::Material& glass = scene.materials()[0];
    CHECK(glass.name == "Glass");
    CHECK(glm::distance(glass.ambient, glm::dvec4(0.1, 0.2, 0, 1)) < 1e-6);
    CHECK(glass.diffuse == glm::dvec4(0.25, 0.5, 0.75, 0.75));
    CHECK(glass.specular == glm::dvec4(1, 0.5, 0, 1));
    CHECK(glass.emission == glm::dvec4(0, 0, 0.5, 1));
    CHECK(glass.shininess == 20);
    CHECK(glass.two_sided);
    const scene::Material& lamp = scene.materials()[1];
    CHECK(lamp.diffuse == glm::dvec4(0, 0, 0, 0.5));
    CHECK(lamp.emission == glm::dvec4(1, 0, 0, 1));
    CHECK_FALSE(lamp.two_sided);
    REQUIRE(lamp.texture == 0);
    CHECK(scene.textures()[0].image.rgba == std::vector<std::uint8_t>{1, 2, 3, 255, 4, 5, 6, 255});
    const auto material_of = [&](scene::Id id) {
        return std::get<scene::GeometryData>(
                   scene.nodes()[static_cast<std::size_t>(scene.find_node(id))].data)
            .material;
    };
    CHECK(material_of(2) == 0);
    CHECK(material_of(5) == 1);
}

TEST_CASE("OSB: switches, levels of detail and lights") {
    B file;
    file.node(1, 20, {2, 3, 4, 5}).node(2, 21, {6, 7}).node(3, 22, {8, 9}).node(4, 23).node(5, 24);
    file.node(6, 0).node(7, 0).node(8, 0).node(9, 0);
    file.add("DirectionalLight", 20,
             {{"beacon", "SFNodePtr", B::u32(4)},
              {"direction", "SFVec3f", B::reals({0, 2, 0})},
              {"diffuse", "SFColor4f", B::reals({1, 0.5F, 0, 1})}});
    file.add("Switch", 21, {{"choice", "SFInt32", B::u32(1)}});
    file.add(
        "DistanceLOD", 22,
        {{"center", "SFPnt3f", B::reals({0, 0, 1})}, {"range", "MFReal32", B::u32(2) + B::reals({10, 20})}});
    file.add("Group", 23);
    file.add("SpotLight", 24,
             {{"on", "SFBool", B::u8(0)},
              {"position", "SFPnt3f", B::reals({1, 2, 3})},
              {"direction", "SFVec3f", B::reals({1, 0, 0})},
              {"spotCutOff", "SFReal32", B::f32(0.5F)},
              {"linearAttenuation", "SFReal32", B::f32(0.25F)}});
    const scene::Scene scene = read_well(file);
    const auto node = [&](scene::Id id) -> const scene::Node& {
        return scene.nodes()[static_cast<std::size_t>(scene.find_node(id))];
    };
    CHECK(std::get<scene::SwitchData>(node(2).data).active_child == 1);
    const scene::Id lod = 5;  // after the switch's two children
    CHECK(std::get<scene::LodData>(node(lod).data).ranges == std::vector<double>{10});
    CHECK(has_notice(scene, "DistanceLOD's center is ignored"));
    std::vector<const scene::Node*> lights;
    for (const scene::Node& each : scene.nodes())
        if (each.type == scene::NodeType::light) lights.push_back(&each);
    REQUIRE(lights.size() == 2);
    const bool sun_first =
        std::get<scene::LightData>(lights[0]->data).type == scene::LightData::Type::directional;
    const scene::Node &sun = *lights[sun_first ? 0 : 1], &spot = *lights[sun_first ? 1 : 0];
    CHECK(scene.nodes()[static_cast<std::size_t>(sun.parent)].id == 8);
    CHECK(glm::distance(glm::dvec3(sun.matrix[2]), glm::dvec3(0, 1, 0)) < 1e-12);
    CHECK(std::get<scene::LightData>(sun.data).color == glm::dvec4(1, 0.5, 0, 1));
    CHECK_FALSE(spot.active);
    CHECK(glm::distance(spot.matrix[3], glm::dvec4(1, 2, 3, 1)) < 1e-12);
    CHECK(glm::distance(glm::dvec3(-spot.matrix[2]), glm::dvec3(1, 0, 0)) < 1e-12);
    CHECK(std::get<scene::LightData>(spot.data).angle == doctest::Approx(glm::degrees(1.0)));
    CHECK(std::get<scene::LightData>(spot.data).attenuation == glm::dvec3(1, 0.25, 0));
}

TEST_CASE("OSB: the pictures that it names lie in its folder") {
    const TemporaryFolder outer;
    const std::string outside = outer.write("secret.png", "no picture").string();
    std::filesystem::create_symlink(outside, outer.write("scenes/x", "").parent_path() / "link.png");
    for (const std::string& name : {std::string("../secret.png"), std::string("link.png"), outside}) {
        B file;
        file.node(1, 10).geometry(20, {{kTriangles, 3}}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, {});
        file.add("Geometry", 10,
                 {{"material", "SFMaterialPtr", B::u32(50)},
                  {"types", "SFGeoPTypesPtr", B::u32(21)},
                  {"positions", "SFGeoPositionsPtr", B::u32(23)}});
        file.add("SimpleTexturedMaterial", 50, {{"image", "SFImagePtr", B::u32(51)}});
        file.add("Image", 51, {{"name", "SFString", B::text(name)}});
        const auto scene = io::read_scene(outer.write("scenes/x.osb", file.bytes()));
        REQUIRE_MESSAGE(scene, scene.error());
        CHECK_MESSAGE(has_notice(*scene, "it lies outside of the scene's folder"), name);
    }
}

TEST_CASE("OSB: a child that the file does not have is left out, and told") {
    const scene::Scene scene = read_well(B().node(1, 0, {2, 3, 9}).node(2, 0).add("Group", 9));
    CHECK(scene.nodes().size() == 3);
    CHECK(has_notice(scene, "a child that is not a Node of the file is ignored (2 times)"));
}

TEST_CASE("OSB: what is not known is skipped and told by its type") {
    B file;
    file.node(1, 20, {2}).node(2, 21);
    file.add("Billboard", 20, {{"axisOfRotation", "SFVec3f", B::reals({0, 1, 0})}});
    file.add("Billboard", 21).add("GenericAtt", 22);
    const scene::Scene scene = read_well(file);
    CHECK(scene.nodes().size() == 3);
    CHECK(has_notice(scene, "x.osb: containers of type 'Billboard' are ignored (2 times)"));
    CHECK(has_notice(scene, "'GenericAtt' are ignored (1 time)"));
}

TEST_CASE("OSB: packed arrays are stepped over, by the size that OpenSG means") {
    B file;
    file.node(1, 10);
    B packed;
    // The size of packed indices leaves out four of their bytes.
    packed.add("Geometry", 10,
               {{"types", "SFGeoPTypesPtr", B::u32(0)}, {"pindices", "PMFUInt8", B::u32(1) + B::u32(2)}});
    std::string bytes = file.node(2, 0).bytes();
    bytes.resize(bytes.size() - B::text("").size());
    std::string hurt = packed.bytes().substr(B::header().size());
    const std::string size = B::u32(8) + B::u32(1);
    hurt.insert(hurt.find(size) + 4, B::u32(7));
    bytes += hurt;
    const auto parts = io::read_osb_parts(bytes, "x.osb");
    REQUIRE_MESSAGE(parts, parts.error());
    CHECK(parts->notices.size() == 2);
}

TEST_CASE("OSB: a malformed file is told in one sentence with its byte") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto matrix = [](std::vector<float> last_column) {
        std::vector<float> all{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
        all.insert(all.end(), last_column.begin(), last_column.end());
        return B().node(1, 2).add("Transform", 2, {{"matrix", "SFMatrix", B::reals(all)}}).bytes();
    };
    const auto points = [](float x) {
        return B().node(1, 10).geometry(10, {{kTriangles, 3}}, {x, 0, 0, 1, 0, 0, 0, 1, 0}, {}).bytes();
    };
    const std::string whole = one_geometry({{kTriangles, 3}}).bytes();
    B many_fields;
    many_fields.add("Node", 1, std::vector<B::Field>(300, {"a", "b", ""}));
    const struct {
        const char* what;
        std::string bytes, error;
    } cases[] = {
        {"empty", "", "x.osb: at byte 0: expected 'OpenSG binary V1.0', found the file's end"},
        {"another format", std::string(100, 'x'),
         "x.osb: at byte 0: expected 'OpenSG binary V1.0', found something else"},
        {"another version", B::text("OpenSG binary V2.0") + std::string(30, '\0'),
         "found 'OpenSG binary V2.0'"},
        {"no end", whole.substr(0, whole.size() - 5),
         "expected a type of container of 4 bytes, found 0 that are left"},
        {"cut in a field", whole.substr(0, 90), "x.osb: at byte "},
        {"a string beyond the end", B::header() + B::u32(0xFFFFFFFF) + "Node",
         "of 4294967295 bytes, found 4"},
        {"no node first", B().add("Group", 1).bytes(), "expected a Node first, found 'Group'"},
        {"an id twice", B().node(1, 0).node(1, 0).bytes(),
         "expected an id that no other container has, found 1"},
        {"id 0", B().node(0, 0).bytes(), "found 0"},
        {"its own child", B().node(1, 0, {1}).bytes(), "a child with one parent, found node 1 again"},
        {"a cycle", B().node(1, 0, {2}).node(2, 0, {3}).node(3, 0, {2}).bytes(), "node 2 again"},
        {"two parents", B().node(1, 0, {2, 3}).node(2, 0, {3}).node(3, 0).bytes(), "node 3 again"},
        {"an index", one_geometry({{kTriangles, 3}}, {0, 1, 6}).bytes(),
         "expected an index below 6, found 6"},
        {"a length", one_geometry({{kTriangles, 7}}).bytes(), "a primitive of at most 6 vertices, found 7"},
        {"a type", one_geometry({{10, 3}}).bytes(), "types of primitives from 0 to 9, found 10"},
        {"NaN", points(nan), "expected a coordinate from -1e15 to 1e15, found nan"},
        {"far away", points(1e20F), "found 1e+20"},
        {"a matrix's last row", matrix({0, 0, 0, 2}), "a matrix whose last row is 0 0 0 1"},
        {"a matrix of NaN", matrix({nan, 0, 0, 1}), "a matrix element from -1e15 to 1e15, found nan"},
        {"a count", B().add("Node", 1, {{"children", "MFNodePtr", B::u32(1000)}}).bytes(),
         "expected a count of at most 0, found 1000"},
        {"a short field", B().node(1, 2).add("Switch", 2, {{"choice", "SFInt32", "ab"}}).bytes(),
         "expected choice of 4 bytes, found 2 that are left"},
        {"too many fields", many_fields.bytes(), "expected at most 256 fields, found one more"},
    };
    for (const auto& row : cases) {
        CAPTURE(row.what);
        const std::string found = error_of(row.bytes);
        CHECK_MESSAGE(found.find(row.error) != std::string::npos, found);
        CHECK(found.starts_with("x.osb: at byte "));
        CHECK(found.find('\n') == std::string::npos);
    }
}

TEST_CASE("OSB: every beginning of a file is refused") {
    const std::string whole = one_geometry({{kStrip, 6}}).bytes();
    for (std::size_t size = 0; size < whole.size(); ++size)
        CHECK_FALSE(error_of(whole.substr(0, size)).empty());
}

TEST_CASE("OSB: arrays shared beyond measure are refused, and not multiplied") {
    B file;
    std::vector<std::uint32_t> children;
    for (std::uint32_t i = 0; i < 300; ++i) children.push_back(1000 + i);
    file.node(1, 0, children);
    // Each geometry has a mapping of its own, so that none is like another.
    for (std::uint32_t i = 0; i < 300; ++i) {
        file.node(1000 + i, 2000 + i);
        file.add("Geometry", 2000 + i,
                 {{"types", "SFGeoPTypesPtr", B::u32(11)},
                  {"positions", "SFGeoPositionsPtr", B::u32(13)},
                  {"normals", "SFGeoNormalsPtr", B::u32(9000 + i)}});
    }
    file.geometry(10, {{kStrip, 3000}}, std::vector<float>(9000, 0.5F), {});
    CHECK(error_of(file.bytes()).find("by arrays that they share") != std::string::npos);
}

TEST_CASE("OSB: a chain of many nodes needs no stack") {
    B file;
    constexpr std::uint32_t kNodes = 20'000;
    for (std::uint32_t i = 1; i < kNodes; ++i) file.node(i, 0, {i + 1});
    CHECK(read_well(file.node(kNodes, 0)).nodes().size() == kNodes + 1);
}

TEST_CASE("OSB: the sample of OpenSG" * NeedsFolder{"VRUT_TEST_MODELS"}) {
    const auto scene = io::read_scene(folder_of("VRUT_TEST_MODELS") / "osb" / "few_cubes.osb");
    REQUIRE_MESSAGE(scene, scene.error());
    CHECK(scene->nodes().size() == 10);
    CHECK(scene->geometries().size() == 8);
    CHECK(scene->materials().size() == 1);
    CHECK(scene->geometries()[0].positions.size() == 1734);
    CHECK(scene->triangle_count() == 8 * 96 * 32);  // 96 strips of 34 vertices
    CHECK(scene->notices().empty());
    const math::Bounds bounds = scene::place(*scene).bounds;
    CHECK(glm::distance(bounds.min, glm::dvec3(-2.7, -2.7, -2.7)) < 1e-5);
}

TEST_CASE("CSB is refused with the reason") {
    const TemporaryFolder folder;
    const auto scene = io::read_scene(folder.write("car.CSB", "anything"));
    REQUIRE_FALSE(scene);
    CHECK(scene.error().find("the CSB format is not supported") != std::string::npos);
}
