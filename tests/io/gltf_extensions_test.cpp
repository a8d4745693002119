#include <doctest/doctest.h>
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include "contains.hpp"
#include "gltf_builder.hpp"
#include "image_bytes.hpp"

using namespace vrut;

namespace {

using Points = std::vector<glm::dvec3>;
const Points kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

/// Marks the last buffer view as compressed, of which it becomes the fallback that has no data.
void compress(GltfBuilder& file, std::size_t count, std::size_t stride, const char* mode,
              const char* filter = "NONE") {
    nlohmann::json& view = file.document["bufferViews"].back();
    view["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                     {"byteOffset", view["byteOffset"]},
                                                     {"byteLength", view["byteLength"]},
                                                     {"byteStride", stride},
                                                     {"count", count},
                                                     {"mode", mode},
                                                     {"filter", filter}};
    view["buffer"] = 1;
    view["byteOffset"] = 0;
    view["byteLength"] = count * stride;
}

template <class Vertex>
void add_compressed_vertices(GltfBuilder& file, const std::vector<Vertex>& vertices,
                             const char* filter = "NONE") {
    std::string data(meshopt_encodeVertexBufferBound(vertices.size(), sizeof(Vertex)), '\0');
    data.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(data.data()), data.size(),
                                           vertices.data(), vertices.size(), sizeof(Vertex)));
    file.add_view(data);
    compress(file, vertices.size(), sizeof(Vertex), "ATTRIBUTES", filter);
}

/// A quad of quantized positions, filtered normals and indices, all compressed.
GltfBuilder meshopt_file(const char* mode) {
    GltfBuilder file;
    const std::vector<glm::i16vec4> positions = {
        {0, 0, 0, 0}, {100, 0, 0, 0}, {100, 100, 0, 0}, {0, 100, 0, 0}};
    add_compressed_vertices(file, positions);
    file.primitive()["attributes"]["POSITION"] = file.add_accessor(0, 5122, "VEC3", 4);
    const std::vector<glm::vec4> up(4, {0, 0, 1, 0});
    std::vector<glm::i8vec4> normals(4);
    meshopt_encodeFilterOct(normals.data(), 4, 4, 8, &up[0].x);
    add_compressed_vertices(file, normals, "OCTAHEDRAL");
    file.primitive()["attributes"]["NORMAL"] = file.add_accessor(1, 5120, "VEC3", 4, true);
    const std::vector<unsigned> indices = {0, 1, 2, 0, 2, 3};
    std::string data(100, '\0');
    auto* const out = reinterpret_cast<unsigned char*>(data.data());
    data.resize(mode == std::string("TRIANGLES")
                    ? meshopt_encodeIndexBuffer(out, data.size(), indices.data(), 6)
                    : meshopt_encodeIndexSequence(out, data.size(), indices.data(), 6));
    file.add_view(data);
    compress(file, 6, 2, mode);
    file.primitive()["indices"] = file.add_accessor(2, 5123, "SCALAR", 6);
    file.document["buffers"] = {
        {{"byteLength", file.bytes.size()}, {"uri", "a.bin"}},
        {{"byteLength", 1000}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    file.document["extensionsUsed"] =
        file.document["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
    return file;
}

/// A strip of so many quads along x, compressed, with its positions and texture coordinates.
GltfBuilder draco_file(int quads, int index_component) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2 * quads);
    const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int texcoords = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
    for (int i = 0; i < 2 * quads; ++i) {
        const int quad = i / 2;
        const auto x = static_cast<float>(quad);
        const glm::vec3 a(x, 0, 0), b(x + 1, 0, 0), c(x + 1, 1, 0), d(x, 1, 0);
        const glm::vec3 corners[] = {a, i % 2 == 0 ? b : c, i % 2 == 0 ? c : d};
        const draco::FaceIndex face(static_cast<unsigned>(i));
        builder.SetAttributeValuesForFace(positions, face, &corners[0], &corners[1], &corners[2]);
        builder.SetAttributeValuesForFace(texcoords, face, &corners[0], &corners[1], &corners[2]);
    }
    const auto mesh = builder.Finalize();
    draco::Encoder encoder;
    draco::EncoderBuffer buffer;
    REQUIRE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    GltfBuilder file;
    file.add_view(std::string(buffer.data(), buffer.size()));
    const std::size_t vertices = mesh->num_points();
    file.primitive()["attributes"] = {{"POSITION", file.add_accessor(-1, 5126, "VEC3", vertices)},
                                      {"TEXCOORD_0", file.add_accessor(-1, 5126, "VEC2", vertices)}};
    file.primitive()["indices"] =
        file.add_accessor(-1, index_component, "SCALAR", static_cast<std::size_t>(6 * quads));
    file.primitive()["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", 0},
        {"attributes",
         {{"POSITION", mesh->attribute(positions)->unique_id()},
          {"TEXCOORD_0", mesh->attribute(texcoords)->unique_id()}}}};
    file.document["extensionsUsed"] = file.document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return file;
}

}  // namespace

