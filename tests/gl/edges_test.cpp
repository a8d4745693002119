#include <algorithm>
#include <cmath>
#include <set>

#include "io/read_scene.hpp"
#include "plan/frame_plan.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

const glm::ivec3 kBlueEdge{140, 199, 255}, kMarked{255, 153, 0};

using Pixels = std::set<std::pair<int, int>>;

template <class Wanted>
Pixels pixels_that(const scene::Image& image, const Wanted& wanted) {
    Pixels pixels;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (wanted(pixel_of(image, x, y))) pixels.emplace(x, y);
    return pixels;
}

Pixels pixels_of(const scene::Image& image, const glm::ivec3& color) {
    return pixels_that(image, [&](const glm::ivec3& pixel) { return pixel == color; });
}

/// In pixels from the picture's top left.
glm::dvec2 seen(const plan::View& view, const glm::dvec3& point) {
    const double aspect = static_cast<double>(view.width) / view.height;
    const glm::dvec4 clip = math::clip_from_view(scene::projection_of(view.camera, aspect), 0.1, 100) *
                            scene::view_from_world(view.camera) * glm::dvec4(point, 1);
    return {(clip.x / clip.w + 1) / 2 * view.width, (1 - clip.y / clip.w) / 2 * view.height};
}

double distance(const glm::dvec2& point, const glm::dvec2& a, const glm::dvec2& b) {
    const double along = std::clamp(glm::dot(point - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    return glm::distance(point, a + (b - a) * along);
}

/// A square of n x n cells with its own corners for each triangle, as many files have them.
scene::Geometry grid(double half, int n) {
    scene::Geometry geometry;
    const auto at = [&](int i, int k) {
        return glm::dvec3(-half + 2 * half * i / n, -half + 2 * half * k / n, 0);
    };
    const auto add = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        const auto first = static_cast<unsigned>(geometry.positions.size());
        for (const glm::dvec3& corner : {a, b, c}) {
            geometry.positions.push_back(corner);
            geometry.normals.emplace_back(0.f, 0.f, 1.f);
            geometry.bounds.add(corner);
        }
        geometry.triangles.emplace_back(first, first + 1, first + 2);
    };
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            add(at(i, k), at(i + 1, k), at(i + 1, k + 1));
            add(at(i, k), at(i + 1, k + 1), at(i, k + 1));
        }
    return geometry;
}

/// From 60 degrees off the +z axis.
scene::Light slanted() {
    scene::Light light;
    light.headlight = false;
    light.type = scene::LightData::Type::directional;
    light.direction = -glm::normalize(glm::dvec3(0, std::sqrt(3.0), 1));
    return light;
}

plan::View wire_from(const glm::dvec3& eye) {
    plan::View view = view_from(eye);
    view.width = 240;
    view.height = 160;
    view.wireframe = true;
    return view;
}

}  // namespace

TEST_CASE("each edge is drawn once, however many triangles share it") {
    RendererFixture studio;
    const plan::View view = wire_from({1, 2, 5});
    const auto edges = [&](const scene::Geometry& geometry) {
        studio.draw(scene_of({{1, geometry, material_of({1, 0, 0}), glm::dmat4(1)}}), view);
        CHECK(studio.stats.triangles == 0);
        return studio.stats.edges;
    };
    CHECK(edges(quad(1)) == 5);
    CHECK(edges(quad(1, false)) == 5);
    CHECK(edges(box({1, 1, 1})) == 12 + 6);
    CHECK(edges(grid(1, 1)) == 5);
    CHECK(edges(grid(1, 4)) == 20 + 20 + 16);
    scene::Geometry degenerate = quad(1);
    degenerate.triangles = {{0, 0, 0}};
    CHECK(edges(degenerate) == 0);
    degenerate.triangles = {{0, 0, 1}, {0, 1, 2}};
    CHECK(edges(degenerate) == 3);
    // Close is not the same.
    scene::Geometry close = quad(1, false);
    close.positions.push_back(close.positions[2] + glm::dvec3(1e-9, 0, 0));
    close.triangles = {{0, 1, 2}, {0, 4, 3}};
    CHECK(edges(close) == 6);
}

