#include "agreement.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "io/read_scene.hpp"
#include "navigation/camera_moves.hpp"
#include "needs_folder.hpp"
#include "renderer_fixture.hpp"
#include "scene_variants.hpp"

using namespace vrut;

namespace {

namespace fs = std::filesystem;

/// Of the pixels that show a surface; the rest are at outlines and creases.
constexpr double kLeastInterior = 0.6;

std::vector<fs::path> teaching_scenes() {
    std::vector<fs::path> scenes;
    for (const auto& entry : fs::directory_iterator(VRUT_SCENES "/teaching"))
        if (entry.path().extension() == ".vrut") scenes.push_back(entry.path());
    std::sort(scenes.begin(), scenes.end());
    return scenes;
}

/// As it starts, but under the scene's own light where it has one.
plan::View view_of_file(const fs::path& path, int width, int height) {
    auto scene = io::read_scene(path);
    REQUIRE_MESSAGE(scene, scene.error());
    plan::View view;
    view.scene = std::make_shared<const scene::PlacedScene>(scene::place(*std::move(scene)));
    view.width = width;
    view.height = height;
    const scene::PlacedScene& placed = *view.scene;
    const auto& nodes = placed.scene->nodes();
    view.camera =
        navigation::home_camera(navigation::fit_target(placed.bounds), static_cast<double>(width) / height);
    if (const scene::Index camera = scene::first_camera_node(placed); camera != scene::kNone)
        view.camera = *scene::camera_at(placed, camera);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto node = static_cast<scene::Index>(i);
        if (std::holds_alternative<scene::LightData>(nodes[i].data))
            view.light = scene::light_of(placed, node);
        if (const auto* data = std::get_if<scene::BackgroundData>(&nodes[i].data)) {
            const scene::Material& material = placed.scene->material(data->material);
            view.background = {glm::dvec3(material.diffuse), material.texture, data->cube_textures};
        }
    }
    return view;
}

std::vector<scene::Id> ids_of(const plan::View& view, const std::vector<scene::Index>& nodes,
                              scene::Id divisor) {
    std::vector<scene::Id> ids;
    ids.reserve(nodes.size());
    for (const scene::Index node : nodes)
        ids.push_back(node == scene::kNone
                          ? -1
                          : view.scene->scene->nodes()[static_cast<std::size_t>(node)].id / divisor);
    return ids;
}

/// Where the stylized drawing may have edges, which the reference leaves out.
std::vector<bool> edges_of(RendererFixture& studio, plan::View view) {
    const std::size_t pixels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
    std::vector<bool> edges(pixels);
    if (view.mode == plan::DrawMode::realistic) return edges;
    view.wireframe = true;
    view.background = {};
    const scene::Image image = studio.draw(view.scene, view);
    for (std::size_t i = 0; i < pixels; ++i)
        edges[i] = glm::ivec3(image.rgba[4 * i], image.rgba[4 * i + 1], image.rgba[4 * i + 2]) !=
                   bytes_of(plan::kDefaultBackground);
    return edges;
}

/// Lines of cuts, which the reference leaves out, are of a colour that nothing else has.
void add_cut_lines(const scene::Image& drawn, std::vector<bool>& lines) {
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (glm::ivec3(drawn.rgba[4 * i], drawn.rgba[4 * i + 1], drawn.rgba[4 * i + 2]) == glm::ivec3(26))
            lines[i] = true;
}

/// Draws a variant of the scene that is judged. All numbers are printed where VRUT_AGREEMENT is set.
void check_drawing(RendererFixture& studio, const std::string& what, const SceneVariant& variant,
                   const JudgedReference& judge, const std::vector<scene::Id>& expected) {
    const std::vector<scene::Index> nodes = studio.renderer().node_ids(variant.view);
    const scene::Image drawn = studio.draw(variant.view.scene, variant.view);
    std::vector<bool> lines = edges_of(studio, variant.view);
    if (!variant.view.clip_planes.empty()) add_cut_lines(drawn, lines);
    Agreement result = agreement(judge, drawn, lines, ids_of(variant.view, nodes, variant.ids), expected);
    // Lines behind glass and in mirrors are mixed with other colours, and not known. Interior pixels have
    // none.
    if (!variant.view.clip_planes.empty()) result.one_node_beyond = 0;
    if (std::getenv("VRUT_AGREEMENT") != nullptr)
        std::printf("%s: %s\n", what.c_str(), line_of(result).c_str());
    CHECK_MESSAGE(violations(result).empty(), what << ": " << violations(result));
}

/// Draws the scene as it is and in all its variants, each in both modes, against one reference.
void check_agreement(RendererFixture& studio, const std::string& name, plan::View view) {
    for (const plan::DrawMode mode : {plan::DrawMode::realistic, plan::DrawMode::stylized}) {
        view.mode = mode;
        const JudgedReference judge = judge_of(view);
        CHECK_MESSAGE(interior_share(judge) > kLeastInterior, name);
        const std::vector<scene::Id> expected = ids_of(view, judge.picture.node, 1);
        std::vector<SceneVariant> variants = variants_of(view);
        variants.insert(variants.begin(), {"as it is", view});
        for (const SceneVariant& variant : variants)
            check_drawing(studio,
                          name + (mode == plan::DrawMode::stylized ? ", stylized, " : ", ") + variant.name,
                          variant, judge, expected);
    }
}

