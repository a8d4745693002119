#include <doctest/doctest.h>

#include <algorithm>

#include "car_scene.hpp"
#include "cut.hpp"
#include "subdivision_shapes.hpp"

using namespace vrut;

namespace {

constexpr double kGap = 0.006;

Outline rectangle(Outline::From from, const glm::dvec2& low, const glm::dvec2& high, double radius) {
    return {from, {{low, radius}, {{high.x, low.y}, radius}, {high, radius}, {{low.x, high.y}, radius}}};
}

CageNode panel_node(scene::Id id, int cut, double edge, double thickness = 0.02) {
    CageNode node;
    node.part.node.id = id;
    node.part.node.type = scene::NodeType::geometry;
    node.part.node.data = scene::GeometryData{};
    node.panel = Panel{0, cut, 0, thickness, edge};
    return node;
}

/// A skin with one cut, the cut's panel (node 1) and the rest (node 2).
CageScene scene_with(const Cage& skin, Outline outline, double edge) {
    CageScene scene;
    scene.meshes = {skin};
    scene.skins = {{0, {{"Door", kGap, {std::move(outline)}}}}};
    scene.nodes = {panel_node(1, 0, edge), panel_node(2, scene::kNone, edge)};
    return scene;
}

SubdividedScene subdivided(const CageScene& cages, double count) {
    auto result = subdivide(cages, count);
    REQUIRE_MESSAGE(result, result.error());
    return *std::move(result);
}

const scene::Geometry& geometry_at(const scene::Scene& scene, scene::Id node) {
    const scene::Index place = scene.find_node(node);
    REQUIRE(place != scene::kNone);
    const auto& data = std::get<scene::GeometryData>(scene.nodes()[static_cast<std::size_t>(place)].data);
    return scene.geometries()[static_cast<std::size_t>(data.geometry)];
}

/// A plane in x > 0 that leans by `degrees` about z; from the left its front is seen.
Cage leaning_plane(double degrees) {
    const double c = std::cos(glm::radians(degrees)), s = std::sin(glm::radians(degrees));
    return shapes::grid(3, [&](double u, double v) {
        return glm::dvec3(1 - s * (1.2 * u - 0.6), 0.6 + c * (1.2 * u - 0.6), 1.6 * v - 0.8);
    });
}

glm::dvec3 plane_normal(double degrees) {
    return {std::cos(glm::radians(degrees)), std::sin(glm::radians(degrees)), 0};
}

double front_area(const scene::Geometry& geometry, const glm::dvec3& normal) {
    double area = 0;
    for (const glm::uvec3& t : geometry.triangles) {
        const glm::dvec3 a = geometry.positions[t.x];
        const glm::dvec3 twice = glm::cross(geometry.positions[t.y] - a, geometry.positions[t.z] - a);
        if (glm::dot(twice, normal) > 0.999 * glm::length(twice)) area += glm::length(twice) / 2;
    }
    return area;
}

/// The edges of a shell's rim, in the plane across `normal`.
std::vector<std::pair<glm::dvec3, glm::dvec3>> rim(const scene::Geometry& geometry,
                                                   const glm::dvec3& normal) {
    const auto flat = [&](const glm::dvec3& p) { return p - glm::dot(p, normal) * normal; };
    std::vector<std::pair<glm::dvec3, glm::dvec3>> edges;
    for (const glm::uvec3& t : geometry.triangles) {
        const glm::dvec3 a = geometry.positions[t.x];
        const glm::dvec3 across = glm::cross(geometry.positions[t.y] - a, geometry.positions[t.z] - a);
        if (std::abs(glm::dot(across, normal)) > 1e-3 * glm::length(across)) continue;
        for (int k = 0; k < 3; ++k)
            edges.emplace_back(flat(geometry.positions[t[k]]), flat(geometry.positions[t[(k + 1) % 3]]));
    }
    return edges;
}

double distance(const glm::dvec3& p, const std::pair<glm::dvec3, glm::dvec3>& edge) {
    const glm::dvec3 along = edge.second - edge.first;
    const double square = glm::dot(along, along);
    const double t = square > 0 ? std::clamp(glm::dot(p - edge.first, along) / square, 0.0, 1.0) : 0;
    return glm::distance(p, edge.first + t * along);
}

Cage bulge() {
    return shapes::grid(4, [](double u, double v) {
        return glm::dvec3(1.1 - (u - 0.5) * (u - 0.5) - 0.5 * (v - 0.5) * (v - 0.5), 0.1 + u, 1.6 * v - 0.8);
    });
}

}  // namespace

