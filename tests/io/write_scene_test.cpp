#include "io/write_scene.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/gtx/transform.hpp>
#include <iterator>
#include <map>
#include <sstream>

#include "base/output_files.hpp"
#include "base/srgb.hpp"
#include "io/gltf/material.hpp"
#include "io/image/image_file.hpp"
#include "io/read_scene.hpp"
#include "temporary_folder.hpp"

using namespace vrut;
namespace fs = std::filesystem;

namespace {

double transfer(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// What the reader makes of a glTF material, by the rule that it states.
scene::Material phong_of(const glm::dvec3& c, double metallic, double roughness) {
    scene::Material material;
    material.diffuse = glm::dvec4(c, 1);
    material.ambient = glm::dvec4(c * 0.1, 1);
    material.specular = glm::dvec4((1 - roughness) * (0.22 + (c - 0.22) * metallic), 1);
    material.shininess = std::clamp((std::pow(roughness, -4) - 1) / 2, 1.0, 10'000.0);
    return material;
}

scene::Geometry corner(scene::Id id) {
    scene::Geometry geometry;
    geometry.id = id;
    geometry.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0.5, 0}};
    geometry.normals = {{0, 0, 2}, {0, 0, 1}, {0, 0.6F, 0.8F}};
    geometry.texcoords = {{0, 0}, {1, 0.25F}, {0.5F, 1}};
    geometry.triangles = {{0, 1, 2}};
    for (const glm::dvec3& position : geometry.positions) geometry.bounds.add(position);
    return geometry;
}

glm::dmat4 mirrored() { return glm::translate(glm::dvec3(5, 6, 7)) * glm::scale(glm::dvec3(-2, 1, 1)); }

scene::LightData light(scene::LightData::Type type) {
    scene::LightData data;
    data.type = type;
    data.color = {1, 0.5, 0.25, 1};
    data.angle = 60;
    return data;
}

/// A bit of everything that a scene can hold.
scene::Scene everything() {
    scene::SceneParts parts;
    parts.unit = 0.001;
    parts.geometries = {corner(1), corner(2)};
    parts.geometries[0].colors = {{1, 0, 0}, {0, 0.5F, 1}, {1, 1, 1}};
    parts.geometries[1].normals.clear();
    parts.geometries[1].texcoords.clear();
    scene::Texture texture{"textures/a plate.png", {}, true};
    texture.image.resize(1, 2);
    texture.image.rgba = {1, 2, 3, 255, 4, 5, 6, 128};
    parts.textures.push_back(texture);
    scene::Material paint = phong_of({0.8, 0.4, 0.1}, 0.5, 0.4);
    paint.name = "Paint \"red\"";
    paint.id = 10;
    paint.emission = {0.1, 0.2, 0.3, 1};
    paint.two_sided = true;
    scene::Material plate = phong_of(glm::dvec3(1), 0, 0.5);
    plate.name = "Plate";
    plate.id = 11;
    plate.texture = 0;
    plate.image = "textures/a plate.png";
    scene::Material glass;
    glass.name = "Glass";
    glass.id = 12;
    glass.ambient = {0.5, 0.5, 0.5, 1};
    glass.diffuse = {0.1, 0.2, 0.3, 0.25};
    glass.specular = {0.5, 0.6, 0.7, 1};
    glass.shininess = 100;
    glass.reflectivity = 0.5;
    parts.materials = {paint, plate, glass};
    const auto add = [&](scene::Node node, scene::Id parent) {
        node.id = static_cast<scene::Id>(parts.nodes.size()) + 1;
        parts.nodes.push_back({std::move(node), parent});
    };
    const auto node = [](std::string name, scene::NodeType type, auto data,
                         glm::dmat4 matrix = glm::dmat4(1)) {
        scene::Node made;
        made.name = std::move(name);
        made.type = type;
        made.matrix = matrix;
        made.data = data;
        return made;
    };
    add(node("Body", scene::NodeType::assembly, scene::GroupData{}, glm::rotate(0.5, glm::dvec3(1, 2, 3))),
        0);
    parts.nodes.back().node.hinge = scene::Hinge{{0, 1, 0}, 60};
    parts.nodes.back().node.presentation = true;
    add(node("Left wing", scene::NodeType::geometry, scene::GeometryData{0, 0}), 1);
    add(node("Right wing", scene::NodeType::geometry, scene::GeometryData{0, 1}, mirrored()), 0);
    add(node("Windscreen", scene::NodeType::geometry, scene::GeometryData{1, 2}), 1);
    add(node("Plain", scene::NodeType::geometry, scene::GeometryData{1, scene::kNone}), 1);
    add(node("Choice", scene::NodeType::switch_, scene::SwitchData{1}), 1);
    add(node("Not chosen", scene::NodeType::geometry, scene::GeometryData{1, 0}), 6);
    add(node("Chosen", scene::NodeType::geometry, scene::GeometryData{1, 0}), 6);
    add(node("Levels", scene::NodeType::lod, scene::LodData{{10}}), 0);
    add(node("Near", scene::NodeType::geometry, scene::GeometryData{0, 0}), 9);
    add(node("Far", scene::NodeType::geometry, scene::GeometryData{1, 0}), 9);
    add(node("Asleep", scene::NodeType::geometry, scene::GeometryData{1, 0}), 0);
    parts.nodes.back().node.active = false;
    add(node("Presenter", scene::NodeType::camera, scene::CameraData{{3, 1, 4}, {0, 1, 0}, {0, 1, 0}, 35}),
        1);
    add(node("Lamp", scene::NodeType::light, light(scene::LightData::Type::point)), 1);
    add(node("Sun", scene::NodeType::light, light(scene::LightData::Type::directional),
             glm::rotate(1.0, glm::dvec3(1, 0, 0))),
        0);
    add(node("Spot", scene::NodeType::light, light(scene::LightData::Type::spot)), 0);
    std::get<scene::LightData>(parts.nodes.back().node.data).attenuation = {1, 0.5, 0};
    add(node("Studio", scene::NodeType::background, scene::BackgroundData{0, {}, {}}), 0);
    auto scene = scene::Scene::build(std::move(parts));
    REQUIRE(scene);
    return *std::move(scene);
}

std::size_t index_of(const scene::Scene& scene, const std::string& name) {
    for (std::size_t i = 0; i < scene.nodes().size(); ++i)
        if (scene.nodes()[i].name == name) return i;
    FAIL("no node " << name);
    return 0;
}

const scene::Node& node_of(const scene::Scene& scene, const std::string& name) {
    return scene.nodes()[index_of(scene, name)];
}

glm::dmat4 world_of(const scene::Scene& scene, const std::string& name) {
    return scene::world_matrices(scene, scene::file_states(scene))[index_of(scene, name)];
}

bool same(const glm::dmat4& a, const glm::dmat4& b) {
    for (int i = 0; i < 4; ++i)
        if (glm::distance(a[i], b[i]) > 1e-5) return false;
    return true;
}

bool near(const glm::dvec4& a, const glm::dvec4& b) { return glm::distance(a, b) < 1e-5; }

const scene::Material& material_of(const scene::Scene& scene, const std::string& node) {
    return scene.material(std::get<scene::GeometryData>(node_of(scene, node).data).material);
}

std::vector<std::string> written(const scene::Scene& scene, const fs::path& path) {
    auto lost = io::write_scene(scene, path);
    REQUIRE_MESSAGE(lost, lost.error());
    for (std::string& notice : *lost) {
        CHECK(notice.starts_with(path.string() + ": "));
        notice.erase(0, path.string().size() + 2);
    }
    return *lost;
}

scene::Scene read_well(const fs::path& path) {
    auto scene = io::read_scene(path);
    REQUIRE_MESSAGE(scene, scene.error());
    return *std::move(scene);
}

/// The lines that begin with the keyword, without it.
std::vector<std::string> lines_of(const std::string& text, const std::string& keyword) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        if (line.starts_with(keyword + " ")) lines.push_back(line.substr(keyword.size() + 1));
    return lines;
}

