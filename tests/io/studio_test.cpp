#include "io/studio/studio.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/srgb.hpp"
#include "io/studio/contact_shadow.hpp"
#include "io/studio/environment.hpp"
#include "io/write_scene.hpp"
#include "scene/style.hpp"
#include "scene_queries.hpp"

using namespace vrut;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

scene::Geometry with_bounds(scene::Geometry geometry) {
    geometry.bounds = {};
    for (const glm::dvec3& position : geometry.positions) geometry.bounds.add(position);
    return geometry;
}

/// From -1 to 1 along x and z, from 0 to 2 along y.
scene::Geometry box() {
    scene::Geometry box;
    for (const double x : {-1, 1})
        for (const double y : {0, 2})
            for (const double z : {-1, 1}) box.positions.emplace_back(x, y, z);
    box.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                     {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
    return with_bounds(box);
}

/// Of radius 1 about (0, 1, 0).
scene::Geometry sphere() {
    constexpr unsigned kRings = 32, kAround = 64;
    scene::Geometry sphere;
    for (unsigned i = 0; i <= kRings; ++i)
        for (unsigned k = 0; k < kAround; ++k) {
            const double down = std::numbers::pi * i / kRings, turn = 2 * std::numbers::pi * k / kAround;
            sphere.positions.emplace_back(std::sin(down) * std::cos(turn), 1 + std::cos(down),
                                          std::sin(down) * std::sin(turn));
        }
    for (unsigned i = 0; i < kRings; ++i)
        for (unsigned k = 0; k < kAround; ++k) {
            const unsigned a = i * kAround + k, b = i * kAround + (k + 1) % kAround;
            sphere.triangles.emplace_back(a, b, a + kAround);
            sphere.triangles.emplace_back(b, b + kAround, a + kAround);
        }
    return with_bounds(sphere);
}

glm::dmat4 moved_by(const glm::dvec3& offset) {
    glm::dmat4 matrix(1);
    matrix[3] = {offset, 1};
    return matrix;
}

glm::dmat4 scaled_by(const glm::dvec3& factors) {
    glm::dmat4 matrix(1);
    for (int i = 0; i < 3; ++i) matrix[i][i] = factors[i];
    return matrix;
}

/// Alpha, 0 to 1, at the square over x and z.
double darkness(const io::ContactShadow& shadow, double x, double z) {
    const auto at = [](double value, double low, double high, int count) {
        return std::clamp(static_cast<int>((value - low) / (high - low) * count), 0, count - 1);
    };
    const scene::Image& image = shadow.image;
    const int column = at(x, shadow.low.x, shadow.high.x, image.width),
              row = at(z, shadow.low.z, shadow.high.z, image.height);
    return image.rgba[4 * static_cast<std::size_t>(row * image.width + column) + 3] / 255.0;
}

io::ContactShadow shadow_of(const std::vector<io::PlacedGeometry>& geometries) {
    auto shadow = io::contact_shadow(geometries);
    REQUIRE(shadow);
    return *std::move(shadow);
}

scene::SceneParts::PartNode part(scene::Id id, scene::Id parent, scene::NodeType type, auto data) {
    scene::SceneParts::PartNode part;
    part.node.id = id;
    part.node.name = "Node " + std::to_string(id);
    part.node.type = type;
    part.node.data = std::move(data);
    part.parent_id = parent;
    return part;
}

scene::SceneParts::PartNode geometry_part(scene::Id id, scene::Id parent, scene::Index geometry = 0,
                                          scene::Index material = scene::kNone) {
    return part(id, parent, scene::NodeType::geometry, scene::GeometryData{geometry, material});
}

scene::SceneParts box_parts() {
    scene::SceneParts parts;
    parts.geometries = {box()};
    parts.geometries[0].id = 40;
    parts.materials.resize(1);
    parts.materials[0].id = 30;
    parts.nodes = {geometry_part(5, 0, 0, 0)};
    return parts;
}

scene::Scene with_studio(scene::SceneParts parts) {
    io::add_studio(parts);
    auto scene = io::build_scene(std::move(parts), "test");
    REQUIRE_MESSAGE(scene, scene.error());
    return *std::move(scene);
}

/// How long the sheet's sides are; 0 where there is none.
glm::dvec3 sheet_size(const scene::SceneParts& parts) {
    const scene::Scene scene = with_studio(parts);
    for (const scene::Node& node : scene.nodes())
        if (node.name == "Contact shadow")
            return 2.0 * scene
                             .geometries()[static_cast<std::size_t>(
                                 std::get<scene::GeometryData>(node.data).geometry)]
                             .bounds.half_extent();
    return glm::dvec3(0);
}

bool has_node(const scene::Scene& scene, const std::string& name) {
    for (const scene::Node& node : scene.nodes())
        if (node.name == name) return true;
    return false;
}

bool is_in_studio(const std::filesystem::path& path, io::Studio studio) {
    const auto scene = io::read_scene(path, {}, {.studio = studio});
    REQUIRE_MESSAGE(scene, scene.error());
    CHECK(has_node(*scene, "Studio") == has_node(*scene, "Contact shadow"));
    return has_node(*scene, "Studio");
}

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 2\nf 1 2 3\n";
const std::string kText =
    "vrut-text 1\ngeometry 1 vertices 3 0 0 0 1 0 0 0 1 2 triangles 1 0 1 2 end\n"
    "node 1 \"Part\" geometry geometry 1 end\n";

}  // namespace

