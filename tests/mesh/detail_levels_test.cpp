#include "mesh/detail_levels.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <new>
#include <random>
#include <thread>

#include "grid_surfaces.hpp"
#include "io/read_scene.hpp"
#include "mesh/simplification.hpp"
#include "mesh/vertex_cache_order.hpp"
#include "repetitions.hpp"

using namespace vrut;

/// What becomes of allocations on other threads than the one that made the rule, where they are as large as
/// what a mesh of thousands of triangles needs.
namespace large_allocations {

enum Kind { allow, halt, fail, fail_one };
constexpr std::size_t kLarge = 50'000;
std::atomic<Kind> rule{allow};
std::atomic<int> halted{0};
std::atomic<int> before_failure{0};  ///< of fail_one: allocations of any size that succeed before the one
std::atomic<std::thread::id> maker;

struct Rule {
    explicit Rule(Kind kind) {
        halted = 0;
        maker = std::this_thread::get_id();
        rule = kind;
    }
    ~Rule() { rule = allow; }
    Rule(const Rule&) = delete;
    Rule& operator=(const Rule&) = delete;
};

void meet(std::size_t size) {
    if (rule == allow || std::this_thread::get_id() == maker.load()) return;
    if (rule == fail_one) {
        if (before_failure-- == 0) throw std::bad_alloc();
        return;
    }
    if (size < kLarge) return;
    if (rule == fail) throw std::bad_alloc();
    ++halted;
    while (rule == halt) std::this_thread::yield();
}

}  // namespace large_allocations