glm::vec3 vector_at(const std::string& bytes, std::size_t at) {
    glm::vec3 value{};
    std::memcpy(&value, bytes.data() + at, 12);
    return value;
}

}  // namespace

TEST_CASE("a scene survives a GLB file but for what is told") {
    const TemporaryFolder folder;
    const scene::Scene scene = everything();
    const auto lost = written(scene, folder.path() / "all.glb");
    const scene::Scene read = read_well(folder.path() / "all.glb");
    SUBCASE("names, tree and matrices") {
        for (const char* name :
             {"Body", "Left wing", "Right wing", "Windscreen", "Plain", "Choice", "Not chosen", "Chosen",
              "Levels", "Near", "Far", "Asleep", "Lamp", "Sun", "Spot", "Studio"}) {
            CAPTURE(name);
            const scene::Node &before = node_of(scene, name), &after = node_of(read, name);
            CHECK(same(after.matrix, before.matrix));
            CHECK(read.nodes()[static_cast<std::size_t>(after.parent)].name ==
                  scene.nodes()[static_cast<std::size_t>(before.parent)].name);
        }
        CHECK(read.nodes().size() == scene.nodes().size());
    }
    SUBCASE("geometry, that of what is hidden apart") {
        const auto& wing = std::get<scene::GeometryData>(node_of(read, "Left wing").data);
        const scene::Geometry& geometry = read.geometries()[static_cast<std::size_t>(wing.geometry)];
        CHECK(geometry.positions == scene.geometries()[0].positions);
        CHECK(geometry.texcoords == scene.geometries()[0].texcoords);
        CHECK(geometry.triangles == scene.geometries()[0].triangles);
        REQUIRE(geometry.colors.size() == 3);
        CHECK(glm::distance(geometry.colors[1], {0, 0.5F, 1}) < 1e-6F);
        CHECK(geometry.normals == std::vector<glm::vec3>{{0, 0, 1}, {0, 0, 1}, {0, 0.6F, 0.8F}});
        const auto& plain = std::get<scene::GeometryData>(node_of(read, "Plain").data);
        CHECK(read.geometries()[static_cast<std::size_t>(plain.geometry)].normals.empty());
        for (const char* hidden : {"Not chosen", "Far", "Asleep"})
            CHECK(node_of(read, hidden).type == scene::NodeType::assembly);
        for (const char* shown : {"Chosen", "Near"})
            CHECK(node_of(read, shown).type == scene::NodeType::geometry);
    }
    SUBCASE("materials") {
        const scene::Material &paint = material_of(read, "Left wing"), &before = scene.materials()[0];
        CHECK(paint.name == before.name);
        CHECK(near(paint.diffuse, before.diffuse));
        CHECK(near(paint.ambient, before.ambient));
        CHECK(near(paint.specular, before.specular));
        CHECK(paint.emission == glm::dvec4(0, 0, 0, 1));  // it is light in glTF
        CHECK(near(glm::dvec4(paint.emissive, 1),
                   glm::dvec4(base::linear_from_srgb(glm::dvec3(before.emission)), 1)));
        CHECK(paint.shininess == doctest::Approx(before.shininess));
        CHECK(paint.two_sided);
        const scene::Material& glass = material_of(read, "Windscreen");
        CHECK(near(glass.diffuse, {0.1, 0.2, 0.3, 0.25}));
        CHECK(near(glass.specular, {0.5, 0.6, 0.7, 1}));
        CHECK(glass.shininess == doctest::Approx(100));
        CHECK(near(glass.ambient, {0.01, 0.02, 0.03, 1}));  // as is told
        CHECK_FALSE(glass.two_sided);
        CHECK(near(material_of(read, "Plain").diffuse, {0.8, 0.8, 0.8, 1}));
    }
    SUBCASE("pictures") {
        const scene::Material& plate = material_of(read, "Right wing");
        REQUIRE(plate.texture != scene::kNone);
        const scene::Texture& texture = read.textures()[static_cast<std::size_t>(plate.texture)];
        CHECK(texture.image.rgba == scene.textures()[0].image.rgba);
        CHECK(texture.transparent);
    }
    SUBCASE("camera and lights") {
        const scene::CameraData& camera = std::get<scene::CameraData>(node_of(read, "Presenter").data);
        CHECK(camera.fov == doctest::Approx(35));
        const glm::dmat4 before = world_of(scene, "Presenter"), after = world_of(read, "Presenter");
        CHECK(near(after * glm::dvec4(camera.eye, 1), before * glm::dvec4(3, 1, 4, 1)));
        CHECK(near(after * glm::dvec4(camera.focus - camera.eye, 0), before * glm::dvec4(-3, 0, -4, 0)));
        CHECK(near(after * glm::dvec4(camera.up, 0), before * glm::dvec4(0, 1, 0, 0)));
        for (const char* name : {"Lamp", "Sun", "Spot"}) {
            CAPTURE(name);
            const scene::LightData &was = std::get<scene::LightData>(node_of(scene, name).data),
                                   &is = std::get<scene::LightData>(node_of(read, name).data);
            CHECK(is.type == was.type);
            CHECK(near(is.color, was.color));
        }
        CHECK(std::get<scene::LightData>(node_of(read, "Spot").data).angle == doctest::Approx(60));
    }
    CHECK(lost == std::vector<std::string>{
                      "a LOD node is replaced by its first child", "a background is lost", "a hinge is lost",
                      "a light's attenuation is lost", "a mark of presentation is lost",
                      "a material's ambient colour becomes a tenth of its diffuse colour (2 times)",
                      "a material's emission becomes light, which brightens less what is lit",
                      "a material's reflectivity is lost", "a switch is replaced by its active child",
                      "an initially hidden geometry is omitted (3 times)", "the scene's unit is lost"});
}

