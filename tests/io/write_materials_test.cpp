#include <doctest/doctest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "io/image/image_file.hpp"
#include "io/write_scene.hpp"
#include "scene_queries.hpp"

using namespace vrut;

namespace {

/// Paint by metal and roughness, with an own texture for each map.
scene::Material car_paint() {
    scene::Material paint;
    paint.name = "Paint";
    paint.diffuse = {1, 0.5, 0, 1};
    paint.ambient = {1, 1, 1, 1};  // which is not drawn under a cube map, as the next three
    // The highlight that the reader gives to the metal and roughness below.
    paint.specular = glm::dvec4(0.75 * (0.22 + (glm::dvec3(paint.diffuse) - 0.22) * 0.75), 1);
    paint.shininess = 127.5;
    paint.emission = {1, 1, 1, 1};
    paint.metallic_roughness = {0.75, 0.25, 0.5};
    return paint;
}

void add_maps(scene::Material& material) {
    material.occlusion_roughness_metallic_texture = 0;
    material.normal_texture = 1;
    material.normal_scale = 0.5;
}

scene::Scene part_of(const scene::Material& material) {
    scene::SceneParts parts;
    parts.geometries.resize(1);
    scene::Geometry& geometry = parts.geometries[0];
    geometry.id = 1;
    geometry.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    geometry.texcoords = {{0, 0}, {1, 0}, {0, 1}};
    geometry.triangles = {{0, 1, 2}};
    parts.textures = {{"surface.png", {1, 1, {10, 20, 30, 255}}, false},
                      {"normals.png", {1, 1, {128, 128, 255, 255}}, false}};
    for (scene::Texture& texture : parts.textures) texture.sampler = material.sampler;
    parts.materials = {material};
    scene::Node node;
    node.id = 1;
    node.name = "Part";
    node.type = scene::NodeType::geometry;
    node.data = scene::GeometryData{0, 0};
    parts.nodes.push_back({node, 0});
    auto scene = scene::Scene::build(std::move(parts));
    REQUIRE(scene);
    return *std::move(scene);
}

struct WrittenFile {
    std::vector<std::string> lost;
    nlohmann::json json;
    nlohmann::json material() const { return json["materials"][0]; }
};

/// The JSON chunk of a GLB file with a part of that material.
WrittenFile written_glb(const scene::Material& material) {
    const TemporaryFolder folder;
    const auto lost = io::write_scene(part_of(material), folder.path() / "x.glb");
    REQUIRE_MESSAGE(lost, lost.error());
    const std::string bytes = folder.read("x.glb");
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data() + 12, 4);
    WrittenFile file{*lost, nlohmann::json::parse(bytes.substr(20, size))};
    for (std::string& notice : file.lost) notice.erase(0, notice.find(": ") + 2);
    return file;
}

}  // namespace

TEST_CASE("a material by metal and roughness is written as glTF has it") {
    const WrittenFile file = written_glb(car_paint());
    const nlohmann::json surface = file.material()["pbrMetallicRoughness"];
    CHECK(surface["baseColorFactor"][0] == 1);
    CHECK(surface["baseColorFactor"][1].get<double>() == doctest::Approx(0.2140411));
    CHECK(surface["metallicFactor"] == 0.75);
    CHECK(surface["roughnessFactor"] == 0.25);
    CHECK(file.material()["extensions"] == R"({"KHR_materials_clearcoat": {"clearcoatFactor": 0.5}})"_json);
    CHECK(file.json["extensionsUsed"] == R"(["KHR_materials_clearcoat"])"_json);
    CHECK_FALSE(file.material().contains("emissiveFactor"));
    CHECK(file.lost.empty());
    SUBCASE("but for its reflectivity") {
        scene::Material mirror = car_paint();
        mirror.reflectivity = 0.5;
        CHECK(written_glb(mirror).lost == std::vector<std::string>{"a material's reflectivity is lost"});
    }
}

TEST_CASE("the maps of a material are textures of a GLB file") {
    scene::Material paint = car_paint();
    SUBCASE("by metal and roughness") {
        add_maps(paint);
        const WrittenFile file = written_glb(paint);
        CHECK(file.material()["pbrMetallicRoughness"]["metallicRoughnessTexture"] == R"({"index": 0})"_json);
        CHECK(file.material()["occlusionTexture"] == R"({"index": 0})"_json);
        CHECK(file.material()["normalTexture"] == R"({"index": 1, "scale": 0.5})"_json);
        CHECK(file.json["textures"].size() == 2);
        CHECK(file.json["images"].size() == 2);
        CHECK(file.lost.empty());
    }
    SUBCASE("by Phong's equation: those that are drawn") {
        paint = {};
        add_maps(paint);
        paint.normal_scale = 1;
        const WrittenFile file = written_glb(paint);
        CHECK_FALSE(file.material()["pbrMetallicRoughness"].contains("metallicRoughnessTexture"));
        CHECK_FALSE(file.material().contains("occlusionTexture"));
        CHECK(file.material()["normalTexture"] == R"({"index": 0})"_json);
        CHECK(file.json["textures"].size() == 1);
    }
}