TEST_CASE("attributes of a glTF mesh may be integers (KHR_mesh_quantization)") {
    GltfBuilder file;
    nlohmann::json& attributes = file.primitive()["attributes"];
    attributes["POSITION"] = file.add_array<std::int16_t>({0, 0, 0, 3, 0, 0, 0, -2, 0}, 5122, "VEC3", 3);
    attributes["NORMAL"] =
        file.add_array<std::int8_t>({0, 0, 127, 0, 0, 127, 0, 0, -128}, 5120, "VEC3", 3, true);
    attributes["TEXCOORD_0"] =
        file.add_array<std::uint16_t>({0, 0, 65535, 0, 0, 65535}, 5123, "VEC2", 2, true);
    const scene::Scene scene = file.read();
    CHECK(scene.geometries()[0].positions == Points{{0, 0, 0}, {3, 0, 0}, {0, -2, 0}});
    CHECK(scene.geometries()[0].normals == std::vector<glm::vec3>{{0, 0, 1}, {0, 0, 1}, {0, 0, -1}});
    CHECK(scene.geometries()[0].texcoords == std::vector<glm::vec2>{{0, 1}, {1, 1}, {0, 0}});
    CHECK(scene.notices().empty());

    attributes["POSITION"] =
        file.add_array<std::uint8_t>({0, 0, 0, 255, 0, 0, 0, 51, 0}, 5121, "VEC3", 3, true);
    CHECK(rounded_positions(file.read()) == Points{{0, 0, 0}, {1, 0, 0}, {0, 0.2, 0}});
}

TEST_CASE("elements of a glTF buffer view may lie between others") {
    GltfBuilder file;
    file.add_triangle();
    const int view = file.add_view(std::string("\x01\xFF\xFF\xFF\x02\xFF\xFF\xFF\x00\xFF\xFF\xFF", 12));
    file.document["bufferViews"].back()["byteStride"] = 4;
    file.primitive()["indices"] = file.add_accessor(view, 5121, "SCALAR", 3);
    CHECK(file.read().geometries()[0].triangles == std::vector<glm::uvec3>{{1, 2, 0}});
    file.document["bufferViews"].back()["byteStride"] = 256;
    CHECK(contains(file.error(), "a bufferView's byteStride exceeds 252"));
}

TEST_CASE("values of a sparse glTF accessor are in their places, over others or zeros") {
    GltfBuilder file;
    file.add_triangle();
    const int index = file.add_view(std::string("\x02", 1));
    const float moved[] = {5, 6, 7};
    const int value = file.add_view(std::string(reinterpret_cast<const char*>(moved), sizeof moved));
    nlohmann::json& accessor = file.document["accessors"][0];
    accessor["sparse"] = {{"count", 1},
                          {"indices", {{"bufferView", index}, {"componentType", 5121}}},
                          {"values", {{"bufferView", value}}}};
    CHECK(file.read().geometries()[0].positions == Points{{0, 0, 0}, {1, 0, 0}, {5, 6, 7}});
    accessor.erase("bufferView");
    CHECK(file.read().geometries()[0].positions == Points{{0, 0, 0}, {0, 0, 0}, {5, 6, 7}});
    accessor["count"] = 2;
    CHECK(contains(file.error(), "a sparse accessor has an index out of range"));
    accessor["sparse"].erase("values");
    CHECK(contains(file.error(), "lacks a member 'bufferView'"));
}