TEST_CASE("a second GLB file of what was read from the first loses nothing more") {
    const TemporaryFolder folder;
    written(everything(), folder.path() / "first.glb");
    const scene::Scene first = read_well(folder.path() / "first.glb");
    CHECK(written(first, folder.path() / "second.glb").empty());
    const scene::Scene second = read_well(folder.path() / "second.glb");
    REQUIRE(second.materials().size() == first.materials().size());
    for (std::size_t i = 0; i < first.materials().size(); ++i) {
        CAPTURE(first.materials()[i].name);
        CHECK(near(second.materials()[i].diffuse, first.materials()[i].diffuse));
        CHECK(second.materials()[i].metallic_roughness == first.materials()[i].metallic_roughness);
        CHECK(near(second.materials()[i].specular, first.materials()[i].specular));
        CHECK(second.materials()[i].shininess == doctest::Approx(first.materials()[i].shininess));
    }
}

TEST_CASE("what the reader's rule made of glTF's materials becomes them again") {
    scene::Scene none;
    const glm::dvec3 colors[] = {{0.9, 0.5, 0.1}, {0.05, 0.1, 0.6}, {0.5, 0.5, 0.5},
                                 {1, 1, 1},       {0, 0, 0},        {0.22, 0.22, 0.22}};
    for (const glm::dvec3& c : colors)
        for (const double metallic : {0.0, 0.3, 1.0})
            for (const double roughness : {0.03, 0.1, 0.35, 0.7, 0.8, 0.95, 1.0}) {
                CAPTURE(c.r);
                CAPTURE(metallic);
                CAPTURE(roughness);
                io::ConversionWarnings warnings;
                const scene::Material phong = phong_of(c, metallic, roughness);
                const io::GltfMaterial made = io::gltf_material(none, phong, warnings);
                CHECK_FALSE(made.glossiness);
                CHECK(transfer(made.base.r) == doctest::Approx(c.r).epsilon(1e-6));
                const scene::Material again = phong_of(c, made.metallic, made.roughness);
                CHECK(glm::distance(again.specular, phong.specular) < 0.5 / 255);
                CHECK(again.shininess == doctest::Approx(phong.shininess).epsilon(1e-6));
                std::vector<std::string> told;
                warnings.append_to(told, "x");
                CHECK(told.empty());
            }
    SUBCASE("where the exponent tells it, the same metal and roughness") {
        io::ConversionWarnings warnings;
        const io::GltfMaterial made = io::gltf_material(none, phong_of({0.9, 0.5, 0.1}, 0.3, 0.35), warnings);
        CHECK(made.metallic == doctest::Approx(0.3).epsilon(1e-6));
        CHECK(made.roughness == doctest::Approx(0.35).epsilon(1e-6));
    }
}