TEST_CASE("a wireframe has its edges, those behind too, and nothing else") {
    RendererFixture studio;
    const scene::Geometry geometry = box({1, 0.7, 0.9});
    const auto scene = scene_of({{1, geometry, material_of({0.5, 0.2, 0.1}), glm::dmat4(1)}});
    for (const glm::dvec3& eye : {glm::dvec3(2, 1.5, 4), glm::dvec3(-3, 2, 1), glm::dvec3(0.1, -4, 0.3)}) {
        const plan::View view = wire_from(eye);
        const Pixels drawn = pixels_that(studio.draw(scene, view), [](const glm::ivec3& pixel) {
            return pixel != bytes_of(plan::kDefaultBackground);
        });
        CHECK(drawn.size() > 200);
        struct ExpectedLine {
            glm::dvec2 a, b;
        };
        std::vector<ExpectedLine> lines;
        for (const glm::uvec3& triangle : geometry.triangles)
            for (int k = 0; k < 3; ++k)
                lines.push_back({seen(view, geometry.positions[triangle[k]]),
                                 seen(view, geometry.positions[triangle[(k + 1) % 3]])});
        int astray = 0, missing = 0;
        for (const auto& [x, y] : drawn) {
            double nearest = 1e9;
            for (const ExpectedLine& line : lines)
                nearest = std::min(nearest, distance({x + 0.5, y + 0.5}, line.a, line.b));
            astray += nearest > 0.8;
        }
        for (const ExpectedLine& line : lines)
            for (int part = 1; part < 50; ++part) {
                const glm::dvec2 point = line.a + (line.b - line.a) * (part / 50.0);
                if (point.x < 1 || point.y < 1 || point.x > view.width - 1 || point.y > view.height - 1)
                    continue;
                bool found = false;
                for (int dx = -1; dx <= 1; ++dx)
                    for (int dy = -1; dy <= 1; ++dy) {
                        const int x = static_cast<int>(point.x) + dx, y = static_cast<int>(point.y) + dy;
                        found = found || (drawn.count({x, y}) > 0 &&
                                          glm::distance(point, glm::dvec2(x + 0.5, y + 0.5)) < 1.1);
                    }
                missing += !found;
            }
        CHECK(astray == 0);
        CHECK(missing == 0);
    }
}

TEST_CASE("realistic edges have their material's colour under the light, from both sides") {
    RendererFixture studio;
    const auto scene = scene_of({{1, quad(1.5), material_of({0.8, 0.4, 0.24}), glm::dmat4(1)}});
    plan::View view = wire_from({1, 0.5, 4});
    view.light = slanted();
    const auto is_drawn = [](const glm::ivec3& pixel) { return pixel != bytes_of(plan::kDefaultBackground); };
    scene::Image image = studio.draw(scene, view);
    CHECK(pixels_of(image, {102, 51, 31}).size() > 200);
    CHECK(pixels_of(image, {102, 51, 31}) == pixels_that(image, is_drawn));
    // Behind it the light is on the other side; with the light there too, it is as bright.
    view = wire_from({1, 0.5, -4});
    view.light = slanted();
    image = studio.draw(scene, view);
    CHECK(pixels_of(image, {0, 0, 0}) == pixels_that(image, is_drawn));
    view.light.direction.z = -view.light.direction.z;
    image = studio.draw(scene, view);
    CHECK(pixels_of(image, {102, 51, 31}).size() > 200);
    CHECK(pixels_of(image, {102, 51, 31}) == pixels_that(image, is_drawn));
    // A normal that is not there is the viewer's direction.
    scene::Geometry flat = quad(1.5);
    flat.normals.assign(4, glm::vec3(1, 0, 0));
    view = wire_from({0, 0, 4});
    image = studio.draw(scene_of({{1, flat, material_of({0.8, 0.4, 0.24}), scaled_by({1, 1, 0})}}), view);
    CHECK(pixels_of(image, {204, 102, 61}) == pixels_that(image, is_drawn));
}

TEST_CASE("of edges at equal depth those of the higher id are in front") {
    RendererFixture studio;
    const plan::View view = wire_from({1, 0.5, 4});
    scene::Material red = material_of({0, 0, 0}), green = red;
    red.emission = {1, 0, 0, 1};
    green.emission = {0, 1, 0, 1};
    const auto both = [&](scene::Id red_id, scene::Id green_id) {
        return studio.draw(
            scene_of({{red_id, quad(1), red, glm::dmat4(1)}, {green_id, quad(1), green, glm::dmat4(1)}}),
            view);
    };
    CHECK(pixels_of(both(1, 2), {255, 0, 0}).empty());
    CHECK(pixels_of(both(1, 2), {0, 255, 0}).size() > 100);
    CHECK(pixels_of(both(2, 1), {0, 255, 0}).empty());
}