TEST_CASE("a rounded polygon has the area of its arcs, and radii for which there is room") {
    const auto area = [](const std::vector<glm::dvec2>& points) {
        double twice = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const glm::dvec2 &a = points[i], &b = points[(i + 1) % points.size()];
            twice += a.x * b.y - a.y * b.x;
        }
        return twice / 2;
    };
    const auto square = [](double radius) {
        return rectangle(Outline::From::left, {0, 0}, {2, 1}, radius).corners;
    };
    const double pi = std::numbers::pi;
    CHECK(area(rounded_polygon(square(0))) == doctest::Approx(2));
    CHECK(area(rounded_polygon(square(0.2))) == doctest::Approx(2 - (4 - pi) * 0.04).epsilon(1e-4));
    CHECK(area(rounded_polygon(square(5))) == doctest::Approx(1 + pi / 4).epsilon(1e-4));
    auto clockwise = square(0.2);
    std::reverse(clockwise.begin(), clockwise.end());
    CHECK(area(rounded_polygon(clockwise)) > 1.9);
}

TEST_CASE("a cut's distance, and which half it means") {
    const CutShape cut({"Door", kGap, {rectangle(Outline::From::left, {-1, 0}, {1, 1}, 0)}});
    const CutDistance inside = cut.at({0.5, 0.75, 0}, 1);
    CHECK(inside.value == doctest::Approx(-0.25));
    CHECK(glm::distance(inside.gradient, glm::dvec3(0, 1, 0)) < 1e-9);
    CHECK(cut.at({0.5, 1.3, 1.4}, 1).value == doctest::Approx(0.5));
    CHECK(cut.at({-0.5, 0.5, 0}, 1).value == doctest::Approx(0.5));
    CHECK(cut.at({0.5, 0.5, 9}, 1).value > 1);
    const CutShape both({"Band", 0, {rectangle(Outline::From::sides, {-1, 0}, {1, 1}, 0)}});
    CHECK(both.at({-0.5, 0.5, 0}, 1).value == doctest::Approx(-0.5));
    const CutShape lid({"Lid", 0, {rectangle(Outline::From::top, {-1, -1}, {1, 1}, 0)}});
    CHECK(lid.at({0, 0.9, 0}, 1).value == doctest::Approx(-0.4));
    const CutShape lamp({"Lamp",
                         0,
                         {rectangle(Outline::From::front, {0, 0}, {1, 1}, 0),
                          rectangle(Outline::From::left, {0, 0}, {1, 0.6}, 0)}});
    CHECK(lamp.at({0.5, 0.5, 0.5}, 1).value == doctest::Approx(-0.1));
    CHECK(lamp.at({0.5, 0.8, 0.5}, 1).value == doctest::Approx(0.2));
}

TEST_CASE("a panel cut from a plane has the area of its outline less half the gap") {
    const Outline outline = rectangle(Outline::From::left, {-0.3, 0.4}, {0.3, 0.8}, 0.05);
    const SubdividedScene result = subdivided(scene_with(leaning_plane(0), outline, 0), 4000);
    const double width = 0.6 - kGap, height = 0.4 - kGap, radius = 0.05 - kGap / 2;
    const double area = width * height - (4 - std::numbers::pi) * radius * radius;
    CHECK(front_area(geometry_at(result.scene, 1), {1, 0, 0}) == doctest::Approx(area).epsilon(1e-4));
    const double hole =
        (0.6 + kGap) * (0.4 + kGap) - (4 - std::numbers::pi) * (0.05 + kGap / 2) * (0.05 + kGap / 2);
    CHECK(front_area(geometry_at(result.scene, 2), {1, 0, 0}) ==
          doctest::Approx(1.6 * 1.2 - hole).epsilon(1e-4));
}