TEST_CASE("an OBJ file holds the shown parts in world space, with their materials and pictures") {
    const TemporaryFolder folder;
    const scene::Scene scene = everything();
    const auto lost = written(scene, folder.path() / "all.obj");
    const std::string obj = folder.read("all.obj"), mtl = folder.read("all.mtl");
    CHECK(lines_of(obj, "mtllib") == std::vector<std::string>{"all.mtl"});
    auto objects = lines_of(obj, "o");
    CHECK(objects.size() == 6);
    REQUIRE(std::find(objects.begin(), objects.end(), "Right_wing") != objects.end());
    const std::string mirrored_part = obj.substr(obj.find("o Right_wing"));
    CHECK(lines_of(mirrored_part, "usemtl")[0] == "Plate");
    CHECK(lines_of(mirrored_part, "v")[1] == "3 6 7");
    CHECK(lines_of(mirrored_part, "vt")[1] == "1 0.25");
    CHECK(lines_of(mirrored_part, "vn")[0] == "0 0 1");
    // The turn of a mirrored part's corners is the other one.
    const std::string face = lines_of(mirrored_part, "f")[0];
    const auto first = static_cast<int>(std::stoi(face)), second = std::stoi(face.substr(face.find(' ')));
    CHECK(second == first - 1);
    CHECK(lines_of(mtl, "newmtl").size() == 4);
    const std::string glass = mtl.substr(mtl.find("newmtl Glass"));
    CHECK(lines_of(glass, "Ka")[0] == "0.5 0.5 0.5");
    CHECK(lines_of(glass, "Kd")[0] == "0.1 0.2 0.3");
    CHECK(lines_of(glass, "Ks")[0] == "0.5 0.6 0.7");
    CHECK(lines_of(glass, "Ns")[0] == "100");
    CHECK(lines_of(glass, "d")[0] == "0.25");
    CHECK(lines_of(mtl.substr(mtl.find("newmtl Paint__red_")), "Ke")[0] == "0.1 0.2 0.3");
    const auto pictures = lines_of(mtl, "map_Kd");
    REQUIRE(pictures.size() == 1);
    const auto picture = io::read_image_file(folder.path() / pictures[0]);
    REQUIRE_MESSAGE(picture, picture.error());
    CHECK(picture->rgba == scene.textures()[0].image.rgba);
    for (const char* told :
         {"a camera is lost", "a light is lost (3 times)", "a material's reflectivity is lost",
          "a material's two-sided flag is lost (3 times)",
          "a material's ambient colour is written, but read back as a tenth of its diffuse colour",
          "a geometry that several nodes share is written once for each node (4 times)",
          "a background is lost", "an assembly is lost: its matrix is applied to the vertices"})
        CHECK_MESSAGE(std::find(lost.begin(), lost.end(), told) != lost.end(), told);

    const scene::Scene read = read_well(folder.path() / "all.obj");
    CHECK(read.triangle_count() == 6);
    for (const std::string& name : objects)
        CHECK_MESSAGE(std::any_of(read.nodes().begin(), read.nodes().end(),
                                  [&](const scene::Node& node) { return node.name == name; }),
                      name);
    const auto pane = std::find_if(read.materials().begin(), read.materials().end(),
                                   [](const scene::Material& material) { return material.name == "Glass"; });
    REQUIRE(pane != read.materials().end());
    CHECK(glm::distance(pane->diffuse, glm::dvec4(0.1, 0.2, 0.3, 0.25)) < 1e-6);
    CHECK(glm::distance(glm::dvec3(pane->specular), glm::dvec3(0.5, 0.6, 0.7)) < 1e-6);
    CHECK(pane->shininess == 100);
    CHECK(near(pane->ambient, {0.01, 0.02, 0.03, 1}));  // as is told
    REQUIRE(read.textures().size() == 1);
    CHECK(read.textures()[0].image.rgba == scene.textures()[0].image.rgba);
}

