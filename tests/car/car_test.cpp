// What holds for the car at every level of detail, whatever it looks like.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <set>

#include "car_geometry.hpp"
#include "io/read_scene.hpp"
#include "plan/frame_plan.hpp"
#include "scene/camera.hpp"

using namespace vrut;

namespace {

const scene::Scene& car(const std::string& level) {
    static std::map<std::string, scene::Scene> cars;
    auto found = cars.find(level);
    if (found == cars.end()) {
        auto scene = io::read_scene(VRUT_CARS "/" + level + ".vrut");
        REQUIRE_MESSAGE(scene, scene.error());
        found = cars.emplace(level, *std::move(scene)).first;
    }
    return found->second;
}

struct CarPart {
    std::string path;  ///< of the first node that has it
    const scene::Node* node = nullptr;
    const scene::Geometry* geometry = nullptr;
    const scene::Material* material = nullptr;
    scene::Index index = scene::kNone;
};

/// Each geometry once.
std::vector<CarPart> parts_of(const scene::Scene& scene) {
    std::vector<CarPart> parts;
    std::set<scene::Index> seen;
    for (std::size_t i = 0; i < scene.nodes().size(); ++i) {
        const auto* data = std::get_if<scene::GeometryData>(&scene.nodes()[i].data);
        if (data == nullptr || data->geometry == scene::kNone || !seen.insert(data->geometry).second)
            continue;
        parts.push_back({path_of(scene, static_cast<scene::Index>(i)), &scene.nodes()[i],
                         &scene.geometries()[static_cast<std::size_t>(data->geometry)],
                         &scene.material(data->material), data->geometry});
    }
    return parts;
}

std::string text_of(const glm::dvec3& p) {
    std::array<char, 80> text{};
    std::snprintf(text.data(), text.size(), "(%.4f %.4f %.4f)", p.x, p.y, p.z);
    return text.data();
}

glm::dvec3 cross_of(const scene::Geometry& geometry, const glm::uvec3& t) {
    return glm::cross(geometry.positions[t.y] - geometry.positions[t.x],
                      geometry.positions[t.z] - geometry.positions[t.x]);
}

double degrees_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0)) /
           scene::kRadiansPerDegree;
}

/// Sheets that are looked at from one side only, and lie in a plane.
bool is_sheet(const std::string& path) {
    static const std::set<std::string> kSheets{
        "Body/Doors/Front left/Mirror/Glass",
        "Body/Doors/Front right/Mirror/Glass",
        "Interior/Interior mirror/Interior mirror glass",
        "Interior/Dashboard/Instrument cluster/Dials",
        "Interior/Dashboard/Centre stack/Screen",
        "Presentation/Floor shadow",
    };
    return kSheets.count(path) > 0;
}

/// Trim without a back, pipes that end in others, panes of an outer and an inner sheet, lenses: no opening of
/// theirs is seen (pictures.test.js).
bool may_be_open(const scene::Scene& scene, const CarPart& part) {
    return !part.path.starts_with("Body/") || part.path.find("/Trim/") != std::string::npos ||
           scene.is_transparent(*part.material);
}

/// What closes a panel from behind: "X liner" beside "X", be X a switch of paints. kNone where it has none.
scene::Index liner_of(const scene::Scene& scene, const CarPart& part) {
    for (std::string path = part.path; !path.empty(); path.resize(path.find_last_of('/'))) {
        if (const scene::Index node = node_at(scene, path + " liner"); node != scene::kNone) return node;
        if (path.find('/') == std::string::npos) break;
    }
    return scene::kNone;
}

const scene::Geometry* geometry_at(const scene::Scene& scene, scene::Index node) {
    if (node == scene::kNone) return nullptr;
    const auto* data = std::get_if<scene::GeometryData>(&scene.nodes()[static_cast<std::size_t>(node)].data);
    return data == nullptr ? nullptr : &scene.geometries()[static_cast<std::size_t>(data->geometry)];
}

glm::dvec3 area_of(const scene::Geometry& geometry) {
    glm::dvec3 area(0);
    for (const glm::uvec3& t : geometry.triangles) area += cross_of(geometry, t) / 2.0;
    return area;
}

const std::vector<std::string> kLevels{"car-20k", "car"};