TEST_CASE("the gap is as wide as asked all around, on leaning surfaces too") {
    for (const double degrees : {0.0, 50.0}) {
        CAPTURE(degrees);
        const glm::dvec3 normal = plane_normal(degrees);
        const Outline outline = rectangle(Outline::From::left, {-0.3, 0.45}, {0.3, 0.75}, 0.04);
        const SubdividedScene result = subdivided(scene_with(leaning_plane(degrees), outline, 0.002), 6000);
        const auto inner = rim(geometry_at(result.scene, 1), normal),
                   outer = rim(geometry_at(result.scene, 2), normal);
        REQUIRE(inner.size() > 50);
        double least = 1, most = 0;
        for (const auto& edge : inner) {
            double nearest = 1;
            for (const auto& other : outer) nearest = std::min(nearest, distance(edge.first, other));
            least = std::min(least, nearest);
            most = std::max(most, nearest);
        }
        CHECK(least > kGap - 1e-4);
        CHECK(most < kGap + 1e-4);
    }
}

TEST_CASE("panels of a curved skin are closed shells that look outward") {
    for (const double count : {2000.0, 10000.0, 50000.0}) {
        CAPTURE(count);
        CageScene cages =
            scene_with(bulge(), rectangle(Outline::From::left, {-0.5, 0.3}, {0.33, 0.9}, 0.06), 0.002);
        // A handle's hole in the door, and a second panel that leaves a narrow strip between.
        cages.skins[0].cuts.insert(
            cages.skins[0].cuts.begin(),
            {"Hole", 0.001, {rectangle(Outline::From::left, {0, 0.7}, {0.1, 0.74}, 0.02)}});
        cages.skins[0].cuts.push_back(
            {"Window", 0.004, {rectangle(Outline::From::left, {-0.5, 0.925}, {0.33, 1.05}, 0.03)}});
        cages.nodes = {panel_node(1, 1, 0.002), panel_node(2, scene::kNone, 0.002),
                       panel_node(3, 2, 0.001, 0.005)};
        const SubdividedScene result = subdivided(cages, count);
        CHECK(result.shown == doctest::Approx(count).epsilon(0.1));
        for (const scene::Geometry& geometry : result.scene.geometries()) {
            CHECK(shapes::open_edges(geometry) == 0);
            CHECK(shapes::volume(geometry) > 0);
        }
        // The strip is there all along: the rest is one piece around both.
        const scene::Geometry& rest = geometry_at(result.scene, 2);
        for (const double z : {-0.45, -0.38, -0.3, -0.21, -0.1, -0.02, 0.05, 0.13, 0.22, 0.28})
            CHECK(std::any_of(rest.triangles.begin(), rest.triangles.end(), [&](const glm::uvec3& t) {
                const auto between = [&](int axis, double at) {
                    const double a = rest.positions[t.x][axis], b = rest.positions[t.y][axis],
                                 c = rest.positions[t.z][axis];
                    return std::min({a, b, c}) <= at && std::max({a, b, c}) >= at;
                };
                return between(2, z) && between(1, 0.9125);
            }));
    }
}

TEST_CASE("a panel stands in its node's space") {
    CageScene cages =
        scene_with(bulge(), rectangle(Outline::From::left, {-0.5, 0.3}, {0.33, 0.9}, 0.06), 0.002);
    const SubdividedScene plain = subdivided(cages, 2000);
    CageNode hinge;
    hinge.part.node.id = 5;
    hinge.part.node.matrix[3] = {1, 2, 3, 1};
    hinge.part.node.matrix[0][0] = -1;  // mirrored: what is outward stays so
    cages.nodes.push_back(hinge);
    cages.nodes[0].part.parent_id = 5;
    const SubdividedScene moved = subdivided(cages, 2000);
    const scene::Geometry &at_home = geometry_at(plain.scene, 1), &away = geometry_at(moved.scene, 1);
    CHECK(shapes::volume(away) == doctest::Approx(shapes::volume(at_home)).epsilon(1e-3));
    CHECK(away.bounds.min.y == doctest::Approx(at_home.bounds.min.y - 2));
    CHECK(away.bounds.max.x == doctest::Approx(1 - at_home.bounds.min.x));
}