TEST_CASE("stylized: dark blue faces under the light, light blue edges, whatever the material") {
    RendererFixture studio;
    scene::Material loud = material_of({1, 0, 0}, {1, 1, 1}, 3);
    loud.emission = {0.5, 0, 0, 1};
    const auto scene = scene_of({{1, quad(1.5), loud, glm::dmat4(1)}});
    plan::View view = wire_from({1, 0.5, 4});
    view.wireframe = false;
    view.mode = plan::DrawMode::stylized;
    view.light = slanted();
    const scene::Image image = studio.draw(scene, view);
    // 0.03 0.05 0.15 + half of 0.10 0.18 0.45
    const Pixels faces = pixels_of(image, {20, 36, 96}), edges = pixels_of(image, kBlueEdge),
                 background = pixels_of(image, bytes_of(plan::kDefaultBackground));
    CHECK(faces.size() > 2000);
    CHECK(edges.size() > 200);
    CHECK(faces.size() + edges.size() + background.size() == 240 * 160);
    CHECK(studio.stats.passes == 2);
    CHECK(studio.stats.draws == 2);

    view.wireframe = true;
    CHECK(pixels_of(studio.draw(scene, view), kBlueEdge) == edges);
    CHECK(studio.stats.passes == 1);
    // From behind there is no face, and its edges are there.
    plan::View behind = wire_from({1, 0.5, -4});
    behind.wireframe = false;
    behind.mode = plan::DrawMode::stylized;
    const scene::Image back = studio.draw(scene, behind);
    CHECK(pixels_of(back, kBlueEdge).size() + pixels_of(back, bytes_of(plan::kDefaultBackground)).size() ==
          240 * 160);
}

TEST_CASE("edges do not fight with their faces, at any tilt and distance") {
    RendererFixture studio;
    for (const double tilt : {0.0, 20.0, 50.0, 75.0, 85.0})
        for (const double away : {1.0, 1000.0, 1e6}) {
            CAPTURE(tilt);
            CAPTURE(away);
            // The speck draws the near plane close.
            const auto scene = scene_of({{1, grid(away, 6), material_of({1, 1, 1}),
                                          moved_by({0, 0, -3 * away}) * turned_by(-tilt, {1, 0.3, 0})},
                                         {2, quad(1e-3), material_of({1, 1, 1}), moved_by({1, 0, -0.01})}});
            plan::View view = view_from({0, 0, 0}, {0, 0, -1});
            view.width = 240;
            view.height = 160;
            view.mode = plan::DrawMode::stylized;
            const Pixels with_faces = pixels_of(studio.draw(scene, view), kBlueEdge);
            view.wireframe = true;
            const Pixels alone = pixels_of(studio.draw(scene, view), kBlueEdge);
            CHECK(alone.size() > 400);
            CHECK(with_faces == alone);
        }
}

TEST_CASE("stylized faces hide the edges behind them") {
    RendererFixture studio;
    plan::View view = view_from({0.3, 0.2, 4});
    view.mode = plan::DrawMode::stylized;
    const auto edges = [&](const std::vector<Part>& parts) {
        return pixels_of(studio.draw(scene_of(parts), view), kBlueEdge);
    };
    const Part front{1, quad(1.5), material_of({1, 1, 1}), glm::dmat4(1)};
    const Pixels alone = edges({front});
    for (const double gap : {0.02, 0.5, 10.0}) {
        CAPTURE(gap);
        CHECK(edges({front, {2, grid(1.3, 8), material_of({1, 1, 1}), moved_by({0, 0, -gap})}}) == alone);
    }
    CHECK(edges({front, {2, grid(1.3, 8), material_of({1, 1, 1}), moved_by({0, 0, 0.02})}}).size() >
          2 * alone.size());
}

TEST_CASE("what is selected in a wireframe has its edges in the mark's colour, over everything") {
    RendererFixture studio;
    plan::View view = wire_from({0, 0, 5});
    scene::Material black = material_of({0, 0, 0});
    const auto scene = scene_of({{1, quad(1), black, glm::dmat4(1)},
                                 {2, quad(1), black, moved_by({0, 0, 1})},
                                 {3, grid(1.5, 9), black, moved_by({0, 0, 1.5})}});
    const auto alone = scene_of({{1, quad(1), black, glm::dmat4(1)}});
    const Pixels edges = pixels_of(studio.draw(alone, view), {0, 0, 0});
    CHECK(edges.size() > 200);
    for (const plan::DrawMode mode : {plan::DrawMode::realistic, plan::DrawMode::stylized}) {
        view.mode = mode;
        view.selected = scene->scene->find_node(1);
        CHECK(pixels_of(studio.draw(scene, view), kMarked) == edges);
        CHECK(studio.stats.passes == 2);
        CHECK(studio.stats.draws == 3);
        view.selected = scene::kNone;
        CHECK(pixels_of(studio.draw(scene, view), kMarked).empty());
        CHECK(studio.stats.passes == 1);
    }
}