TEST_CASE("a GLB file keeps the highlight by Phong's equation beside metal and roughness") {
    scene::Material paint = car_paint();
    paint.specular = {0.5, 0.4, 0.3, 1};
    paint.shininess = 40;
    const TemporaryFolder folder;
    const auto lost = io::write_scene(part_of(paint), folder.path() / "x.glb");
    REQUIRE_MESSAGE(lost, lost.error());
    const auto scene = io::read_scene(folder.path() / "x.glb");
    REQUIRE_MESSAGE(scene, scene.error());
    const scene::Material& read = scene->materials()[0];
    CHECK(read.metallic_roughness == paint.metallic_roughness);
    CHECK(glm::distance(read.specular, paint.specular) < 1e-6);
    CHECK(read.shininess == doctest::Approx(40));
}

TEST_CASE("a GLB file keeps emissive light above 1") {
    scene::Material lamp = car_paint();
    lamp.metallic_roughness->clear_coat = 0;
    lamp.emissive = {8, 4, 0};
    const WrittenFile file = written_glb(lamp);
    CHECK(file.material()["emissiveFactor"] == R"([1, 0.5, 0])"_json);
    CHECK(file.material()["extensions"] ==
          R"({"KHR_materials_emissive_strength": {"emissiveStrength": 8}})"_json);
    CHECK(file.json["extensionsUsed"] == R"(["KHR_materials_emissive_strength"])"_json);
    CHECK(file.lost.empty());
}

TEST_CASE("an OBJ file keeps metal, roughness, clear coat and normal map") {
    const TemporaryFolder folder;
    scene::Material paint = car_paint();
    add_maps(paint);
    const scene::Scene before = part_of(paint);
    const auto lost = io::write_scene(before, folder.path() / "x.obj");
    REQUIRE_MESSAGE(lost, lost.error());
    CHECK(*lost ==
          std::vector<std::string>{
              (folder.path() / "x.obj").string() + ": a material's metallic-roughness texture is lost",
              (folder.path() / "x.obj").string() + ": a material's two-sided flag is lost"});
    const scene::Scene scene = read_well(folder.path() / "x.obj");
    const scene::Material& read = material_of(scene, "Paint");
    CHECK(read.metallic_roughness == paint.metallic_roughness);
    CHECK(read.normal_scale == 0.5);
    CHECK(read.emissive == glm::dvec3(0));
    REQUIRE(read.normal_texture != scene::kNone);
    CHECK(scene.textures()[static_cast<std::size_t>(read.normal_texture)].image.rgba ==
          before.textures()[1].image.rgba);
    CHECK(scene.notices().empty());
}

TEST_CASE("GLB files keep how textures are sampled, OBJ files where they are clamped or repeat") {
    using scene::Wrap;
    const TemporaryFolder folder;
    for (const scene::Sampler& sampler :
         {scene::Sampler(), scene::Sampler{{Wrap::clamp, Wrap::clamp}},
          scene::Sampler{{Wrap::mirror, Wrap::clamp}},
          scene::Sampler{{Wrap::clamp, Wrap::clamp}, scene::Magnification::nearest}})
        for (const char* file : {"x.glb", "x.obj"}) {
            CAPTURE(file);
            scene::Material paint;
            paint.name = "Paint";
            paint.two_sided = true;
            paint.texture = 0;
            paint.sampler = sampler;
            const auto lost = io::write_scene(part_of(paint), folder.path() / file);
            REQUIRE_MESSAGE(lost, lost.error());
            const bool is_lost = sampler.wraps[0] == Wrap::mirror && std::string(file) == "x.obj";
            const auto tells = [](const std::string& what) {
                return what.find("a texture repeats where it was mirrored") != std::string::npos;
            };
            CHECK(std::ranges::any_of(*lost, tells) == is_lost);
            const scene::Scene scene = read_well(folder.path() / file);
            const scene::Sampler kept = material_of(scene, "Paint").sampler;
            CHECK(kept.wraps == (is_lost ? scene::Sampler() : sampler).wraps);
            const bool is_nearest = sampler.magnification == scene::Magnification::nearest;
            const bool is_mixed = is_nearest && std::string(file) == "x.obj";
            CHECK((kept.magnification == scene::Magnification::nearest) == (is_nearest && !is_mixed));
            const auto mixes = [](const std::string& what) {
                return what.find("nearest texel is lost") != std::string::npos;
            };
            CHECK(std::ranges::any_of(*lost, mixes) == is_mixed);
        }
}
