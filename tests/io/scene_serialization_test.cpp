#include "io/scene_serialization.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include "image_bytes.hpp"
#include "io/vrut/text_writer.hpp"
#include "temporary_folder.hpp"

using namespace vrut;

namespace {

constexpr const char* kText = R"(vrut-text 1
unit 0.001
material 3 "Paint" ambient 0.02 0.01 0 1 diffuse 0.6 0.02 0.03 0.5 specular 0.8 0.7 0.6 1
  emission 0.1 0.2 0.3 1 shininess 64 reflectivity 0.25 two-sided 1 image "red.png"
  emissive 0.5 0 2 emissive-image "red.png"
  metallic-roughness 0.25 0.5 clear-coat 0.75 occlusion-roughness-metallic-image "red.png"
  normal-image "a.png" normal-scale 0.5 image-wrap clamp mirror image-magnification nearest end
material 12 "Grey" image "no such.png" end
geometry 7 vertices 4 0 0 0  1 0 0  0 1 0  1 1 -0.25 normals 4 0 0 1  0 0 1  0 0 1  0 1 0
  texcoords 4 0 0  1 0  0 1  1.5 -2 colors 4 1 0 0  0 0.5 0  0 0 1  1 1 1 triangles 2 0 1 2  2 1 3 end
geometry 8 vertices 0 triangles 0 end
node 0 "Estate" root end
node 4 "Body" assembly active 0 matrix 1 2 3 4  5 6 7 8  9 10 11 12  0 0 0 1 end
node 5 "Door" geometry parent 4 presentation 1 geometry 7 hinge 0 2 0 -65.5 material 3 end
node 6 "Presenter" camera eye 3 1 4 focus 0 0.7 0.5 up 1 2 3 fov 41 look 0.75 end
node 8 "Lamp" light type spot color 0.1 0.2 0.3 1 attenuation 4 5 6 angle 33 end
node 9 "Wheels" switch parent 4 active-child -2 end
node 10 "Far or near" lod parent 4 ranges 10 40.5 end
node 13 "Sky" background material 12 cube-map "a.png" "a.png" "red.png" "a.png" "a.png" "a.png" only-reflected 1 end
node 14 "Horn" sound parent 9 end
)";

scene::SceneParts full_parts() {
    const TemporaryFolder folder;
    folder.write("red.png", flat_png(2, 2, {255, 0, 0, 99}));
    folder.write("a.png", flat_png(2, 2, {1, 2, 3, 255}));
    auto parts = io::read_scene_parts(folder.write("full.vrut", kText));
    REQUIRE_MESSAGE(parts, parts.error());
    return *std::move(parts);
}

std::string bytes_of(io::PartsResult parts) {
    std::string bytes;
    io::serialize_parts(std::move(parts), [&](std::string_view piece) { bytes += piece; });
    return bytes;
}

struct Ended {};

io::PartsResult read(std::string_view bytes, const std::string& file = "car.glb",
                     std::uint64_t most = 1 << 20) {
    const auto source = [&](void* to, std::size_t size) {
        if (size > bytes.size()) throw Ended();
        bytes.copy(static_cast<char*>(to), size);
        bytes.remove_prefix(size);
    };
    return io::deserialize_parts(source, most, file);
}

void put(std::string& bytes, std::size_t at, std::uint64_t word) {
    std::memcpy(bytes.data() + at, &word, sizeof word);
}

std::string text_of(scene::SceneParts parts) {
    const auto scene = io::build_scene(std::move(parts), "full.vrut");
    REQUIRE_MESSAGE(scene, scene.error());
    std::ostringstream text;
    io::write_vrut_text(*scene, text);
    return text.str();
}

std::string refusal(std::string_view bytes, std::uint64_t most = 1 << 20) {
    const auto parts = read(bytes, "car.glb", most);
    REQUIRE_FALSE(parts);
    CHECK_MESSAGE(
        parts.error().starts_with("car.glb: the import process returned an invalid scene: before byte "),
        parts.error());
    return parts.error();
}

