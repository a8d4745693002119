#include "io/vrut/text_reader.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "base/utf8.hpp"
#include "contains.hpp"

using namespace vrut;

namespace {

constexpr std::string_view kFull = R"(vrut-text 1
unit 0.001                        # metres per unit
# A comment with "quotes", \escapes and the word end
material 3 "Paint \"red\" \\ #1"
  ambient 0.02 0.01 0 1   diffuse 0.6 0.02 0.03 0.5   specular 0.8 0.7 0.6 1   emission 0.1 0.2 0.3 1
  shininess 64   reflectivity 0.25   two-sided 1
  emissive 0.5 0 2   emissive-image "textures/glow.png"
  metallic-roughness 0.25 0.5   clear-coat 0.75   occlusion-roughness-metallic-image "textures/worn.png"
  normal-image "textures/leather.png"   normal-scale 0.5
  image "textures/plate.png"   image-wrap mirror clamp   image-magnification nearest
end
geometry 7
  triangles 2  0 1 2  2 1 3
  vertices 4   0 0 0  1 0 0  0 1 0  1 +1 -2.5e-1
  normals 4    0 0 1  0 0 1  0 0 1  0 1 0
  texcoords 4  0 0  1 0  0 1  1.5 -2
  colors 4     1 0 0  0 0.5 0  0 0 1  1 1 1
end
node 4 "Body" assembly
  parent 0   active 0
  matrix 1 2 3 4  5 6 7 8  9 10 11 12  0 0 0 1
end
node 0 "Estate" root end
node 5 "Door" geometry   parent 4   geometry 7   hinge 0 2 0 -65.5   material 3   end
node 6 "Presenter" camera parent 0   eye 3 1 4   focus 0 0.7 0.5   up 1 2 3   fov 41   look 0.75   end
node 8 "Lamp" light      parent 0   type spot   color 0.1 0.2 0.3 1   attenuation 4 5 6   angle 33   end
node 9 "Wheels" switch   parent 4   active-child -2   end
node 10 "Far or near" lod parent 4  ranges 10 40.5   end
node 11 "Studio" background parent 0   material 12   end
node 13 "Sky" background material 12 cube-map "px.png" "nx.png" "py.png" "ny.png" "pz.png" "nz.png"   only-reflected 1   end
node 14 "Horn" sound parent 9 end
material 12 "Grey" end
)";

io::ReadResult read(const std::string& text) { return io::read_vrut_text(text, "folder/car.vrut"); }

scene::Scene read_well(const std::string& text) {
    auto scene = read(text);
    REQUIRE_MESSAGE(scene, scene.error());
    return *std::move(scene);
}

const scene::Node& node_of(const scene::Scene& scene, scene::Id id) {
    const scene::Index index = scene.find_node(id);
    REQUIRE(index != scene::kNone);
    return scene.nodes()[static_cast<std::size_t>(index)];
}

template <class Data>
const Data& data_of(const scene::Scene& scene, scene::Id id) {
    const auto* data = std::get_if<Data>(&node_of(scene, id).data);
    REQUIRE(data);
    return *data;
}

std::string repeated(const std::string& text, int count) {
    std::string result;
    for (int i = 0; i < count; ++i) result += text;
    return result;
}

}  // namespace