TEST_CASE("studio: light from above, less from the sides, least from below, all of it grey") {
    // What a camera of each image sees ahead, to its right and up.
    const std::array<std::array<glm::dvec3, 3>, 6> faces{{{{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}}},
                                                          {{{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}}},
                                                          {{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}}},
                                                          {{{0, -1, 0}, {1, 0, 0}, {0, 0, -1}}},
                                                          {{{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}}},
                                                          {{{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}}}};
    const std::array<scene::Image, 6> images = io::studio_cube_map();
    const auto irradiance = [&](const glm::dvec3& normal) {  // by π
        double sum = 0, weights = 0;
        for (std::size_t i = 0; i < 6; ++i)
            for (int y = 0; y < images[i].height; ++y)
                for (int x = 0; x < images[i].width; ++x) {
                    const glm::dvec2 at = 2.0 * (glm::dvec2(x, y) + 0.5) / double(images[i].width) - 1.0;
                    const glm::dvec3 towards = faces[i][0] + at.x * faces[i][1] + at.y * faces[i][2];
                    const double distance = glm::length(towards);
                    const double weight = std::max(0.0, glm::dot(towards, normal)) / std::pow(distance, 4);
                    const std::size_t texel = 4 * static_cast<std::size_t>(y * images[i].width + x);
                    sum += weight * base::linear_from_srgb(images[i].rgba[texel] / 255.0);
                    weights += weight;
                }
        return sum / weights;
    };
    CHECK(irradiance({0, 1, 0}) == doctest::Approx(0.75).epsilon(0.05));
    for (const glm::dvec3& side : {glm::dvec3(1, 0, 0), {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}, {0.6, 0, 0.8}})
        CHECK(irradiance(side) == doctest::Approx(0.4).epsilon(0.05));
    CHECK(irradiance({0, -1, 0}) == doctest::Approx(0.2).epsilon(0.05));
    int largest_step = 0;
    for (const scene::Image& image : images) {
        REQUIRE(image.width == 128);
        REQUIRE(image.height == 128);
        for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
            REQUIRE(image.rgba[i] == image.rgba[i + 1]);
            REQUIRE(image.rgba[i] == image.rgba[i + 2]);
            REQUIRE(image.rgba[i + 3] == 255);
            if (i >= 512)
                largest_step = std::max(largest_step, std::abs(image.rgba[i] - image.rgba[i - 512]));
            if (i % 512 > 0)
                largest_step = std::max(largest_step, std::abs(image.rgba[i] - image.rgba[i - 4]));
        }
    }
    CHECK(largest_step <= 20);
}