template <class Data>
Data& first(scene::SceneParts& parts) {
    for (auto& part : parts.nodes)
        if (auto* data = std::get_if<Data>(&part.node.data)) return *data;
    FAIL("no such node");
    std::abort();
}

}  // namespace

TEST_CASE("parts come back as they were written") {
    const scene::SceneParts parts = full_parts();
    const auto back = read(bytes_of(parts), "full.vrut");
    REQUIRE_MESSAGE(back, back.error());
    CHECK(text_of(*back) == text_of(parts));
    CHECK(back->name == "full");
    CHECK(back->notices == parts.notices);
    CHECK(back->notices.size() == 2);  // of the sound and of the picture that is missing
    REQUIRE(back->textures.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
        const scene::Texture &was = parts.textures[i], &is = back->textures[i];
        CHECK(is.file == was.file);
        CHECK(is.image.width == 2);
        CHECK(is.image.height == 2);
        CHECK(is.image.rgba == was.image.rgba);
        CHECK(is.transparent == was.transparent);
    }
    CHECK(back->materials[0].texture == 0);
    CHECK(back->materials[1].texture == scene::kNone);
    CHECK(back->geometries[0].bounds.min == glm::dvec3(0, 0, -0.25));
    CHECK(back->nodes[1].line == parts.nodes[1].line);
    CHECK(std::get<scene::BackgroundData>(back->nodes[7].node.data).cube_textures ==
          std::get<scene::BackgroundData>(parts.nodes[7].node.data).cube_textures);
}

TEST_CASE("a reader's refusal comes back word for word") {
    const auto back = read(bytes_of(tl::unexpected(std::string("car.glb: it is no glTF"))), "other");
    REQUIRE_FALSE(back);
    CHECK(back.error() == "car.glb: it is no glTF");
}

TEST_CASE("what is cut short, goes on, or is not of this program is refused") {
    const std::string bytes = bytes_of(full_parts());
    for (std::size_t size = 8; size < bytes.size(); size += 8) {
        CHECK_THROWS_AS(read(bytes.substr(0, size)), Ended);
        std::string shorter = bytes.substr(0, size);
        put(shorter, 0, size / 8 - 1);
        refusal(shorter);
    }
    std::string longer = bytes + std::string(8, '\0');
    put(longer, 0, longer.size() / 8 - 1);
    CHECK(refusal(longer).find("the end") != std::string::npos);
    std::string other = bytes;
    ++other[8];
    refusal(other);
    CHECK(refusal(bytes, bytes.size() - 16).find("fewer words") != std::string::npos);
    CHECK(read(bytes, "car.glb", bytes.size() - 8));
}

TEST_CASE("no word, whatever it says, does harm") {
    const std::string bytes = bytes_of(full_parts());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t at = 8; at < bytes.size(); at += 8)
        for (const std::uint64_t word : {std::uint64_t{0}, std::uint64_t{7}, ~std::uint64_t{0},
                                         std::uint64_t{1} << 40, std::bit_cast<std::uint64_t>(nan)}) {
            std::string changed = bytes;
            put(changed, at, word);
            if (auto parts = read(changed))
                if (auto scene = io::build_scene(*std::move(parts), "car.glb"))
                    (void)scene::place(*std::move(scene));
        }
}

