#include "vrut_writer.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <sstream>
#include <tuple>

#include "file_bytes.hpp"
#include "vrut_text.hpp"

using namespace vrut;

namespace {

std::string written(const Scene& scene, const std::string& comment = {}) {
    std::ostringstream out;
    write_vrut_text(scene, out, comment);
    return out.str();
}

Scene read(const std::string& text, const std::string& file) {
    auto scene = read_vrut_text(text, file);
    REQUIRE_MESSAGE(scene, scene.error());
    return *std::move(scene);
}

// Whether all that a scene's text tells is the same.

bool same(const Material& a, const Material& b) {
    const auto members = [](const Material& m) {
        return std::tie(m.id, m.name, m.ambient, m.diffuse, m.specular, m.emission, m.shininess,
                        m.reflectivity, m.two_sided, m.image);
    };
    return members(a) == members(b);
}

bool same(const Geometry& a, const Geometry& b) {
    const auto members = [](const Geometry& g) {
        return std::tie(g.id, g.positions, g.normals, g.texcoords, g.triangles);
    };
    return members(a) == members(b);
}

auto members(const GroupData&) { return std::tuple<>(); }
auto members(const GeometryData& data) { return std::tie(data.geometry, data.material); }
auto members(const CameraData& data) { return std::tie(data.eye, data.focus, data.up, data.fov); }
auto members(const LightData& data) { return std::tie(data.type, data.color, data.attenuation, data.angle); }
auto members(const SwitchData& data) { return std::tie(data.active_child); }
auto members(const LodData& data) { return std::tie(data.ranges); }
auto members(const BackgroundData& data) { return std::tie(data.material, data.cube_map); }

bool same(const Node& a, const Node& b) {
    const auto of_all = [](const Node& n) {
        return std::tie(n.id, n.name, n.type, n.parent, n.children, n.active, n.matrix, n.hinge);
    };
    if (of_all(a) != of_all(b) || a.data.index() != b.data.index()) return false;
    return std::visit(
        [&](const auto& data) {
            return members(data) == members(std::get<std::decay_t<decltype(data)>>(b.data));
        },
        a.data);
}

template <class Things>
bool all_same(const Things& a, const Things& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const auto& c, const auto& d) { return same(c, d); });
}

void check_same(const Scene& a, const Scene& b) {
    CHECK(a.unit() == b.unit());
    CHECK(all_same(a.materials(), b.materials()));
    CHECK(all_same(a.geometries(), b.geometries()));
    CHECK(all_same(a.nodes(), b.nodes()));
}

}  // namespace

TEST_CASE("what is written reads back as the same scene, and is written the same again") {
    std::size_t scenes = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(VRUT_SCENES)) {
        if (entry.path().extension() != ".vrut") continue;
        CAPTURE(entry.path().string());
        const auto text = read_bytes(entry.path());
        REQUIRE(text);
        const Scene scene = read(*text, entry.path().string());
        const std::string once = written(scene);
        const Scene again = read(once, entry.path().string());
        check_same(scene, again);
        CHECK(written(again) == once);
        ++scenes;
    }
    CHECK(scenes > 30);
}

TEST_CASE("a scene that holds everything reads back") {
    const Scene scene = read(R"(vrut-text 1
unit 0.001
material 3 "Paint \"red\" \\ #1" ambient 0.1 0.2 0.3 0.4 diffuse 0.6 0.02 0.03 0.5 shininess 64.125 two-sided 1
  reflectivity 0.25 specular 0.333333333333333314 0 0 1 emission 1e-30 0 0 1 image "a b/plate.png" end
geometry 7 triangles 1 0 1 2 vertices 3 0 -0 1e15 1 0.1 0 0 1 -2.5e-17
  normals 3 0 0 1 0 0.7071067 0.7071068 1 0 0 texcoords 3 0 0 1e-7 0.3 0 1 end
geometry 8 end
node 0 "Root" root active 0 end
node 4 "Grüße" assembly active 0 matrix 1 2 3 4 5 6 7 8 9 10 11 12.5 0 0 0 1 hinge -0 2.5e-17 1e15 -360 end
node 5 "Door" geometry parent 4 geometry 7 material 3 hinge 0.1 0.2 0.30000000000000004 64.99999999999999 end
node 51 "Lid" geometry parent 4 hinge 1 0 0 360 end
node 50 "Nothing" geometry parent 4 end
node 6 "Eye" camera parent 0 eye 3 1 4 focus 0 0.7 0.5 up 1 2 3 fov 41 end
node 8 "Lamp" light parent 0 type spot color 0.1 0.2 0.3 1 attenuation 4 5 6 angle 33 end
node 80 "Sun" light type directional end
node 9 "Wheels" switch parent 4 active-child -2 end
node 10 "Lod" lod parent 9 ranges 10 40.5 end
node 12 "No ranges" lod parent 9 end
node 11 "Studio" background material 3 end
node 13 "Sky" background material 3 cube-map "px.png" "n\"x.png" "py.png" "ny.png" "pz.png" "nz.png" end
node 14 "Horn" sound parent 9 end
)",
                             "all.vrut");
    const std::string text = written(scene, "two\nlines");
    CHECK(text.starts_with("vrut-text 1\n# two\n# lines\nunit 0.001\n"));
    const Scene again = read(text, "all.vrut");
    check_same(scene, again);
    CHECK(written(again, "two\nlines") == text);
}

TEST_CASE("numbers of all sizes read back to the last bit") {
    std::mt19937_64 random(7);
    Geometry geometry;
    geometry.id = 1;
    // The shortest digits of the first, read as a double, round to its neighbour.
    geometry.texcoords = {{7.038531e-26F, -0.0F}, {1e-45F, 1e15F}};
    geometry.positions.resize(2);
    while (geometry.positions.size() < 5000) {
        const auto sized = [&](int exponent) {
            return std::ldexp(std::uniform_real_distribution<double>(-1, 1)(random), exponent);
        };
        const int exponent = std::uniform_int_distribution<int>(-140, 49)(random);
        geometry.positions.emplace_back(sized(exponent), sized(7 * std::min(exponent, 0)), sized(3));
        geometry.texcoords.emplace_back(sized(exponent), sized(exponent / 3));
    }
    SceneParts parts;
    parts.geometries = {geometry};
    const Scene scene = *Scene::build(std::move(parts));
    check_same(scene, read(written(scene), "numbers.vrut"));
}

TEST_CASE("the empty scene reads back") {
    const Scene scene;
    check_same(scene, read(written(scene), "empty.vrut"));
}