TEST_CASE("what an OBJ file has of a material and its reader does not take is told") {
    const TemporaryFolder folder;
    const auto lost = [&](const std::function<void(scene::Material&)>& change) {
        scene::SceneParts parts;
        parts.geometries = {corner(1)};
        parts.textures.push_back({"a.png", {1, 1, {1, 2, 3, 128}}, true});
        parts.materials = {phong_of({0.8, 0.4, 0.1}, 0.5, 0.4)};
        parts.materials[0].name = "Paint";
        change(parts.materials[0]);
        scene::Node node;
        node.id = 1;
        node.name = "Part";
        node.type = scene::NodeType::geometry;
        node.data = scene::GeometryData{0, 0};
        parts.nodes.push_back({node, 0});
        const scene::Scene scene = *scene::Scene::build(std::move(parts));
        auto told = written(scene, folder.path() / "x.obj");
        const scene::Material before = scene.materials()[0],
                              after = read_well(folder.path() / "x.obj").materials()[0];
        const bool same = near(before.diffuse, after.diffuse) && near(before.ambient, after.ambient) &&
                          near(before.specular, after.specular) && near(before.emission, after.emission) &&
                          std::abs(before.shininess - after.shininess) < 1e-4 &&
                          before.emissive == after.emissive;
        CHECK(same == (told.size() == 1));
        REQUIRE_FALSE(told.empty());
        const std::string either = "a material's two-sided flag is lost";
        CHECK(std::erase(told, either) == 1);
        CHECK(told.size() <= 1);
        return told.empty() ? either : told.front();
    };
    using std::string;
    const string either = "a material's two-sided flag is lost";
    CHECK(lost([](scene::Material&) {}) == either);
    CHECK(lost([](scene::Material& m) { m.texture = 0; }) == either);
    CHECK(lost([](scene::Material& m) { m.diffuse.a = 0.5; }) == either);
    CHECK(lost([](scene::Material& m) {
              m.emissive = {0.5, 0, 0};
          }) == "a material's emissive light is lost");
    CHECK(lost([](scene::Material& m) { m.texture = 0, m.diffuse.a = 0.5; }) ==
          "a textured material's own opacity is written, but not read back");
    CHECK(lost([](scene::Material& m) {
              m.ambient = {1, 0, 0, 1};
          }) == "a material's ambient colour is written, but read back as a tenth of its diffuse colour");
    for (const double shininess : {0.0, 0.5})
        CHECK(lost([&](scene::Material& m) { m.shininess = shininess; }) ==
              "a shininess below 1 is written, but read back as another or none");
}

