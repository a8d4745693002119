// Occluded parts are culled, and no byte of an image changes.
#include <algorithm>
#include <array>

#include "random_parts.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

const scene::Material kPaint = material_of({0.7, 0.5, 0.3}), kWall = material_of({0.2, 0.6, 0.3});

scene::Material glass() {
    scene::Material material = material_of({0.3, 0.5, 0.9});
    material.diffuse.a = 0.4;
    material.two_sided = true;
    return material;
}

/// A square in the plane z = 0, of 1,800 triangles.
scene::Geometry sheet(double half) {
    return surface(30, 30, [&](double u, double v) { return half * glm::dvec3(2 * u - 1, 2 * v - 1, 0); });
}

/// Of more than 1,000 triangles.
scene::Geometry ball(double radius) { return sphere(radius, 20); }

/// The same triangles twice, at equal depth, with other normals the second time.
scene::Geometry doubled(scene::Geometry geometry) {
    const auto count = static_cast<unsigned>(geometry.positions.size());
    const std::vector<glm::uvec3> triangles = geometry.triangles;
    for (unsigned i = 0; i < count; ++i) {
        const glm::vec3 normal = geometry.normals[i];
        geometry.positions.push_back(geometry.positions[i]);
        geometry.normals.push_back(glm::normalize(normal + glm::vec3(0, 0.5F, 0)));
    }
    for (const glm::uvec3& triangle : triangles) geometry.triangles.push_back(triangle + count);
    return geometry;
}

/// Draws views with and without hidden parts, and compares.
class Comparison {
public:
    void check(const plan::View& view) {
        plan::View all = view;
        all.methods.culling = plan::Methods::Culling::frustum;
        const scene::Image expected = studio_.draw(view.scene, all);
        all_ = studio_.stats;
        const scene::Image image = studio_.draw(view.scene, view);
        CHECK(image.rgba == expected.rgba);
        images_with_less_ += stats().triangles < all_.triangles;
    }
    /// Of the last image, and of that with everything.
    const plan::FrameStats& stats() const { return studio_.stats; }
    const plan::FrameStats& all() const { return all_; }
    int images_with_less() const { return images_with_less_; }
    renderer::Renderer& renderer() { return studio_.renderer(); }

private:
    RendererFixture studio_;
    plan::FrameStats all_;
    int images_with_less_ = 0;
};

/// Balls and sheets of many triangles, turned, mirrored and some flattened, between walls and panes.
std::vector<Part> parts_between_walls(Dice& dice) {
    const std::array geometries{ball(0.7), sheet(0.8), doubled(ball(0.5)), quad(3.5)};
    scene::Material both_sides = kWall;
    both_sides.two_sided = true;
    std::vector<Part> parts;
    for (scene::Id id = 1; id <= 60; ++id) {
        const auto which = static_cast<std::size_t>(id) % geometries.size();
        scene::Material material = which == 3 ? both_sides : kPaint;
        material.diffuse.r = dice.between(0, 1);
        if (id % 20 == 3) material = glass();
        parts.push_back({id, geometries[which], material, dice.matrix()});
        if (id % 15 == 1) parts.back().matrix *= scaled_by({1, 1, 0});
    }
    // The same places twice: both are hidden and revealed together.
    for (scene::Id id = 61; id <= 70; ++id) {
        Part part = parts[static_cast<std::size_t>(id - 60)];
        part.id = id;
        part.material.diffuse.g = 0;
        parts.push_back(part);
    }
    return parts;
}

/// A body of 12 triangles around balls.
std::shared_ptr<const scene::PlacedScene> closed_body(int balls) {
    std::vector<Part> parts{{1, box(glm::dvec3(2)), kWall, glm::dmat4(1)}};
    for (int i = 0; i < balls; ++i) {
        const glm::ivec3 place(i % 5, i / 5 % 5, i / 25);
        parts.push_back({i + 2, ball(0.3), kPaint,
                         moved_by(glm::dvec3(0.7, 0.7, 1) * (glm::dvec3(place) - glm::dvec3(2, 2, 0.5)))});
    }
    return scene_of(parts);
}

/// The same scene with a node hidden or not, and moved.
std::shared_ptr<const scene::PlacedScene> with_node(const scene::PlacedScene& placed, scene::Id id,
                                                    bool active, const glm::dmat4& matrix = glm::dmat4(1)) {
    std::vector<scene::NodeState> nodes = placed.nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (placed.scene->nodes()[i].id != id) continue;
        nodes[i].active = active;
        nodes[i].matrix = matrix * nodes[i].matrix;
    }
    return std::make_shared<const scene::PlacedScene>(scene::place(placed.scene, std::move(nodes)));
}

}  // namespace

TEST_CASE("images are equal on flights through parts that walls hide and show") {
    constexpr int kImages = 80;
    for (const unsigned seed : {1U, 2U, 3U, 4U}) {
        CAPTURE(seed);
        Comparison comparison;
        Dice dice(seed);
        const double scale = seed == 4 ? 1e4 : 1;
        std::vector<Part> parts = parts_between_walls(dice);
        for (Part& part : parts) part.matrix = scaled_by(glm::dvec3(scale)) * part.matrix;
        const auto scene = scene_of(parts);
        const glm::dvec3 from = glm::normalize(dice.vector(1)) * 14.0, to = -0.8 * from + dice.vector(4),
                         focus = dice.vector(1);
        for (int i = 0; i < kImages; ++i) {
            CAPTURE(i);
            plan::View view = view_from(scale * glm::mix(from, to, double(i) / kImages), scale * focus);
            view.scene = scene;
            view.samples = i % 10 == 9 ? 4 : 1;
            if (i % 16 == 15) view.selected = 5;
            comparison.check(view);
        }
        CHECK(comparison.images_with_less() > kImages / 4);
    }
}