TEST_CASE("materials, geometries and the file's own facts") {
    const scene::Scene scene = read_well(std::string(kFull));
    CHECK(scene.name() == "car");
    CHECK(scene.unit() == 0.001);
    REQUIRE(scene.materials().size() == 2);
    const scene::Material& paint = scene.materials()[0];
    CHECK(paint.id == 3);
    CHECK(paint.name == R"(Paint "red" \ #1)");
    CHECK(paint.ambient == glm::dvec4(0.02, 0.01, 0, 1));
    CHECK(paint.diffuse == glm::dvec4(0.6, 0.02, 0.03, 0.5));
    CHECK(paint.specular == glm::dvec4(0.8, 0.7, 0.6, 1));
    CHECK(paint.emission == glm::dvec4(0.1, 0.2, 0.3, 1));
    CHECK(paint.shininess == 64);
    CHECK(paint.reflectivity == 0.25);
    CHECK(paint.two_sided);
    CHECK(paint.image == "textures/plate.png");
    CHECK(paint.emissive == glm::dvec3(0.5, 0, 2));
    CHECK(paint.emissive_image == "textures/glow.png");
    CHECK(paint.metallic_roughness == scene::MetallicRoughness{0.25, 0.5, 0.75});
    CHECK(paint.occlusion_roughness_metallic_image == "textures/worn.png");
    CHECK(paint.normal_image == "textures/leather.png");
    CHECK(paint.normal_scale == 0.5);
    CHECK(paint.sampler ==
          scene::Sampler{{scene::Wrap::mirror, scene::Wrap::clamp}, scene::Magnification::nearest});
    const scene::Material& grey = scene.materials()[1];
    CHECK(grey.sampler == scene::Sampler());
    CHECK(grey.ambient == glm::dvec4(0, 0, 0, 1));
    CHECK(grey.diffuse == glm::dvec4(0.8, 0.8, 0.8, 1));
    CHECK(grey.shininess == 0);
    CHECK_FALSE(grey.two_sided);
    CHECK(grey.image.empty());

    REQUIRE(scene.geometries().size() == 1);
    const scene::Geometry& geometry = scene.geometries()[0];
    CHECK(geometry.id == 7);
    CHECK(geometry.positions == std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, -0.25}});
    CHECK(geometry.normals == std::vector<glm::vec3>{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 1, 0}});
    CHECK(geometry.texcoords == std::vector<glm::vec2>{{0, 0}, {1, 0}, {0, 1}, {1.5, -2}});
    CHECK(geometry.colors == std::vector<glm::vec3>{{1, 0, 0}, {0, 0.5, 0}, {0, 0, 1}, {1, 1, 1}});
    CHECK(geometry.triangles == std::vector<glm::uvec3>{{0, 1, 2}, {2, 1, 3}});
    CHECK(geometry.bounds.min == glm::dvec3(0, 0, -0.25));
    CHECK(geometry.bounds.max == glm::dvec3(1, 1, 0));
}

