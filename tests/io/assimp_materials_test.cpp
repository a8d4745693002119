#include <doctest/doctest.h>

#include <fstream>
#include <iterator>

#include "image_bytes.hpp"
#include "scene_queries.hpp"

using namespace vrut;
namespace fs = std::filesystem;

namespace {

std::string panel_text(const std::string& name) {
    std::ifstream stream(VRUT_TEST_DATA "/scenes/" + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void replace(std::string& text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE_MESSAGE(at != std::string::npos, from);
    text.replace(at, from.size(), to);
}

std::string pixel(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
    return png_bytes(
        {.width = 1, .height = 1, .color_type = PNG_COLOR_TYPE_RGB, .rows = {{red, green, blue}}});
}

/// Beside the panel lie a normal map and a bump map.
scene::Scene read_beside_maps(const std::string& name, const std::string& text,
                              const std::string& library = "") {
    const TemporaryFolder folder;
    folder.write("panel.mtl", library);
    folder.write("normals.png", pixel(128, 128, 255));
    folder.write("heights.png", pixel(200, 204, 196));
    return read_well(folder.write(name, text));
}

scene::Material obj_material(const std::string& lines) {
    return material_of(
        read_beside_maps("panel.obj", panel_text("panel.obj"), "newmtl Paint\n" + lines + "newmtl Glass\n"),
        "Paint");
}

/// The material Paint of the FBX panel with these properties besides its own.
scene::Material fbx_material(const std::string& properties) {
    std::string text = panel_text("panel.fbx");
    replace(text, "P: \"TransparencyFactor\"", properties + "P: \"TransparencyFactor\"");
    return material_of(read_beside_maps("panel.fbx", text), "Paint");
}

std::string fbx_number(const std::string& name, const std::string& value) {
    return "P: \"" + name + "\", \"Float\", \"\", \"A\"," + value + "\n";
}

bool is_surface(const scene::Material& material, double metallic, double roughness, double clear_coat) {
    if (!material.metallic_roughness) return false;
    const scene::MetallicRoughness& surface = *material.metallic_roughness;
    return glm::distance(glm::dvec3(surface.metallic, surface.roughness, surface.clear_coat),
                         glm::dvec3(metallic, roughness, clear_coat)) < 1e-6;
}

}  // namespace

TEST_CASE("an OBJ material is by metal and roughness where the file tells one of them") {
    const scene::Material paint =
        obj_material("Kd 0.5 0.25 0\nKs 1 1 1\nNs 50\nKe 0 0 0.5\nPm 0.7\nPr 0.3\nPc 0.5\n");
    CHECK(is_surface(paint, 0.7, 0.3, 0.5));
    CHECK(paint.diffuse == glm::dvec4(0.5, 0.25, 0, 1));
    CHECK(paint.specular == glm::dvec4(1));
    CHECK(paint.shininess == 50);
    CHECK(paint.emission == glm::dvec4(0, 0, 0, 1));
    CHECK(is_near(glm::dvec4(paint.emissive, 1), {0, 0, 0.2140411, 1}));
    CHECK(is_surface(obj_material("Pr 0\n"), 0, 0, 0));
    CHECK(is_surface(obj_material("Pm 2\n"), 1, 1, 0));
    CHECK_FALSE(obj_material("Kd 1 1 1\nPc 1\n").metallic_roughness);
}

TEST_CASE("an FBX material of 3ds Max or Maya is by metal and roughness") {
    struct Names {
        const char *metallic, *roughness, *clear_coat;
    };
    for (const Names& names :
         {Names{"3dsMax|Parameters|metalness", "3dsMax|Parameters|roughness", "3dsMax|Parameters|coating"},
          {"Maya|metalness", "Maya|specularRoughness", "Maya|coat"}})
        CHECK_MESSAGE(
            is_surface(fbx_material(fbx_number(names.metallic, "0.7") + fbx_number(names.roughness, "0.3") +
                                    fbx_number(names.clear_coat, "0.5")),
                       0.7, 0.3, 0.5),
            names.metallic);
    for (const Names& names : {Names{"3dsMax|main|metalness", "3dsMax|main|roughness", ""},
                               {"Maya|metallic", "Maya|roughness", ""}})
        CHECK_MESSAGE(
            is_surface(fbx_material(fbx_number(names.metallic, "0.7") + fbx_number(names.roughness, "0.3")),
                       0.7, 0.3, 0),
            names.metallic);
    CHECK(is_surface(fbx_material(fbx_number("3dsMax|Parameters|metalness", "0") +
                                  fbx_number("3dsMax|Parameters|roughness", "0.75") +
                                  "P: \"3dsMax|Parameters|roughness_inv\", \"Bool\", \"\", \"A\",1\n"),
                     0, 0.25, 0));
    CHECK_FALSE(fbx_material("").metallic_roughness);  // its roughness is assimp's
}

TEST_CASE("the base colour of such an FBX material is its own") {
    struct Names {
        const char *metallic, *base;
    };
    for (const Names& names : {Names{"3dsMax|Parameters|metalness", "3dsMax|Parameters|base_color"},
                               {"3dsMax|main|metalness", "3dsMax|main|basecolor"},
                               {"Maya|metalness", "Maya|baseColor"},
                               {"Maya|metallic", "Maya|base_color"}}) {
        const scene::Material paint = fbx_material(fbx_number(names.metallic, "1") + "P: \"" + names.base +
                                                   "\", \"Color\", \"\", \"A\",0.1,0.2,0.3\n");
        CHECK_MESSAGE(is_near(paint.diffuse, {0.1, 0.2, 0.3, 0.4}), names.base);
        CHECK(is_near(paint.ambient, {0.01, 0.02, 0.03, 1}));
    }
}

TEST_CASE("a normal map is shown, with Phong's equation too") {
    const auto map_of = [](const scene::Scene& scene) {
        const scene::Material& paint = material_of(scene, "Paint");
        REQUIRE(paint.normal_texture != scene::kNone);
        CHECK_FALSE(has_notice(scene, "map"));
        CHECK(scene.textures()[static_cast<std::size_t>(paint.normal_texture)].file == paint.normal_image);
        return std::pair(paint.normal_image, paint.normal_scale);
    };
    const std::string obj = panel_text("panel.obj");
    CHECK(map_of(read_beside_maps("panel.obj", obj, "newmtl Paint\nKd 1 1 1\nnorm normals.png\n")) ==
          std::pair(std::string("normals.png"), 1.0));
    CHECK(map_of(read_beside_maps("panel.obj", obj, "newmtl Paint\nPm 1\nnorm -bm 0.5 normals.png\n")) ==
          std::pair(std::string("normals.png"), 0.5));
    for (const char* property : {"NormalMap", "Maya|TEX_normal_map", "3dsMax|Parameters|bump_map"}) {
        std::string fbx = panel_text("panel.fbx");
        replace(fbx, "\"DiffuseColor\"\n}", '"' + std::string(property) + "\"\n}");
        replace(fbx, "tex\\paint.png\"\n  }", "normals.png\"\n  }");
        replace(fbx, "P: \"TransparencyFactor\"",
                fbx_number("BumpFactor", "0.25") + "P: \"TransparencyFactor\"");
        CHECK_MESSAGE(
            map_of(read_beside_maps("panel.fbx", fbx)) == std::pair(std::string("normals.png"), 0.25),
            property);
    }
}

TEST_CASE("a map of metal or roughness is ignored, with a notice") {
    const scene::Scene scene =
        read_beside_maps("panel.obj", panel_text("panel.obj"),
                         "newmtl Paint\nPm 0.5\nmap_Pm heights.png\nmap_Pr heights.png\n");
    CHECK(has_notice(scene, "a metallic texture is ignored"));
    CHECK(has_notice(scene, "a roughness texture is ignored"));
    CHECK(is_surface(material_of(scene, "Paint"), 0.5, 1, 0));
}

TEST_CASE("a bump map is ignored, with a notice, whatever the file calls it") {
    const auto ignores = [](const scene::Scene& scene) {
        const scene::Material& paint = material_of(scene, "Paint");
        return paint.normal_texture == scene::kNone && paint.normal_image.empty() &&
               has_notice(scene, "a bump map is ignored");
    };
    const std::string obj = panel_text("panel.obj");
    CHECK(ignores(read_beside_maps("panel.obj", obj, "newmtl Paint\nKd 1 1 1\nbump normals.png\n")));
    CHECK(ignores(read_beside_maps("panel.obj", obj, "newmtl Paint\nKd 1 1 1\nnorm heights.png\n")));
    for (const auto& [map, is_ignored] : {std::pair("heights.png", true), {"normals.png", false}}) {
        std::string dae = panel_text("panel.dae");
        replace(dae, "</phong></technique>",
                "</phong><extra><technique profile=\"FCOLLADA\"><bump><texture texture=\"samp\" "
                "texcoord=\"UV\"/></bump></technique></extra></technique>");
        replace(dae, "tex/my%20paint.png", map);
        CHECK(ignores(read_beside_maps("panel.dae", dae)) == is_ignored);
    }
}