void* operator new(std::size_t size) {
    large_allocations::meet(size);
    if (void* memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return std::malloc(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace {

const std::atomic<bool> kGoOn{false};

std::ptrdiff_t thread_count() {
    return std::distance(std::filesystem::directory_iterator("/proc/self/task"), {});
}
const std::ptrdiff_t kThreadsAtStart = thread_count();  // a sanitizer may have one

/// Levels that are destroyed do not wait for their thread, whose allocations would count as another's.
void wait_for_other_threads() {
    while (thread_count() > kThreadsAtStart) std::this_thread::yield();
}

scene::Geometry mapped(scene::Geometry geometry, const glm::dvec3& scale, const glm::dvec3& offset) {
    geometry.bounds = {};
    for (glm::dvec3& position : geometry.positions) {
        position = position * scale + offset;
        geometry.bounds.add(position);
    }
    return geometry;
}

scene::Geometry with_normals(scene::Geometry geometry) {
    geometry.normals.assign(geometry.positions.size(), glm::vec3(0));
    for (const glm::uvec3& t : geometry.triangles) {
        const auto& p = geometry.positions;
        for (int k = 0; k < 3; ++k)
            geometry.normals[t[k]] += glm::vec3(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]));
    }
    return geometry;
}

/// Every triangle with corners of its own.
scene::Geometry exploded(const scene::Geometry& geometry) {
    scene::Geometry result;
    result.bounds = geometry.bounds;
    for (const glm::uvec3& triangle : geometry.triangles) {
        const auto first = static_cast<unsigned>(result.positions.size());
        for (int k = 0; k < 3; ++k) result.positions.push_back(geometry.positions[triangle[k]]);
        result.triangles.emplace_back(first, first + 1, first + 2);
    }
    return result;
}

double distance_to_edge(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
    const double squared = glm::dot(b - a, b - a);
    const double along = squared > 0 ? std::clamp(glm::dot(p - a, b - a) / squared, 0.0, 1.0) : 0;
    return glm::distance(p, glm::mix(a, b, along));
}

double distance_to(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const auto inside = [&](const glm::dvec3& from, const glm::dvec3& to) {
        return glm::dot(glm::cross(to - from, p - from), normal) >= 0;
    };
    if (glm::length(normal) > 0 && inside(a, b) && inside(b, c) && inside(c, a))
        return std::abs(glm::dot(normal, p - a)) / glm::length(normal);
    return std::min({distance_to_edge(p, a, b), distance_to_edge(p, b, c), distance_to_edge(p, c, a)});
}

/// Points of some triangles, at their corners, along their edges and within, and how far the furthest of them
/// is from others: one side of Hausdorff's distance.
double furthest(const scene::Geometry& geometry, const std::vector<glm::uvec3>& from,
                const std::vector<glm::uvec3>& to) {
    const std::vector<glm::dvec3>& p = geometry.positions;
    double result = 0;
    constexpr std::size_t kPairs = test::repetitions(100'000);
    const std::size_t step = 1 + from.size() * to.size() / kPairs;
    for (std::size_t i = 0; i < from.size(); i += step)
        for (int u = 0; u <= 4; ++u)
            for (int v = 0; u + v <= 4; ++v) {
                const glm::uvec3& t = from[i];
                const glm::dvec3 point =
                    (p[t.x] * (4.0 - u - v) + p[t.y] * (1.0 * u) + p[t.z] * (1.0 * v)) / 4.0;
                double nearest = 1e300;
                for (std::size_t k = 0; k < to.size() && nearest > result; ++k)
                    nearest = std::min(nearest, distance_to(point, p[to[k].x], p[to[k].y], p[to[k].z]));
                result = std::max(result, nearest);
            }
    return result;
}

void check_bounds(const scene::Geometry& geometry, std::size_t least_levels) {
    const auto levels = mesh::simplify(geometry, kGoOn);
    CHECK(levels.size() >= least_levels);
    std::size_t triangles = geometry.triangles.size();
    double error = 0;
    for (const mesh::DetailLevel& level : levels) {
        CAPTURE(level.triangles.size());
        CHECK(level.triangles.size() < triangles);
        CHECK(level.error >= error);
        triangles = level.triangles.size();
        error = level.error;
        CHECK(furthest(geometry, geometry.triangles, level.triangles) <= error);
        CHECK(furthest(geometry, level.triangles, geometry.triangles) <= error);
    }
}

std::shared_ptr<const scene::Scene> scene_with(std::vector<scene::Geometry> geometries,
                                               bool two_sided = false) {
    scene::SceneParts parts;
    if (two_sided) parts.materials.emplace_back().two_sided = true;
    for (std::size_t i = 0; i < geometries.size(); ++i) geometries[i].id = static_cast<scene::Id>(i + 1);
    parts.geometries = std::move(geometries);
    return std::make_shared<const scene::Scene>(*scene::Scene::build(std::move(parts)));
}

}  // namespace

TEST_CASE("no surface lies further from the one it stands for than its level says") {
    SUBCASE("ball") { check_bounds(ball(48, 24), 5); }
    SUBCASE("ball with normals") { check_bounds(with_normals(ball(48, 24)), 3); }
    SUBCASE("ball of many triangles") { check_bounds(with_normals(ball(128, 64)), 5); }
    SUBCASE("torus") { check_bounds(torus(48, 24), 4); }
    SUBCASE("creases and a border") { check_bounds(corrugated(60, 20), 3); }
    SUBCASE("triangles of their own") { check_bounds(exploded(torus(40, 20)), 4); }
    SUBCASE("noise") {
        std::mt19937 random(3);
        std::uniform_real_distribution<double> height(0, 0.05);
        check_bounds(surface(30, 30, [&](double u, double v) { return glm::dvec3(u, height(random), v); }),
                     2);
    }
    SUBCASE("far from the origin, tiny and flattened, huge") {
        check_bounds(mapped(torus(40, 20), glm::dvec3(1), {1e7, -2e8, 3e7}), 4);
        check_bounds(mapped(torus(40, 20), {1e-12, 1e-12, 1e-15}, glm::dvec3(0)), 4);
        check_bounds(mapped(torus(40, 20), glm::dvec3(1e50), glm::dvec3(0)), 4);
    }
}

TEST_CASE("no level of the car's parts lies further off than it says") {
    const auto car = io::read_scene(std::string(VRUT_CARS) + "/car-20k.vrut");
    REQUIRE(car);
    for (const scene::Geometry& geometry : car->geometries())
        if (geometry.triangles.size() < 1500) check_bounds(geometry, 0);
}

TEST_CASE("an even surface keeps its plane and its outline") {
    const scene::Geometry geometry = surface(40, 40, [](double u, double v) { return glm::dvec3(u, 3, v); });
    auto levels = mesh::simplify(geometry, kGoOn);
    std::erase_if(levels, [](const mesh::DetailLevel& level) { return level.error > 2e-5; });
    REQUIRE(levels.size() >= 2);
    const scene::Geometry coarse = mesh::geometry_of(geometry, levels.back());
    CHECK(coarse.triangles.size() <= 800);
    CHECK(coarse.positions.size() <= 800);
    CHECK(coarse.normals.empty());
    CHECK(coarse.bounds.max == geometry.bounds.max);
    double area = 0;
    for (const glm::uvec3& t : coarse.triangles) {
        const auto& p = coarse.positions;
        const glm::dvec3 doubled = glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]);
        area -= doubled.y / 2;
    }
    CHECK(area == doctest::Approx(1));
}