TEST_CASE("studio: a background and a sheet hang in an assembly of their own") {
    const scene::Scene scene = with_studio(box_parts());
    const scene::PlacedScene placed = scene::place(scene);
    REQUIRE(scene.nodes().size() == 5);
    const scene::Node& studio = scene.nodes()[static_cast<std::size_t>(scene.find_node(6))];
    CHECK(studio.name == "Studio");
    CHECK(studio.parent == 0);
    CHECK(studio.presentation);
    const scene::Node& background = scene.nodes()[static_cast<std::size_t>(scene.find_node(7))];
    const auto& data = std::get<scene::BackgroundData>(background.data);
    CHECK(parent_of(scene, background).id == 6);
    CHECK(data.only_reflected);
    CHECK(scene.material(data.material).id == 31);
    CHECK(scene.material(data.material).diffuse == glm::dvec4(scene::kDefaultBackground, 1));
    REQUIRE(data.cube_textures);
    for (std::size_t i = 0; i < 6; ++i)
        CHECK(scene.textures()[static_cast<std::size_t>((*data.cube_textures)[i])].file ==
              (*data.cube_map)[i]);
    const scene::Node& sheet = scene.nodes()[static_cast<std::size_t>(scene.find_node(8))];
    CHECK(parent_of(scene, sheet).id == 6);
    CHECK(scene.is_presentation(scene.find_node(8)));
    CHECK_FALSE(scene.is_presentation(scene.find_node(5)));
    const scene::Geometry& geometry = scene.geometries()[1];
    CHECK(geometry.id == 41);
    CHECK(geometry.bounds.min.y < 0);
    CHECK(geometry.bounds.min.y > -1e-3);
    CHECK(geometry.bounds.max.y == geometry.bounds.min.y);
    CHECK(geometry.bounds.min.x < -1.2);
    CHECK(geometry.bounds.max.z > 1.2);
    CHECK(scene.plane(1)->normal.y == 1);
    const scene::Material& black = scene.materials()[2];
    CHECK(black.id == 32);
    for (const glm::dvec4& color : {black.ambient, black.diffuse, black.specular, black.emission})
        CHECK(color == glm::dvec4(0, 0, 0, 1));
    CHECK(scene.is_transparent(black, 1));
}

TEST_CASE("studio: what brings a background, shows nothing or has no free ids gets none") {
    const auto is_unchanged = [](const scene::SceneParts& before) {
        scene::SceneParts after = before;
        io::add_studio(after);
        return after.nodes.size() == before.nodes.size() && after.textures.empty() &&
               after.materials.size() == before.materials.size() &&
               after.geometries.size() == before.geometries.size();
    };
    CHECK_FALSE(is_unchanged(box_parts()));
    CHECK(is_unchanged({}));
    scene::SceneParts parts = box_parts();
    parts.nodes.push_back(part(9, 0, scene::NodeType::background, scene::BackgroundData{}));
    CHECK(is_unchanged(parts));
    parts = box_parts();
    parts.nodes[0].node.active = false;
    CHECK(is_unchanged(parts));
    parts = box_parts();
    parts.geometries[0].triangles.clear();
    CHECK(is_unchanged(parts));
    parts = box_parts();
    parts.nodes.push_back(parts.nodes[0]);  // twice the id
    CHECK(is_unchanged(parts));
    parts = box_parts();
    parts.nodes[0].node.presentation = true;
    CHECK(is_unchanged(parts));
    for (std::size_t i = 0; i < 3; ++i) {
        parts = box_parts();
        scene::Id& id =
            *std::array{&parts.nodes[0].node.id, &parts.materials[0].id, &parts.geometries[0].id}[i];
        id = scene::kMaxId - 3;
        CHECK_FALSE(is_unchanged(parts));
        id = scene::kMaxId - 2;
        CHECK(is_unchanged(parts));
    }
}

TEST_CASE("studio: of files in other formats without light, or on request") {
    const TemporaryFolder folder;
    const auto obj = folder.write("a.obj", kTriangle), text = folder.write("a.vrut", kText),
               lit = folder.write("lit.vrut", kText + "node 2 \"Lamp\" light type directional end\n"),
               sky = folder.write("sky.vrut", kText + "node 2 \"Sky\" background end\n"),
               glb = folder.path() / "lit.glb";
    REQUIRE(io::write_scene(read_well(lit), glb));
    CHECK(is_in_studio(obj, io::Studio::automatic));
    for (const auto& file : {text, lit, sky, glb}) CHECK_FALSE(is_in_studio(file, io::Studio::automatic));
    for (const auto& file : {obj, text, lit, glb}) CHECK(is_in_studio(file, io::Studio::on));
    CHECK_FALSE(is_in_studio(sky, io::Studio::on));
    CHECK_FALSE(is_in_studio(obj, io::Studio::off));
    CHECK_FALSE(has_node(read_well(obj), "Studio"));
}