/// How far what is at and below a node reaches in a direction, with the node opened by its hinge.
double reach_of(const scene::Scene& scene, scene::Index top, double part, const glm::dvec3& direction) {
    std::vector<scene::NodeState> states = scene::file_states(scene);
    const auto place = static_cast<std::size_t>(top);
    const scene::Hinge& hinge = *scene.nodes()[place].hinge;
    states[place].matrix = glm::rotate(states[place].matrix, part * hinge.degrees * scene::kRadiansPerDegree,
                                       scene::unit_axis(hinge));
    const std::vector<glm::dmat4> world = scene::world_matrices(scene, states);
    const std::vector<bool> below = scene::subtree(scene, top);
    double reach = -1e9;
    for (std::size_t i = 0; i < world.size(); ++i) {
        const scene::Geometry* geometry =
            below[i] ? geometry_at(scene, static_cast<scene::Index>(i)) : nullptr;
        if (geometry == nullptr) continue;
        for (const glm::dvec3& position : geometry->positions)
            reach = std::max(reach, glm::dot(direction, glm::dvec3(world[i] * glm::dvec4(position, 1))));
    }
    return reach;
}

}  // namespace

TEST_CASE(
    "every geometry has triangles, none of them without area, twice or with corners that nothing uses") {
    for (const std::string& level : kLevels)
        for (const CarPart& part : parts_of(car(level))) {
            CAPTURE(level);
            CAPTURE(part.path);
            const scene::Geometry& geometry = *part.geometry;
            CHECK(!geometry.triangles.empty());
            CHECK(geometry.normals.size() == geometry.positions.size());
            std::set<std::array<std::array<double, 3>, 3>> known;
            std::vector<bool> used(geometry.positions.size());
            int without_area = 0, twice = 0;
            glm::dvec3 where(0);
            for (const glm::uvec3& t : geometry.triangles) {
                std::array<std::array<double, 3>, 3> corners{};
                for (int k = 0; k < 3; ++k) {
                    used[t[k]] = true;
                    const glm::dvec3& p = geometry.positions[t[k]];
                    corners[static_cast<std::size_t>(k)] = {p.x, p.y, p.z};
                }
                std::sort(corners.begin(), corners.end());
                const bool flat = glm::length(cross_of(geometry, t)) / 2 <= 1e-12,
                           known_one = !known.insert(corners).second;
                without_area += flat;
                twice += known_one;
                if (flat || known_one) where = geometry.positions[t.x];
            }
            CHECK_MESSAGE(without_area == 0, "at " << text_of(where));
            CHECK_MESSAGE(twice == 0, "at " << text_of(where));
            CHECK(std::count(used.begin(), used.end(), false) == 0);
        }
}

TEST_CASE("every corner's normal is on the front side of its triangles") {
    // A normal behind its face is lit from the wrong side. Where there are few triangles, those of a rounded
    // edge may lean nearly as far; where there are many, none may come close.
    const std::map<std::string, double> bounds{{"car-20k", 90}, {"car", 80}};
    for (const auto& entry : bounds) {
        const std::string& level = entry.first;
        const double bound = entry.second;
        for (const CarPart& part : parts_of(car(level))) {
            CAPTURE(level);
            CAPTURE(part.path);
            const scene::Geometry& geometry = *part.geometry;
            int beyond = 0;
            double worst = 0, area = 0;
            glm::dvec3 where(0);
            for (const glm::uvec3& t : geometry.triangles) {
                const glm::dvec3 face = cross_of(geometry, t);
                for (int k = 0; k < 3; ++k) {
                    const double angle = degrees_between(face, geometry.normals[t[k]]);
                    beyond += !(angle < bound);
                    if (!(angle > worst)) continue;
                    worst = angle;
                    area = glm::length(face) / 2;
                    where = geometry.positions[t[k]];
                }
            }
            CHECK_MESSAGE(beyond == 0, beyond << " corners, the worst by " << worst << " degrees, of "
                                              << area * 1e6 << " mm2, at " << text_of(where));
        }
    }
}

TEST_CASE(
    "the body's parts are closed, all parts are of one piece of sheet, and what is closed has its front "
    "outside") {
    for (const std::string& level : kLevels)
        for (const CarPart& part : parts_of(car(level))) {
            if (is_sheet(part.path) || part.path.ends_with(" liner") || part.geometry->triangles.empty())
                continue;
            CAPTURE(level);
            CAPTURE(part.path);
            std::vector<const scene::Geometry*> halves{part.geometry};
            const scene::Index liner = liner_of(car(level), part);
            if (geometry_at(car(level), liner) != nullptr) halves.push_back(geometry_at(car(level), liner));
            const bool left_out =
                liner != scene::kNone && halves.size() == 1;  // where there are few triangles
            const Surface surface = welded(halves);
            const OpenEdges edges = open_edges(surface);
            CHECK_MESSAGE(edges.crowded == 0, "at " << text_of(edges.at));
            if (!left_out && !may_be_open(car(level), part))
                CHECK_MESSAGE(edges.open == 0, "at " << text_of(edges.at));
            if (edges.open > 0) continue;
            for (const Body& body : bodies_of(surface))
                CHECK_MESSAGE(body.volume > 0, body.triangles << " triangles at " << text_of(body.at));
        }
}