TEST_CASE("whole numbers are taken off texture coordinates before they become float") {
    const auto texcoords = [](const std::string& given) {
        const scene::Scene scene =
            read_well("vrut-text 1 geometry 1 vertices 3 0 0 0 1 0 0 0 1 0 texcoords 3 " + given +
                      " triangles 1 0 1 2 end");
        return scene.geometries()[0].texcoords;
    };
    const std::vector<glm::vec2> wanted{{0.3F, 0.1F}, {1.3F, 0.1F}, {0.3F, 0.7F}};
    for (const double whole : {3.0, 100'000.0, 1e9}) {
        CAPTURE(whole);
        const auto number = [&](double part, double sign) { return std::to_string(sign * whole + part); };
        const std::vector<glm::vec2> found =
            texcoords(number(0.3, 1) + " " + number(0.1, -1) + " " + number(1.3, 1) + " " + number(0.1, -1) +
                      " " + number(0.3, 1) + " " + number(0.7, -1));
        for (std::size_t i = 0; i < 3; ++i) CHECK(glm::distance(found[i], wanted[i]) < 2e-7);
    }
    // What is near 0 stays, and so does what reaches around it.
    CHECK(texcoords("0 0 1 0.25 1 1.5") == std::vector<glm::vec2>{{0, 0}, {1, 0.25F}, {1, 1.5F}});
    CHECK(texcoords("0 0 4 0 4 100000") == std::vector<glm::vec2>{{0, 0}, {4, 0}, {4, 100'000}});
}

TEST_CASE("nodes of every type") {
    const scene::Scene scene = read_well(std::string(kFull));
    REQUIRE(scene.nodes().size() == 10);
    CHECK(scene.nodes()[0].name == "Estate");

    const scene::Node& body = node_of(scene, 4);
    CHECK(body.name == "Body");
    CHECK(body.type == scene::NodeType::assembly);
    CHECK_FALSE(body.active);
    CHECK(body.matrix * glm::dvec4(1, 10, 100, 1) == glm::dvec4(325, 773, 1221, 1));
    CHECK_FALSE(body.hinge);
    CHECK(node_of(scene, 5).hinge == scene::Hinge{{0, 2, 0}, -65.5});
    const auto child_ids = [&] {
        std::vector<scene::Id> ids;
        for (const scene::Index child : body.children)
            ids.push_back(scene.nodes()[static_cast<std::size_t>(child)].id);
        return ids;
    };
    CHECK(child_ids() == std::vector<scene::Id>{5, 9, 10});

    CHECK(node_of(scene, 5).active);
    CHECK(node_of(scene, 5).matrix == glm::dmat4(1));
    CHECK(data_of<scene::GeometryData>(scene, 5).geometry == 0);
    CHECK(data_of<scene::GeometryData>(scene, 5).material == 0);
    const auto& camera = data_of<scene::CameraData>(scene, 6);
    CHECK(camera.eye == glm::dvec3(3, 1, 4));
    CHECK(camera.focus == glm::dvec3(0, 0.7, 0.5));
    CHECK(camera.up == glm::dvec3(1, 2, 3));
    CHECK(camera.fov == 41);
    CHECK(camera.look_radius == 0.75);
    const auto& light = data_of<scene::LightData>(scene, 8);
    CHECK(light.type == scene::LightData::Type::spot);
    CHECK(light.color == glm::dvec4(0.1, 0.2, 0.3, 1));
    CHECK(light.attenuation == glm::dvec3(4, 5, 6));
    CHECK(light.angle == 33);
    CHECK(data_of<scene::SwitchData>(scene, 9).active_child == -2);
    CHECK(data_of<scene::LodData>(scene, 10).ranges == std::vector<double>{10, 40.5});
    CHECK(data_of<scene::BackgroundData>(scene, 11).material == 1);
    CHECK_FALSE(data_of<scene::BackgroundData>(scene, 11).cube_map);
    const auto& sky = data_of<scene::BackgroundData>(scene, 13);
    REQUIRE(sky.cube_map);
    CHECK(sky.only_reflected);
    CHECK_FALSE(data_of<scene::BackgroundData>(scene, 11).only_reflected);
    CHECK(*sky.cube_map ==
          std::array<std::string, 6>{"px.png", "nx.png", "py.png", "ny.png", "pz.png", "nz.png"});
    CHECK(node_of(scene, 13).parent == 0);
    CHECK(node_of(scene, 14).type == scene::NodeType::sound);
    CHECK(node_of(scene, node_of(scene, 14).id).parent == scene.find_node(9));
    CHECK(scene.notices() ==
          std::vector<std::string>{"folder/car.vrut:31: node 14 is a sound and was kept as a group"});
}

TEST_CASE("what a node leaves out") {
    const scene::Scene scene = read_well(
        "vrut-text 1 node 1 \"\" geometry end node 2 \"\" camera end node 3 \"\" light end node 4 \"\" "
        "switch end "
        "node 5 \"\" lod end node 6 \"\" background end");
    CHECK_FALSE(scene.unit());
    CHECK(data_of<scene::GeometryData>(scene, 1).geometry == scene::kNone);
    CHECK(data_of<scene::GeometryData>(scene, 1).material == scene::kNone);
    const auto& camera = data_of<scene::CameraData>(scene, 2);
    CHECK(camera.eye == glm::dvec3(0));
    CHECK(camera.focus == glm::dvec3(0, 0, -1));
    CHECK(camera.up == glm::dvec3(0, 1, 0));
    CHECK(camera.fov == 40);
    CHECK(camera.look_radius == 0);
    const auto& light = data_of<scene::LightData>(scene, 3);
    CHECK(light.type == scene::LightData::Type::point);
    CHECK(light.color == glm::dvec4(1));
    CHECK(light.attenuation == glm::dvec3(1, 0, 0));
    CHECK(light.angle == 90);
    CHECK(data_of<scene::SwitchData>(scene, 4).active_child == 0);
    CHECK(data_of<scene::LodData>(scene, 5).ranges.empty());
    CHECK(data_of<scene::BackgroundData>(scene, 6).material == scene::kNone);
}

TEST_CASE("a hinge's axis may have any length but none, and has one direction") {
    const scene::Scene scene = read_well(
        "vrut-text 1 node 1 \"\" assembly hinge 0 0 -1e15 360 end node 2 \"\" geometry hinge 3e-300 0 4e-300 "
        "-360 end "
        "node 3 \"\" assembly hinge 1 0 0 0 end");
    CHECK(scene::unit_axis(*node_of(scene, 1).hinge) == glm::dvec3(0, 0, -1));
    CHECK(glm::distance(scene::unit_axis(*node_of(scene, 2).hinge), glm::dvec3(0.6, 0, 0.8)) < 1e-15);
    CHECK(node_of(scene, 3).hinge->degrees == 0);
}

TEST_CASE("VRUT's numbers stand for its node types") {
    const scene::NodeType types[] = {
        scene::NodeType::assembly, scene::NodeType::root,       scene::NodeType::camera,
        scene::NodeType::geometry, scene::NodeType::light,      scene::NodeType::lod,
        scene::NodeType::switch_,  scene::NodeType::background, scene::NodeType::sound};
    const char* keywords[] = {"assembly", "root",   "camera",     "geometry", "light",
                              "lod",      "switch", "background", "sound"};
    for (int number = 0; number < 9; ++number) {
        const std::string id = number == 1 ? "0" : "5";
        const auto read_type = [&](const std::string& type) {
            return node_of(read_well("vrut-text 1 node " + id + " \"\" " + type + " end"), std::stoi(id))
                .type;
        };
        CHECK(read_type(std::to_string(number)) == types[number]);
        CHECK(read_type(keywords[number]) == types[number]);
        CHECK(scene::name_of(types[number]) == keywords[number]);
    }
}

TEST_CASE("numbers") {
    const auto up_of = [](const std::string& number) {
        const scene::Scene scene = read_well("vrut-text 1 node 1 \"\" camera up " + number + " 0 1 end");
        return data_of<scene::CameraData>(scene, 1).up.x;
    };
    CHECK(up_of("+5") == 5);
    CHECK(up_of("-.5") == -0.5);
    CHECK(up_of("5.") == 5);
    CHECK(up_of("1e3") == 1000);
    CHECK(up_of("12.5E-1") == 1.25);
    CHECK(up_of("0.1") == 0.1);
    CHECK(up_of("-0") == 0);
    CHECK(up_of("4.9406564584124654e-324") == 4.9406564584124654e-324);
    CHECK(up_of("0.30000000000000004") == 0.30000000000000004);
    // A light may be brighter than 1.
    const scene::Scene lamp = read_well("vrut-text 1 node 1 \"\" light color 1.5 200 0 1 end");
    CHECK(data_of<scene::LightData>(lamp, 1).color == glm::dvec4(1.5, 200, 0, 1));
}

TEST_CASE("lines may end as on Windows, and blocks may stand on one") {
    const scene::Scene scene =
        read_well("vrut-text 1\r\nmaterial 1 \"M\"\r\n # comment\r\n end\r\nnode 1 \"N\" 0 end");
    CHECK(scene.materials()[0].name == "M");
    const auto error = read("vrut-text 1\r\nmaterial 1 \"M\"\r\n shine");
    REQUIRE_FALSE(error);
    CHECK(contains(error.error(), ":3: "));
    CHECK(read_well("vrut-text 1# no space\nnode 1\"N\"assembly end#").nodes().size() == 2);
    CHECK(read_well("vrut-text 1").nodes().size() == 1);
}

TEST_CASE("unknown members are skipped with a notice") {
    const scene::Scene scene = read_well(
        "vrut-text 1\n"
        "material 1 \"M\"\n"
        "  gloss fancy 1 -2.5 \"end\" diffusive   shininess 7\n"
        "  layers 3\n"
        "end\n"
        "node 1 \"N\" assembly mass 12 parent 0\n"
        "  eye 1 2 3 end\n");
    CHECK(scene.materials()[0].shininess == 7);
    CHECK(scene.nodes().size() == 2);
    REQUIRE(scene.notices().size() == 4);
    const struct {
        const char *place, *member, *block;
    } expected[] = {{"folder/car.vrut:3: ", "'gloss'", "material 1"},
                    {"folder/car.vrut:4: ", "'layers'", "material 1"},
                    {"folder/car.vrut:6: ", "'mass'", "node 1"},
                    {"folder/car.vrut:7: ", "'eye'", "node 1"}};
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK_MESSAGE(scene.notices()[i].starts_with(expected[i].place), scene.notices()[i]);
        CHECK_MESSAGE(contains(scene.notices()[i], expected[i].member), scene.notices()[i]);
        CHECK_MESSAGE(contains(scene.notices()[i], expected[i].block), scene.notices()[i]);
    }
}

TEST_CASE("notices are few, short and valid UTF-8") {
    std::string text = "vrut-text 1\n";
    for (int i = 0; i < 500; ++i)
        text += "material " + std::to_string(i) + " \"\" " +
                std::string(static_cast<std::size_t>(i % 4), 'a') + repeated("é", 1000) + " 1 end\n";
    const scene::Scene noisy = read_well(text);
    REQUIRE(noisy.notices().size() <= 50);
    std::size_t told = noisy.notices().size() - 1;
    CHECK_MESSAGE(contains(noisy.notices().back(), std::to_string(500 - told) + " more"),
                  noisy.notices().back());
    for (const std::string& notice : noisy.notices()) {
        CHECK(base::find_invalid_utf8(notice) == std::string_view::npos);
        CHECK(notice.size() < 200);
    }
}

TEST_CASE("what is malformed is refused with file, line and what was expected") {
    struct Case {
        std::string text;
        int line;
        std::string sentence;  // a part of it
    };
    const std::string h = "vrut-text 1\n";
    const std::string triangle = "geometry 1 vertices 3 0 0 0 1 0 0 0 1 0 triangles 1 0 1 2 end\n";
    const std::vector<Case> cases{
        // --- the header and the blocks
        {"", 1, "'vrut-text 1'"},
        {"\n\nmaterial 1 \"x\" end", 3, "'vrut-text 1'"},
        {"{\"scene\": 1}", 1, "'vrut-text 1'"},
        {"vrut-text\n2\n", 2, "version 1 of vrut-text, found '2'"},
        {"vrut-text", 1, "version 1 of vrut-text, found the end of the file"},
        {h + "mesh 1 end", 2, "'unit', 'material', 'geometry' or 'node', found 'mesh'"},
        {h + "\n17", 3, "'unit', 'material', 'geometry' or 'node', found '17'"},
        {h + "unit 0", 2, "metres per unit"},
        {h + "unit -1", 2, "metres per unit"},
        {h + "unit\nend", 3, "metres per unit"},
        {h + "node 1 \"x\" assembly\n", 3, "a member of node 1 or 'end', found the end of the file"},
        {h + "node 1 \"x\" assembly\nparent 0\n\"end\"", 4, "a member of node 1 or 'end', found \"end\""},
        {h + "material 1 \"x\"\ngloss 1\n", 4, "'end' of material 1, found the end of the file"},
        {h + "material \"x\" 1 end", 2,
         "the material's id (an integer from 0 to 9007199254740991), found \"x\""},
        {h + "material 1.5 \"x\" end", 2, "the material's id"},
        {h + "material -1 \"x\" end", 2, "the material's id"},
        {h + "material 9007199254740992 \"x\" end", 2, "the material's id"},
        {h + "material 1 \"x\" image-wrap clamp tile end", 2,
         "expected repeat, mirror or clamp, found 'tile'"},
        {h + "material 1 \"x\" image-magnification sharp end", 2,
         "expected linear or nearest, found 'sharp'"},
        {h + "material 1 x end", 2, "the material's name in quotes, found 'x'"},
        {h + "material 1 \"x\" shininess 1\nshininess 2 end", 3, "'shininess' once in material 1"},
        {h + "material 1 \"x\" end\nmaterial 1 \"y\" end", 3, "each material once, found 1 twice"},
        {h + triangle + triangle, 3, "each geometry once, found 1 twice"},
        // --- tokens
        {h + "material 1 \"x\\n\" end", 2, "\\\" or \\\\"},
        {h + "material 1\n\"x", 3, "\" before the end of the file"},
        {h + "material 1 \"x\nend\"", 2, "\" before the end of the line"},
        {h + "material 1 \"x\\", 2, "\\\" or \\\\"},
        {h + "material 1 \"x\"\nshininess 1.2.3 end", 3, "a number, found '1.2.3'"},
        {h + "material 1 \"x\"\nshininess 0x10 end", 3, "a number, found '0x10'"},
        {h + "material 1 \"x\"\nshininess 1,5 end", 3, "a number, found '1,5'"},
        {h + "material 1 \"x\"\nshininess +-5 end", 3, "a number, found '+-5'"},
        {h + "material 1 \"x\"\nshininess ++5 end", 3, "a number, found '++5'"},
        {h + "material 1 \"x\"\nshininess - end", 3, "a number, found '-'"},
        {h + "material 1 \"x\"\nshininess 1e999 end", 3, "a number in the range of double, found '1e999'"},
        {h + "material 1 \"x\"\nshininess 1e-999 end", 3, "a number in the range of double, found '1e-999'"},
        {h + "material 1 \"x\"\nshininess -inf end", 3, "a number, found '-inf'"},
        {h + "material 1 \"" + std::string(65536, 'x') + "\" end", 2,
         "of at most 65535 bytes, found a longer one"},
        {h + std::string(65536, 'x'), 2, "of at most 65535 bytes"},
        {h + "unit\n0." + std::string(65536, '0'), 3, "of at most 65535 bytes"},
        {h + "material 1 \"x\xC3\x28\" end", 2, "UTF-8"},
        {h + "unit 0\n# \xFF\n", 2, "metres per unit"},
        {h + "# comment\n# \xFF\n", 3, "UTF-8"},
        // --- materials
        {h + "material 1 \"x\"\nshininess nan end", 3, "shininess (a number from 0 to 10000), found 'nan'"},
        {h + "material 1 \"x\"\nshininess inf end", 3, "shininess (a number from 0 to 10000), found 'inf'"},
        {h + "material 1 \"x\"\nshininess\n10001 end", 4,
         "shininess (a number from 0 to 10000), found '10001'"},
        {h + "material 1 \"x\"\nshininess -1 end", 3, "shininess"},
        {h + "material 1 \"x\"\nreflectivity 2 end", 3, "reflectivity (a number from 0 to 1), found '2'"},
        {h + "material 1 \"x\"\ntwo-sided 2 end", 3, "two-sided (an integer from 0 to 1), found '2'"},
        {h + "material 1 \"x\"\ntwo-sided yes end", 3, "two-sided (an integer from 0 to 1), found 'yes'"},
        {h + "material 1 \"x\"\ndiffuse 1 1 1\nend", 4,
         "diffuse's alpha (a number from 0 to 1), found 'end'"},
        {h + "material 1 \"x\"\nambient 0 -0.1 0 1 end", 3, "ambient"},
        {h + "material 1 \"x\"\nambient 0 0 0 1.1 end", 3, "ambient's alpha"},
        {h + "material 1 \"x\"\ndiffuse 0 0 0 -0.1 end", 3,
         "diffuse's alpha (a number from 0 to 1), found '-0.1'"},
        {h + "material 1 \"x\"\nimage plate.png end", 3, "the image's file in quotes, found 'plate.png'"},
        // --- geometries
        {h + "geometry 1\nvertices 4000000000 0 0 0 end", 3, "a count of vertices that fits into the file"},
        {h + "geometry 1\nvertices -1 end", 3, "a count of vertices"},
        {h + "geometry 1\nvertices 2.5 end", 3, "a count of vertices"},
        {h + "geometry 1\nvertices 2 0 0 0\n1 0\nend", 5, "a vertex coordinate"},
        {h + "geometry 1\nvertices 1 0 1e16 0 end", 3, "a vertex coordinate"},
        {h + "geometry 1 vertices 3 0 0 0 1 0 0\n0", 2,
         "a count of vertices that fits into the file, found 3"},
        {h + "geometry 1 vertices 2 0.5 0.5 0.5\n0.5 0.5", 3, "a vertex coordinate (a number from -1e+15"},
        {h + "geometry 1 vertices 3 0 0 0 1 0 0 0 1 0\ntriangles 1\n0 1 3\nend", 3,
         "vertex indices below 3 in geometry 1, found 3"},
        {h + "geometry 1 vertices 3 0 0 0 1 0 0 0 1 0\ntriangles 1 0 1 -1\nend", 3, "a vertex index"},
        {h + "geometry 1\ntriangles 1 0 0 0 end", 3, "vertex indices below 0"},
        {h + "geometry 1 vertices 1 0 0 0\nnormals 2\n0 0 1 0 0 1\nend", 3,
         "as many normals as vertices (1), found 2"},
        {h + "geometry 1\ntexcoords 1 0 0 vertices 2 0 0 0 1 1 1\nend", 3,
         "as many texture coordinates as vertices (2), found 1"},
        {h + "geometry 1\ncolors 1 0 0 1 vertices 2 0 0 0 1 1 1\nend", 3,
         "as many colours as vertices (2), found 1"},
        {h + "geometry 1 vertices 1 0 0 0\ncolors 1 0 1.5 0 end", 3, "a colour"},
        // --- nodes
        {h + "node 1 \"x\"\ncar end", 3, "a node type (assembly, root, camera,"},
        {h + "node 1 \"x\" 9 end", 2, "a node type"},
        {h + "node 1 \"x\" 2.5 end", 2, "a node type"},
        {h + "\nnode 1 \"x\" geometry\ngeometry 5\nend", 3, "geometry 5 of node 1 in the file, found none"},
        {h + "\nnode 1 \"x\" geometry\nmaterial 5\nend", 3, "material 5 of node 1 in the file, found none"},
        {h + "\nnode 1 \"x\" background\nmaterial 5\nend", 3, "material 5 of node 1 in the file, found none"},
        {h + "\nnode 1 \"x\" light\ntype neon\nend", 4, "point, directional or spot, found 'neon'"},
        {h + "node 1 \"x\" light\nattenuation 1 -0.1 0\nend", 3, "attenuation (a number from 0"},
        {h + "node 1 \"x\" light\nangle 181\nend", 3, "angle (a number from 0 to 180), found '181'"},
        {h + "node 1 \"x\" light\nangle -1\nend", 3, "angle (a number from 0 to 180), found '-1'"},
        {h + "node 1 \"x\" light\ncolor 1 -0.1 1 1\nend", 3, "color (a number from 0"},
        {h + "node 1 \"x\" light\ncolor 1 1 1 1.1\nend", 3,
         "color's alpha (a number from 0 to 1), found '1.1'"},
        {h + "node 1 \"x\" camera\nfov 171\nend", 3, "fov (a number from 1 to 170), found '171'"},
        {h + "node 1 \"x\" camera\nfov 0.5\nend", 3, "fov"},
        {h + "node 1 \"x\" camera\nlook -1\nend", 3, "the radius of looking around"},
        {h + "node 1 \"x\" switch\nactive-child -3 end", 3, "active-child"},
        {h + "node 1 \"x\" switch\nactive-child 0.5 end", 3, "active-child"},
        {h + "node 1 \"x\" lod\nranges 10 -4 end", 3, "a range"},
        {h + "node 1 \"x\" background\ncube-map \"1\" \"2\" \"3\" \"4\" \"5\"\nend", 4,
         "a cube map's image in quotes, found 'end'"},
        {h + "node 1 \"x\" assembly\nactive 1 2 end", 3, "a member of node 1 or 'end', found '2'"},
        {h + "node 1 \"x\" assembly\nmatrix 1 0 0 0 0 1 0 0 0 0 1 0\n0 0 0 2\n\nend", 4,
         "0 0 0 1 as the matrix's last row"},
        {h + "node 1 \"x\" assembly\nmatrix 1 0 0 0 0 1 0 0 0 0 1 0\nend", 4, "a matrix element"},
        {h + "node 1 \"x\" assembly\nhinge 0\n0 0 65 end", 3, "a hinge's axis that is not zero, found 0 0 0"},
        {h + "node 1 \"x\" assembly\nhinge 0 1e16 0 65 end", 3, "the hinge's axis"},
        {h + "node 1 \"x\" assembly\nhinge 0 nan 0 65 end", 3, "the hinge's axis"},
        {h + "node 1 \"x\" assembly\nhinge 0 1 0 end", 3,
         "the hinge's degrees (a number from -360 to 360), found 'end'"},
        {h + "node 1 \"x\" geometry\nhinge 0 1 0 360.5 end", 3,
         "the hinge's degrees (a number from -360 to 360), found '360.5'"},
        {h + "node 1 \"x\" geometry\nhinge 0 1 0 -361 end", 3, "the hinge's degrees"},
        {h + "node 1 \"x\" geometry\nhinge 0 1 0 inf end", 3, "the hinge's degrees"},
        {h + "node 1 \"x\" geometry\nhinge 0 1 0 5 hinge 0 1 0 5 end", 3, "'hinge' once in node 1"},
        {h + "node 1 \"x\" assembly\npresentation 2 end", 3, "presentation"},
        // --- the tree
        {h + "node 1 \"x\" assembly end\n\nnode 1 \"y\" assembly end", 4, "each node once, found 1 twice"},
        {h + "node 1 \"x\" assembly end\nnode 2 \"x\" assembly\nparent 7 end", 3,
         "parent 7 of node 2 in the file"},
        {h + "node 1 \"x\" assembly end\nnode 2 \"x\" assembly\nparent 2 end", 3, "among its own ancestors"},
        {h + "node 9 \"x\" 0 parent 3 end\nnode 2 \"x\" 0 parent 3 end\nnode 3 \"x\" 0 parent 2 end", 4,
         "node 3 below the root, found it among its own ancestors"},
        {h + "node 2 \"x\" assembly end\nnode 0 \"x\" assembly end", 3, "id 0 for the root"},
        {h + "node 2 \"x\" assembly end\nnode 1 \"x\" root end", 3, "id 0 for the root"},
    };
    for (const Case& c : cases) {
        CAPTURE(c.text);
        const auto result = read(c.text);
        REQUIRE_FALSE(result);
        const std::string start = "folder/car.vrut:" + std::to_string(c.line) + ": expected ";
        CHECK_MESSAGE(result.error().starts_with(start), result.error());
        CHECK_MESSAGE(contains(result.error(), c.sentence), result.error());
    }
}

TEST_CASE("sentences repeat little of the file, and as valid UTF-8") {
    for (int ascii = 0; ascii < 4; ++ascii) {
        const std::string word = std::string(static_cast<std::size_t>(ascii), 'a') + repeated("é", 100);
        for (const std::string& text :
             {word, "vrut-text 1 " + word, "vrut-text 1 unit " + word, "vrut-text 1 unit \"" + word + "\"",
              "vrut-text 1 unit 1" + word, "vrut-text 1 node 1 \"\" light type " + word,
              "vrut-text 1 node 1 \"\" " + word}) {
            const auto result = read(text);
            REQUIRE_FALSE(result);
            CHECK(result.error().size() < 200);
            CHECK_MESSAGE(base::find_invalid_utf8(result.error()) == std::string_view::npos, result.error());
        }
        // As much of it as fits is shown.
        CHECK(contains(read("vrut-text 1 unit " + word).error(),
                       word.substr(0, static_cast<std::size_t>(38 + ascii % 2))));
    }
    const auto control = read(std::string("vrut-text 1 unit a\0b\x01", 20));
    REQUIRE_FALSE(control);
    CHECK(control.error().find('\0') == std::string::npos);
    CHECK(control.error().find('\x01') == std::string::npos);
}

TEST_CASE("a text cut off anywhere, or with any byte replaced, gives a scene or a sentence") {
    const auto check = [](const std::string& text) {
        const auto result = read(text);
        if (!result) REQUIRE_MESSAGE(result.error().starts_with("folder/car.vrut:"), result.error());
        return result.has_value();
    };
    int whole = 0;
    for (std::size_t length = 0; length <= kFull.size(); ++length)
        whole += check(std::string(kFull.substr(0, length)));
    // Whole are: the full text without its last line break, with it, and what ends behind 'vrut-text 1', a
    // unit or a block whose references are known.
    CHECK(whole > 10);
    CHECK(whole < 400);
    std::string text(kFull);
    for (char& place : text) {
        const char before = place;
        for (const char other : {'"', ' ', '\n', '#', '\\', '9', '-', 'e', '\xC3', '\0'}) {
            place = other;
            check(text);
        }
        place = before;
    }
}

TEST_CASE("UTF-8") {
    const std::size_t valid = std::string_view::npos;
    const struct {
        std::string_view text;
        std::size_t invalid_at;
    } cases[] = {
        {"", valid},
        {"plain", valid},
        {"\x7F", valid},
        {"\xC2\x80 \xDF\xBF \xE0\xA0\x80 \xEF\xBF\xBF \xF0\x90\x80\x80 \xF4\x8F\xBF\xBF", valid},
        {"\xED\x9F\xBF\xEE\x80\x80", valid},
        {"ab\x80", 2},             // a continuation alone
        {"a\xC0\x80", 1},          // overlong
        {"a\xC1\xBF", 1},          // overlong
        {"a\xE0\x9F\xBF", 1},      // overlong
        {"a\xF0\x8F\xBF\xBF", 1},  // overlong
        {"a\xED\xA0\x80", 1},      // a surrogate
        {"a\xED\xBF\xBF", 1},      // a surrogate
        {"a\xF4\x90\x80\x80", 1},  // beyond U+10FFFF
        {"a\xF5\x80\x80\x80", 1},  // no such lead
        {"a\xC3", 1},              // cut off
        {"a\xE2\x82", 1},          // cut off
        {"a\xF0\x9F\x98", 1},      // cut off
        {"a\xE2\x82\x28", 1},      // a third byte that continues nothing
        {"a\xF0\x9F\x98\x28", 1},
        {"\xC3\xA9\xC3\x28", 2},
    };
    for (const auto& c : cases) {
        CAPTURE(c.text.size());
        CHECK(base::find_invalid_utf8(c.text) == c.invalid_at);
    }
}

TEST_CASE("files") {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "vrut-preview-formats-test";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder / "folder.vrut");
    const auto write = [&](const char* name, std::string_view text) {
        std::ofstream(folder / name, std::ios::binary) << text;
        return folder / name;
    };
    const auto error_of = [](const std::filesystem::path& path) {
        const auto result = io::read_scene(path);
        REQUIRE_FALSE(result);
        CHECK_MESSAGE(result.error().starts_with(path.string() + ":"), result.error());
        return result.error();
    };
    CHECK(contains(error_of(folder / "none.vrut"), "there is no such file"));
    CHECK(contains(error_of(folder / "none" / "none.vrut"), "there is no such file"));
    CHECK(contains(error_of(folder / "folder.vrut"), "is not a regular file"));
    CHECK(contains(error_of(write("scene.xyz", kFull)), "supported are .vrut"));
    CHECK(contains(error_of(write("scene", kFull)), "supported are .vrut"));
    CHECK(contains(error_of(write("empty.vrut", "")), ":1: expected 'vrut-text 1'"));
    CHECK(contains(error_of(write("bad.vrut", "vrut-text 1\nunit")), ":2: expected metres per unit"));

    const auto scene = io::read_scene(write("My car.VRUT", kFull));
    REQUIRE_MESSAGE(scene, scene.error());
    CHECK(scene->name() == "My car");
    CHECK(scene->nodes().size() == 10);
    std::filesystem::remove_all(folder);
}