TEST_CASE("an STL file holds the shown triangles in world space, their fronts outside") {
    const TemporaryFolder folder;
    const auto lost = written(everything(), folder.path() / "all.stl");
    const std::string stl = folder.read("all.stl");
    REQUIRE(stl.size() == 84 + 6 * 50);
    CHECK(stl.compare(0, 5, "solid") != 0);
    CHECK(stl[80] == 6);
    bool found = false;
    for (std::size_t at = 84; at < stl.size(); at += 50) {
        if (vector_at(stl, at + 36) != glm::vec3(5, 6, 7)) continue;
        found = true;  // the mirrored one: its corners are in turn again
        CHECK(vector_at(stl, at) == glm::vec3(0, 0, 1));
        CHECK(vector_at(stl, at + 24) == glm::vec3(3, 6, 7));
    }
    CHECK(found);
    CHECK(std::find(lost.begin(), lost.end(), "names and materials are lost") != lost.end());
    CHECK(read_well(folder.path() / "all.stl").triangle_count() == 6);
}

TEST_CASE("a scene survives a file of its own format, pictures from inside another file too") {
    const TemporaryFolder folder;
    CHECK(written(everything(), folder.path() / "all.glb").size() == 11);
    const scene::Scene scene = read_well(folder.path() / "all.glb");
    CHECK(written(scene, folder.path() / "all.vrut").empty());
    const scene::Scene read = read_well(folder.path() / "all.vrut");
    CHECK(read.nodes().size() == scene.nodes().size());
    CHECK(read.notices().empty());
    const scene::Material& plate = material_of(read, "Right wing");
    REQUIRE(plate.texture != scene::kNone);
    CHECK(plate.image.starts_with("all.textures/"));
    CHECK(read.textures()[static_cast<std::size_t>(plate.texture)].image.rgba ==
          scene.textures()[0].image.rgba);
}