TEST_CASE("each window is a sheet outside and one inside") {
    for (const std::string& level : kLevels) {
        CAPTURE(level);
        const scene::Scene& scene = car(level);
        int panes = 0;
        for (const CarPart& part : parts_of(scene)) {
            if (!part.material->name.starts_with("Glass") || part.path.ends_with(" inside")) continue;
            CAPTURE(part.path);
            const scene::Geometry* inside = geometry_at(scene, node_at(scene, part.path + " inside"));
            REQUIRE(inside != nullptr);
            const glm::dvec3 out = area_of(*part.geometry), in = area_of(*inside);
            CHECK(degrees_between(out, -in) < 2);
            CHECK(std::abs(glm::length(in) / glm::length(out) - 1) < 0.05);
            ++panes;
        }
        CHECK(panes >= 8);
    }
}

TEST_CASE("sheets are flat, and so are the mirrors, and nothing else is a mirror") {
    for (const std::string& level : kLevels) {
        CAPTURE(level);
        const scene::Scene& scene = car(level);
        int sheets = 0, mirrors = 0;
        for (const CarPart& part : parts_of(scene)) {
            CAPTURE(part.path);
            if (is_sheet(part.path)) {
                ++sheets;
                CHECK(unevenness(welded({part.geometry})) < 1e-6);
            }
            const auto* data = std::get_if<scene::GeometryData>(&part.node->data);
            const bool mirror = scene.is_mirror(scene.material(data->material), part.index);
            // A mirror costs a drawing of all that it shows.
            CHECK(mirror == (part.material->reflectivity > 0.5 && part.material->name.starts_with("Mirror")));
            mirrors += mirror;
            if (mirror) CHECK(unevenness(welded({part.geometry})) < 1e-6);
        }
        CHECK(sheets >= 5);
        CHECK(mirrors >= 2);
    }
}

TEST_CASE("every node has a path of its own") {
    for (const std::string& level : kLevels) {
        CAPTURE(level);
        const scene::Scene& scene = car(level);
        std::set<std::string> paths;
        for (std::size_t i = 1; i < scene.nodes().size(); ++i) {
            CHECK(!scene.nodes()[i].name.empty());
            CHECK(scene.nodes()[i].name.find('/') == std::string::npos);
            const std::string path = path_of(scene, static_cast<scene::Index>(i));
            CHECK_MESSAGE(paths.insert(path).second, path << " is there twice");
        }
    }
}

TEST_CASE("what a presenter would ask for is there") {
    const std::vector<std::string> sides{"left", "right"},
        corners{"Front left", "Front right", "Rear left", "Rear right"};
    std::vector<std::string> wanted{"Body/Bonnet",
                                    "Body/Boot lid",
                                    "Body/Boot lid/Window",
                                    "Body/Boot lid/Number plate",
                                    "Body/Roof",
                                    "Body/Roof/Aerial",
                                    "Body/Windows/Windscreen",
                                    "Body/Bumpers/Front",
                                    "Body/Bumpers/Rear",
                                    "Body/Grille",
                                    "Body/Wipers",
                                    "Body/Panels/Fuel flap",
                                    "Wheels",
                                    "Drive train/Engine",
                                    "Drive train/Engine/Cylinder block",
                                    "Drive train/Gearbox",
                                    "Drive train/Drive shafts",
                                    "Chassis/Front suspension",
                                    "Chassis/Rear suspension",
                                    "Chassis/Steering",
                                    "Chassis/Exhaust system",
                                    "Chassis/Fuel system/Fuel tank",
                                    "Chassis/Engine bay/Battery",
                                    "Chassis/Engine bay/Radiator",
                                    "Interior/Dashboard",
                                    "Interior/Dashboard/Instrument cluster/Dials",
                                    "Interior/Dashboard/Centre stack/Screen",
                                    "Interior/Dashboard/Glove box",
                                    "Interior/Steering/Steering wheel",
                                    "Interior/Pedals/Accelerator",
                                    "Interior/Pedals/Brake",
                                    "Interior/Centre console/Gear lever",
                                    "Interior/Centre console/Handbrake",
                                    "Interior/Rear bench",
                                    "Interior/Seat belts",
                                    "Interior/Interior mirror",
                                    "Interior/Boot/Floor",
                                    "Presentation/Lights",
                                    "Presentation/Cameras/Outside",
                                    "Presentation/Cameras/Driver's seat",
                                    "Presentation/Backgrounds",
                                    "Presentation/Floor shadow"};
    for (const std::string& side : sides) {
        wanted.push_back("Body/Lamps/Headlamp " + side);
        wanted.push_back("Body/Lamps/Tail lamp " + side);
        wanted.push_back("Body/Doors/Front " + side + "/Mirror/Glass");
        wanted.push_back("Body/Panels/Front wing " + side);
        wanted.push_back("Body/Panels/Sill " + side);
        wanted.push_back("Interior/Front seat " + side);
    }
    for (const std::string& corner : corners) {
        for (const std::string part : {"Panel", "Window", "Handle", "Trim"})
            wanted.push_back("Body/Doors/" + corner + "/" + part);
        for (const std::string part : {"Tyre", "Rim", "Brake disc"})
            wanted.push_back("Wheels/" + corner + "/Turning/" + part);
        wanted.push_back("Chassis/Brake calipers/" + corner);
    }
    for (const std::string& level : kLevels)
        for (const std::string& path : wanted)
            CHECK_MESSAGE(node_at(car(level), path) != scene::kNone, level << ": " << path);
}