TEST_CASE("compressed buffer views are decompressed (EXT_meshopt_compression), fallbacks not looked at") {
    for (const char* mode : {"TRIANGLES", "INDICES"}) {
        const scene::Scene scene = meshopt_file(mode).read();
        const scene::Geometry& geometry = scene.geometries()[0];
        CHECK(geometry.positions == Points{{0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {0, 100, 0}});
        CHECK(geometry.normals == std::vector(4, glm::vec3(0, 0, 1)));
        CHECK(scene.triangle_count() == 2);
        CHECK(scene.notices().empty());
    }
}

TEST_CASE("damaged meshopt data are refused in a sentence") {
    const auto error_with = [](int view, const char* member, const nlohmann::json& value) {
        GltfBuilder file = meshopt_file("TRIANGLES");
        file.document["bufferViews"][static_cast<std::size_t>(view)]["extensions"]["EXT_meshopt_compression"]
                     [member] = value;
        return file.error();
    };
    CHECK(contains(error_with(0, "byteLength", 3), "compressed by EXT_meshopt_compression is damaged"));
    CHECK(contains(error_with(0, "byteStride", 6), "its byteStride does not fit its mode"));
    CHECK(contains(error_with(0, "byteStride", 512), "its byteStride does not fit its mode"));
    CHECK(contains(error_with(2, "byteStride", 3), "its byteStride does not fit its mode"));
    CHECK(contains(error_with(2, "count", 5), "its mode does not fit"));
    CHECK(contains(error_with(0, "mode", "POINTS"), "its byteStride does not fit its mode"));
    CHECK(contains(error_with(1, "filter", "QUATERNION"), "its filter does not fit"));
    CHECK(contains(error_with(1, "filter", "?"), "its filter does not fit"));
    CHECK(contains(error_with(0, "count", 4294967295), "more than 256 MiB of memory"));
    CHECK(contains(error_with(0, "count", 4294967296), "its count is too large"));
    CHECK(contains(error_with(0, "byteOffset", 1 << 30), "exceeds its buffer"));
}

TEST_CASE(
    "compressed primitives are decompressed (KHR_draco_mesh_compression), whatever their indices' type") {
    for (const int component : {5121, 5123, 5125}) {
        const scene::Scene scene = draco_file(100, component).read();
        const scene::Geometry& geometry = scene.geometries()[0];
        CHECK(scene.triangle_count() == 200);
        CHECK(geometry.positions.size() == 202);
        CHECK(geometry.bounds.min == glm::dvec3(0, 0, 0));
        CHECK(geometry.bounds.max.x == doctest::Approx(100));
        REQUIRE(geometry.texcoords.size() == 202);
        CHECK(geometry.texcoords[0].y == doctest::Approx(1 - geometry.positions[0].y));
        CHECK(scene.notices().empty());
    }
}

TEST_CASE("damaged draco data are refused in a sentence") {
    GltfBuilder file = draco_file(2, 5123);
    const std::string bytes = file.bytes;
    for (std::size_t i = 0; i < bytes.size(); ++i) {  // they may also stay readable
        file.bytes[i] = static_cast<char>(~bytes[i]);
        const TemporaryFolder folder;
        folder.write("a.bin", file.bytes);
        const auto scene = io::read_scene(folder.write("a.gltf", file.text()));
        file.bytes = bytes;
        if (!scene) CHECK(contains(scene.error(), "a.gltf: "));
    }
    file.bytes.resize(20);
    file.document.erase("buffers");
    file.document["bufferViews"][0]["byteLength"] = 20;
    CHECK(contains(file.error(), "compressed by KHR_draco_mesh_compression is damaged"));
    GltfBuilder other = draco_file(2, 5123);
    other.primitive()["extensions"]["KHR_draco_mesh_compression"]["attributes"]["POSITION"] = 77;
    CHECK(contains(other.error(), "compressed by KHR_draco_mesh_compression is damaged"));
}

TEST_CASE("the buffers of a binary glTF file may be data URIs or files too") {
    GltfBuilder file;
    file.add_triangle();
    file.document["buffers"] = {
        {{"byteLength", file.bytes.size()}},
        {{"byteLength", 36},
         {"uri", "data:application/gltf-buffer;base64,AAAAAAAAAAAAAAAAAAAAQAAAAAAAAAAAAAAAAAAAAEAAAAAA"}},
        {{"byteLength", 36}, {"uri", "b.bin"}}};
    const auto glb = [&](int buffer, bool with_chunk) {
        file.document["bufferViews"][0]["buffer"] = buffer;
        std::string json = file.document.dump();
        json.resize((json.size() + 3) / 4 * 4, ' ');
        const auto word = [](std::size_t value) {
            const auto number = static_cast<std::uint32_t>(value);
            return std::string(reinterpret_cast<const char*>(&number), 4);
        };
        std::string chunks = word(json.size()) + "JSON" + json;
        if (with_chunk) chunks += word(file.bytes.size()) + std::string("BIN\0", 4) + file.bytes;
        return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
    };
    const TemporaryFolder folder;
    folder.write("b.bin", file.bytes.substr(0, 36));
    const auto right = [&](int buffer, bool with_chunk = true) {
        return read_well(folder.write("a.glb", glb(buffer, with_chunk))).geometries()[0].positions[1];
    };
    CHECK(right(0) == glm::dvec3(1, 0, 0));
    CHECK(right(1) == glm::dvec3(2, 0, 0));
    CHECK(right(2) == glm::dvec3(1, 0, 0));
    file.primitive()["attributes"].erase("TEXCOORD_0");
    CHECK(right(1, false) == glm::dvec3(2, 0, 0));
    check_refused_file("a.glb", glb(0, false), "buffer 0 has no data");
}

TEST_CASE("a required glTF extension that is not supported refuses the file, unless it is about looks") {
    GltfBuilder file;
    file.add_triangle();
    file.document["extensionsUsed"] = file.document["extensionsRequired"] = {"KHR_materials_transmission"};
    CHECK(has_notice(file.read(), "the glTF extension KHR_materials_transmission is not supported"));
    file.document["extensionsRequired"].push_back("EXT_else");
    CHECK(contains(file.error(),
                   "it requires the glTF extension EXT_else, which is not supported: export it without"));
}

TEST_CASE("instances of a glTF mesh are nodes with one geometry (EXT_mesh_gpu_instancing)") {
    GltfBuilder file;
    file.add_triangle();
    nlohmann::json& node = file.document["nodes"][0];
    nlohmann::json& attributes = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    attributes["TRANSLATION"] = file.add_array<float>({1, 2, 3, 4, 5, 6}, 5126, "VEC3", 3);
    attributes["ROTATION"] = file.add_array<std::int8_t>({0, 0, 0, 127, 0, 127, 0, 0}, 5120, "VEC4", 4, true);
    attributes["SCALE"] = file.add_array<float>({2, 2, 2, 1, 1, 1}, 5126, "VEC3", 3);
    file.document["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    const scene::Scene scene = file.read();
    CHECK(scene.geometries().size() == 1);
    CHECK(scene.triangle_count() == 2);
    const scene::Node& part = node_of(scene, "Part");
    REQUIRE(part.children.size() == 2);
    const scene::Node& first = scene.nodes()[static_cast<std::size_t>(part.children[0])];
    const scene::Node& second = scene.nodes()[static_cast<std::size_t>(part.children[1])];
    CHECK(first.name == "Mesh");
    CHECK(first.matrix == glm::dmat4(2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 2, 3, 1));
    CHECK(is_near(second.matrix[0], {-1, 0, 0, 0}));
    CHECK(second.matrix[3] == glm::dvec4(4, 5, 6, 1));
    CHECK(scene.notices().empty());

    // Each instance of several parts is a node above them.
    file.document["meshes"][0]["primitives"].push_back(file.primitive());
    const scene::Scene several = file.read();
    CHECK(several.nodes().size() == 1 + 1 + 2 * 3);
    CHECK(parent_of(several, node_of(several, "Mesh-1")).name == "Mesh");

    attributes["SCALE"] = file.add_array<float>({2, 2, 2}, 5126, "VEC3", 3);
    CHECK(contains(file.error(), "differ in count"));
    attributes.erase("SCALE");
    attributes.erase("ROTATION");
    attributes["TRANSLATION"] = file.add_accessor(-1, 5126, "VEC3", 4'000'000);
    CHECK(contains(file.error(), "more than 256 MiB of memory"));
    attributes["TRANSLATION"] = file.add_array<float>({1, 2, INFINITY}, 5126, "VEC3", 3);
    CHECK(contains(file.error(), "the matrix of an instance"));
}

TEST_CASE("the transform of a glTF texture is in the texture coordinates (KHR_texture_transform)") {
    GltfBuilder file;
    file.add_triangle();
    file.add_floats("TEXCOORD_1", {0, 0, 0.5, 0, 0, 0.5}, 2);
    file.document["images"] = {{{"uri", "none.png"}}};
    file.document["textures"] = {{{"source", 0}}};
    nlohmann::json& info = file.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    info["index"] = 0;
    file.primitive()["material"] = 0;
    const auto texcoords = [&] {
        const scene::Scene scene = file.read();
        std::vector<glm::vec2> all;  // as glTF has them, downwards
        for (const glm::vec2& uv : scene.geometries()[0].texcoords)
            all.push_back(glm::round(glm::vec2(uv.x, 1 - uv.y) * 100.0F) / 100.0F);
        return all;
    };
    using TexCoords = std::vector<glm::vec2>;
    CHECK(texcoords() == TexCoords{{0, 0}, {1, 0}, {0, 1}});
    nlohmann::json& transform = info["extensions"]["KHR_texture_transform"];
    transform["offset"] = {0.25, 0.5};
    transform["scale"] = {2, 4};
    CHECK(texcoords() == TexCoords{{0.25, 0.5}, {2.25, 0.5}, {0.25, 4.5}});
    // The specification's example: the lower left quadrant, turned by a quarter.
    transform = {{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}};
    CHECK(texcoords() == TexCoords{{0, 1}, {0, 0.5}, {0.5, 1}});
    transform = {{"texCoord", 1}};
    CHECK(texcoords() == TexCoords{{0, 0}, {0.5, 0}, {0, 0.5}});
    transform = {{"rotation", "much"}};
    CHECK(contains(file.error(), "a member 'rotation' that is not a number"));
}

TEST_CASE("the variants of a glTF material are children of a switch (KHR_materials_variants)") {
    GltfBuilder file;
    file.add_triangle();
    file.document["materials"] = {{{"name", "Red"}}, {{"name", "Blue"}}, {{"name", "Chrome"}}};
    file.document["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "Sport"}},
                                                                         {{"name", "Town"}}};
    file.document["extensionsUsed"] = {"KHR_materials_variants"};
    file.primitive()["material"] = 1;
    nlohmann::json& mappings = file.primitive()["extensions"]["KHR_materials_variants"]["mappings"];
    mappings = {{{"material", 0}, {"variants", {0}}}, {{"material", 1}, {"variants", {1}}}};
    // Beside it a part that is chrome in one variant, and one that is the same in all.
    nlohmann::json& primitives = file.document["meshes"][0]["primitives"];
    nlohmann::json rim = file.primitive(), body = file.primitive();
    rim["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 2}, {"variants", {0}}}};
    body.erase("extensions");
    primitives.push_back(rim);
    primitives.push_back(body);
    const auto materials_of = [](const scene::Scene& scene, const scene::Node& part) {
        std::vector<std::string> names;
        for (const scene::Index child : part.children) {
            const scene::Node& choice = scene.nodes()[static_cast<std::size_t>(child)];
            names.push_back(choice.name + ": " +
                            scene.material(std::get<scene::GeometryData>(choice.data).material).name);
        }
        return names;
    };
    using Names = std::vector<std::string>;
    const scene::Scene scene = file.read();
    const scene::Node& paint = node_of(scene, "Mesh-0");
    REQUIRE(paint.type == scene::NodeType::switch_);
    CHECK(materials_of(scene, paint) == Names{"Sport: Red", "Town: Blue"});
    CHECK(std::get<scene::SwitchData>(paint.data).active_child == 1);  // what other programs show
    CHECK(materials_of(scene, node_of(scene, "Mesh-1")) == Names{"Sport: Chrome", "Town: Blue"});
    CHECK(node_of(scene, "Mesh-2").type == scene::NodeType::geometry);
    CHECK(scene.geometries().size() == 3);
    CHECK(scene.notices().empty());

    // What is shown without variants is none of them.
    file.primitive()["material"] = 2;
    const scene::Scene other = file.read();
    CHECK(materials_of(other, node_of(other, "Mesh-0")) ==
          Names{"default: Chrome", "Sport: Red", "Town: Blue"});
    CHECK(materials_of(other, node_of(other, "Mesh-1")) ==
          Names{"default: Blue", "Sport: Chrome", "Town: Blue"});
    CHECK(std::get<scene::SwitchData>(node_of(other, "Mesh-0").data).active_child == 0);

    // A texture that lies in another way needs texture coordinates of its own.
    file.document["images"] = {{{"uri", "none.png"}}};
    file.document["textures"] = {{{"source", 0}}};
    file.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {
        {"index", 0}, {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}}}}}};
    CHECK(file.read().geometries().size() == 4);

    mappings[0]["variants"] = {7};
    CHECK(contains(file.error(), "there is no variant 7"));
    mappings[0] = {{"material", 9}, {"variants", {0}}};
    CHECK(contains(file.error(), "there is no material 9"));
}

