#include "io/vrut/text_writer.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <random>
#include <sstream>
#include <tuple>

#include "base/file_bytes.hpp"
#include "io/vrut/text_reader.hpp"

using namespace vrut;

namespace {

std::string written(const scene::Scene& scene, const std::string& comment = {}) {
    std::ostringstream out;
    io::write_vrut_text(scene, out, comment);
    return out.str();
}

scene::Scene read(const std::string& text, const std::string& file) {
    auto scene = io::read_vrut_text(text, file);
    REQUIRE_MESSAGE(scene, scene.error());
    return *std::move(scene);
}

// Whether all that a scene's text tells is the same.

bool same(const scene::Material& a, const scene::Material& b) {
    const auto members = [](const scene::Material& m) {
        return std::tie(m.id, m.name, m.ambient, m.diffuse, m.specular, m.emission, m.shininess,
                        m.reflectivity, m.two_sided, m.emissive, m.image, m.emissive_image,
                        m.metallic_roughness, m.occlusion_roughness_metallic_image, m.normal_image,
                        m.normal_scale, m.sampler);
    };
    return members(a) == members(b);
}

bool same(const scene::Geometry& a, const scene::Geometry& b) {
    const auto members = [](const scene::Geometry& g) {
        return std::tie(g.id, g.positions, g.normals, g.texcoords, g.colors, g.triangles);
    };
    return members(a) == members(b);
}

auto members(const scene::GroupData&) { return std::tuple<>(); }
auto members(const scene::GeometryData& data) { return std::tie(data.geometry, data.material); }
auto members(const scene::CameraData& data) {
    return std::tie(data.eye, data.focus, data.up, data.fov, data.look_radius);
}
auto members(const scene::LightData& data) {
    return std::tie(data.type, data.color, data.attenuation, data.angle);
}
auto members(const scene::SwitchData& data) { return std::tie(data.active_child); }
auto members(const scene::LodData& data) { return std::tie(data.ranges); }
auto members(const scene::BackgroundData& data) {
    return std::tie(data.material, data.cube_map, data.only_reflected);
}

bool same(const scene::Node& a, const scene::Node& b) {
    const auto of_all = [](const scene::Node& n) {
        return std::tie(n.id, n.name, n.type, n.parent, n.children, n.active, n.matrix, n.hinge,
                        n.presentation);
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

void check_same(const scene::Scene& a, const scene::Scene& b) {
    CHECK(a.unit() == b.unit());
    CHECK(all_same(a.materials(), b.materials()));
    CHECK(all_same(a.geometries(), b.geometries()));
    CHECK(all_same(a.nodes(), b.nodes()));
}

/// What is written tells each bit: -0 is not 0.
void check_reads_back(const scene::Scene& scene, const std::string& file) {
    const std::string once = written(scene);
    const scene::Scene again = read(once, file);
    check_same(scene, again);
    CHECK(written(again) == once);
}

/// Scenes of every kind of node, with numbers of all sizes and names of all characters that a name can have.
class RandomScene {
public:
    explicit RandomScene(unsigned seed) : random_(seed) {}

    scene::Scene make() {
        parts_.unit = 1e-12 + std::abs(number(1e12));
        for (scene::Id id : ids(6)) parts_.materials.push_back(material(id));
        for (scene::Id id : ids(6)) parts_.geometries.push_back(geometry(id));
        std::vector<scene::Id> parents{0};
        parts_.nodes.push_back({node(0, scene::NodeType::root), 0});
        for (scene::Id id : ids(30)) {
            parts_.nodes.push_back(
                {node(id + 1, types_[below(types_.size())]), parents[below(parents.size())]});
            parents.push_back(id + 1);
        }
        std::shuffle(parts_.nodes.begin(), parts_.nodes.end(), random_);
        return *scene::Scene::build(std::move(parts_));
    }

private:
    std::size_t below(std::size_t end) {
        return std::uniform_int_distribution<std::size_t>(0, end - 1)(random_);
    }
    bool coin() { return below(2) == 1; }

    /// At most `size`, of any exponent, often 0 or -0.
    double number(double size) {
        if (below(6) == 0) return coin() ? 0.0 : -0.0;
        const double unit = std::uniform_real_distribution<double>(-1, 1)(random_);
        return coin() ? size * unit : std::ldexp(size * unit, -static_cast<int>(below(1000)));
    }
    double positive(double size) { return std::abs(number(size)); }
    glm::dvec3 point() { return {number(1e15), number(1e15), number(1e15)}; }
    glm::dvec4 color() { return {positive(1e6), positive(1e6), positive(1e6), positive(1)}; }

    std::string name() {
        constexpr std::string_view kCharacters[] = {"a",  " ",    "\"",   "\\", "#", "\t",
                                                    "\r", "\x01", "\x7f", "é",  "🚗", "end"};
        std::string result;
        for (std::size_t left = below(9); left > 0; --left)
            result += kCharacters[below(std::size(kCharacters))];
        return coin() ? result + std::string(1, '\0') : result;
    }

    std::vector<scene::Id> ids(std::size_t most) {
        std::vector<scene::Id> result;
        for (std::size_t i = 0; i < most; ++i)
            result.push_back(
                static_cast<scene::Id>(below(coin() ? 100 : static_cast<std::size_t>(scene::kMaxId))));
        std::sort(result.begin(), result.end());
        result.erase(std::unique(result.begin(), result.end()), result.end());
        std::shuffle(result.begin(), result.end(), random_);
        return result;
    }

    scene::Material material(scene::Id id) {
        scene::Material result;
        result.id = id;
        result.name = name();
        for (glm::dvec4* to : {&result.ambient, &result.diffuse, &result.specular, &result.emission})
            *to = color();
        result.shininess = positive(10000);
        result.reflectivity = positive(1);
        result.two_sided = coin();
        if (coin()) result.emissive = color();
        result.image = name();
        result.emissive_image = name();
        if (coin()) result.metallic_roughness = {positive(1), positive(1), positive(1)};
        result.occlusion_roughness_metallic_image = name();
        result.normal_image = name();
        result.normal_scale = coin() ? 1 : number(1e6);
        for (scene::Wrap& wrap : result.sampler.wraps)
            wrap = coin() ? scene::Wrap::repeat : coin() ? scene::Wrap::mirror : scene::Wrap::clamp;
        if (coin()) result.sampler.magnification = scene::Magnification::nearest;
        return result;
    }

    scene::Geometry geometry(scene::Id id) {
        scene::Geometry result;
        result.id = id;
        const std::size_t count = below(20);
        const bool normals = coin(), texcoords = coin(), colors = coin();
        for (std::size_t i = 0; i < count; ++i) {
            result.positions.push_back(point());
            result.bounds.add(result.positions.back());
            if (normals) result.normals.emplace_back(point());
            if (texcoords) result.texcoords.emplace_back(point());
            if (colors) result.colors.emplace_back(glm::abs(glm::sin(point())));
            const auto index = [&] { return static_cast<unsigned>(below(count)); };
            if (coin()) result.triangles.emplace_back(index(), index(), index());
        }
        return result;
    }

    scene::Index index(std::size_t count) { return static_cast<scene::Index>(below(count + 1)) - 1; }

    scene::Node node(scene::Id id, scene::NodeType type) {
        scene::Node result;
        result.id = id;
        result.name = name();
        result.type = type;
        result.active = coin();
        if (coin())
            for (int column = 0; column < 4; ++column)
                for (int row = 0; row < 3; ++row) result.matrix[column][row] = number(1e15);
        if ((type == scene::NodeType::assembly || type == scene::NodeType::geometry) && coin())
            result.hinge = {point() + glm::dvec3(0, 1e-3, 0), number(360)};
        if (type == scene::NodeType::assembly || type == scene::NodeType::geometry)
            result.presentation = coin();
        set_data(result);
        return result;
    }

    void set_data(scene::Node& node) {
        const scene::Index material = index(parts_.materials.size());
        if (node.type == scene::NodeType::geometry)
            node.data = scene::GeometryData{index(parts_.geometries.size()), material};
        if (node.type == scene::NodeType::camera)
            node.data = scene::CameraData{point(), point(), point(), 1 + positive(169)};
        if (node.type == scene::NodeType::light)
            node.data = scene::LightData{static_cast<scene::LightData::Type>(below(3)), color(),
                                         glm::abs(point()), positive(180)};
        if (node.type == scene::NodeType::switch_)
            node.data = scene::SwitchData{static_cast<int>(below(100)) - 2};
        if (node.type == scene::NodeType::lod) {
            scene::LodData lod;
            for (std::size_t left = below(4); left > 0; --left) lod.ranges.push_back(positive(1e15));
            node.data = lod;
        }
        if (node.type == scene::NodeType::background) {
            scene::BackgroundData background{material, {}, {}, coin()};
            if (coin()) background.cube_map = {name(), name(), name(), name(), name(), name()};
            node.data = background;
        }
    }

    static constexpr std::array types_{scene::NodeType::assembly, scene::NodeType::camera,
                                       scene::NodeType::geometry, scene::NodeType::light,
                                       scene::NodeType::lod,      scene::NodeType::switch_,
                                       scene::NodeType::sound,    scene::NodeType::background};
    std::mt19937_64 random_;
    scene::SceneParts parts_;
};

}  // namespace

TEST_CASE("what is written reads back as the same scene, and is written the same again") {
    std::size_t scenes = 0;
    for (const char* folder : {VRUT_SCENES, VRUT_CARS})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
            if (entry.path().extension() != ".vrut") continue;
            CAPTURE(entry.path().string());
            const auto text = base::read_bytes(entry.path());
            REQUIRE(text);
            check_reads_back(read(*text, entry.path().string()), entry.path().string());
            ++scenes;
        }
    CHECK(scenes > 30);
}

TEST_CASE("random scenes read back to the last bit") {
    for (unsigned seed = 0; seed < 300; ++seed) {
        CAPTURE(seed);
        check_reads_back(RandomScene(seed).make(), "random.vrut");
    }
}

TEST_CASE("a sound is still one, and what nothing uses is kept") {
    const scene::Scene again = read(
        written(read("vrut-text 1 node 1 \"Horn\" sound end material 5 \"M\" end geometry 6 end", "s")), "s");
    CHECK(again.nodes()[1].type == scene::NodeType::sound);
    CHECK(again.notices().size() == 1);
    REQUIRE(again.materials().size() == 1);
    CHECK(again.materials()[0].id == 5);
    REQUIRE(again.geometries().size() == 1);
    CHECK(again.geometries()[0].id == 6);
}

TEST_CASE("a matrix that differs from none by the sign of a zero is written") {
    const std::string text = "vrut-text 1 node 1 \"\" assembly matrix 1 0 0 -0 0 1 0 0 0 0 1 0 0 0 0 1 end";
    CHECK(std::signbit(read(written(read(text, "s")), "s").nodes()[1].matrix[3][0]));
}

TEST_CASE("a name with a line break, which no text can hold, is written with a space") {
    scene::SceneParts parts;
    parts.materials.emplace_back().name = "two\nlines";
    CHECK(read(written(*scene::Scene::build(std::move(parts))), "name.vrut").materials()[0].name ==
          "two lines");
}

TEST_CASE("a scene that holds everything reads back") {
    const scene::Scene scene = read(R"(vrut-text 1
unit 0.001
material 3 "Paint \"red\" \\ #1" ambient 0.1 0.2 0.3 0.4 diffuse 0.6 0.02 0.03 0.5 shininess 64.125 two-sided 1
  reflectivity 0.25 specular 0.333333333333333314 0 0 1 emission 1e-30 0 0 1 image "a b/plate.png" end
geometry 7 triangles 1 0 1 2 vertices 3 0 -0 1e15 1 0.1 0 0 1 -2.5e-17
  normals 3 0 0 1 0 0.7071067 0.7071068 1 0 0 texcoords 3 0 0 1e-7 0.3 0 1 end
geometry 8 end
node 0 "Root" root active 0 end
node 4 "Grüße" assembly active 0 matrix 1 2 3 4 5 6 7 8 9 10 11 12.5 0 0 0 1 hinge -0 2.5e-17 1e15 -360 end
node 5 "Door" geometry parent 4 geometry 7 material 3 hinge 0.1 0.2 0.30000000000000004 64.99999999999999 end
node 51 "Lid" geometry parent 4 presentation 1 hinge 1 0 0 360 end
node 50 "Nothing" geometry parent 4 end
node 6 "Eye" camera parent 0 eye 3 1 4 focus 0 0.7 0.5 up 1 2 3 fov 41 look 0.75 end
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
    const scene::Scene again = read(text, "all.vrut");
    check_same(scene, again);
    CHECK(written(again, "two\nlines") == text);
}

TEST_CASE("numbers of all sizes read back to the last bit") {
    std::mt19937_64 random(7);
    scene::Geometry geometry;
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
    scene::SceneParts parts;
    parts.geometries = {geometry};
    check_reads_back(*scene::Scene::build(std::move(parts)), "numbers.vrut");
}

TEST_CASE("the empty scene reads back") {
    const scene::Scene scene;
    check_same(scene, read(written(scene), "empty.vrut"));
}