TEST_CASE("doors, bonnet and boot lid open outwards by their hinges, and nothing else has one") {
    const glm::dvec3 left(1, 0, 0), up(0, 1, 0), back(0, 0, -1);
    struct Hinged {
        std::string path;
        glm::dvec3 axis, outwards;
        double least;  ///< metres by which it reaches beyond where it was
    };
    const std::vector<Hinged> all{{"Body/Doors/Front left", {0, 1, 0}, left, 0.5},
                                  {"Body/Doors/Front right", {0, 1, 0}, -left, 0.5},
                                  {"Body/Doors/Rear left", {0, 1, 0}, left, 0.4},
                                  {"Body/Doors/Rear right", {0, 1, 0}, -left, 0.4},
                                  {"Body/Bonnet", {1, 0, 0}, up, 0.5},
                                  {"Body/Boot lid", {1, 0, 0}, back, 0.4}};
    for (const std::string& level : kLevels) {
        CAPTURE(level);
        const scene::Scene& scene = car(level);
        CHECK(std::count_if(scene.nodes().begin(), scene.nodes().end(), [](const scene::Node& node) {
                  return node.hinge.has_value();
              }) == static_cast<long>(all.size()));
        for (const Hinged& hinged : all) {
            CAPTURE(hinged.path);
            const scene::Index index = node_at(scene, hinged.path);
            REQUIRE(index != scene::kNone);
            const scene::Node& node = scene.nodes()[static_cast<std::size_t>(index)];
            REQUIRE(node.hinge);
            CHECK(scene::unit_axis(*node.hinge) == hinged.axis);
            double reach = reach_of(scene, index, 0, hinged.outwards);
            const double closed = reach;
            for (const double part : {0.25, 0.5, 0.75, 1.0}) {  // further at every step
                const double opened = reach_of(scene, index, part, hinged.outwards);
                CHECK_MESSAGE(opened > reach, "at " << part << " it reaches " << opened);
                reach = opened;
            }
            CHECK_MESSAGE(reach - closed > hinged.least, "it reaches " << reach - closed << " m further");
        }
    }
}

TEST_CASE("what turns has its origin where it turns, and a matrix that leaves its size") {
    const scene::Scene& scene = car("car-20k");
    for (const std::string path :
         {"Body/Doors/Front left", "Body/Doors/Front right", "Body/Doors/Rear left", "Body/Doors/Rear right",
          "Body/Bonnet", "Body/Boot lid", "Wheels/Front left", "Wheels/Rear right", "Interior/Steering"}) {
        CAPTURE(path);
        const scene::Index index = node_at(scene, path);
        REQUIRE(index != scene::kNone);
        const glm::dmat3 axes(scene.nodes()[static_cast<std::size_t>(index)].matrix);
        CHECK(std::abs(glm::determinant(axes) - 1) < 1e-5);
        for (int k = 0; k < 3; ++k) CHECK(std::abs(glm::length(axes[k]) - 1) < 1e-5);
    }
}