TEST_CASE("a glTF texture is multiplied by its material's colour, as light is") {
    GltfBuilder file;
    file.add_triangle();
    const std::string data = flat_png(2, 2, {255, 128, 64, 255});
    file.document["images"] = {{{"bufferView", file.add_view(data)}, {"mimeType", "image/png"}}};
    file.document["textures"] = {{{"source", 0}}};
    file.document["materials"] = {
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {0.5, 0, 1, 1}}, {"baseColorTexture", {{"index", 0}}}}}}};
    file.primitive()["material"] = 0;
    const scene::Scene scene = file.read();
    REQUIRE(scene.textures().size() == 1);
    const std::vector<std::uint8_t> rgba = scene.textures()[0].image.rgba;
    CHECK(std::vector(rgba.begin(), rgba.begin() + 4) == std::vector<std::uint8_t>{188, 0, 64, 255});
    CHECK(scene.notices().empty());
}

TEST_CASE("a glTF texture is clamped and mirrored as its sampler says") {
    GltfBuilder file;
    file.add_triangle();
    file.document["images"] = {{{"bufferView", file.add_view(flat_png(2, 2, {1, 2, 3, 255}))}}};
    file.document["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 0}}};
    file.document["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
    file.document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}},
                                  {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 1}}}}}}};
    nlohmann::json second = file.primitive();
    file.primitive()["material"] = 0;
    second["material"] = 1;
    file.document["meshes"][0]["primitives"].push_back(second);
    const scene::Scene scene = file.read();
    REQUIRE(scene.materials().size() == 2);
    constexpr scene::Sampler kClampMirror{{scene::Wrap::clamp, scene::Wrap::mirror}};
    const auto sampler_of = [](const scene::Scene& read, std::size_t material) {
        const scene::Index texture = read.materials()[material].texture;
        REQUIRE(texture != scene::kNone);
        CHECK(read.textures()[static_cast<std::size_t>(texture)].sampler ==
              read.materials()[material].sampler);
        return read.materials()[material].sampler;
    };
    CHECK(sampler_of(scene, 0) == kClampMirror);
    CHECK(sampler_of(scene, 1) == scene::Sampler());
    CHECK(scene.textures().size() == 2);  // one image, seen in two ways
    CHECK(scene.notices().empty());
    // In one material it is seen as its first texture.
    file.document["materials"][0]["emissiveTexture"] = {{"index", 1}};
    file.document["materials"][0]["emissiveFactor"] = {1, 1, 1};
    const scene::Scene mixed = file.read();
    CHECK(sampler_of(mixed, 0) == kClampMirror);
    CHECK(mixed.materials()[0].emissive_texture == mixed.materials()[0].texture);
    REQUIRE(mixed.notices().size() == 1);
    CHECK(contains(mixed.notices()[0], "an emissive texture lies as the material's first texture does"));
    file.document["samplers"][0] = nlohmann::json::object();
    CHECK(sampler_of(file.read(), 0) == scene::Sampler());
}