scene::ClipPlane through_middle(const plan::View& view, const glm::dvec3& normal, bool caps) {
    const glm::dvec3 unit = glm::normalize(normal);
    return {unit, glm::dot(unit, view.scene->bounds.center()), caps};
}

/// One plane, and two with a box's six. Halves of parts are not watertight: their planes have no caps.
void check_sections(RendererFixture& studio, const std::string& name, plan::View view) {
    const scene::PlacedScene& placed = *view.scene;
    const auto box = [&](std::vector<scene::ClipPlane> planes) {
        for (int axis = 0; axis < 3; ++axis)
            for (const double sign : {-1.0, 1.0}) {
                glm::dvec3 normal(0);
                normal[axis] = sign;
                planes.push_back({normal, glm::dot(normal, placed.bounds.center()) +
                                              0.75 * placed.bounds.half_extent()[axis]});
            }
        return planes;
    };
    const std::vector<scene::ClipPlane> one{through_middle(view, {0.3, 0.1, 1}, true)};
    const std::vector<scene::ClipPlane> uncapped{through_middle(view, {0.3, 0.1, 1}, false)};
    const std::vector<scene::ClipPlane> many =
        box({through_middle(view, {1, 1, 0.2}, true), through_middle(view, {-0.2, 1, 0.4}, false)});
    for (const auto& planes : {one, uncapped, many}) {
        view.clip_planes = planes;
        const JudgedReference judge = judge_of(view);
        const std::vector<scene::Id> expected = ids_of(view, judge.picture.node, 1);
        std::vector<SceneVariant> variants = variants_of(view);
        variants.insert(variants.begin(), {"as it is", view});
        for (const SceneVariant& variant : variants)
            if (variant.name != "split" || planes == uncapped)
                check_drawing(studio,
                              name + ", " + std::to_string(planes.size()) + " planes, " + variant.name,
                              variant, judge, expected);
    }
    view.clip_planes = one;
    view.mode = plan::DrawMode::stylized;
    const JudgedReference judge = judge_of(view);
    check_drawing(studio, name + ", stylized", {"as it is", view}, judge,
                  ids_of(view, judge.picture.node, 1));
}

}  // namespace

TEST_CASE("a drawing that is off is told") {
    const plan::View view = view_of_file(VRUT_SCENES "/teaching/materials.vrut", 160, 120);
    const JudgedReference judge = judge_of(view);
    const std::vector<scene::Id> ids = ids_of(view, judge.picture.node, 1);
    const std::vector<bool> nothing(ids.size());
    const scene::Image right = reference::image_of(judge.picture);
    CHECK(violations(agreement(judge, right, nothing, ids, ids)).empty());

    const auto at = static_cast<std::size_t>(std::find(judge.interior.begin(), judge.interior.end(), true) -
                                             judge.interior.begin());
    scene::Image wrong = right;
    for (std::size_t i = 0; i < 4; ++i) wrong.rgba[4 * (at + i)] -= 2;
    CHECK_FALSE(violations(agreement(judge, wrong, nothing, ids, ids)).empty());

    std::vector<scene::Id> others = ids;
    others[at] = 77;
    CHECK(violations(agreement(judge, right, nothing, others, ids)).empty());
    others[at + 1] = others[at + 2] = 77;
    CHECK_FALSE(violations(agreement(judge, right, nothing, others, ids)).empty());
}

TEST_CASE("teaching scenes are drawn as the reference has them, whatever their size, place and parts") {
    RendererFixture studio;
    const std::vector<fs::path> scenes = teaching_scenes();
    CHECK(scenes.size() > 30);
    for (const fs::path& scene : scenes)
        check_agreement(studio, scene.stem().string(), view_of_file(scene, 320, 240));
}

TEST_CASE("sections are drawn as the reference has them, whatever the size and place of the scene") {
    RendererFixture studio;
    check_sections(studio, "car", view_of_file(VRUT_CARS "/car.vrut", 640, 400));
    for (const char* scene : {"mirror", "materials", "glass"})
        check_sections(studio, scene,
                       view_of_file(VRUT_SCENES "/teaching/" + std::string(scene) + ".vrut", 320, 240));
}

TEST_CASE("the car is drawn as the reference has it") {
    RendererFixture studio;
    check_agreement(studio, "car", view_of_file(VRUT_CARS "/car.vrut", 640, 400));
}

TEST_CASE("models of other programs are drawn as the reference has them" * NeedsFolder{"VRUT_TEST_MODELS"}) {
    const fs::path models = folder_of("VRUT_TEST_MODELS");
    RendererFixture studio;
    for (const char* file :
         {"bmw_m6/bmw_m6.glb", "hatchback/hatchback/meshes/hatchback.obj", "jeep/2013_ASCII/jeep1.fbx",
          "jeep/2013_BINARY/jeep1.fbx", "racing/vehicle-motorcycle.glb", "racing/vehicle-truck-green.glb",
          "racing/vehicle-truck-red.glb"}) {
        const plan::View view = view_of_file(models / file, 640, 400);
        const JudgedReference judge = judge_of(view);
        check_drawing(studio, file, {"as it is", view}, judge, ids_of(view, judge.picture.node, 1));
    }
}