TEST_CASE("what a closed body hides is not drawn, and what is seen again is drawn at once") {
    Comparison comparison;
    const auto closed = closed_body(40);
    plan::View view = view_from({3, 2, 9});
    view.scene = closed;
    for (int i = 0; i < 2; ++i) {
        comparison.check(view);
        CHECK(comparison.stats().triangles == comparison.all().triangles);
    }
    for (int i = 0; i < 3; ++i) {
        view.camera = view_from({3 + 0.1 * i, 2, 9}).camera;
        comparison.check(view);
        CHECK(comparison.stats().triangles == 12);
        CHECK(comparison.stats().draws == 1);
    }
    view.samples = 4;
    comparison.check(view);
    CHECK(comparison.stats().triangles == 4 * 12);
    view.samples = 1;

    SUBCASE("the body vanishes") {
        view.scene = with_node(*closed, 1, false);
        comparison.check(view);
        comparison.check(view);
        CHECK(comparison.stats().triangles == comparison.all().triangles);
    }
    SUBCASE("a part comes out") {
        view.scene = with_node(*closed, 7, true, moved_by({0, 0, 3}));
        comparison.check(view);
        CHECK(comparison.stats().triangles > 12);
        CHECK(comparison.stats().triangles < comparison.all().triangles / 4);
    }
    SUBCASE("the eye comes in") {
        for (int i = 0; i < 40; ++i) {
            view.camera = view_from({3 - 0.1 * i, 1, 9 - 0.25 * i}, {0, 0, -1}).camera;
            comparison.check(view);
        }
    }
}

TEST_CASE("where a part that is seen again has a depth in common with others, the higher id is in front") {
    for (const bool hidden_first : {true, false}) {
        CAPTURE(hidden_first);
        Comparison comparison;
        const auto scene = scene_of({{hidden_first ? 1 : 2, sheet(0.5), kPaint, glm::dmat4(1)},
                                     {hidden_first ? 2 : 1, quad(3), kWall, glm::dmat4(1)},
                                     {3, quad(1), material_of({0.9, 0.9, 0.9}), moved_by({0, 0, 1})}});
        plan::View view = view_from({0, 0, 10});
        view.scene = scene;
        for (int i = 0; i < 3; ++i) comparison.check(view);
        CHECK(comparison.images_with_less() > 0);
        view.scene = with_node(*scene, 3, false);
        comparison.check(view);
        // The late part, and then all again.
        CHECK(comparison.stats().triangles > comparison.all().triangles);
        comparison.check(view);
        CHECK(comparison.stats().triangles == comparison.all().triangles);
    }
}

TEST_CASE("parts that are seen again keep their order, and that of their triangles") {
    Comparison comparison;
    const auto scene = scene_of({{1, doubled(ball(0.5)), kPaint, moved_by({-0.6, 0, 0})},
                                 {2, doubled(ball(0.5)), kPaint, moved_by({0.6, 0, 0})},
                                 {3, quad(2), kWall, moved_by({0, 0, 1})}});
    plan::View view = view_from({0, 0, 10});
    view.scene = scene;
    for (int i = 0; i < 3; ++i) comparison.check(view);
    CHECK(comparison.stats().draws == 1);
    view.scene = with_node(*scene, 3, false);
    comparison.check(view);
    // Each is queried by a draw of its own, and none is drawn again.
    CHECK(comparison.stats().draws == 4);
}

TEST_CASE("where nothing is hidden, as much is drawn as without looking for it") {
    Comparison comparison;
    std::vector<Part> parts;
    for (int i = 0; i < 25; ++i)
        parts.push_back({i + 1, ball(0.4), kPaint, moved_by({i % 5 - 2, i / 5 - 2, 0})});
    plan::View view = view_from({0, 0, 9});
    view.scene = scene_of(parts);
    for (int i = 0; i < 20; ++i) {
        view.camera = view_from({0.05 * i, 0, 9}).camera;
        comparison.check(view);
        CHECK(comparison.stats().draws == comparison.all().draws);
        CHECK(comparison.stats().triangles == comparison.all().triangles);
        CHECK(comparison.stats().passes == comparison.all().passes);
    }
}

TEST_CASE("images that are drawn in turns, in small steps, see other parts each and are equal") {
    Comparison comparison;
    Dice dice(9);
    std::vector<Part> parts = parts_between_walls(dice);
    for (int i = 0; i < 16; ++i) parts.push_back({100 + i, quad(9), kWall, moved_by({0, 0, -7 - 0.1 * i})});
    const auto scene = scene_of(parts);
    int between = 0;
    for (int round = 0; round < 8; ++round) {
        std::vector<plan::RenderJob> jobs;
        std::vector<scene::Image> expected;
        for (const glm::dvec3& eye : {glm::dvec3(-5, -2, 7), glm::dvec3(0.2 * round - 9, 2, 5)}) {
            plan::View view = view_from(eye);
            view.scene = scene;
            view.samples = 2;
            view.width = 960;
            view.height = 640;
            plan::FrameStats stats;
            plan::View all = view;
            all.methods.culling = plan::Methods::Culling::frustum;
            comparison.renderer().render(all, expected.emplace_back(), stats);
            jobs.emplace_back(view).interactive = true;
        }
        for (bool done = false; !done;) {
            done = true;
            for (plan::RenderJob& job : jobs) {
                if (job.samples == 2) continue;
                const int before = job.samples;
                done = comparison.renderer().step(job) && done;
                between += job.samples == before;
            }
        }
        for (std::size_t i = 0; i < jobs.size(); ++i) CHECK(jobs[i].image.rgba == expected[i].rgba);
    }
    CHECK(between > (comparison.renderer().software() ? 8 : 0));  // a graphics card does more in a step
}