TEST_CASE("a panel of which nothing is left is told of, and one whose node flattens space is refused") {
    CageScene cages = scene_with(bulge(), rectangle(Outline::From::left, {5, 0.3}, {6, 0.9}, 0.06), 0.002);
    cages.nodes[0].part.node.name = "Door";
    CHECK(subdivided(cages, 2000).lost == std::vector<std::string>{"node 1 \"Door\""});
    cages.nodes[0].part.node.matrix[0][0] = 0;
    const auto result = subdivide(cages, 2000);
    REQUIRE_FALSE(result);
    CHECK(result.error() == "node 1 \"Door\": its place in the car has no inverse");
}

TEST_CASE("what a switch hides is not counted, what several nodes use is counted for each") {
    CageScene cages;
    cages.meshes = {shapes::cube(), shapes::cube()};
    const auto add = [&](scene::Id id, scene::Id parent, scene::NodeType type, int mesh) -> CageNode& {
        CageNode& node = cages.nodes.emplace_back();
        node.part.node.id = id;
        node.part.node.type = type;
        node.part.parent_id = parent;
        node.mesh = mesh;
        if (type == scene::NodeType::geometry) node.part.node.data = scene::GeometryData{};
        if (type == scene::NodeType::switch_) node.part.node.data = scene::SwitchData{1};
        return node;
    };
    add(1, 0, scene::NodeType::switch_, scene::kNone);
    add(2, 1, scene::NodeType::geometry, 0);
    add(3, 1, scene::NodeType::geometry, 1);
    add(4, 1, scene::NodeType::geometry, scene::kNone).geometry_of = 3;
    add(5, 0, scene::NodeType::geometry, scene::kNone).geometry_of = 3;
    const SubdividedScene result = subdivided(cages, 4000);
    CHECK(result.shown == doctest::Approx(4000).epsilon(0.02));
    CHECK(geometry_at(result.scene, 3).triangles.size() == doctest::Approx(2000).epsilon(0.02));
    CHECK(&geometry_at(result.scene, 3) == &geometry_at(result.scene, 5));
    CHECK(geometry_at(result.scene, 2).triangles.size() == doctest::Approx(2000).epsilon(0.1));
}

TEST_CASE("a narrow strip between two panels is not torn, whatever its slant") {
    const double width = 0.02, gap = 0.004;
    for (int step = 0; step < 16; ++step) {
        const double slant = 0.05 + 0.06 * step;
        CAPTURE(slant);
        const auto beside = [&](double offset, double far) {
            const auto line = [&](double y) { return slant * (y - 0.6) + offset; };
            return Outline{Outline::From::left, {{{far, -3}}, {{line(-3), -3}}, {{line(3), 3}}, {{far, 3}}}};
        };
        CageScene cages;
        cages.meshes = {leaning_plane(0)};
        cages.skins.push_back(
            {0, {{"Before", gap, {beside(-width / 2, -9)}}, {"Behind", gap, {beside(width / 2, 9)}}}});
        cages.nodes = {panel_node(1, 0, 0), panel_node(2, 1, 0), panel_node(3, scene::kNone, 0)};
        const double area = 1.2 * (width - gap * std::sqrt(1 + slant * slant));
        for (const double count : {8000.0, 13000.0}) {
            CAPTURE(count);
            const scene::Scene scene = subdivided(cages, count).scene;
            CHECK(front_area(geometry_at(scene, 3), {1, 0, 0}) == doctest::Approx(area).epsilon(0.002));
        }
    }
}