TEST_CASE("a matrix that shears or flattens is kept in a GLB file, and told") {
    const TemporaryFolder folder;
    scene::SceneParts parts;
    scene::Node node;
    node.id = 1;
    node.name = "Slanted";
    SUBCASE("shears") { node.matrix[1][0] = 0.5; }
    SUBCASE("flattens") { node.matrix[1][1] = 0; }
    parts.nodes.push_back({node, 0});
    const scene::Scene scene = *scene::Scene::build(std::move(parts));
    CHECK(written(scene, folder.path() / "x.glb") ==
          std::vector<std::string>{"a node's matrix shears or flattens, which glTF forbids: other programs "
                                   "may reject it"});
}

TEST_CASE("an empty scene can be written in every format") {
    const TemporaryFolder folder;
    for (const char* name : {"x.vrut", "x.obj", "x.stl", "x.GLB"}) {
        CAPTURE(name);
        CHECK(io::write_scene(scene::Scene(), folder.path() / name));
        CHECK(fs::file_size(folder.path() / name) > 0);
    }
}

TEST_CASE("what cannot be written is told, and leaves what was there") {
    const TemporaryFolder folder;
    const auto file = folder.write("car.stl", "old");
    SUBCASE("an ending that is none") {
        const auto result = io::write_scene(scene::Scene(), folder.path() / "car.fbx");
        REQUIRE_FALSE(result);
        CHECK(result.error().find(
                  "car.fbx: this file extension cannot be written; supported are .vrut, .obj, .stl, .glb") !=
              std::string::npos);
    }
    SUBCASE("no such folder") {
        const auto result = io::write_scene(scene::Scene(), folder.path() / "a" / "b" / "car.stl");
        REQUIRE_FALSE(result);
        CHECK(result.error().find("car.stl: it cannot be written: No such file or directory") !=
              std::string::npos);
    }
    SUBCASE("a folder in its place") {
        fs::create_directory(folder.path() / "folder.obj");
        CHECK_FALSE(io::write_scene(everything(), folder.path() / "folder.obj"));
        CHECK_FALSE(fs::exists(folder.path() / "folder.mtl"));
        CHECK_FALSE(fs::exists(folder.path() / "folder.textures"));
    }
    SUBCASE("a file that breaks off") {
        base::OutputFiles files;
        CHECK_THROWS_AS(files.write(file,
                                    [](std::ostream& out) {
                                        out << "new";
                                        out.setstate(std::ios::badbit);
                                    }),
                        base::WriteError);
    }
    CHECK(folder.read("car.stl") == "old");
    for (const auto& entry : fs::directory_iterator(folder.path()))
        CHECK(entry.path().extension() != ".part");
}
