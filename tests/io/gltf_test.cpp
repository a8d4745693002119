#include <doctest/doctest.h>

#include <cstring>

#include "image_bytes.hpp"
#include "scene_queries.hpp"

using namespace vrut;
namespace fs = std::filesystem;

namespace {

const fs::path kCar = VRUT_TEST_DATA "/scenes/car.gltf";

std::string car_text() {
    std::ifstream stream(kCar, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// The text with each `from` in it, of which there is one at least, as `to`.
std::string replaced(std::string text, const std::string& from, const std::string& to) {
    std::size_t at = text.find(from);
    REQUIRE_MESSAGE(at != std::string::npos, from);
    for (; at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
    return text;
}

void check_refused(const std::string& text, const std::string& why, const std::string& name = "car.gltf") {
    check_refused_file(name, text, why);
}

std::string car_with(const std::string& from, const std::string& to) {
    return replaced(car_text(), from, to);
}

std::string decoded_base64(std::string_view text) {
    std::string bytes;
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < text.size() && text[i] != '='; ++i) {
        constexpr std::string_view kLetters =
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        bits = (bits << 6) | static_cast<std::uint32_t>(kLetters.find(text[i]));
        if (i % 4 > 0) bytes += static_cast<char>(bits >> (6 - 2 * (i % 4)));
    }
    return bytes;
}

std::string chunk(const char* kind, std::string bytes, char padding) {
    bytes.resize((bytes.size() + 3) / 4 * 4, padding);
    const auto size = static_cast<std::uint32_t>(bytes.size());
    std::string head(8, '\0');
    std::memcpy(head.data(), &size, 4);
    std::memcpy(head.data() + 4, kind, 4);
    return head + bytes;
}

/// The car as a binary file.
std::string car_glb() {
    std::string json = car_text();
    const std::string uri = R"(, "uri": "data:application/octet-stream;base64,)";
    const std::size_t begin = json.find(uri), end = json.find('"', begin + uri.size());
    const std::string buffer = json.substr(begin + uri.size(), end - begin - uri.size());
    json.erase(begin, end + 1 - begin);
    const std::string chunks = chunk("JSON", json, ' ') + chunk("BIN\0", decoded_base64(buffer), '\0');
    const std::uint32_t numbers[] = {2, static_cast<std::uint32_t>(12 + chunks.size())};
    return "glTF" + std::string(reinterpret_cast<const char*>(numbers), sizeof numbers) + chunks;
}

}  // namespace

TEST_CASE("a glTF scene keeps its hierarchy, names and matrices") {
    const scene::Scene scene = read_well(kCar);
    CHECK(scene.unit() == 1);
    CHECK(scene.nodes()[0].children.size() == 3);
    const scene::Node& car = node_of(scene, "Car");
    CHECK(car.matrix[3] == glm::dvec4(1, 2, 3, 1));
    const scene::Node& left = node_of(scene, "Left door");
    CHECK(&parent_of(scene, left) == &car);
    CHECK(is_near(left.matrix[0], {0.56, 0, -1.92, 0}));  // by twice cosine and sine of 73.7 degrees
    CHECK(is_near(left.matrix[2], {1.92, 0, 0.56, 0}));
    CHECK(node_of(scene, "Right door").matrix[3] == glm::dvec4(0.5, -4, 0.25, 1));
    for (const scene::Node& node : scene.nodes()) CHECK(node.name != "Not in the scene");
}

TEST_CASE("a glTF mesh is one geometry for all nodes that show it, with a child for each of several parts") {
    const scene::Scene scene = read_well(kCar);
    CHECK(scene.geometries().size() == 3);
    const scene::Node& left = node_of(scene, "Left door");
    const scene::Node& right = node_of(scene, "Door");
    CHECK(parent_of(scene, right).name == "Right door");
    CHECK(std::get<scene::GeometryData>(left.data).geometry ==
          std::get<scene::GeometryData>(right.data).geometry);
    CHECK(node_of(scene, "Mirror").type == scene::NodeType::assembly);
    CHECK(parent_of(scene, node_of(scene, "Mirror-0")).name == "Mirror");
    CHECK(parent_of(scene, node_of(scene, "Mirror-1")).name == "Mirror");
    const scene::Geometry& door = scene.geometries()[0];
    CHECK(door.positions[2] == glm::dvec3(1, 1, 0));
    CHECK(door.normals.size() == 4);
    CHECK(door.normals[3] == glm::vec3(0, 0, 1));
    CHECK(door.texcoords[0] == glm::vec2(0, 0));  // bottom left, which is 0 1 in glTF
    CHECK(door.texcoords[2] == glm::vec2(1, 1));
    CHECK(door.triangles[1] == glm::uvec3(0, 2, 3));
    CHECK(door.bounds.max == glm::dvec3(1, 1, 0));
    CHECK(scene.triangle_count() == 8);
}

TEST_CASE("glTF materials follow one rule") {
    const scene::Scene scene = read_well(kCar);
    const scene::Material& chrome = material_of(scene, "Chrome");
    const double half = 0.7353569830524495;           // what half the light displays as
    CHECK(is_near(chrome.diffuse, {half, 1, 0, 1}));  // opaque, whatever its alpha
    CHECK(is_near(chrome.ambient, {half / 10, 0.1, 0, 1}));
    CHECK(is_near(chrome.specular, {half / 2, 0.5, 0, 1}));
    CHECK(chrome.shininess == doctest::Approx(7.5));
    CHECK(chrome.emissive == glm::dvec3(0, 0, 0.5));
    CHECK(chrome.emission == glm::dvec4(0, 0, 0, 1));
    CHECK(chrome.two_sided);
    CHECK(chrome.texture == scene::kNone);
    CHECK_FALSE(material_of(scene, "Paint").two_sided);
    CHECK(material_of(scene, "Paint").specular == glm::dvec4(0, 0, 0, 1));
    CHECK(material_of(scene, "Paint").shininess == 1);
    const scene::Material& glass = material_of(scene, "Glass");
    CHECK(glass.diffuse == glm::dvec4(1, 1, 1, 0.25));
    CHECK(is_near(glass.specular, {0.22, 0.22, 0.22, 1}));
    CHECK(glass.shininess == 10'000);
}

TEST_CASE("pictures inside a glTF file are read, and seen through only where its material blends") {
    const scene::Scene scene = read_well(kCar);
    const auto texture = [&](const char* material) -> const scene::Texture& {
        const scene::Index index = material_of(scene, material).texture;
        REQUIRE(index != scene::kNone);
        return scene.textures()[static_cast<std::size_t>(index)];
    };
    const std::vector<std::uint8_t> clear = {0,   0, 255, 255, 255, 255, 255, 0,
                                             255, 0, 0,   255, 0,   255, 0,   255};
    CHECK(texture("Glass").image.rgba == clear);  // blue at the bottom left
    CHECK(texture("Glass").transparent);
    std::vector<std::uint8_t> opaque = clear;
    opaque[7] = 255;
    CHECK(texture("Paint").image.rgba == opaque);
    CHECK_FALSE(scene.is_transparent(material_of(scene, "Paint")));
}

TEST_CASE("glTF cameras and lights are nodes") {
    const scene::Scene scene = read_well(kCar);
    const scene::Node& camera = node_of(scene, "Presenter");
    REQUIRE(camera.type == scene::NodeType::camera);
    CHECK(std::get<scene::CameraData>(camera.data).fov == doctest::Approx(30));
    CHECK(std::get<scene::CameraData>(camera.data).eye == glm::dvec3(0));
    CHECK(camera.matrix[3] == glm::dvec4(0, 1, 5, 1));
    const scene::Node& lamp = node_of(scene, "light");
    CHECK(parent_of(scene, lamp).name == "Lamps");
    const auto& spot = std::get<scene::LightData>(lamp.data);
    CHECK(spot.type == scene::LightData::Type::spot);
    CHECK(spot.angle == doctest::Approx(60));
    CHECK(is_near(spot.color, {1, 0.7353569830524495, 0, 1}));
    CHECK(std::get<scene::LightData>(node_of(scene, "Sun").data).type == scene::LightData::Type::directional);
}

TEST_CASE("a glTF camera's field of view is the file's vertical one, whatever its aspect ratio") {
    const TemporaryFolder folder;
    for (const char* aspect : {"\"aspectRatio\": 1.5", "\"aspectRatio\": 0.1", "\"aspectRatio\": 1e39"}) {
        const scene::Scene scene =
            read_well(folder.write("car.gltf", car_with("\"aspectRatio\": 1.5", aspect)));
        CHECK(std::get<scene::CameraData>(node_of(scene, "Presenter").data).fov == doctest::Approx(30));
    }
}

TEST_CASE("a glTF camera's extras may tell its focus distance, and may be anything else") {
    const TemporaryFolder folder;
    const auto focus_with = [&](const std::string& extras) {
        const std::string text = car_with("\"cameras\": [{", "\"cameras\": [{\"extras\": " + extras + ", ");
        return std::get<scene::CameraData>(
                   node_of(read_well(folder.write("car.gltf", text)), "Presenter").data)
            .focus;
    };
    const glm::dvec3 seen = focus_with("{}");
    CHECK(focus_with(R"({"focusDistance": 2.5})") == glm::dvec3(0, 0, -2.5));
    for (const char* other :
         {"7", "[1]", R"("far")", R"({"focusDistance": "far"})", R"({"focusDistance": 0})",
          R"({"focusDistance": -3})", R"({"focusDistance": 1e200})"})
        CHECK(focus_with(other) == seen);
}

TEST_CASE("what a glTF scene loses is told, once for each kind") {
    const scene::Scene scene = read_well(kCar);
    for (const char* part : {"a skin is ignored", "an animation is ignored", "points or lines",
                             "it does not attenuate with distance (2 times)"})
        CHECK_MESSAGE(has_notice(scene, part), part);
    CHECK(scene.notices().size() == 4);
}

TEST_CASE("a binary glTF file and an ending in capitals are the same scene") {
    const TemporaryFolder folder;
    CHECK(read_well(folder.write("car.glb", car_glb())).triangle_count() == 8);
    CHECK(read_well(folder.write("CAR.GLB", car_glb())).triangle_count() == 8);
    CHECK(read_well(folder.write("CAR.GLTF", car_text())).triangle_count() == 8);
}

TEST_CASE("the buffers and pictures of a glTF scene lie in its folder") {
    const std::string text = car_text();
    const std::size_t begin = text.find("data:application"), end = text.find('"', begin);
    const std::string data = text.substr(begin, end - begin);
    const std::string image =
        text.substr(text.find("data:image"), text.find("\"}],\n  \"cameras\"") - text.find("data:image"));
    const TemporaryFolder outer;
    const std::string buffer(140, '\0');  // all zeros: six times the first vertex
    outer.write("secret.bin", buffer);
    outer.write("scenes/my parts/car.bin", buffer);
    outer.write("scenes/my parts/paint.png", flat_png(2, 2, {1, 2, 3, 255}));
    fs::create_symlink(outer.path() / "secret.bin", outer.path() / "scenes/link.bin");
    const auto read_with = [&](const std::string& uri) {
        return io::read_scene(outer.write("scenes/car.gltf", car_with(data, uri)));
    };
    CHECK(read_with("my parts/car.bin"));
    CHECK(read_with("my%20parts/car.bin"));
    for (const std::string& uri :
         {std::string("../secret.bin"), std::string("link.bin"), (outer.path() / "secret.bin").string(),
          std::string("my parts/../../secret.bin")}) {
        const auto scene = read_with(uri);
        REQUIRE_MESSAGE(!scene, uri);
        CHECK_MESSAGE(scene.error().find("it lies outside of the scene's folder") != std::string::npos,
                      scene.error());
    }
    REQUIRE_FALSE(read_with("none.bin"));
    CHECK(read_with("none.bin").error().find("'none.bin': there is no such file") != std::string::npos);
    const scene::Scene scene =
        read_well(outer.write("scenes/car.gltf", car_with(image, "my%20parts/paint.png")));
    CHECK(scene.textures().size() == 1);
    outer.write("scenes/my%20paint.png",
                flat_png(2, 2, {1, 2, 3, 255}));  // as the address says, to the letter
    CHECK(read_well(outer.write("scenes/car.gltf", car_with(image, "my%20paint.png"))).textures().size() ==
          1);
    for (const std::string& uri :
         {std::string("../secret.bin"), std::string("link.bin"), (outer.path() / "secret.bin").string()})
        CHECK_MESSAGE(has_notice(read_well(outer.write("scenes/car.gltf", car_with(image, uri))),
                                 "without its texture '" + uri + "': it lies outside of the scene's folder"),
                      uri);
}

TEST_CASE("a glTF file that is none is refused in a sentence") {
    check_refused("", "its JSON ends too early");
    check_refused("nothing", "its JSON is invalid at byte 2");
    check_refused("[]", "its JSON is not an object");
    check_refused("{\"a\": 1e999}", "beyond the range of double precision");
    check_refused(car_text().substr(0, 900), "its JSON ends too early");
    check_refused(car_with("\"scene\": 0", "\"scene\": \"0\""),
                  "a member 'scene' that is not an integer from 0");
    check_refused("vrut-text 1", "not a binary glTF", "car.glb");
    check_refused(R"({"meshes":{"box":{}},"asset":{"generator":"a","version":"1.0"}})",
                  "it is glTF 1.0: export");
    check_refused(std::string("glTF\1\0\0\0", 8) + std::string(40, ' '), "it is glTF 1.0: export", "car.glb");
    check_refused(car_glb().substr(0, 900), "its JSON chunk exceeds the file", "car.glb");
    check_refused(car_glb().substr(0, car_glb().size() - 8), "its binary chunk exceeds the file", "car.glb");
    check_refused(car_with("\"2.0\"", "\"1.0\""), "it is glTF 1.0: export");
    check_refused(car_with("\"2.0\"", "\"3.0\""), "export it as glTF 2.0");
    check_refused(car_with("Left door", "Left \xff door"), "UTF-8");
    check_refused(std::string(100'000, '['), "nested too deeply");
    check_refused(car_with("\"scene\": 0", "\"scene\": 3"), "no scene");
    check_refused(car_with("\"mode\": 3", "\"mode\": 9"), "mode is invalid");
    check_refused(R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{}]})",
                  "no triangles");
    check_refused(car_with("[0, 6, 7]", "[5]"), "no triangles");
}

TEST_CASE("numbers of a glTF file that lead nowhere are refused in a sentence") {
    check_refused(car_with("\"mesh\": 1", "\"mesh\": 7"), "no mesh 7");
    check_refused(car_with("\"children\": [3]", "\"children\": [30]"), "no node 30");
    check_refused(car_with("\"children\": [3]", "\"children\": [0]"), "node 0 has several parents");
    check_refused(car_with("\"children\": [3]", "\"children\": [1]"), "node 1 has several parents");
    check_refused(car_with("\"indices\": 3", "\"indices\": 8"), "no accessor 8");
    check_refused(car_with("\"material\": 1", "\"material\": 5"), "no material 5");
    check_refused(car_with("\"byteOffset\": 128", "\"byteOffset\": 129"), "exceeds its buffer");
    check_refused(car_with("5123, \"count\": 6", "5123, \"count\": 7"), "exceeds its bufferView");
    check_refused(car_with("5123, \"count\": 6", "5123, \"count\": 1"), "too few vertices");
    // Of the normals' bytes a vertex index is made that there is not: 1 as a float ends with 0x3f80.
    check_refused(car_with("\"bufferView\": 3", "\"bufferView\": 1"), "vertex index out of range");
    check_refused(car_with("[1, 2, 3]", "[1e300, 2, 3]"), "matrix of node 'Car'");
    check_refused(car_with("0.25, 1]", "0.25, 2]"), "0 0 0 1");
}

TEST_CASE("the indices of glTF lines and points, which are not shown, may be any") {
    const std::string strange =
        replaced(car_text(), "\"count\": 6, \"type\": \"SCALAR\"}",
                 "\"count\": 6, \"type\": \"SCALAR\"}, {\"bufferView\": 1, \"byteOffset\": 10, "
                 "\"componentType\": 5121, \"count\": 2, \"type\": \"SCALAR\"}");
    const TemporaryFolder folder;
    for (const char* mode : {"0", "1", "2", "3"}) {
        const std::string primitive = "\"indices\": 4, \"mode\": " + std::string(mode);
        const scene::Scene scene =
            read_well(folder.write("car.gltf", replaced(strange, "\"mode\": 3", primitive)));
        CHECK(scene.triangle_count() == 8);
        CHECK(has_notice(scene, "points or lines"));
    }
}

TEST_CASE("data URIs of a glTF file may be written in any way") {
    const TemporaryFolder folder;
    const auto read_with = [&](const std::string& from, const std::string& to) {
        return read_well(folder.write("car.gltf", car_with(from, to)));
    };
    for (const char* head :
         {R"(d\u0061ta:image\/p\u006Eg)", "data:", "data:image", "data:image/x-unknown;charset=a"})
        CHECK_MESSAGE(read_with("data:image/png", head).textures().size() == 2, head);
    const std::string long_head = "data:" + std::string(300, 'a') + "/b";
    for (const std::string& head :
         {std::string(R"(data:\u010D\ud83d\ude97)"), std::string("data:"), long_head})
        CHECK(read_with("data:application/octet-stream", head).triangle_count() == 8);
    CHECK(has_notice(read_with("data:image/png;base64,", "data:image/png"),
                     "is drawn without its texture '*0': a data URI has no data"));
    CHECK(has_notice(read_with("data:image/png;base64,", "data:image/png,"),
                     "without its texture '*0': it is none of"));
    check_refused(car_with("octet-stream;base64,", "octet-stream;base64,!"),
                  "a data URI is not valid base64");
    check_refused(car_with("octet-stream;base64,", "octet-stream,"), "mesh 'Door' has a vertex index");
    check_refused(car_with("\"byteLength\": 140", "\"byteLength\": 144"),
                  "buffer 0 has 140 bytes, but its byteLength is 144");
    check_refused(car_with("data:application/octet-stream", R"(\u0000)"),
                  "its name is empty or contains a NUL");
}

TEST_CASE("a small glTF file that would take much memory is refused") {
    const std::string large =
        "{\"componentType\": 5126, \"count\": 16777216, \"type\": \"VEC3\", \"sparse\": "
        "{\"count\": 1, \"indices\": {\"bufferView\": 3, \"componentType\": 5123}, "
        "\"values\": {\"bufferView\": 0}}}";
    const std::string why = "loading it would need more than 256 MiB of memory";
    // Sparse ones.
    const auto with_positions = [](const std::string& text) {
        return replaced(text, "\"attributes\": {\"POSITION\": 0}, \"indices\": 3",
                        "\"attributes\": {\"POSITION\": 4}, \"indices\": 3");
    };
    const std::string behind = "\"type\": \"SCALAR\"}";
    check_refused(with_positions(car_with(behind, behind + ", " + large)), why);
    const std::string none = "{\"componentType\": 5126, \"count\": 4294967295, \"type\": \"VEC3\"}";  // zeros
    check_refused(with_positions(car_with(behind, behind + ", " + none)), why);
    // One that is used often.
    std::string primitives;
    for (int i = 0; i < 40; ++i) primitives += "{\"attributes\": {\"POSITION\": 4}}, ";
    const std::string million = replaced(large, "16777216", "1000000");
    const std::string many = replaced(car_with(behind, behind + ", " + million),
                                      "{\"attributes\": {\"POSITION\": 0}, \"mode\": 3}",
                                      primitives + "{\"attributes\": {\"POSITION\": 0}}");
    check_refused(many, why);
    const TemporaryFolder folder;
    CHECK(io::read_scene(folder.write("car.gltf", replaced(many, "1000000", "1000"))));
    // One file in many buffers.
    folder.write("zeros.bin", "");
    fs::resize_file(folder.path() / "zeros.bin", 4 << 20);
    std::string buffers, views, pictures, textures, materials, used;
    for (int i = 1; i <= 100; ++i) {
        const std::string number = std::to_string(i);
        buffers += ", {\"byteLength\": 4194304, \"uri\": \"zeros.bin\"}";
        views += ", {\"buffer\": " + number + ", \"byteLength\": 4194304}";
        pictures += ", {\"bufferView\": " + std::to_string(i + 3) + ", \"mimeType\": \"image/png\"}";
        textures += ", {\"source\": " + number + "}";
        materials += ", {\"pbrMetallicRoughness\": {\"baseColorTexture\": {\"index\": " + number + "}}}";
        used +=
            "{\"attributes\": {\"POSITION\": 0}, \"mode\": 3, \"material\": " + std::to_string(i + 2) + "}, ";
    }
    std::string text = replaced(car_text(), "\"}]\n}", "\"}" + buffers + "]\n}");
    text = replaced(text, "\"byteLength\": 12}", "\"byteLength\": 12}" + views);
    text = replaced(text, "ggg==\"}", "ggg==\"}" + pictures);
    text = replaced(text, "{\"source\": 0}", "{\"source\": 0}" + textures);
    text = replaced(text, "\"normalTexture\": {\"index\": 0}}",
                    "\"normalTexture\": {\"index\": 0}}" + materials);
    text = replaced(text, "{\"attributes\": {\"POSITION\": 0}, \"mode\": 3}",
                    used + "{\"attributes\": {\"POSITION\": 0}, \"mode\": 3}");
    const scene::Scene scene = read_well(folder.write("car.gltf", text));
    CHECK(has_notice(scene, "without its texture '*1': it is none of"));
    CHECK(has_notice(scene, "more notices of this kind"));
}

TEST_CASE("a glTF camera whose field of view cannot be is lost, and told") {
    const TemporaryFolder folder;
    for (const char* yfov : {"1e39", "0", "3.15"}) {
        const scene::Scene scene = read_well(
            folder.write("car.gltf", car_with("\"yfov\": 0.5235988", "\"yfov\": " + std::string(yfov))));
        CHECK(node_of(scene, "Presenter").type == scene::NodeType::assembly);
        CHECK(has_notice(scene, "a camera is ignored: its field of view is not between 0 and 180 degrees"));
    }
}

TEST_CASE("a black glTF light is black") {
    const TemporaryFolder folder;
    for (const char* black : {"\"intensity\": 0", "\"intensity\": 40, \"color\": [0, 0, 0]"}) {
        const std::string text = replaced(car_text(), "\"type\": \"directional\"",
                                          "\"type\": \"directional\", " + std::string(black));
        const scene::Scene scene = read_well(folder.write("car.gltf", text));
        CHECK(std::get<scene::LightData>(node_of(scene, "Sun").data).color == glm::dvec4(0, 0, 0, 1));
    }
}

TEST_CASE("positions of a glTF file are numbers") {
    // The first coordinate of the buffer, eight letters of base64 for six bytes.
    const std::string buffer = "base64,AAAAAAAA";
    check_refused(car_with(buffer, "base64,AADAfwAA"), "a vertex of mesh 'Door'");  // not a number
    check_refused(car_with(buffer, "base64,AACAfwAA"), "a vertex of mesh 'Door'");  // infinite
}

TEST_CASE("a chain of glTF nodes is read, however long") {
    const auto chain = [](int length) {
        std::string nodes = "{\"mesh\": 0}";
        for (int i = 0; i < length; ++i) nodes += ", {\"children\": [" + std::to_string(i) + "]}";
        std::string text = car_text();
        const std::size_t begin = text.find("\"nodes\": [\n"), end = text.find("  ],\n  \"meshes\"");
        text.replace(begin, end - begin, "\"nodes\": [" + nodes);
        const std::string roots = "[0, 6, 7]";
        text.replace(text.find(roots), roots.size(), "[" + std::to_string(length) + "]");
        return text;
    };
    const TemporaryFolder folder;
    CHECK(read_well(folder.write("chain.gltf", chain(100'000))).nodes().size() == 100'002);
}