TEST_CASE("what normals pretend counts as a distance") {
    scene::Geometry plane = surface(40, 40, [](double u, double v) { return glm::dvec3(u, 3, v); });
    for (const glm::dvec3& position : plane.positions)
        plane.normals.push_back({0.2F * std::sin(20 * static_cast<float>(position.x)), 1, 0});
    const auto levels = mesh::simplify(plane, kGoOn);
    REQUIRE(levels.size() >= 3);
    CHECK(levels[2].error > 1e-3);
    CHECK(levels[2].error < 0.2);  // no edge is longer than 1, and a shade is off by 0.4 at most
    plane.normals.assign(plane.positions.size(), {0, 1, 0});
    CHECK(mesh::simplify(plane, kGoOn)[2].error < 2e-5);
}

TEST_CASE("a seam does not open") {
    // A tube whose ends meet in two rows of vertices, with texture coordinates of their own.
    scene::Geometry tube = surface(40, 20, [](double u, double v) { return glm::dvec3(turn(u), v); });
    for (unsigned i = 0; i < tube.positions.size(); ++i) {
        const unsigned row = i / 41, column = i % 41;
        tube.texcoords.emplace_back(static_cast<float>(column) / 40, static_cast<float>(row) / 20);
    }
    const auto levels = mesh::simplify(with_normals(tube), kGoOn);
    REQUIRE(levels.size() >= 3);
    for (const mesh::DetailLevel& level : levels) {
        std::vector<double> left, right;  // heights of the seam's vertices
        for (const glm::uvec3& triangle : level.triangles)
            for (int k = 0; k < 3; ++k) {
                const unsigned column = triangle[k] % 41;
                if (column == 0) left.push_back(tube.positions[triangle[k]].z);
                if (column == 40) right.push_back(tube.positions[triangle[k]].z);
            }
        for (std::vector<double>* heights : {&left, &right}) {
            std::sort(heights->begin(), heights->end());
            heights->erase(std::unique(heights->begin(), heights->end()), heights->end());
        }
        CHECK(left == right);
    }
}

TEST_CASE("the border between two colours stays where it is") {
    scene::Geometry tiles = surface(20, 20, [](double u, double v) { return glm::dvec3(u, v, 0); });
    // Half of it red: along the border two vertices differ in their colours alone.
    std::vector<unsigned> red(tiles.positions.size());
    tiles.colors.assign(tiles.positions.size(), {0, 0, 1});
    for (unsigned i = 0; i < red.size(); ++i) {
        red[i] = static_cast<unsigned>(tiles.positions.size());
        tiles.positions.push_back(glm::dvec3(tiles.positions[i]));
        tiles.colors.emplace_back(1, 0, 0);
    }
    const auto is_right = [&](const glm::uvec3& t) {
        return tiles.positions[t.x].x + tiles.positions[t.y].x + tiles.positions[t.z].x > 1.5;
    };
    for (glm::uvec3& triangle : tiles.triangles)
        if (is_right(triangle)) triangle = {red[triangle.x], red[triangle.y], red[triangle.z]};
    const auto levels = mesh::simplify(tiles, kGoOn);
    REQUIRE_FALSE(levels.empty());
    for (const mesh::DetailLevel& level : levels) {
        const scene::Geometry simplified = mesh::geometry_of(tiles, level);
        REQUIRE(simplified.colors.size() == simplified.positions.size());
        double red_area = 0;
        for (const glm::uvec3& t : simplified.triangles) {
            CHECK(simplified.colors[t.x] == simplified.colors[t.y]);
            CHECK(simplified.colors[t.x] == simplified.colors[t.z]);
            const glm::dvec3& corner = simplified.positions[t.x];
            const glm::dvec3 cross =
                glm::cross(simplified.positions[t.y] - corner, simplified.positions[t.z] - corner);
            if (simplified.colors[t.x].r > 0) red_area += glm::length(cross) / 2;
        }
        CHECK(red_area == doctest::Approx(0.5));
    }
}