TEST_CASE("a glTF texture shows its nearest texel from near where its sampler asks for it") {
    GltfBuilder file;
    file.add_triangle();
    file.document["images"] = {{{"bufferView", file.add_view(flat_png(2, 2, {1, 2, 3, 255}))}}};
    file.document["textures"] = {{{"source", 0}, {"sampler", 0}}};
    file.document["samplers"] = {{{"minFilter", 9728}}};
    file.document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    file.primitive()["material"] = 0;
    const auto read = [&] {
        scene::Scene scene = file.read();
        CHECK(scene.notices().empty());
        REQUIRE(scene.textures().size() == 1);
        CHECK(scene.textures()[0].sampler == scene.materials()[0].sampler);
        return scene.textures()[0].sampler;
    };
    CHECK(read() == scene::Sampler());  // what is far away is filtered by any viewer that is good
    file.document["samplers"] = {{{"magFilter", 9729}}};
    CHECK(read() == scene::Sampler());
    file.document["samplers"] = {{{"magFilter", 9728}, {"wrapS", 33071}}};
    CHECK(read() == scene::Sampler{{scene::Wrap::clamp, scene::Wrap::repeat}, scene::Magnification::nearest});
}

TEST_CASE("an unlit glTF material shines in its own colour (KHR_materials_unlit)") {
    GltfBuilder file;
    file.add_triangle();
    file.document["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 1, 0.5}}, {"roughnessFactor", 0}}},
         {"alphaMode", "BLEND"},
         {"emissiveFactor", {0, 1, 0}},
         {"extensions", {{"KHR_materials_unlit", nlohmann::json::object()}}}}};
    file.primitive()["material"] = 0;
    const scene::Scene scene = file.read();
    const scene::Material& material = scene.materials()[0];
    const glm::dvec4 black(0, 0, 0, 1);
    CHECK(material.emissive == glm::dvec3(1, 0, 1));
    CHECK(material.emission == black);
    CHECK(material.diffuse == glm::dvec4(0, 0, 0, 0.5));
    CHECK(material.ambient == black);
    CHECK(material.specular == black);
    CHECK(scene.notices().empty());

    file.document["images"] = {{{"uri", "none.png"}}};
    file.document["textures"] = {{{"source", 0}}};
    file.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    const scene::Scene textured = file.read();
    CHECK(textured.materials()[0].diffuse == glm::dvec4(1, 0, 1, 0.5));
    CHECK(textured.materials()[0].emissive == glm::dvec3(0));
    CHECK(has_notice(textured, "the texture of an unlit material that is not opaque is lit"));

    file.document["materials"][0].erase("alphaMode");
    const scene::Scene opaque = file.read();
    CHECK(opaque.materials()[0].image.empty());
    CHECK(opaque.materials()[0].emissive_image == "none.png");
    CHECK(opaque.materials()[0].emissive == glm::dvec3(1, 0, 1));
    CHECK(opaque.materials()[0].diffuse == glm::dvec4(0, 0, 0, 1));
}

