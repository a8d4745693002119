#include <doctest/doctest.h>

#include <cstdlib>

#include "../assimp_leaks.hpp"
#include "image_bytes.hpp"
#include "needs_folder.hpp"
#include "scene_queries.hpp"

using namespace vrut;
namespace fs = std::filesystem;

namespace {

std::string text_of(const std::string& name) {
    std::ifstream stream(VRUT_TEST_DATA "/scenes/" + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Blue at the bottom left, the alpha of its neighbour 128.
std::string picture() {
    return png_bytes({.width = 2,
                      .height = 2,
                      .color_type = PNG_COLOR_TYPE_RGBA,
                      .rows = {{255, 0, 0, 255, 0, 255, 0, 255}, {0, 0, 255, 255, 255, 255, 255, 128}}});
}

/// The scene of one of the files there, with `from` in it as `to`, beside its material library and picture.
scene::Scene read_panel(const std::string& name, const std::string& from = "", const std::string& to = "") {
    const TemporaryFolder folder;
    folder.write("panel.mtl", text_of("panel.mtl"));
    folder.write("paint.png", picture());
    folder.write("tex/my paint.png", picture());
    std::string text = text_of(name);
    const std::size_t at = text.find(from);
    REQUIRE_MESSAGE(at != std::string::npos, from);
    return read_well(folder.write(name, text.replace(at, from.size(), to)));
}

const scene::Geometry& geometry_of(const scene::Scene& scene, const scene::Node& node) {
    return scene.geometries()[static_cast<std::size_t>(std::get<scene::GeometryData>(node.data).geometry)];
}

const scene::Material& material_of(const scene::Scene& scene, const scene::Node& node) {
    return scene.material(std::get<scene::GeometryData>(node.data).material);
}

/// The picture as it is, or without its alpha.
void check_picture(const scene::Scene& scene, const scene::Material& material, std::uint8_t alpha) {
    REQUIRE(material.texture != scene::kNone);
    const scene::Image& image = scene.textures()[static_cast<std::size_t>(material.texture)].image;
    CHECK(image.rgba == std::vector<std::uint8_t>{0, 0, 255, 255, 255, 255, 255, alpha,  // from the bottom
                                                  255, 0, 0, 255, 0, 255, 0, 255});
}

/// Two triangles over the unit square, laid with the picture upright.
void check_panel(const scene::Geometry& panel, bool has_texcoords) {
    CHECK(panel.positions.size() == 4);
    CHECK(panel.triangles.size() == 2);
    CHECK(panel.bounds.max == glm::dvec3(1, 1, 0));
    for (const glm::uvec3& t : panel.triangles)
        CHECK(glm::cross(panel.positions[t.y] - panel.positions[t.x],
                         panel.positions[t.z] - panel.positions[t.x])
                  .z > 0);
    REQUIRE(panel.texcoords.size() == (has_texcoords ? 4 : 0));
    for (std::size_t i = 0; i < panel.texcoords.size(); ++i)
        CHECK(panel.texcoords[i] == glm::vec2(panel.positions[i]));
}

/// A cube's triangles as seen from outside, or from inside; or one of them left out.
std::string cube_obj(bool outwards, bool whole) {
    constexpr int kQuads[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5},
                                  {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
    std::string text;
    for (int i = 0; i < 8; ++i)
        text += "v " + std::to_string(i & 1) + " " + std::to_string(i >> 1 & 1) + " " +
                std::to_string(i >> 2) + "\n";
    for (int quad = whole ? 0 : 1; quad < 6; ++quad) {
        text += "f";
        for (int i = 0; i < 4; ++i) text += " " + std::to_string(kQuads[quad][outwards ? i : 3 - i]);
        text += "\n";
    }
    return text;
}

/// A triangle's 36 bytes and a face's 13, with the counts that its header tells.
std::string binary_ply(std::uint64_t vertices, std::uint64_t faces) {
    std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) +
                       "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                       std::to_string(faces) + "\nproperty list uchar int vertex_indices\nend_header\n";
    const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::int32_t face[] = {0, 1, 2};
    text.append(reinterpret_cast<const char*>(corners), sizeof corners).append(1, '\3');
    return text.append(reinterpret_cast<const char*>(face), sizeof face);
}

}  // namespace

TEST_CASE("an OBJ scene keeps its objects, normals and places on pictures") {
    const scene::Scene scene = read_panel("panel.obj");
    CHECK(scene.nodes().size() == 3);
    const scene::Node &panel = node_of(scene, "Panel"), &pane = node_of(scene, "Pane");
    CHECK(panel.parent == 0);
    CHECK(panel.type == scene::NodeType::geometry);
    check_panel(geometry_of(scene, panel), true);
    CHECK(geometry_of(scene, panel).normals.empty());  // flat
    CHECK(geometry_of(scene, pane).normals == std::vector(3, glm::vec3(0, 0.6F, 0.8F)));
}

TEST_CASE("materials that are Phong's follow one rule") {
    const scene::Scene scene = read_panel("panel.obj");
    const scene::Material& paint = material_of(scene, "Paint");
    CHECK(paint.diffuse == glm::dvec4(0.5, 0.25, 0, 1));
    CHECK(is_near(paint.ambient, {0.05, 0.025, 0, 1}));
    CHECK(paint.specular == glm::dvec4(0.5, 0.25, 0, 1));
    CHECK(paint.emission == glm::dvec4(0, 0, 0.25, 1));
    CHECK(paint.shininess == 50);
    CHECK(paint.two_sided);
    check_picture(scene, paint, 255);
    const scene::Material& glass = material_of(scene, "Glass");
    CHECK(is_near(glass.diffuse, {0.1, 0.2, 0.3, 0.4}));
    CHECK(glass.specular == glm::dvec4(0, 0, 0, 1));  // without an exponent
    CHECK(has_notice(scene, "a bump map is ignored"));
    CHECK(has_notice(scene, "not multiplied by the diffuse colour"));
    CHECK(scene.notices().size() == 2);
}

TEST_CASE("an OBJ texture that is not multiplied by its colour has a notice, unless that is black") {
    const TemporaryFolder folder;
    folder.write("paint.png", picture());
    const fs::path path = folder.write("panel.obj", text_of("panel.obj"));
    for (const auto& [color, is_told] : {std::pair("0.5 1 1", true), {"0 0 0", false}, {"1 1 1", false}}) {
        folder.write("panel.mtl", "newmtl Paint\nKd " + std::string(color) + "\nmap_Kd paint.png\n");
        CHECK(has_notice(read_well(path), "not multiplied by the diffuse colour") == is_told);
    }
}

TEST_CASE("a picture's alpha counts in OBJ where it is the picture of the opacity too") {
    const TemporaryFolder folder;
    folder.write("paint.png", picture());
    const fs::path path = folder.write("panel.obj", text_of("panel.obj"));
    for (const auto& [opacity, alpha] : {std::pair("paint.png", 128), {"other.png", 255}}) {
        folder.write("panel.mtl", "newmtl Paint\nmap_Kd paint.png\nmap_d " + std::string(opacity) + "\n");
        const scene::Scene scene = read_well(path);
        check_picture(scene, material_of(scene, "Paint"), static_cast<std::uint8_t>(alpha));
        CHECK(has_notice(scene, "an opacity map that is not the diffuse texture") == (alpha == 255));
    }
}

TEST_CASE("parts are two-sided unless they are closed, wound outwards and opaque") {
    const TemporaryFolder folder;
    const auto two_sided = [&](const std::string& text) {
        return read_well(folder.write("cube.obj", text)).materials()[0].two_sided;
    };
    CHECK_FALSE(two_sided(cube_obj(true, true)));
    CHECK(two_sided(cube_obj(false, true)));
    CHECK(two_sided(cube_obj(true, false)));
    folder.write("glass.mtl", "newmtl Glass\nd 0.5\n");
    CHECK(two_sided("mtllib glass.mtl\nusemtl Glass\n" + cube_obj(true, true)));
    // The material of a closed and of an open part.
    CHECK(two_sided("o Whole\n" + cube_obj(true, true) + "o Open\n" + "f 1 2 3\n"));
}

TEST_CASE("an STL scene keeps its solids, each welded and flat") {
    const scene::Scene scene = read_panel("panel.stl");
    CHECK(scene.nodes().size() == 3);
    const scene::Node& panel = node_of(scene, "Panel");
    check_panel(geometry_of(scene, panel), false);
    CHECK(geometry_of(scene, panel).normals.empty());
    CHECK(geometry_of(scene, node_of(scene, "Pane")).triangles.size() == 1);
    CHECK(scene.material(0).diffuse == scene::Material().diffuse);
    CHECK(scene.material(0).two_sided);
    CHECK(scene.notices().empty());
}

TEST_CASE("a binary STL scene is one part by its file's name") {
    std::string text(80, ' ');
    const std::uint32_t count = 1;
    text.append(reinterpret_cast<const char*>(&count), 4);
    const float numbers[] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0};
    text.append(reinterpret_cast<const char*>(numbers), sizeof numbers).append(2, '\0');
    const TemporaryFolder folder;
    const scene::Scene scene = read_well(folder.write("lid.STL", text));
    CHECK(geometry_of(scene, node_of(scene, "lid")).positions.size() == 3);
}

TEST_CASE("a PLY scene is one part by its file's name") {
    const scene::Scene scene = read_panel("panel.ply");
    CHECK(scene.nodes().size() == 2);
    const scene::Node& panel = node_of(scene, "panel");
    check_panel(geometry_of(scene, panel), false);  // and the vertex that no face has is gone
    CHECK(geometry_of(scene, panel).normals == std::vector(4, glm::vec3(0, 0.6F, 0.8F)));
    CHECK(geometry_of(scene, panel).colors == std::vector(4, glm::vec3(1, 0, 0)));
    CHECK(material_of(scene, panel).diffuse == glm::dvec4(1));  // they are shown as they are
    CHECK(material_of(scene, panel).ambient == glm::dvec4(0.1, 0.1, 0.1, 1));
    CHECK(scene.notices().empty());
}

TEST_CASE("colours of vertices are shown as they are, or multiply a material's") {
    const TemporaryFolder folder;
    const std::string triangle = "v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0 0 0 1\nf 1 2 3\n";
    const std::vector<glm::vec3> colors{{1, 0, 0}, {0, 0.5F, 0}, {0, 0, 1}};
    const scene::Scene plain = read_well(folder.write("plain.obj", triangle));
    CHECK(plain.geometries()[0].colors == colors);
    CHECK(plain.material(0).diffuse == glm::dvec4(1));
    folder.write("red.mtl", "newmtl Red\nKd 0.5 0 0\n");
    const scene::Scene red = read_well(folder.write("red.obj", "mtllib red.mtl\nusemtl Red\n" + triangle));
    CHECK(red.geometries()[0].colors == colors);
    CHECK(red.material(0).diffuse == glm::dvec4(0.5, 0, 0, 1));
}

TEST_CASE(
    "a binary PLY scene is read where its counts fit to the byte, and one of lists and spare lines too") {
    const TemporaryFolder folder;
    CHECK(read_well(folder.write("lid.ply", binary_ply(3, 1))).triangle_count() == 1);
    const std::string text =
        "PLY\r\nformat ascii 1.0\r\ncomment element vertex 999\r\nobj_info x\r\n"
        "element vertex 3\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\n"
        "element face 1\r\nproperty list uchar int vertex_indices\r\nend_header\r\n"
        "0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2";
    CHECK(read_well(folder.write("lid.ply", text)).triangle_count() == 1);
    std::string of_old_mac = text_of("panel.ply");
    std::replace(of_old_mac.begin(), of_old_mac.end(), '\n', '\r');
    CHECK(read_well(folder.write("lid.ply", of_old_mac)).triangle_count() ==
          read_panel("panel.ply").triangle_count());
}

TEST_CASE("a Collada scene keeps its hierarchy, names and matrices, upright and in metres") {
    const scene::Scene scene = read_panel("panel.dae");
    CHECK(scene.unit() == 1);
    const scene::Node &top = node_of(scene, "Scene"), &car = node_of(scene, "Car"),
                      &door = node_of(scene, "Door");
    CHECK(is_near(top.matrix[2], {0, 0.01, 0, 0}));   // up
    CHECK(is_near(top.matrix[1], {0, 0, -0.01, 0}));  // away
    CHECK(&parent_of(scene, car) == &top);
    CHECK(&parent_of(scene, door) == &car);
    CHECK(car.matrix[3] == glm::dvec4(1, 2, 3, 1));
    CHECK(door.matrix == glm::dmat4(0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1));
    check_panel(geometry_of(scene, door), true);
    const scene::Material& paint = material_of(scene, door);
    CHECK(paint.name == "Paint");
    CHECK(paint.diffuse == glm::dvec4(1, 1, 1, 0.5));
    CHECK(paint.emission == glm::dvec4(0, 0, 0.25, 1));
    CHECK(paint.specular == glm::dvec4(0.5, 0.5, 0.5, 1));
    CHECK(paint.shininess == 50);
    check_picture(scene, paint, 255);
}

TEST_CASE("a Collada scene keeps its cameras and lights") {
    const scene::Scene scene = read_panel("panel.dae");
    const scene::Node& camera = node_of(scene, "Camera");
    CHECK(camera.matrix[3] == glm::dvec4(0, 0, 9, 1));
    const auto& seen = std::get<scene::CameraData>(camera.data);
    CHECK(seen.fov == doctest::Approx(2 * 21.0517));  // of 60 degrees across, 3 : 2
    CHECK(seen.eye == glm::dvec3(0));
    CHECK(seen.focus == glm::dvec3(0, 0, -1));
    CHECK(std::get<scene::CameraData>(node_of(scene, "Camera2").data).fov == 40);
    const auto& lamp = std::get<scene::LightData>(node_of(scene, "Lamp").data);
    CHECK(lamp.type == scene::LightData::Type::spot);
    CHECK(lamp.color == glm::dvec4(1, 0.5, 0, 1));
    CHECK(lamp.attenuation == glm::dvec3(1, 0.5, 0.25));
    CHECK(lamp.angle == doctest::Approx(60));
    CHECK(node_of(scene, "Amb").type == scene::NodeType::assembly);
    CHECK(has_notice(scene, "a camera's field of view is unknown"));
    CHECK(has_notice(scene, "an area or ambient light"));
    CHECK(scene.notices().size() == 2);
}

TEST_CASE("an FBX scene keeps its hierarchy, names and matrices, upright and with its unit") {
    const scene::Scene scene = read_panel("panel.fbx");
    CHECK(scene.unit() == doctest::Approx(0.0254));
    const scene::Node &root = node_of(scene, "RootNode"), &car = node_of(scene, "Car");
    CHECK(root.matrix == glm::dmat4(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1));
    CHECK(&parent_of(scene, car) == &root);
    CHECK(car.matrix[3] == glm::dvec4(1, 2, 3, 1));
    // Shift, pivot, turn by 180 degrees, the post-rotation back by 90, pivot back, and the mesh's own shift.
    const scene::Node& door = node_of(scene, "Door");
    CHECK(&parent_of(scene, door) == &car);
    CHECK(is_near(door.matrix[0], {0, 1, 0, 0}));
    CHECK(is_near(door.matrix[1], {-1, 0, 0, 0}));
    CHECK(is_near(door.matrix[3], {5, 4, 13, 1}));
    // To which that shift does not belong.
    const scene::Node& handle = node_of(scene, "Handle");
    CHECK(&parent_of(scene, handle) == &door);
    CHECK(is_near(handle.matrix[3], {1, 0, -7, 1}));
    check_panel(geometry_of(scene, handle), true);
    CHECK(scene.geometries().size() == 1);
    CHECK(scene.nodes().size() == 9);
}

TEST_CASE("an FBX scene keeps its materials, cameras and lights") {
    const scene::Scene scene = read_panel("panel.fbx");
    const scene::Material& paint = material_of(scene, "Paint");
    CHECK(is_near(paint.diffuse, {0.5, 0.25, 0, 0.4}));
    CHECK_FALSE(has_notice(scene, "not multiplied"));  // the texture takes its place
    CHECK(paint.specular == glm::dvec4(0.5, 0.25, 0, 1));
    CHECK(paint.emission == glm::dvec4(0, 0, 0.25, 1));
    CHECK(paint.shininess == 50);
    check_picture(scene, paint, 255);
    const auto& camera = std::get<scene::CameraData>(node_of(scene, "Presenter").data);
    CHECK(camera.fov == doctest::Approx(2 * 21.0517));
    CHECK(is_near(glm::dvec4(camera.focus, 1), {4.5, 0, 0, 1}));  // as deep as the scene's centre
    CHECK(camera.up == glm::dvec3(0, 1, 0));
    const scene::Node& light = node_of(scene, "light");
    CHECK(parent_of(scene, light).name == "Lamp");
    CHECK(is_near(light.matrix[2], {0, 1, 0, 0}));  // so that -z, where it shines, is -y
    CHECK(std::get<scene::LightData>(light.data).color == glm::dvec4(0.5, 0.25, 0, 1));
    CHECK(std::get<scene::LightData>(light.data).angle == doctest::Approx(60));
    CHECK(has_notice(scene, "it does not attenuate with distance"));
    CHECK(scene.notices().size() == 1);
}

TEST_CASE("a camera looks at its target") {
    const scene::Scene scene = read_panel("panel.fbx", "\"Model::Handle\"", "\"Model::Presenter.Target\"");
    const auto& camera = std::get<scene::CameraData>(node_of(scene, "Presenter").data);
    CHECK(is_near(glm::dvec4(camera.focus, 1), {5, 5, 6, 1}));
}

TEST_CASE("FBX axes that are none are left as they are") {
    const scene::Scene scene = read_panel("panel.fbx", "\"FrontAxis\", \"int\", \"Integer\", \"\",1",
                                          "\"FrontAxis\", \"int\", \"Integer\", \"\",7");
    CHECK(parent_of(scene, node_of(scene, "Car")).type == scene::NodeType::root);
    CHECK(has_notice(scene, "its axes are not converted"));
}

TEST_CASE("the material library and pictures of an OBJ scene lie in its folder") {
    const TemporaryFolder outer;
    outer.write("secret.mtl", "newmtl Paint\nKd 1 0 0\n");
    outer.write("secret.png", picture());
    outer.write("scenes/tex/paint.png", picture());
    fs::create_symlink(outer.path() / "secret.png",
                       fs::path(outer.write("scenes/x", "")).parent_path() / "link.png");
    const auto notices_with = [&](const std::string& library, const std::string& image) {
        outer.write("scenes/paint.mtl", "newmtl Paint\nKd 1 1 1\nmap_Kd " + image + "\n");
        std::string text = text_of("panel.obj");
        text.replace(text.find("panel.mtl"), 9, library);
        return read_well(outer.write("scenes/panel.obj", text));
    };
    CHECK(notices_with("paint.mtl", "tex\\paint.png").notices().empty());
    const std::string outside = "it lies outside of the scene's folder";
    for (const std::string& image :
         {std::string("../secret.png"), std::string("link.png"), (outer.path() / "secret.png").string(),
          std::string("tex/../../secret.png")}) {
        const scene::Scene scene = notices_with("paint.mtl", image);
        CHECK_MESSAGE(has_notice(scene, outside), image);
        CHECK_MESSAGE(scene.textures().empty(), image);
    }
    CHECK(has_notice(notices_with("paint.mtl", "none.png"),
                     "without its texture 'none.png': there is no such file"));
    CHECK(has_notice(notices_with("none.mtl", "x"), "'none.mtl': there is no such file"));
    fs::create_symlink(outer.path() / "secret.mtl", outer.path() / "scenes/link.mtl");
    for (const std::string& library :
         {std::string("../secret.mtl"), std::string("link.mtl"), (outer.path() / "secret.mtl").string()}) {
        const scene::Scene scene = notices_with(library, "x");
        CHECK_MESSAGE(has_notice(scene, "'" + library + "': " + outside), library);
        for (const scene::Material& material : scene.materials())
            CHECK(material.diffuse != glm::dvec4(1, 0, 0, 1));
    }
}

TEST_CASE("the pictures of a Collada or FBX scene lie in its folder") {
    const TemporaryFolder outer;
    outer.write("secret.png", picture());
    outer.write("scenes/paint.png", picture());
    fs::create_symlink(outer.path() / "secret.png", outer.path() / "scenes/link.png");
    for (const auto& panel :
         {std::pair("panel.dae", "tex/my%20paint.png"), {"panel.fbx", "tex\\paint.png"}}) {
        const std::string file = panel.first, own = panel.second;
        const auto with_picture = [&](const std::string& image) {
            std::string text = text_of(file);
            if (const std::size_t at = text.find("C:\\work\\"); at != std::string::npos) text.erase(at, 8);
            for (std::size_t at = 0; (at = text.find(own, at)) != std::string::npos; at += image.size())
                text.replace(at, own.size(), image);
            return read_well(outer.write("scenes/" + file, text));
        };
        CAPTURE(file);
        CHECK(with_picture("paint.png").textures().size() == 1);
        for (const std::string& image : {std::string("../secret.png"), std::string("link.png"),
                                         (outer.path() / "secret.png").string()}) {
            const scene::Scene scene = with_picture(image);
            CHECK_MESSAGE(has_notice(scene, "it lies outside of the scene's folder"), image);
            CHECK_MESSAGE(scene.textures().empty(), image);
        }
    }
}

TEST_CASE("a picture is found by its name, beside the scene or in textures/") {
    const TemporaryFolder folder;
    folder.write("paint.png", picture());
    folder.write("textures/wheel.png", picture());
    const auto pictures_with = [&](const std::string& image) {
        folder.write("panel.mtl", "newmtl Paint\nmap_Kd " + image + "\n");
        return read_well(folder.write("panel.obj", text_of("panel.obj"))).textures().size();
    };
    for (const char* image : {"paint.png ", "paint.png\t\r", "../maps/paint.png", "/home/me/paint.png ",
                              "wheel.png", "C:\\maps\\wheel.png", "../wheel.png"})
        CHECK_MESSAGE(pictures_with(image) == 1, image);
    CHECK(pictures_with("door.png") == 0);

    std::string gltf = text_of("car.gltf");
    const std::size_t start = gltf.find("data:image"), end = gltf.find('"', start);
    gltf.replace(start, end - start, "../somewhere/wheel.png");
    CHECK_FALSE(has_notice(read_well(folder.write("car.gltf", gltf)), "without its texture"));
}

TEST_CASE("harmless faults do not refuse a file") {
    const TemporaryFolder folder;
    const auto triangle = [&](const std::string& normal, const std::string& material) {
        folder.write("a.mtl", "newmtl Paint\nKd 1 0 0\n" + material + "\n");
        return read_well(folder.write("a.obj", "mtllib a.mtl\nusemtl Paint\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn " +
                                                   normal + "\nf 1//1 2//1 3//1\n"));
    };
    const scene::Scene odd = triangle("nan 0 1", "");
    CHECK(odd.geometries()[0].normals == std::vector(3, glm::vec3(0)));
    CHECK(has_notice(odd, "a normal that is not a number is replaced by the face's (3 times)"));
    CHECK(triangle("0 0 1", "").notices().empty());

    for (const char* transparent : {"Tr 1", "d 0"}) {
        const scene::Scene scene = triangle("0 0 1", transparent);
        CHECK(scene.materials()[0].diffuse == glm::dvec4(1, 0, 0, 1));
        CHECK(has_notice(scene, "a material is opaque, though its file calls it wholly transparent"));
    }
    const scene::Scene clear =
        read_panel("panel.dae", "<transparency><float>0.5<", "<transparency><float>0<");
    CHECK(material_of(clear, "Paint").diffuse.a == 1);

    const std::string matrix = "0 -1 0 4 1 0 0 5 0 0 1 6 0 0 0 1";
    const scene::Scene rounded =
        read_panel("panel.dae", matrix, "0 -1 0 4 1 0 0 5 0 0 1 6 0 -1e-7 0 0.999999");
    CHECK(node_of(rounded, "Door").matrix == glm::dmat4(0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1));
    std::string text = text_of("panel.dae");
    check_refused_file("a.dae",
                       text.replace(text.find(matrix), matrix.size(), "0 -1 0 4 1 0 0 5 0 0 1 6 0 0.001 0 1"),
                       "the matrix of node 'Door' is not affine");
}

TEST_CASE("z is up where the user says so, in formats that do not tell") {
    const TemporaryFolder folder;
    for (const char* name : {"panel.obj", "panel.stl", "panel.ply", "panel.dae", "panel.fbx"}) {
        CAPTURE(name);
        const fs::path path = folder.write(name, text_of(name));
        const auto as_is = io::read_scene(path), turned = io::read_scene(path, {}, {.z_up = true});
        REQUIRE(as_is);
        REQUIRE(turned);
        const math::Bounds before = scene::place(*as_is).bounds, after = scene::place(*turned).bounds;
        const bool tells = path.extension() == ".dae" || path.extension() == ".fbx";
        CHECK(after.min == (tells ? before.min : glm::dvec3(before.min.x, before.min.z, -before.max.y)));
        CHECK(after.max == (tells ? before.max : glm::dvec3(before.max.x, before.max.z, -before.min.y)));
    }
}

TEST_CASE("a notice says that a scene seems to lie on its side") {
    const TemporaryFolder folder;
    const auto seems_z_up = [&](const std::string& name, const std::string& text) {
        return has_notice(
            read_well(folder.write(name, text)),
            "it seems to lie on its side: choose z as its up axis, in the page's menu or by --up-axis z");
    };
    const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ply = text_of("panel.ply");
    CHECK_FALSE(seems_z_up("a.obj", triangle));
    CHECK(seems_z_up("a.obj", "# Z-up, metres\n" + triangle));
    CHECK(seems_z_up("a.obj", "# Up axis: Z\n" + triangle));
    for (const char* comment : {"# y-up", "# group Z", "# Blender v2.79 (sub 0) OBJ File"})
        CHECK_FALSE(seems_z_up("a.obj", comment + ("\n" + triangle)));
    CHECK_FALSE(seems_z_up("a.ply", ply));
    CHECK(seems_z_up("a.ply",
                     std::string(ply).insert(ply.find("element"), "comment Created by Blender 2.93.0\n")));
    const std::string stl = text_of("panel.stl");
    for (const auto& [head, z_up] :
         {std::pair("Exported from Blender-2.93.1 (sub 0)", true), {"STL output from Blender", false}}) {
        CHECK(seems_z_up("a.stl", "solid " + std::string(head) + stl.substr(stl.find('\n'))) == z_up);
    }
    // Four wheels: small triangles.
    const auto car = [&](const std::string& name, char up) {
        std::string text;
        for (const auto& [x, y] : {std::pair(0, 0), {4, 0}, {0, 2}, {4, 2}}) {
            const std::string ends[] = {" 0", " 1", " 0"};
            text += "o " + name + std::to_string(10 * x + y) + "\n";
            for (int i = 0; i < 3; ++i) {
                const std::string at = std::to_string(y + i % 2);
                text += "v " + std::to_string(x + i / 2) +
                        (up == 'z' ? " " + at + ends[i] : ends[i] + " " + at) + "\n";
            }
            text += "f -3 -2 -1\n";
        }
        return text;
    };
    CHECK(seems_z_up("a.obj", car("Wheel_", 'z')));
    CHECK_FALSE(seems_z_up("a.obj", car("Wheel_", 'y')));
    CHECK_FALSE(seems_z_up("a.obj", car("Panel_", 'z')));
    // What stands on the ground.
    const auto standing = [](const char* corners) { return std::string(corners) + "f 1 2 3\nf 1 3 4\n"; };
    CHECK(seems_z_up("a.obj", standing("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv 0 0 3\n")));
    CHECK_FALSE(seems_z_up("a.obj", standing("v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv 0 3 0\n")));
    CHECK_FALSE(seems_z_up("a.obj", standing("v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv 0 0 1\n")));
    const fs::path cone = folder.write("a.obj", standing("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv 0 0 3\n"));
    CHECK(io::read_scene(cone, {}, {.z_up = true})->notices().empty());
}

TEST_CASE("polygons of many corners are covered") {
    // A star of 600 corners, 1 and 2 from its middle: each of its points adds sin(2 pi / 600) to its area.
    constexpr int kCorners = 600;
    std::string vertices, face = "f", turned = "f";
    for (int i = 0; i < kCorners; ++i) {
        const double angle = 2 * M_PI * i / kCorners, radius = 1 + i % 2;
        vertices += "v " + std::to_string(radius * std::cos(angle)) + " " +
                    std::to_string(radius * std::sin(angle)) + " 0\n";
        face += " " + std::to_string(i + 1);
        turned += " " + std::to_string(kCorners - i);
    }
    const TemporaryFolder folder;
    const scene::Scene scene =
        read_well(folder.write("a.obj", vertices + face + "\nf 1 2 3 4 5\n" + turned + "\nf 1 2 3\n"));
    REQUIRE(scene.geometries().size() == 1);
    const scene::Geometry& geometry = scene.geometries()[0];
    CHECK(geometry.triangles.size() == 2 * (kCorners - 2) + 3 + 1);
    double front = 0, back = 0;
    for (const glm::uvec3& t : geometry.triangles) {
        const glm::dvec3 a = geometry.positions[t.x];
        const double area = glm::cross(geometry.positions[t.y] - a, geometry.positions[t.z] - a).z / 2;
        (area > 0 ? front : back) += area;
    }
    CHECK(read_well(folder.write("b.obj", vertices + face + "\n")).triangle_count() == kCorners - 2);
    const double star = kCorners * std::sin(2 * M_PI / kCorners);
    CHECK(std::abs(back + star) < 1e-4);
    CHECK(std::abs(front - star) < 0.1);
}

TEST_CASE("an empty solid beside others is no fault") {
    const TemporaryFolder folder;
    const scene::Scene scene =
        read_well(folder.write("a.stl", text_of("panel.stl") + "solid nothing\nendsolid nothing\n"));
    CHECK(scene.geometries().size() == read_panel("panel.stl").geometries().size());
}

TEST_CASE("a picture lies on the texture coordinates that its material names") {
    std::string text = text_of("panel.dae");
    const auto replace = [&](const std::string& from, const std::string& to) {
        REQUIRE_MESSAGE(text.find(from) != std::string::npos, from);
        text.replace(text.find(from), from.size(), to);
    };
    const auto read = [&] {
        const TemporaryFolder folder;
        folder.write("tex/my paint.png", picture());
        return read_well(folder.write("panel.dae", text));
    };
    replace("texcoord=\"UV\"", "texcoord=\"CHANNEL1\"");
    replace("target=\"#mat\"/>",
            "target=\"#mat\"><bind_vertex_input semantic=\"CHANNEL1\" input_semantic=\"TEXCOORD\" "
            "input_set=\"0\"/></instance_material>");
    const scene::Scene first = read();
    check_panel(geometry_of(first, node_of(first, "Door")), true);
    CHECK_FALSE(has_notice(first, "texture coordinates"));

    const std::string other =
        "<bind_vertex_input semantic=\"CHANNEL2\" input_semantic=\"TEXCOORD\" input_set=\"0\"/>";
    replace("</instance_material>", other + "</instance_material>");
    const scene::Scene twice = read();
    check_panel(geometry_of(twice, node_of(twice, "Door")), true);
    CHECK_FALSE(has_notice(twice, "texture coordinates"));
    replace(other, "");

    replace("input_set=\"0\"", "input_set=\"1\"");
    replace("<input semantic=\"TEXCOORD\" source=\"#uv\" offset=\"1\" set=\"0\"/>",
            "<input semantic=\"TEXCOORD\" source=\"#zero\" offset=\"1\" set=\"0\"/>"
            "<input semantic=\"TEXCOORD\" source=\"#uv\" offset=\"1\" set=\"1\"/>");
    replace("<vertices id=\"v\">",
            "<source id=\"zero\"><float_array id=\"zeroa\" count=\"8\">0 0 0 0 0 0 0 0</float_array>"
            "<technique_common><accessor source=\"#zeroa\" count=\"4\" stride=\"2\">"
            "<param name=\"S\" type=\"float\"/><param name=\"T\" "
            "type=\"float\"/></accessor></technique_common></source>"
            "<vertices id=\"v\">");
    const scene::Scene second = read();
    check_panel(geometry_of(second, node_of(second, "Door")), true);
    CHECK_FALSE(has_notice(second, "texture coordinates"));
}

TEST_CASE("a picture that says that it is huge is not read") {
    const TemporaryFolder folder;
    folder.write("panel.mtl", "newmtl Paint\nmap_Kd paint.png\n");
    std::string png = picture();
    png[17] = png[21] = 1;  // 65,538 pixels on each side, and a checksum that is no longer right
    folder.write("paint.png", png);
    CHECK(has_notice(read_well(folder.write("panel.obj", text_of("panel.obj"))),
                     "without its texture 'paint.png'"));
}

TEST_CASE("files of other programs that are none are refused in a sentence") {
    const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", ply = text_of("panel.ply"),
                      dae = text_of("panel.dae"), fbx = text_of("panel.fbx");
    const auto with = [](std::string text, const std::string& from, const std::string& to) {
        REQUIRE(text.find(from) != std::string::npos);
        return text.replace(text.find(from), from.size(), to);
    };
    const struct {
        const char* file;
        std::string text;
        const char* why;
    } kFiles[] = {
        {"a.obj", "", "too small"},
        {"a.obj", "nothing that a model is made of\n", "no triangles"},
        {"a.obj", triangle, "no triangles"},
        {"a.obj", triangle + "p 1 2 3\n", "it has no triangles, only points or lines"},
        {"a.obj", triangle + "l 1 2 3\n", "it has no triangles, only points or lines"},
        {"a.obj", triangle + "f 1 2 9\n", "index out of range"},
        {"a.obj", triangle + "f -1 -2 -9\n", "index out of range"},
        {"a.obj", triangle + "f 99999999999999999999 1 2\n", "index out of range"},
        {"a.obj", triangle + "f 0 0 0\n", "Invalid face index"},
        {"a.obj", triangle + "f 1 2", "no triangles"},
        {"a.obj", "v nan 0 0\n" + triangle + "f 1 2 3\n", "a vertex of mesh 'defaultobject' is not a number"},
        {"a.obj", "v 1e300 0 0\n" + triangle + "f 1 2 3\n",
         "a vertex of mesh 'defaultobject' is not a number"},
        {"a.obj", "v 1e999 0 0\n" + triangle + "f 1 2 3\n", "is not a number from -1e15 to 1e15"},
        {"a.obj", "v inf 0 0\n" + triangle + "f 1 2 3\n", "is not a number from -1e15 to 1e15"},
        {"a.stl", "", "empty"},
        {"a.stl", std::string(80, 'x') + std::string(4, '\1') + std::string(50, '\0'),
         "of the size that its triangle count requires"},
        {"a.stl", std::string(80, 'x') + std::string(4, '\xff') + std::string(50, '\0'),
         "of the size that its triangle count requires"},
        {"a.stl",
         std::string(80, 'x') + std::string("\x20\x85\xeb\x51") + std::string(64, '\0'),  // 2^36 bytes
         "too small to hold all facets"},
        {"a.stl", std::string(80, 'x') + std::string("\2\0\0\0", 4) + std::string(50, '\0'),
         "of the size that its triangle count requires"},
        {"a.stl",
         "solid a\nfacet normal 0 0 1\nouter loop\nvertex 1e999 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
         "endloop\nendfacet\nendsolid a\n",
         "a vertex of mesh 'a' is not a number"},
        {"a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "Invalid number of vertices"},
        {"a.ply", "", "empty"},
        {"a.ply", "not a model", "magic number"},
        {"a.ply", with(ply, "4 0 1 2 3", "0"), "a face without vertices"},
        {"a.ply", with(ply, "4 0 1 2 3", "4 0 1 2 9"), "the mesh has a vertex index out of range"},
        {"a.ply", with(ply, "4 0 1 2 3", "3 0 1 -2"), "the mesh has a vertex index out of range"},
        {"a.ply", with(ply, "1 1 0 0 0.6", "1 1e30 0 0 0.6"), "a vertex of the mesh is not a number"},
        {"a.ply", ply.substr(0, ply.size() - 20), "a vertex index out of range"},
        {"a.ply", ply.substr(0, 60), "its header has no 'end_header'"},
        {"a.ply", ply.substr(0, ply.size() - 100),
         "line 3: expected a count of 'vertex' that fits into the file"},
        {"a.ply", with(ply, "vertex 5", "vertex 4000000000"), "line 3: expected a count of 'vertex'"},
        {"a.ply", with(ply, "vertex 5", "vertex 99999999999999999999"),
         "line 3: expected a count of 'vertex'"},
        {"a.ply", with(ply, "vertex 5", "vertex -1"), "line 3: expected a count of 'vertex', found '-1'"},
        {"a.ply", with(ply, "face 1", "face 4000000000"),
         "line 13: expected a count of 'face' that fits into the file, found 4000000000"},
        {"a.ply", with(ply, "element face 1", "element edge 4000000000\nelement face 1"),
         "line 13: expected a count of 'edge'"},
        {"a.ply", with(ply, "element face", "element vertex 7\nelement face"),
         "'vertex' once, found it twice"},
        {"a.ply", with(ply, "element face", "element tristrips 1\nelement face"),
         "line 14: 'tristrips' beside 'face' cannot be read: export it with one of them"},
        {"a.ply", with(ply, "element face 1", "element face 0"), "only points or lines"},
        {"a.ply", binary_ply(4'000'000'000, 1), "line 3: expected a count of 'vertex'"},
        {"a.ply", binary_ply(5, 1), "line 3: expected a count of 'vertex' that fits into the file, found 5"},
        {"a.ply", binary_ply(3, 4'000'000'000), "line 7: expected a count of 'face'"},
        {"a.stl", "solid a\nendsolid a\n", "no triangles"},
        {"a.dae", "", "malformed XML"},
        {"a.dae", dae.substr(0, dae.size() / 2), "malformed XML"},
        {"a.dae", with(dae, "3 3</p>", "9 3</p>"), "Invalid data index"},
        {"a.dae", with(dae, "0 0 0 1 0 0", "0 0 0 1e999 0 0"), "a vertex of mesh 'Panel' is not a number"},
        {"a.dae", with(dae, "url=\"#Scene\"", "url=\"#none\""), "Unable to resolve visual_scene"},
        {"a.dae", with(dae, "<instance_visual_scene url=\"#Scene\"/>", ""), "it has no scene to show"},
        {"a.dae", with(dae, "<vcount>4<", "<vcount>400<"), "index count"},
        {"a.dae", with(dae, "<translate>1 2 3", "<translate>1 2e30 3"), "the matrix of node 'Car'"},
        {"a.fbx", "", "unexpected end of file"},
        {"a.fbx", "nothing that a model is made of\n", "unexpected token"},
        {"a.fbx", fbx.substr(0, fbx.size() / 2), "FBX-Parser"},
        {"a.fbx", with(fbx, "FBXVersion: 7", "FBXVersion: 6"),
         "it is FBX of a version before 7.1, which cannot be read: export it as FBX 2011 or later"},
        {"a.fbx", "Kaydara FBX Binary  " + std::string(1, '\0') + "\x1a" + std::string(40, '\x7f'),
         "written by assimp 5.2"},
        {"a.fbx",
         "Kaydara FBX Binary  " + std::string("\0\x1a\0\xe8\x1c\0\0\x60\0\0\0\1\0\0\0\1\0\0\0\1AZ", 22) +
             std::string(90, '\0'),
         "its contents are damaged, or newer than FBX 2013"},
        {"a.fbx", with(fbx, "0,1,2,-4", "0,1,9,-4"), "no triangles"},
        {"a.fbx", with(fbx, "0,1,2,-4", "0,1,2,3"), "no triangles"},
        {"a.fbx", with(fbx, "0,0,0,1,0,0,1,1,0", "0,0,0,1,0,0,1,1e999,0"),
         "a vertex of mesh 'Door' is not a number"},
        {"a.fbx", with(fbx, "0,0,0,1,0,0,1,1,0", "0,0,0,1,0,0,1,nan,0"),
         "a vertex of mesh 'Door' is not a number"},
    };
    for (const auto& [file, text, why] : kFiles) check_refused_file(file, text, why);
}

TEST_CASE("models of other programs are read whole" * NeedsFolder{"VRUT_TEST_MODELS"}) {
    const fs::path models = folder_of("VRUT_TEST_MODELS");
    const struct {
        const char* file;
        std::uint64_t triangles;
        std::size_t geometries, materials, textures;
    } kModels[] = {
        {"bmw_m6/bmw_m6.glb", 791'468, 110, 24, 0},
        {"hatchback/hatchback/meshes/hatchback.obj", 788, 4, 2, 0},  // its pictures lie elsewhere
        {"jeep/2013_ASCII/jeep1.fbx", 2'032, 7, 2, 1},
        {"jeep/2013_BINARY/jeep1.fbx", 2'032, 7, 2, 1},
    };
    for (const auto& model : kModels) {
        const scene::Scene scene = read_well(models / model.file);
        CHECK_MESSAGE(scene.triangle_count() == model.triangles, model.file);
        CHECK_MESSAGE(scene.geometries().size() == model.geometries, model.file);
        CHECK_MESSAGE(scene.materials().size() == model.materials, model.file);
        CHECK_MESSAGE(scene.textures().size() == model.textures, model.file);
    }
}