TEST_CASE("what cannot be simplified has no levels") {
    CHECK(mesh::simplify({}, kGoOn).empty());
    scene::Geometry few = ball(4, 4);
    CHECK(mesh::simplify(few, kGoOn).empty());
    scene::Geometry point = ball(20, 20);
    for (glm::dvec3& position : point.positions) position = {1, 2, 3};
    point.bounds = {{1, 2, 3}, {1, 2, 3}};
    CHECK(mesh::simplify(point, kGoOn).empty());
    scene::Geometry line = surface(20, 20, [](double u, double) { return glm::dvec3(u, 0, 0); });
    for (const mesh::DetailLevel& level : mesh::simplify(line, kGoOn)) CHECK(level.error <= 2e-5);
    scene::Geometry beyond = mapped(ball(20, 20), glm::dvec3(1e308), glm::dvec3(0));
    CHECK(mesh::simplify(beyond, kGoOn).empty());
    scene::Geometry apart;  // triangles that nothing joins
    for (unsigned i = 0; i < 300; ++i) {
        for (const glm::dvec3& corner : {glm::dvec3(0), {1, 0, 0}, {0, 1, 0}})
            apart.positions.push_back(corner + glm::dvec3(0, 0, i));
        apart.bounds.add(apart.positions.back());
        apart.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    for (const mesh::DetailLevel& level : mesh::simplify(apart, kGoOn))
        CHECK(furthest(apart, apart.triangles, level.triangles) <= level.error);
}

TEST_CASE("triangles in a bad order get a better one, and only those") {
    const scene::Geometry good = with_normals(torus(80, 40));
    CHECK_FALSE(mesh::optimize_vertex_cache(good));
    scene::Geometry bad = good;
    std::shuffle(bad.triangles.begin(), bad.triangles.end(), std::mt19937(1));
    const auto level = mesh::optimize_vertex_cache(bad);
    REQUIRE(level);
    CHECK(level->number == 0);
    CHECK(level->error == 0);
    const auto sorted = [](std::vector<glm::uvec3> triangles) {
        std::sort(triangles.begin(), triangles.end(), [](const glm::uvec3& a, const glm::uvec3& b) {
            return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
        });
        return triangles;
    };
    CHECK(sorted(level->triangles) == sorted(good.triangles));
    CHECK_FALSE(mesh::optimize_vertex_cache(mesh::geometry_of(bad, *level)));
    bad.normals.clear();
    CHECK_FALSE(mesh::optimize_vertex_cache(bad));  // its triangles share no vertices

    const mesh::DetailLevels levels(scene_with({with_normals(bad)}));
    levels.wait();
    CHECK(levels.of(0).size() >= 4);
    for (std::size_t i = 0; i < levels.of(0).size(); ++i)
        CHECK(levels.of(0)[i].number == static_cast<int>(i));
}

TEST_CASE("levels are made in the background, for each geometry") {
    const auto scene = scene_with({ball(48, 24), {}, torus(40, 20)});
    const mesh::DetailLevels levels(scene);
    levels.wait();
    CHECK(levels.done());
    CHECK(levels.of(0).size() >= 4);
    CHECK(levels.of(1).empty());
    CHECK(levels.of(2).size() >= 4);
    for (std::size_t i = 0; i < levels.of(2).size(); ++i)
        CHECK(levels.of(2)[i].number == static_cast<int>(i) + 1);
    CHECK(levels.of(0).back().triangles == mesh::simplify(scene->geometries()[0], kGoOn).back().triangles);
}

TEST_CASE("each geometry is examined for holes, two-sided or not") {
    const scene::Geometry whole = welded(sphere(1, 8));
    scene::Geometry holed = whole;
    holed.triangles.pop_back();
    for (const bool two_sided : {false, true}) {
        CAPTURE(two_sided);
        const mesh::DetailLevels levels(scene_with({whole, holed, {}, torus(40, 20)}, two_sided));
        levels.wait();
        if (two_sided) CHECK(levels.watertight(0).has_value());
        levels.wait_until_examined();
        CHECK(levels.examined());
        CHECK(levels.done());
        for (const scene::Index geometry : {0, 1, 2, 3})
            CHECK(levels.watertight(geometry) == (geometry == 0 || geometry == 3));
    }
}

TEST_CASE("levels do not wait for the examination of one-sided geometries") {
    const auto scene = scene_with({torus(120, 60)});
    const mesh::DetailLevels levels(scene);
    while (levels.of(0).empty()) std::this_thread::yield();
    const large_allocations::Rule rule(large_allocations::halt);
    levels.wait();
    while (large_allocations::halted == 0 && !levels.examined()) std::this_thread::yield();
    if (large_allocations::halted > 0) {
        CHECK(levels.done());
        CHECK_FALSE(levels.examined());
        CHECK_FALSE(levels.watertight(0).has_value());
    }
    large_allocations::rule = large_allocations::allow;
    levels.wait_until_examined();
    CHECK(levels.watertight(0) == true);
}

TEST_CASE("levels can be given up while they are made") {
    const auto scene = scene_with(std::vector<scene::Geometry>(400, torus(120, 60)));
    const mesh::DetailLevels none(scene_with({}));
    none.wait();
    {
        const mesh::DetailLevels levels(scene);
        while (levels.of(0).empty()) std::this_thread::yield();
        CHECK_FALSE(levels.done());
    }
    std::atomic<bool> stopped{true};
    CHECK(mesh::simplify(torus(40, 20), stopped).empty());
}

TEST_CASE(
    "whoever gives levels up waits for nothing, and the scene is let go by the thread that makes them") {
    auto scene = scene_with({torus(120, 60)});
    const std::weak_ptr<const scene::Scene> held = scene;
    const large_allocations::Rule rule(large_allocations::halt);
    {
        const mesh::DetailLevels levels(std::move(scene));
        while (large_allocations::halted == 0) std::this_thread::yield();
    }
    CHECK_FALSE(held.expired());  // it still stands where it was halted
    large_allocations::rule = large_allocations::allow;
    while (!held.expired()) std::this_thread::yield();
}

TEST_CASE("levels for which there is no memory are not made, and the reason is reported once") {
    const auto scene = scene_with({torus(120, 60), ball(16, 8)});
    const large_allocations::Rule rule(large_allocations::fail);
    std::vector<std::string> reasons;
    const mesh::DetailLevels levels(scene, [&](const std::string& reason) { reasons.push_back(reason); });
    levels.wait();
    CHECK(reasons == std::vector<std::string>{"std::bad_alloc"});
    CHECK(levels.done());
    CHECK(levels.of(0).empty());
    CHECK(levels.of(1).empty());
    levels.wait_until_examined();
    CHECK(levels.watertight(1) == false);  // it is not known, and will not be
}

TEST_CASE("whichever allocation fails on the thread that makes levels, the program goes on") {
    scene::Geometry shuffled = with_normals(torus(16, 8));
    std::shuffle(shuffled.triangles.begin(), shuffled.triangles.end(), std::mt19937(1));
    const auto scene = scene_with({shuffled, ball(16, 8)}, true);
    for (int allocations = 0, left = -1; left < 0; ++allocations) {
        wait_for_other_threads();
        large_allocations::before_failure = allocations;
        const large_allocations::Rule rule(large_allocations::fail_one);
        int reports = 0;
        const mesh::DetailLevels levels(scene, [&](const std::string& /*reason*/) {
            ++reports;
            throw std::bad_alloc();
        });
        levels.wait();
        left = large_allocations::before_failure;
        CAPTURE(allocations);
        CHECK(reports == (left < 0));
    }
}