TEST_CASE("large arrays come in pieces") {
    scene::SceneParts parts;
    scene::Geometry& geometry = parts.geometries.emplace_back();
    for (int i = 0; i < 300'001; ++i) geometry.positions.emplace_back(i, -i, 0.5);
    for (unsigned i = 0; i < 300'000; ++i) geometry.triangles.emplace_back(i, i + 1, 0);
    const auto back = read(bytes_of(parts), "car.glb", 1 << 30);
    REQUIRE(back);
    CHECK(back->geometries[0].positions == geometry.positions);
    CHECK(back->geometries[0].triangles == geometry.triangles);
    CHECK(back->geometries[0].bounds.max == glm::dvec3(300'000, 0, 0.5));
}

TEST_CASE("parts that no reader would hand over are refused") {
    const struct {
        const char* expected;
        void (*spoil)(scene::SceneParts&);
    } kFaults[] = {
        {"an integer in its range", [](scene::SceneParts& p) { p.materials[0].texture = 2; }},
        {"an integer in its range", [](scene::SceneParts& p) { first<scene::GeometryData>(p).geometry = 2; }},
        {"an integer in its range",
         [](scene::SceneParts& p) { first<scene::GeometryData>(p).material = -2; }},
        {"an integer in its range",
         [](scene::SceneParts& p) { (*first<scene::BackgroundData>(p).cube_textures)[3] = -1; }},
        {"an integer in its range",
         [](scene::SceneParts& p) { first<scene::SwitchData>(p).active_child = -3; }},
        {"an integer in its range", [](scene::SceneParts& p) { p.nodes[2].node.id = scene::kMaxId + 1; }},
        {"an integer in its range", [](scene::SceneParts& p) { p.nodes[2].node.type = scene::NodeType{9}; }},
        {"an integer in its range", [](scene::SceneParts& p) { p.textures[0].image.width = 16385; }},
        {"4 bytes for each pixel", [](scene::SceneParts& p) { p.textures[0].image.width = 3; }},
        {"squares of one size", [](scene::SceneParts& p) { p.textures[1].image.resize(4, 4); }},
        {"each id once", [](scene::SceneParts& p) { p.materials[1].id = 3; }},
        {"each id once", [](scene::SceneParts& p) { p.geometries[1].id = 7; }},
        {"indices of vertices", [](scene::SceneParts& p) { p.geometries[0].triangles[1].y = 4; }},
        {"as many of each", [](scene::SceneParts& p) { p.geometries[0].normals.pop_back(); }},
        {"as many of each", [](scene::SceneParts& p) { p.geometries[0].texcoords.pop_back(); }},
        {"as many of each", [](scene::SceneParts& p) { p.geometries[0].colors.pop_back(); }},
        {"colours from", [](scene::SceneParts& p) { p.geometries[0].colors[3].y = 1.5F; }},
        {"colours from", [](scene::SceneParts& p) { p.geometries[0].colors[0].x = std::nanf(""); }},
        {"numbers from", [](scene::SceneParts& p) { p.geometries[0].positions[2].z = 1e16; }},
        {"numbers from", [](scene::SceneParts& p) { p.geometries[0].normals[0].x = std::nanf(""); }},
        {"a number in its range", [](scene::SceneParts& p) { p.nodes[1].node.matrix[3][0] = INFINITY; }},
        {"0 0 0 1", [](scene::SceneParts& p) { p.nodes[1].node.matrix[3][3] = 2; }},
        {"a hinge's axis", [](scene::SceneParts& p) { p.nodes[2].node.hinge->axis = glm::dvec3(0); }},
        {"a number in its range", [](scene::SceneParts& p) { first<scene::CameraData>(p).fov = 0; }},
        {"a distance", [](scene::SceneParts& p) { first<scene::LodData>(p).ranges[0] = -1; }},
        {"UTF-8", [](scene::SceneParts& p) { p.nodes[1].node.name = "\xFF"; }},
        {"UTF-8", [](scene::SceneParts& p) { p.notices[0] = "\xC3"; }},
    };
    const scene::SceneParts whole = full_parts();
    for (const auto& fault : kFaults) {
        scene::SceneParts parts = whole;
        fault.spoil(parts);
        const std::string why = refusal(bytes_of(std::move(parts)));
        CHECK_MESSAGE(why.find(fault.expected) != std::string::npos, fault.expected << ": " << why);
    }
}
