#include <algorithm>

#include "reference/reference.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

/// Pixels whose node is another than the reference's.
long off(RendererFixture& studio, const std::shared_ptr<const scene::PlacedScene>& scene, plan::View view) {
    view.scene = scene;
    const std::vector<scene::Index> drawn = studio.renderer().node_ids(view),
                                    should = reference::trace(view).node;
    REQUIRE(drawn.size() == should.size());
    long count = 0;
    for (std::size_t i = 0; i < drawn.size(); ++i) count += drawn[i] != should[i];
    return count;
}

}  // namespace

TEST_CASE("the node at each pixel is the reference's") {
    RendererFixture studio;
    scene::Material glass = material_of({0.1, 0.2, 0.3}), clear = glass;
    glass.diffuse.a = 0.5;
    clear.diffuse.a = 0;
    const std::vector<Part> parts{{70000, sphere(1, 20), material_of({1, 0, 0}), glm::dmat4(1)},
                                  {5, box({0.5, 2, 0.5}), material_of({0, 1, 0}), scaled_by({-1, 1, 1})},
                                  {6, sphere(1, 20), material_of({0, 1, 0}), glm::dmat4(1)},  // a tie
                                  {7, mapped(quad(1.5), 1, {0, 0, 1.5}), glass, turned_by(20, {1, 1, 0})},
                                  {9, mapped(quad(0.5), 1, {-1.5, 0, 2}), clear, glm::dmat4(1)},
                                  {8, mapped(quad(1.5), 1, {0, 0, 2}), glass, turned_by(180, {0, 1, 0})}};
    plan::View view = view_from({1, 2, 6});
    view.width = 320;
    view.height = 240;
    const auto scene = scene_of(parts);
    CHECK(off(studio, scene, view) <= 2);
    view.scene = scene;
    const auto drawn = studio.renderer().node_ids(view);
    for (const scene::Id id : {scene::Id{70000}, scene::Id{5}, scene::Id{7}, scene::Id{9}})
        CHECK(std::count(drawn.begin(), drawn.end(), scene->scene->find_node(id)) > 100);
    CHECK(std::count(drawn.begin(), drawn.end(), scene->scene->find_node(6)) == 0);
    CHECK(std::count(drawn.begin(), drawn.end(), scene->scene->find_node(8)) == 0);

    // Upright, and of odd width.
    plan::View odd = pixel_view(3, 2);
    const auto bar = scene_of({{3, rectangle(0, 0, 2, 1, odd), material_of({1, 1, 1}), glm::dmat4(1)}});
    odd.scene = bar;
    const scene::Index node = bar->scene->find_node(3);
    CHECK(studio.renderer().node_ids(odd) ==
          std::vector<scene::Index>{scene::kNone, scene::kNone, scene::kNone, node, node, scene::kNone});
    odd.wireframe = true;
    CHECK(studio.renderer().node_ids(odd) == std::vector<scene::Index>(6, scene::kNone));
    odd.scene = nullptr;
    CHECK(studio.renderer().node_ids(odd) == std::vector<scene::Index>(6, scene::kNone));
}