TEST_CASE("a glTF material is lit by metal and roughness, under a clear coat (KHR_materials_clearcoat)") {
    GltfBuilder file;
    file.add_triangle();
    file.document["materials"] = nlohmann::json::array({nlohmann::json::object()});
    file.primitive()["material"] = 0;
    nlohmann::json& material = file.document["materials"][0];
    const auto surface = [&] { return file.read().materials()[0].metallic_roughness; };
    CHECK(surface() == scene::MetallicRoughness{1, 1, 0});
    material["pbrMetallicRoughness"] = {{"metallicFactor", 0.25}, {"roughnessFactor", 7}};
    CHECK(surface() == scene::MetallicRoughness{0.25, 1, 0});
    file.document["extensionsUsed"] = {"KHR_materials_clearcoat"};
    material["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 0.5},
                                                         {"clearcoatRoughnessFactor", 0.05}};
    CHECK(surface() == scene::MetallicRoughness{0.25, 1, 0.5});
    CHECK(file.read().notices().empty());
    material["extensions"]["KHR_materials_clearcoat"]["clearcoatRoughnessFactor"] = 0.5;
    CHECK(has_notice(file.read(), "a clear coat is drawn smooth"));
    material["extensions"] = {{"KHR_materials_unlit", nlohmann::json::object()}};
    CHECK_FALSE(surface());
}