TEST_CASE("studio: it can be written, and read again") {
    const TemporaryFolder folder;
    const scene::Scene scene = with_studio(box_parts());
    REQUIRE(io::write_scene(scene, folder.path() / "a.vrut"));
    const scene::Scene again = read_well(folder.path() / "a.vrut");
    CHECK(again.notices().empty());
    REQUIRE(again.textures().size() == 7);
    const auto& data =
        std::get<scene::BackgroundData>(again.nodes()[static_cast<std::size_t>(again.find_node(7))].data);
    CHECK(data.only_reflected);
    REQUIRE(data.cube_textures);
    for (std::size_t i = 0; i < 6; ++i)
        CHECK(again.textures()[static_cast<std::size_t>((*data.cube_textures)[i])].image.rgba ==
              scene.textures()[i].image.rgba);
    const scene::Texture& shadow =
        again.textures()[static_cast<std::size_t>(material_of(again, "Contact shadow").texture)];
    CHECK(shadow.image.rgba == scene.textures()[6].image.rgba);
    CHECK(shadow.transparent);
}

TEST_CASE("contact shadow: dark below what stands, light beside it, none at the border") {
    const scene::Geometry cube = box(), ball = sphere();
    const io::ContactShadow shadow = shadow_of({{&cube}});
    CHECK(darkness(shadow, 0, 0) > 0.55);
    CHECK(darkness(shadow, 0, 0) <= 0.65);
    CHECK(darkness(shadow, 1.1, 0) > 0.02);
    for (const glm::dvec2& beside : {glm::dvec2(1.1, 0), {-1.1, 0}, {0, 1.1}, {0, -1.1}})
        CHECK(darkness(shadow, beside.x, beside.y) < 0.6 * darkness(shadow, 0, 0));
    CHECK(darkness(shadow, 1.3, 0) < darkness(shadow, 1.1, 0));
    const scene::Image& image = shadow.image;
    int largest_step = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const auto i = 4 * static_cast<std::size_t>(y * image.width + x);
            REQUIRE(image.rgba[i] + image.rgba[i + 1] + image.rgba[i + 2] == 0);
            if (x == 0 || y == 0 || x == image.width - 1 || y == image.height - 1)
                REQUIRE(image.rgba[i + 3] == 0);
            else
                largest_step = std::max(largest_step, std::abs(image.rgba[i + 3] - image.rgba[i - 1]));
        }
    CHECK(largest_step <= 42);
    // What floats, and what is round, is lighter.
    const io::ContactShadow floating = shadow_of(
        {{&cube, moved_by({-4, 0, 0})}, {&ball, moved_by({4, 0.5, 0})}, {&ball, moved_by({0, 2, 0})}});
    CHECK(darkness(floating, 4, 0) < 0.8 * darkness(floating, -4, 0));
    CHECK(darkness(floating, 0, 0) < 0.6 * darkness(floating, 4, 0));
    CHECK(darkness(floating, 0, 0) > 0);
    const io::ContactShadow round = shadow_of({{&ball}});
    CHECK(darkness(round, 0.8, 0) < 0.7 * darkness(round, 0, 0));
    CHECK(darkness(round, 0.8, 0) > darkness(round, 1.1, 0));
}

TEST_CASE("contact shadow: it lies where the thing stands, in any unit") {
    const scene::Geometry cube = box();
    const io::ContactShadow shadow = shadow_of({{&cube}});
    for (const double unit : {1e-20, 1e-3, 1e3, 1e10}) {
        const glm::dvec3 place = unit * glm::dvec3(8, -6, 4);
        const io::ContactShadow other = shadow_of({{&cube, moved_by(place) * scaled_by(glm::dvec3(unit))}});
        CHECK(glm::distance(other.low, place + unit * shadow.low) < 1e-9 * unit);
        CHECK(glm::distance(other.high, place + unit * shadow.high) < 1e-9 * unit);
        REQUIRE(other.image.rgba.size() == shadow.image.rgba.size());
        int off = 0;
        for (std::size_t i = 3; i < shadow.image.rgba.size(); i += 4)
            off = std::max(off, std::abs(other.image.rgba[i] - shadow.image.rgba[i]));
        CHECK(off <= 12);  // a corner on the edge of a square may count for either
    }
    const scene::Geometry half = [&] {
        scene::Geometry part = cube;
        for (glm::dvec3& position : part.positions) position.x = std::max(position.x, 0.0);
        return part;
    }();
    const io::ContactShadow left = shadow_of({{&half, moved_by({0, 0, -1})}, {&cube, moved_by({-4, 0, 5})}});
    CHECK(darkness(left, 0.5, -1) > 0.5);
    CHECK(darkness(left, -4, 5) > 0.5);
    CHECK(darkness(left, 0.5, 5) < 0.02);
    CHECK(darkness(left, -4, -1) < 0.02);
}