namespace {

std::shared_ptr<const scene::Scene> car_scene() {
    auto scene = io::read_scene(VRUT_CARS "/car-20k.vrut");
    REQUIRE(scene);
    return scene::place(*std::move(scene)).scene;
}

/// The car, of which only what is opaque and no mirror shows, and windows where they are asked for.
std::shared_ptr<const scene::PlacedScene> shown_parts(const std::shared_ptr<const scene::Scene>& scene,
                                                      bool windows) {
    std::vector<scene::NodeState> states = scene::file_states(*scene);
    for (std::size_t i = 0; i < states.size(); ++i) {
        const auto* data = std::get_if<scene::GeometryData>(&scene->nodes()[i].data);
        if (!data) continue;
        const scene::Material& material = scene->material(data->material);
        if (scene->is_mirror(material, data->geometry) ||
            (scene->is_transparent(material) && !(windows && material.name.starts_with("Glass"))))
            states[i].active = false;
    }
    return std::make_shared<const scene::PlacedScene>(scene::place(scene, std::move(states)));
}

}  // namespace

TEST_CASE("a car's opaque parts take one pass, and what is not wanted costs nothing") {
    const auto car = shown_parts(car_scene(), false);
    RendererFixture studio;
    plan::View view = view_from({3, 2, 5}, {0, 0.7, 0});
    studio.draw(car, view);
    CHECK(studio.stats.passes == 1);
    CHECK(studio.stats.edges == 0);
    plan::View planned = view;
    planned.scene = car;
    const plan::DrawLists lists = plan::plan_frame(planned).scene;
    CHECK(lists.transparent.empty());  // nothing is blended
    CHECK(lists.mirrors.empty());      // nor drawn into another target
    const int draws = studio.stats.draws;
    const auto parts = static_cast<int>(lists.opaque.size());
    CHECK(draws <= parts);  // some show only their backs
    std::uint64_t planned_triangles = 0, shown = 0;
    for (const plan::DrawItem& item : lists.opaque)
        planned_triangles += plan::triangle_count(item, *car->scene);
    const std::vector<bool> shows = scene::shown_nodes(*car, view.camera.eye);
    for (std::size_t i = 0; i < shows.size(); ++i)
        if (const auto* data = std::get_if<scene::GeometryData>(&car->scene->nodes()[i].data);
            data && shows[i])
            shown += car->scene->geometries()[static_cast<std::size_t>(data->geometry)].triangles.size();
    CHECK(planned_triangles == shown);  // none of a paint or rim that the switches do not choose
    CHECK(shown < car->scene->triangle_count());
    CHECK(studio.stats.triangles <= shown);
    const long objects = gl::live_gl_objects();
    view.wireframe = true;
    studio.draw(car, view);
    CHECK(studio.stats.passes == 1);
    CHECK(studio.stats.draws == parts);
    CHECK(studio.stats.triangles == 0);
    CHECK(studio.stats.edges > shown);  // half as many again, were every edge shared by two
    CHECK(studio.stats.edges < 2 * shown);
    CHECK(gl::live_gl_objects() > objects);
    view.wireframe = false;
    view.mode = plan::DrawMode::stylized;
    studio.draw(car, view);
    CHECK(studio.stats.passes == 2);
    CHECK(studio.stats.draws == draws + parts);
    CHECK(studio.stats.uploads == 0);
}

TEST_CASE("a car's windows cost one pass, and a draw each") {
    const auto scene = car_scene();
    RendererFixture studio;
    plan::View view = view_from({3, 2, 5}, {0, 0.7, 0});
    studio.draw(shown_parts(scene, false), view);
    const int draws = studio.stats.draws;
    view.scene = shown_parts(scene, true);
    studio.draw(view.scene, view);
    CHECK(studio.stats.passes == 2);
    int windows = 0;
    for (const plan::TransparentGroup& group : plan::plan_frame(view).scene.transparent)
        windows += static_cast<int>(group.items.size());
    CHECK(windows >= 8);
    CHECK(studio.stats.draws == draws + windows);
}