TEST_CASE("an archived glossiness counts where a glTF material says no more than that") {
    GltfBuilder file;
    file.add_triangle();
    file.document["materials"] = {{{"extensions",
                                    {{"KHR_materials_pbrSpecularGlossiness",
                                      {{"diffuseFactor", {1, 0, 0, 1}}, {"glossinessFactor", 0.75}}}}}}};
    file.primitive()["material"] = 0;
    const scene::Material glossy = file.read().materials()[0];
    CHECK(glossy.metallic_roughness == scene::MetallicRoughness{0, 0.25, 0});
    CHECK(glm::dvec3(glossy.diffuse) == glm::dvec3(1, 0, 0));
    file.document["materials"][0]["pbrMetallicRoughness"] = {{"baseColorFactor", {0, 1, 0, 1}}};
    const scene::Material both = file.read().materials()[0];
    CHECK(both.metallic_roughness == scene::MetallicRoughness{1, 1, 0});
    CHECK(glm::dvec3(both.diffuse) == glm::dvec3(0, 1, 0));
}

TEST_CASE("occlusion, roughness and metal of glTF come from one texture") {
    GltfBuilder file;
    file.add_triangle();
    file.document["images"] = {{{"bufferView", file.add_view(flat_png(1, 1, {55, 60, 70, 255}))}},
                               {{"bufferView", file.add_view(flat_png(1, 1, {99, 99, 99, 255}))}}};
    file.document["textures"] = {{{"source", 0}}, {{"source", 1}}};
    file.document["materials"] = nlohmann::json::array({nlohmann::json::object()});
    file.primitive()["material"] = 0;
    nlohmann::json& material = file.document["materials"][0];
    const auto pixel = [&] {
        const scene::Scene scene = file.read();
        const scene::Index texture = scene.materials()[0].occlusion_roughness_metallic_texture;
        REQUIRE(texture != scene::kNone);
        const auto& rgba = scene.textures()[static_cast<std::size_t>(texture)].image.rgba;
        return glm::ivec3(rgba[0], rgba[1], rgba[2]);
    };
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 0}};
    CHECK(pixel() == glm::ivec3(255, 60, 70));  // its red may be anything
    material["occlusionTexture"] = {{"index", 0}};
    CHECK(pixel() == glm::ivec3(55, 60, 70));
    material["occlusionTexture"]["strength"] = 0.5;
    CHECK(pixel() == glm::ivec3(155, 60, 70));
    CHECK(file.read().notices().empty());
    material["occlusionTexture"] = {{"index", 1}};
    CHECK(pixel() == glm::ivec3(255, 60, 70));
    CHECK(has_notice(file.read(), "an occlusion texture beside a metallic-roughness texture is ignored"));
    material.erase("pbrMetallicRoughness");
    CHECK(pixel() == glm::ivec3(99, 255, 255));
}