TEST_CASE("contact shadow: nothing without height, or beyond what readers take") {
    const scene::Geometry cube = box();
    const auto has_shadow = [&](const glm::dmat4& world) {
        const std::vector<io::PlacedGeometry> geometries{{&cube, world}};
        return io::contact_shadow(geometries).has_value();
    };
    CHECK_FALSE(io::contact_shadow({}));
    CHECK(has_shadow(glm::dmat4(1)));
    CHECK_FALSE(has_shadow(scaled_by({1, 0, 1})));
    CHECK(has_shadow(scaled_by({0, 1, 1})));
    CHECK(has_shadow(scaled_by({0, 1, 0})));
    CHECK(has_shadow(scaled_by({1e6, 1, 1e-6})));
    CHECK(has_shadow(scaled_by({1, 1e9, 1})));
    CHECK_FALSE(has_shadow(glm::dmat4(0)));
    CHECK(has_shadow(scaled_by(glm::dvec3(1e14))));
    for (const double factor : {1e15, 1e200, 1e308, kInfinity, std::nan("")})
        CHECK_FALSE(has_shadow(scaled_by(glm::dvec3(factor))));
    // One bad corner leaves out its triangles alone.
    for (const double bad : {std::nan(""), kInfinity, -kInfinity}) {
        scene::Geometry broken = cube;
        broken.positions.back().y = bad;
        const io::ContactShadow shadow = shadow_of({{&broken}});
        CHECK(darkness(shadow, -0.5, -0.5) > 0.5);
        CHECK(shadow.low.y > -1e-3);
    }
}

TEST_CASE("contact shadow: of very many triangles some are looked at, and the same ones each time") {
    scene::Geometry cube = box();
    for (std::size_t i = 0; i < 16; ++i)
        cube.triangles.insert(cube.triangles.end(), cube.triangles.begin(), cube.triangles.end());
    const std::vector<io::PlacedGeometry> many(50'016,
                                               {&cube});  // 4 · 10^10 triangles, 12 · 1639 for each looked at
    const io::ContactShadow shadow = shadow_of(many);
    CHECK(darkness(shadow, 0, 0) > 0.55);
    CHECK(shadow.image.rgba == shadow_of(many).image.rgba);
}

TEST_CASE("contact shadow: of what is shown at first, and cannot be seen through") {
    const auto size_with = [](const auto& change) {
        scene::SceneParts parts = box_parts();
        parts.nodes.push_back(geometry_part(50, 0));
        parts.nodes.back().node.matrix = moved_by({100, 0, 0});
        change(parts);
        return sheet_size(parts).x;
    };
    const auto under = [](scene::NodeType type, auto data, scene::Id before) {
        return [=](scene::SceneParts& parts) {
            parts.nodes.push_back(part(45, 0, type, data));
            parts.nodes.push_back(part(before, 45, scene::NodeType::assembly, scene::GroupData{}));
            parts.nodes[1].parent_id = 45;
        };
    };
    CHECK(size_with([](auto&) {}) > 100);
    CHECK(size_with([](auto& parts) { parts.nodes[1].node.active = false; }) < 10);
    CHECK(size_with([](auto& parts) { parts.nodes[1].node.presentation = true; }) < 10);
    CHECK(size_with(under(scene::NodeType::switch_, scene::SwitchData{0}, 51)) > 100);
    CHECK(size_with(under(scene::NodeType::switch_, scene::SwitchData{0}, 49)) < 10);
    CHECK(size_with(under(scene::NodeType::lod, scene::LodData{{5, 50}}, 51)) > 100);
    CHECK(size_with(under(scene::NodeType::lod, scene::LodData{{5, 50}}, 49)) < 10);
    // Glass counts for the size, and casts no shadow.
    const auto alpha_of = [](double alpha) {
        scene::SceneParts parts = box_parts();
        parts.materials[0].diffuse.a = alpha;
        const scene::Scene scene = with_studio(parts);
        const scene::Image& image = scene.textures()[6].image;
        return image.rgba[4 * static_cast<std::size_t>(image.height / 2 * image.width + image.width / 2) + 3];
    };
    CHECK(alpha_of(1) > 100);
    CHECK(alpha_of(0.5) == 0);
}
