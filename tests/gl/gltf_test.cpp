#include <algorithm>
#include <cstdlib>

#include "io/read_scene.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

/// With the ambient colour that a white glTF material has.
std::shared_ptr<const scene::PlacedScene> placed(const std::string& file) {
    auto parts = io::read_scene_parts(file);
    REQUIRE_MESSAGE(parts, parts.error());
    for (scene::Material& material : parts->materials) material.ambient = {0.1, 0.1, 0.1, 1};
    auto scene = io::build_scene(*std::move(parts), file);
    REQUIRE_MESSAGE(scene, scene.error());
    return std::make_shared<scene::PlacedScene>(scene::place(*std::move(scene)));
}

}  // namespace

TEST_CASE("a scene in glTF is drawn as the same scene in scene text") {
    RendererFixture studio;
    const plan::View view = view_from({0, 0.5, 6.4});
    const scene::Image text = studio.draw(placed(VRUT_SCENES "/teaching/texture.vrut"), view);
    const scene::Image gltf = studio.draw(placed(VRUT_TEST_DATA "/texture.gltf"), view);
    REQUIRE(gltf.rgba.size() == text.rgba.size());
    const auto pixel = [&](int x, int y) {
        return &gltf.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width) +
                               static_cast<std::size_t>(x))];
    };
    const std::uint8_t *card = pixel(view.width / 4, view.height / 2), *background = pixel(0, 0);
    CHECK_FALSE(std::equal(card, card + 4, background));
    int worst = 0;
    for (std::size_t i = 0; i < text.rgba.size(); ++i)
        worst = std::max(worst, std::abs(int{text.rgba[i]} - int{gltf.rgba[i]}));
    CHECK(worst <= 1);
}