TEST_CASE("a normal map of glTF lies on the surface") {
    GltfBuilder file;
    file.add_triangle();
    file.document["images"] = {{{"bufferView", file.add_view(flat_png(1, 1, {128, 128, 255, 255}))}}};
    file.document["textures"] = {{{"source", 0}}};
    file.document["materials"] = {{{"normalTexture", {{"index", 0}, {"scale", 0.5}}}}};
    file.primitive()["material"] = 0;
    const scene::Scene scene = file.read();
    CHECK(scene.materials()[0].normal_texture == 0);
    CHECK(scene.materials()[0].normal_scale == 0.5);
    CHECK(scene.notices().empty());
    file.document["materials"][0]["emissiveFactor"] = {1, 1, 1};
    file.document["materials"][0]["emissiveTexture"] = {{"index", 0}, {"texCoord", 1}};
    CHECK(has_notice(file.read(), "a normal map lies as the material's first texture does"));
}

TEST_CASE("a glTF material sends light by itself, where its emissive texture says and as strongly as told") {
    GltfBuilder file;
    file.add_triangle();
    const std::string data = flat_png(2, 2, {1, 2, 3, 255});
    file.document["images"] = {{{"bufferView", file.add_view(data)}}};
    file.document["textures"] = {{{"source", 0}}};
    file.document["materials"] = {
        {{"emissiveFactor", {0.5, 0, 1}},
         {"emissiveTexture", {{"index", 0}}},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 3}}}}}}};
    file.document["extensionsUsed"] = {"KHR_materials_emissive_strength"};
    file.primitive()["material"] = 0;
    const scene::Scene scene = file.read();
    CHECK(scene.materials()[0].emissive == glm::dvec3(1.5, 0, 3));
    CHECK(scene.materials()[0].emissive_texture == 0);
    CHECK(scene.materials()[0].texture == scene::kNone);
    CHECK(scene.notices().empty());
    file.document["materials"][0]["emissiveFactor"] = {0, 0, 0};
    CHECK(file.read().textures().empty());
}

TEST_CASE("colours of glTF vertices are linear, floats or normalized integers") {
    GltfBuilder file;
    file.add_triangle();
    const std::string bytes("\xFF\x00\x80\xFF\x00\x00\x00\x80\xFF\xFF\xFF\xFF", 12);
    file.primitive()["attributes"]["COLOR_0"] =
        file.add_accessor(file.add_view(bytes), 5121, "VEC4", 3, true);
    const scene::Scene scene = file.read();
    const std::vector<glm::vec3>& colors = scene.geometries()[0].colors;
    REQUIRE(colors.size() == 3);
    CHECK(colors[0].r == 1);
    CHECK(colors[0].g == 0);
    CHECK(colors[0].b == doctest::Approx(0.73665).epsilon(1e-5));  // 128 / 255 of the light
    CHECK(colors[1] == glm::vec3(0));
    CHECK(colors[2] == glm::vec3(1));
    CHECK(has_notice(scene, "the opacity of vertex colours is ignored"));
}

TEST_CASE("a glTF texture has its image from an extension where it has no other") {
    GltfBuilder file;
    file.add_triangle();
    const std::string data = flat_png(2, 2, {1, 2, 3, 255});
    file.document["images"] = {{{"bufferView", file.add_view("\xABKTX 20\xBB\r\n\x1A\n")}},
                               {{"bufferView", file.add_view(data)}}};
    file.document["textures"] = {{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
    file.document["extensionsUsed"] = file.document["extensionsRequired"] = {"KHR_texture_basisu"};
    file.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    file.primitive()["material"] = 0;
    const scene::Scene compressed = file.read();
    CHECK(has_notice(compressed,
                     "without its texture '*0': it is KTX2, which is not supported: save it as PNG"));
    CHECK(compressed.notices().size() == 1);
    file.document["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 1;
    CHECK(file.read().textures().size() == 1);
    file.document["textures"][0] = {{"source", 1}, {"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
    CHECK(file.read().textures().size() == 1);
}
